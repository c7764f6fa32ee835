"""What of a drawing a job machines: contours of its layers, its copies, open lines, and the clamps that no tool may
touch.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from enum import Enum
from functools import cached_property
from operator import is_

import numpy as np
import shapely
import shapely.affinity
from numpy.typing import NDArray

from ..core import tolerances
from ..core.errors import ParameterError
from ..core.options import option
from ..core.wording import in_plane
from ..geometry.as_circle import as_circle
from ..geometry.chaining.chain import ChainingResult, chain
from ..geometry.even_odd import even_odd
from ..geometry.outlines import holders, nested, reversed_contour
from ..geometry.overlay.overlay import OverlayResult, without_crossings, without_outlines
from ..geometry.primitives import contour_rows, sample, signed_area
from ..model.curve_selectors import CirclesOf, ContourKind, CurveNumber, OnLayer, Selector, layer_names
from ..model.curves import Arc, Circle, Line, Point, Primitive
from ..model.fields import parameters_of
from ..model.finding import Finding, FindingKind
from ..model.job import Job
from ..model.notes import Mark, Note
from ..model.operation import Operation, Side
from ..model.part import Contour, Entity, Region
from ..model.stock_box import extent
from .witness import chaining_findings, region_findings

_CHORD = 1e-3
"""mm; arcs as chords within this, where it is asked what lies in what."""


@dataclass(frozen=True)
class DrawnRegions:
    """Regions that closed contours bound.

    Attributes:
        about: tells how they came about; the witness measures for it, so it is asked once, by whoever looks.
    """

    regions: tuple[Region, ...]
    about: Callable[[], Iterable[Finding]] = tuple

    @cached_property
    def findings(self) -> tuple[Finding, ...]:
        """What there is to say of how they came about."""
        return tuple(self.about())


@dataclass(frozen=True)
class DrawnContours:
    """The contours of a job, copies and all.

    Attributes:
        closed: contours of the wanted layers.
        open: lines that are not closed, and all strokes of letters.
        crossing: True where closed ones may cross, themselves or one another.
        clamps: what closed outlines of keep-out layers hold, one region an outline, without islands; they may overlap.
            Not copied.
        about: tells what there is to say about the drawing; the witness measures for it, so it is asked once, by
            whoever looks.
    """

    closed: tuple[Contour, ...] = ()
    open: tuple[Contour, ...] = ()
    crossing: bool = False
    clamps: tuple[Region, ...] = ()
    about: Callable[[], Iterable[Finding]] = tuple

    @cached_property
    def findings(self) -> tuple[Finding, ...]:
        """What there is to say about the drawing."""
        return tuple(self.about())

    @cached_property
    def uncrossed(self) -> OverlayResult:
        """The closed contours as ones that do not cross, and bound the same even-odd."""
        return without_crossings(self.closed) if self.crossing else OverlayResult(self.closed)

    def without_crossings(self, contours: Sequence[Contour]) -> OverlayResult:
        """Return `uncrossed` of some contours, which are closed ones and others; of all closed ones it is made once."""
        if self._all_closed(contours):
            return self.uncrossed
        return without_crossings(contours) if self.crossing else OverlayResult(tuple(contours))

    @cached_property
    def regions(self) -> DrawnRegions:
        """What all closed contours bound, without a look at clamps; those that meet count even-odd."""
        made = self.uncrossed
        nesting = nested(made.contours)
        return DrawnRegions(nesting.regions, lambda: [*made.findings, *region_findings(self.closed, (), nesting)])

    def regions_of(self, contours: Sequence[Contour]) -> DrawnRegions:
        """Return `regions` of some contours, which are closed ones and others, without what clamps hold; the witness is
        asked about them. Of all closed ones, where nothing is clamped, they are made once.
        """
        if self._all_closed(contours) and not self.clamps:
            return self.regions
        plain = self.without_crossings(contours)
        outlines = [clamp.boundary for clamp in self.clamps]
        free = without_outlines(plain.contours, outlines)
        nesting = nested(free.contours)
        return DrawnRegions(
            nesting.regions,
            lambda: [*plain.findings, *free.findings, *region_findings(contours, outlines, nesting)],
        )

    def _all_closed(self, contours: Sequence[Contour]) -> bool:
        return len(contours) == len(self.closed) and all(map(is_, contours, self.closed))

    @cached_property
    def holders(self) -> list[list[int]]:
        """Which closed contours lie round each closed one, by their indices."""
        return holders(self.closed)

    @cached_property
    def inner(self) -> frozenset[int]:
        """The identities of the closed contours that lie in another closed one."""
        return frozenset(id(each) for each, held in zip(self.closed, self.holders, strict=True) if held)


def layers_of(job: Job) -> frozenset[str]:
    """Return the names of the layers that a job machines.

    Raises:
        ParameterError: a layer of an operation, or a keep-out layer, is not in the drawing, or a layer is both.
    """
    known = {layer.name for layer in job.part.layers}
    visible = {layer.name for layer in job.part.layers if layer.visible}
    requested = {name for each in job.operations if each.cut.enabled for name in layer_names(each.cut.curves)}
    for name in (*job.keep_out_layers, *sorted(requested)):
        if name not in known:
            raise ParameterError(f"The drawing has no layer '{name}'; it has {', '.join(sorted(known)) or 'none'}.")
    for name in job.keep_out_layers:
        if name in requested or name in job.layer_names:
            raise ParameterError(f"Layer '{name}' is to be machined and to be kept off; take it out of one of the two.")
    return frozenset(((set(job.layer_names) or visible) | requested) - set(job.keep_out_layers))


def drawn_contours(job: Job) -> DrawnContours:
    """Return what a job machines of its drawing.

    Raises:
        ParameterError: it names a layer that the drawing does not have.
    """
    layers = layers_of(job)
    entities = [e for e in job.part.entities if e.layer in layers and not e.lettering]
    chaining = chain(entities, job.join_tolerance)
    strokes, about_strokes = strokes_of(
        [e for e in job.part.entities if e.layer in layers and e.lettering], job.join_tolerance
    )
    closed = [contour for contour in chaining.contours if contour.closed] + _point_holes(job, layers)
    lines = [contour for contour in chaining.contours if not contour.closed]
    clamps, about_clamps = clamps_of(job)
    meet = _copies_meet(closed, job)
    crossing = bool(meet) or _crosses(chaining.findings)
    shifts = job.copies.shifts
    copies = _copied(closed, shifts)

    def about() -> tuple[Finding, ...]:
        doubts = chaining_findings(entities, chaining, job.join_tolerance)
        return (*chaining.findings, *doubts, *about_clamps, *meet, *_under_clamps(copies, clamps), *about_strokes)

    return DrawnContours(copies, _copied([*lines, *strokes], shifts), crossing, clamps, about)


def _point_holes(job: Job, layers: frozenset[str]) -> list[Contour]:
    """Return a circle at each drawn point for every width of the tools of operations that take points, once a place."""
    points = [(note, note.shape.at) for note in job.part.notes if isinstance(note.shape, Mark) and note.layer in layers]
    taking = [each for each in job.operations if each.cut.enabled and each.takes_points]
    if not points or not taking:
        return []
    found: dict[tuple[Point, float], Contour] = {}
    for operation in taking:
        radius = job.tool(operation.cut.tool).radius
        for note, at in points:
            if _names(operation.cut.curves, note):
                found.setdefault(
                    (at, radius), Contour((Circle(at, radius),), closed=True, layer=note.layer, entity_ids=(note.id,))
                )
    return list(found.values())


def _names(curves: Sequence[Selector], note: Note) -> bool:
    """Tell whether selectors take a point in: by its number, by its layer, or because there are none."""
    return not curves or any(each in (CurveNumber(note.id), OnLayer(note.layer)) for each in curves)


def _crosses(findings: Sequence[Finding]) -> bool:
    return any(finding.kind is FindingKind.SELF_INTERSECTION for finding in findings)


def clamps_of(job: Job) -> tuple[tuple[Region, ...], list[Finding]]:
    """Return what the outlines of keep-out layers hold, and what is to say about them.

    An outline holds all that is in it: a bolt that is drawn inside of a clamp is no hole in it, and where two clamps
    lie over one another is no gap between them.
    """
    requested = set(job.keep_out_layers)
    if not requested:
        return (), []
    entities = [e for e in job.part.entities if e.layer in requested and not e.lettering]
    chaining = chain(entities, job.join_tolerance)
    closed = [contour for contour in chaining.contours if contour.closed]
    findings = [
        Finding(
            FindingKind.OPEN_CONTOUR,
            f"An outline of keep-out layer '{contour.layer}' is open at {in_plane(x, y)}, "
            "so it keeps nothing out; close it.",
            x,
            y,
            entity_ids=contour.entity_ids,
        )
        for contour in chaining.contours
        if not contour.closed
        for x, y in [contour.primitives[-1].end]
    ]
    if not closed:
        findings.append(
            Finding(FindingKind.LEFT_OUT, f"Keep-out layers {', '.join(job.keep_out_layers)} have no closed outline.")
        )
    if _crosses(chaining.findings):
        plain = [without_crossings([contour]) for contour in closed]
        closed = [part for each in plain for part in each.contours]
        findings += [finding for each in plain for finding in each.findings]
    findings += chaining_findings(entities, chaining, job.join_tolerance)
    return outermost(closed), findings


def outermost(contours: Sequence[Contour]) -> tuple[Region, ...]:
    """Return what each contour holds, all of it, but for those of which another one holds all, exactly."""
    areas = np.array([abs(signed_area(contour_rows(each))) for each in contours])
    around = np.array([extent([each]) for each in contours]).reshape(-1, 4)

    def is_held(k: int) -> bool:
        wide = (around[:, :2] <= around[k, :2] + _CHORD).all(axis=1) & (around[:, 2:] >= around[k, 2:] - _CHORD).all(
            axis=1
        )
        larger = (areas > areas[k]) | ((areas == areas[k]) & (np.arange(len(areas)) < k))
        left = (even_odd([contours[k]], [contours[j]]) for j in np.flatnonzero(wide & larger).tolist())
        return any(each.area <= each.length * tolerances.WELD for each in left)

    kept = [each for k, each in enumerate(contours) if areas[k] > 0 and not is_held(k)]
    return tuple(
        Region(number, each if signed_area(contour_rows(each)) > 0 else reversed_contour(each))
        for number, each in enumerate(kept, 1)
    )


def boxes_near(contours: Sequence[Contour], others: Sequence[Contour]) -> list[int]:
    """Return which contours (indices, rising) have boxes that come within 1 um of the box of another."""
    if not contours or not others:
        return []
    mine, theirs = (shapely.box(*np.array([extent([each]) for each in some]).T) for some in (contours, others))
    found: list[int] = np.unique(shapely.STRtree(theirs).query(mine, predicate="dwithin", distance=_CHORD)[0]).tolist()
    return found


def filled(contours: Sequence[Contour]) -> NDArray[np.object_]:
    """Return what contours hold, as polygons (n,)."""
    rings = [sample(contour_rows(contour), _CHORD) for contour in contours]
    shapes = [shapely.make_valid(shapely.Polygon(ring)) if len(ring) > 2 else shapely.Polygon() for ring in rings]
    found = np.empty(len(shapes), dtype=object)
    found[:] = shapes
    return found


def _under_clamps(contours: Sequence[Contour], clamps: Sequence[Region]) -> list[Finding]:
    """Return what is not machined because clamps lie over it."""
    if not clamps or not contours:
        return []
    held = shapely.union_all(filled([clamp.boundary for clamp in clamps]))
    near = boxes_near(contours, [clamp.boundary for clamp in clamps])
    shapes = filled([contours[k] for k in near])
    shapely.prepare(held)
    inside = shapely.covers(held, shapes)
    whole = [contours[k] for k, under in zip(near, inside.tolist(), strict=True) if under]
    findings = []
    if whole:
        x, y = whole[0].primitives[0].start
        what = "The contour that begins" if len(whole) == 1 else f"{len(whole)} contours, of which the first begins"
        text = (
            f"{what} at {in_plane(x, y)} {'lies' if len(whole) == 1 else 'lie'} wholly under clamps, and nothing "
            "is machined there."
        )
        ids = tuple(dict.fromkeys(number for contour in whole for number in contour.entity_ids))
        findings.append(Finding(FindingKind.LEFT_OUT, text, x, y, entity_ids=ids, amount=float(len(whole))))
    partly = int(np.sum(~inside & shapely.intersects(held, shapely.boundary(shapes))))
    if partly:
        text = (
            f"Clamps lie over parts of {partly} {'contour' if partly == 1 else 'contours'}; what is under them is "
            "not machined."
        )
        findings.append(Finding(FindingKind.LEFT_OUT, text, counts=False, amount=float(partly)))
    return findings


def moved(primitive: Primitive, dx: float, dy: float) -> Primitive:
    """Return a line, arc or circle moved by (dx, dy), mm."""

    def at(point: Point) -> Point:
        return point[0] + dx, point[1] + dy

    if isinstance(primitive, Line):
        return Line(at(primitive.start), at(primitive.end))
    if isinstance(primitive, Circle):
        return Circle(at(primitive.centre), primitive.radius, primitive.ccw)
    return Arc(at(primitive.start), at(primitive.end), at(primitive.centre), primitive.ccw)


def _copied(contours: Sequence[Contour], shifts: Sequence[Point]) -> tuple[Contour, ...]:
    return tuple(
        contour
        if (dx, dy) == (0, 0)
        else replace(contour, primitives=tuple(moved(each, dx, dy) for each in contour.primitives))
        for dx, dy in shifts
        for contour in contours
    )


def _copies_meet(contours: Sequence[Contour], job: Job) -> list[Finding]:
    """Return the finding that lines of copies meet, if some do; copies that reach into one another without touching are
    none.
    """
    copies = job.copies
    box = extent(contours) if len(copies.shifts) > 1 else None
    if box is None:
        return []
    lines = shapely.union_all([shapely.boundary(shape) for shape in filled(contours)])
    shapely.prepare(lines)
    across, up = (
        min(count - 1, int(size / abs(step)) + 1) if count > 1 else 0
        for count, step, size in (
            (copies.columns, copies.dx, box[2] - box[0]),
            (copies.rows, copies.dy, box[3] - box[1]),
        )
    )
    for column, row in ((i, j) for j in range(up + 1) for i in range(-across if j else 1, across + 1)):
        dx, dy = column * copies.dx, row * copies.dy
        gap = float(shapely.distance(lines, shapely.affinity.translate(lines, dx, dy)))
        if gap < 2 * _CHORD:
            text = f"Copies that are {abs(dx):.3f} mm apart along X and {abs(dy):.3f} mm along Y meet; move them apart."
            return [Finding(FindingKind.OVERLAP, text, box[0] + max(dx, 0.0), box[1] + max(dy, 0.0), amount=gap)]
    return []


# Strokes of letters: lines for a tool to follow, which bound nothing, wherever they meet, cross or close.


def strokes_of(entities: Sequence[Entity], join_tolerance: float) -> tuple[tuple[Contour, ...], list[Finding]]:
    """Return the strokes of letters as open lines, also those that end where they begin, and what is to say about them.

    Args:
        entities: strokes of letters. join_tolerance: within which ends are joined, mm.
    """
    if not entities:
        return (), []
    chaining = chain(entities, join_tolerance)
    lines = tuple(map(_opened, chaining.contours))
    doubts = chaining_findings(entities, ChainingResult(lines, chaining.findings), join_tolerance)
    return lines, [*(_told(lines, layer) for layer in dict.fromkeys(line.layer for line in lines)), *doubts]


def _opened(contour: Contour) -> Contour:
    return replace(
        contour, primitives=tuple(part for each in contour.primitives for part in _halves(each)), closed=False
    )


def _halves(primitive: Primitive) -> tuple[Primitive, ...]:
    """Return both halves of a circle, and anything else as it is."""
    if not isinstance(primitive, Circle):
        return (primitive,)
    (x, y), radius, ccw = primitive.centre, primitive.radius, primitive.ccw
    right, left = (x + radius, y), (x - radius, y)
    return Arc(right, left, (x, y), ccw), Arc(left, right, (x, y), ccw)


def _told(lines: Sequence[Contour], layer: str) -> Finding:
    """Return the remark that letters of a layer are but strokes; it goes where an operation follows them all."""
    mine = [line for line in lines if line.layer == layer]
    x, y = mine[0].primitives[0].start
    count = "1 stroke of a letter, which bounds" if len(mine) == 1 else f"{len(mine)} strokes of letters, which bound"
    engraved = f"{option('side', 'on')} engraves along them."
    text = f"Layer {layer} has {count} nothing and that no operation follows; {engraved}"
    ids = tuple(dict.fromkeys(number for line in mine for number in line.entity_ids))
    return Finding(FindingKind.OPEN_CONTOUR, text, x, y, counts=False, entity_ids=ids, amount=float(len(mine)))


# Which contours of a drawing an operation works on, by its selectors, and what to say of those that find nothing.


SAME_DIAMETER = 0.005
"""mm by which a circle may be wider or narrower than asked for: drawings in inches, and their last digits."""

_NAMED = 8
"""Diameters, numbers or layers that a finding names."""


@dataclass(frozen=True, eq=False)
class SelectedCurves:
    """Contours of a drawing that an operation works on.

    Attributes:
        closed, open: in the order of the drawing, copies and all.
    """

    closed: tuple[Contour, ...]
    open: tuple[Contour, ...]


def selected(drawn: DrawnContours, curves: Sequence[Selector]) -> SelectedCurves:
    """Return the contours that any of some selectors selects; without one all that the job machines."""
    if not curves:
        return SelectedCurves(drawn.closed, drawn.open)
    placed = any(each in (ContourKind.OUTER, ContourKind.INNER) for each in curves)
    inner = drawn.inner if placed else frozenset()
    return SelectedCurves(
        tuple(c for c in drawn.closed if any(_selects(each, c, id(c) in inner) for each in curves)),
        tuple(c for c in drawn.open if any(_selects(each, c, is_inner=False) for each in curves)),
    )


def _selects(selector: Selector, contour: Contour, is_inner: bool) -> bool:
    match selector:
        case CurveNumber(number):
            return number in contour.entity_ids
        case OnLayer(name):
            return contour.layer == name
        case CirclesOf(least, most):
            circle = as_circle(contour)
            return circle is not None and least - SAME_DIAMETER <= 2 * circle.radius <= most + SAME_DIAMETER
        case ContourKind.OPEN:
            return not contour.closed
        case _:
            return contour.closed and is_inner is (selector is ContourKind.INNER)


def selection_findings(job: Job, drawn: DrawnContours) -> list[Finding]:
    """Return a finding that counts for each selector of an operation that selects nothing which that can machine."""
    return [
        _about(operation, selector, drawn, job)
        for operation in job.operations
        if operation.cut.enabled
        for selector in operation.cut.curves
        if not _usable(operation, selected(drawn, (selector,)))
        # an empty layer was never a fault: nothing is asked for that could be missing
        if not isinstance(selector, OnLayer)
    ]


def _not_taken(operation: Operation) -> tuple[Enum, ...]:
    """Return the sides that an operation refuses."""
    side = parameters_of(type(operation)).get("side")
    return () if side is None else side.parameter.not_taken


def _usable(operation: Operation, found: SelectedCurves) -> bool:
    """Tell whether an operation can machine something of what was found."""
    if operation.takes_open:
        return bool(found.open or (found.closed and operation.wall_side is Side.ON))
    if operation.HOLES:
        return any(as_circle(each) is not None for each in found.closed)
    return bool(found.closed)


def _about(operation: Operation, selector: Selector, drawn: DrawnContours, job: Job) -> Finding:
    who = f"{operation.WORD.capitalize()} T{operation.cut.tool} asks for {selector.text}"
    found = selected(drawn, (selector,))
    named = [*found.closed, *found.open]
    x, y = named[0].primitives[0].start if named else (None, None)
    ids = tuple(number for each in named for number in each.entity_ids)
    if found.closed:
        why = "which is no circle to drill"
    elif found.open:
        on = Side.ON not in _not_taken(operation)
        begins = in_plane(*found.open[0].primitives[0].start)
        why = f"which is open, beginning at {begins}: close it{', or follow it with side = on' if on else ''}"
    else:
        why = f"and there is none; {_there(selector, drawn, job)}"
    return Finding(FindingKind.LEFT_OUT, f"{who}, {why}.", x, y, entity_ids=ids)


def _there(selector: Selector, drawn: DrawnContours, job: Job) -> str:
    """Return what the drawing has in the place of what a selector does not find."""
    match selector:
        case CurveNumber(number):
            if (entity := next((each for each in job.part.entities if each.id == number), None)) is not None:
                return f"that curve is on layer '{entity.layer}', which the job does not machine or keeps off"
            numbers = sorted({each.id for each in job.part.entities})
            return f"the drawing has {_listed(_runs(numbers))}"
        case CirclesOf():
            circles = (as_circle(each) for each in drawn.closed)
            sizes = sorted({round(2 * circle.radius, 3) for circle in circles if circle is not None})
            return f"the drawing has {_listed(f'circles:{size:g}' for size in sizes)}"
        case _:
            outer, inner = len(drawn.closed) - len(drawn.inner), len(drawn.inner)
            return (
                f"the drawing has {_counted(outer, 'outer')}, {_counted(inner, 'inner')} and "
                f"{_counted(len(drawn.open), 'open')} contours"
            )


def _counted(count: int, what: str) -> str:
    return f"{count or 'no'} {what}"


def _listed(words: Iterable[str]) -> str:
    """Return the first of some words, and how many more there are."""
    every = list(words)
    more = [f"{len(every) - _NAMED} more"] if len(every) > _NAMED else []
    return ", ".join([*every[:_NAMED], *more]) or "none"


def _runs(numbers: Sequence[int]) -> Iterator[str]:
    """Yield numbers, from the first to the last where there is no gap between them."""
    first = None
    for k, number in enumerate(numbers):
        first = number if first is None else first
        if k + 1 == len(numbers) or numbers[k + 1] != number + 1:
            yield f"#{first}" if first == number else f"#{first} to #{number}"
            first = None
