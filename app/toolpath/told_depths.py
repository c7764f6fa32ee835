"""Which shape of a drawing each depth is of that the drawing tells, and the operations that are cut to these depths.

A depth by elevation or thickness is that of the contour whose curves lie there. A text is of the shape whose line is
nearest to its letters: of one that holds it at any distance, else of one within a few letters' height. Where two
shapes are as near, or two texts tell one shape different depths, nobody guesses: it is named, and the operation's own
depth holds.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
import shapely

from ..core.errors import ParameterError
from ..geometry.outlines import holders
from ..geometry.primitives import contour_rows, sample
from ..geometry.sample import bounds, union
from ..model.curve_selectors import CurveNumber
from ..model.drawn_depths import DepthSource, DrawnDepth
from ..model.fields import parameters_of
from ..model.hole_operations import HoleOperation
from ..model.job import Copies, Job
from ..model.operation import Operation, Side
from ..model.part import Contour
from .drawn_contours import DrawnContours, drawn_contours, selected
from .drill_holes import circle_of, holes_of

BESIDE = 3.0
"""Heights of letters from a text to a shape that it is beside."""

_NEARER = 0.5
"""Heights of letters by which the next shape must be farther than the one that a text is of."""

_CHORD = 0.01
"""mm by which chords may leave arcs where texts are assigned to shapes."""
_ALIKE = 1e-6
"""mm; depths that differ by no more are one."""


@dataclass(frozen=True)
class ToldDepth:
    """A depth and the contour that it is of."""

    told: DrawnDepth
    contour: Contour

    @property
    def depth(self) -> float:
        """How deep it is, mm."""
        assert self.told.depth is not None
        return self.told.depth


@dataclass(frozen=True)
class UnclearDepth:
    """What tells a depth and is of no shape, or of none alone; `why`: in words."""

    told: DrawnDepth
    why: str


@dataclass(frozen=True)
class ToldDepths:
    """What a drawing tells of the depths of a job's shapes.

    Attributes:
        job: whose operations are cut to these depths, one for each depth of an operation.
        told: depths that are used. unclear: those that are not.
        untold: contours that operations cut to their own depth, for the drawing tells none.
    """

    job: Job
    told: tuple[ToldDepth, ...] = ()
    unclear: tuple[UnclearDepth, ...] = ()
    untold: tuple[Contour, ...] = ()


def told_depths(job: Job) -> ToldDepths:
    """Return a job whose operations are cut to the depths that its drawing tells.

    An operation that clears within its lines comes once for each depth of its shapes: what lies in a shape and tells
    a smaller depth, or none, is an island in it, what tells a larger one is cut deeper thereafter. Others come once
    for each depth of the contours that they follow. What tells no depth is cut as deep as the operation says.
    """
    single = replace(job, copies=Copies())
    drawn = drawn_contours(single)
    assigned = _Assigned(single, drawn)
    operations = tuple(new for each in job.operations for new in assigned.operations_of(each))
    used = {id(each): each for each in assigned.untold}
    return ToldDepths(
        replace(job, operations=operations),
        tuple(assigned.told.values()),
        tuple(assigned.unclear),
        tuple(used.values()),
    )


@dataclass
class _Assigned:
    """Depths by the identity of their contours, and what is not clear."""

    job: Job
    drawn: DrawnContours
    told: dict[int, ToldDepth] = field(default_factory=dict)
    unclear: list[UnclearDepth] = field(default_factory=list)
    untold: list[Contour] = field(default_factory=list)

    def __post_init__(self) -> None:
        self._heights()
        self._texts()

    @cached_property
    def letters(self) -> frozenset[int]:
        """Numbers of the curves of texts that speak of depths, which nothing machines."""
        texts = (each for each in self.job.part.depths if each.source is DepthSource.TEXT)
        return frozenset(number for each in texts for number in each.curves)

    def _is_shape(self, contour: Contour) -> bool:
        return self.letters.isdisjoint(contour.entity_ids)

    @cached_property
    def shapes(self) -> list[Contour]:
        """The contours that an operation cuts to a depth."""
        found: dict[int, Contour] = {}
        for operation in self.job.operations:
            if _reads(operation):
                found |= {id(each): each for each in self._cut_by(operation)}
        return list(found.values())

    def _cut_by(self, operation: Operation) -> list[Contour]:
        """Return the contours of an operation."""
        of = selected(self.drawn, operation.cut.curves)
        closed = [each for each in of.closed if self._is_shape(each)]
        if isinstance(operation, HoleOperation):
            holes = holes_of(self.job, self.drawn, operation)
            taken = {*holes.drilled, *holes.narrow, *holes.held}
            return [each for each in closed if circle_of(each) in taken]
        if operation.wall_side in (None, Side.ON):
            return closed + [each for each in of.open if self._is_shape(each)]
        return closed

    def _heights(self) -> None:
        """Give contours the depths at which their curves lie."""
        by_number = {
            number: each
            for each in self.job.part.depths
            if each.source is not DepthSource.TEXT
            for number in each.curves
        }
        unclear: dict[int, UnclearDepth] = {}
        for contour in self.shapes if by_number else ():
            found = {id(by_number.get(number)): by_number.get(number) for number in contour.entity_ids}
            first = next((each for each in found.values() if each is not None), None)
            if first is None:
                continue
            if len(found) > 1:
                unclear[id(first)] = UnclearDepth(first, "other curves of the same shape lie elsewhere along Z")
            elif first.depth is None:
                unclear[id(first)] = UnclearDepth(first, "its curves lean")
            else:
                self.told[id(contour)] = ToldDepth(first, contour)
        self.unclear += unclear.values()

    def _texts(self) -> None:
        """Give shapes the depths of the texts beside them."""
        texts = [each for each in self.job.part.depths if each.source is DepthSource.TEXT]
        if not texts or not self.shapes:
            self.unclear += [UnclearDepth(each, "there is no shape for it") for each in texts]
            return
        near = _Near(self.shapes)
        given: defaultdict[int, list[ToldDepth]] = defaultdict(list)
        for text in texts:
            if text.depth is None:
                self.unclear.append(UnclearDepth(text, "it tells no depth, or several"))
            elif isinstance(found := near.shape_of(text, self._box(text)), str):
                self.unclear.append(UnclearDepth(text, found))
            else:
                given[id(found)].append(ToldDepth(text, found))
        for key, several in given.items():
            if max(each.depth for each in several) - min(each.depth for each in several) > _ALIKE:
                why = "another text tells the same shape another depth"
                self.unclear += [UnclearDepth(each.told, why) for each in several]
                self.told.pop(key, None)
            else:
                self.told[key] = several[0]

    def _box(self, text: DrawnDepth) -> shapely.Geometry:
        """Return the box of a text's letters; its place where it has none."""
        own = set(text.curves)
        box = union([bounds(each.curve) for each in self.job.part.entities if each.id in own])
        at = shapely.Point(text.at)
        return at if box is None else shapely.envelope(shapely.union(shapely.box(*box), at))

    def operations_of(self, operation: Operation) -> Iterator[Operation]:
        """Yield an operation once for each depth of its shapes."""
        if not operation.cut.enabled or operation.FACES:
            yield operation
            return
        if not _reads(operation):
            yield self._without_letters(operation)
            return
        contours = self._cut_by(operation)
        if operation.wall_side is Side.INSIDE and not operation.HOLES:
            groups = self._floors(contours, operation.cut.depth)
        else:
            groups = self._each(contours, operation.cut.depth)
        for depth in sorted(groups):
            yield _cut_to(operation, depth, groups[depth])
        if not groups:
            yield self._without_letters(operation)

    def _without_letters(self, operation: Operation) -> Operation:
        """Return an operation that leaves the letters of depths alone."""
        of = selected(self.drawn, operation.cut.curves)
        contours = (*of.closed, *of.open)
        if all(map(self._is_shape, contours)):
            return operation
        return _cut_to(operation, operation.cut.depth, [each for each in contours if self._is_shape(each)])

    def _each(self, contours: Sequence[Contour], own: float) -> dict[float, list[Contour]]:
        """Return contours by the depth that each tells itself."""
        groups: defaultdict[float, list[Contour]] = defaultdict(list)
        for contour in contours:
            told = self.told.get(id(contour))
            if told is None:
                self.untold.append(contour)
            groups[own if told is None else told.depth].append(contour)
        return groups

    def _floors(self, contours: Sequence[Contour], own: float) -> dict[float, list[Contour]]:
        """Return for each depth the contours that bound the ground that is cut to it, with all in it that is deeper."""
        held = holders(contours)
        order = sorted(range(len(contours)), key=lambda k: len(held[k]))
        around = [max(held[k], key=lambda j: len(held[j]), default=None) for k in range(len(contours))]
        floor: list[float] = [0.0] * len(contours)
        for k in order:
            told, outer = self.told.get(id(contours[k])), around[k]
            if told is not None:
                floor[k] = told.depth
            elif outer is None or floor[outer] == 0.0:
                outside = [*_outwards(around, k)]
                floor[k] = next((floor[j] for j in outside if floor[j]), own)
                if not any(id(contours[j]) in self.told for j in outside):
                    self.untold.append(contours[k])
        groups = {}
        for depth in sorted({each for each in floor if each}):
            group = _ground(_Ground(depth, floor, around), order)
            groups[depth] = [contours[k] for k in group]
        return groups


def _outwards(around: Sequence[int | None], k: int) -> Iterator[int]:
    """Yield the contours round one, from the nearest on."""
    outer = around[k]
    while outer is not None:
        yield outer
        outer = around[outer]


@dataclass(frozen=True)
class _Ground:
    """Ground of at least a depth: floors by contour, and the contour round each."""

    depth: float
    floor: Sequence[float]
    around: Sequence[int | None]

    def deep(self, k: int | None) -> bool:
        """Whether the ground just within a contour is cut; None: outside of all."""
        return k is not None and self.floor[k] >= self.depth

    def opening(self, k: int) -> int | None:
        """Return the contour at which the ground opens that lies within one, or that an island stands in."""
        at: int | None = k if self.deep(k) else self.around[k]
        if not self.deep(at):
            return None
        while at is not None and self.deep(self.around[at]):
            at = self.around[at]
        return at


def _ground(ground: _Ground, order: Sequence[int]) -> list[int]:
    """Return which contours bound the pieces of ground of at least a depth that have a floor of just this depth."""
    opened = {ground.opening(k) for k in order if ground.floor[k] == ground.depth}
    return [k for k in sorted(order) if ground.deep(k) != ground.deep(ground.around[k]) and ground.opening(k) in opened]


class _Near:
    """Shapes by their distance from texts."""

    def __init__(self, shapes: Sequence[Contour]) -> None:
        self._shapes = shapes
        rings = [sample(contour_rows(each), _CHORD) for each in shapes]
        self._lines = np.array(
            [
                shapely.LineString([*ring, ring[0] if each.closed else each.primitives[-1].end])
                for ring, each in zip(rings, shapes, strict=True)
            ],
            dtype=object,
        )
        self._areas = [
            shapely.make_valid(shapely.Polygon(ring)) if each.closed and len(ring) > 3 else None
            for ring, each in zip(rings, shapes, strict=True)
        ]

    def shape_of(self, text: DrawnDepth, letters: shapely.Geometry) -> Contour | str:
        """Return the shape that a text is beside or in, or why there is none."""
        far = shapely.distance(self._lines, letters)
        k = int(np.argmin(far))
        area = self._areas[k]
        if not (area is not None and area.covers(letters.centroid)) and far[k] > BESIDE * text.height:
            return "no shape is near to it"
        others = np.delete(far, k)
        if len(others) and others.min() - far[k] < _NEARER * text.height:
            return "two shapes are as near to it"
        return self._shapes[k]


def _reads(operation: Operation) -> bool:
    """Tell whether an operation is cut to a depth."""
    return operation.cut.enabled and not operation.FACES and "depth" in parameters_of(type(operation))


def _cut_to(operation: Operation, depth: float, contours: Sequence[Contour]) -> Operation:
    """Return an operation on some contours, to a depth.

    Raises:
        ParameterError: its parameters do not go with this depth.
    """
    cut = operation.cut
    curves = tuple(dict.fromkeys(CurveNumber(each.entity_ids[0]) for each in contours))
    try:
        return replace(operation, cut=replace(cut, depth=depth, stepdown=min(cut.stepdown, depth), curves=curves))
    except ParameterError as error:
        raise ParameterError(
            f"The {operation.WORD} T{cut.tool} is to go {depth:g} mm deep, as the drawing tells: {error}"
        ) from error
