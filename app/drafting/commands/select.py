"""Which entities a `select` line means."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import Enum
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.tolerances import WELD
from ...geometry.dimension_lines import dimension_lines
from ...geometry.sample import Box, bounds, sample
from ...model.curves import Curve, Point
from ...model.notes import Guide, Mark, Note, Shape
from ...model.part import Entity, Part
from .command import DraftingSession, check_ids


class SelectMode(Enum):
    """What becomes of the selection that was there."""

    REPLACE = ""
    ADD = "add"
    REMOVE = "remove"


class SelectCriterion(Enum):
    """What the entities are chosen by."""

    IDS = "ids"
    ALL = "all"
    NONE = "none"
    WINDOW = "window"
    CROSSING = "crossing"
    LAYER = "layer"
    CHAIN = "chain"


@dataclass(frozen=True, slots=True)
class SelectEntities:
    """Choose entities; hidden and locked layers are passed over, except by number.

    Attributes:
        ids: chosen by number; CHAIN takes what joins these end to end, too.
        box: x0, y0, x1, y1 with x0 <= x1 and y0 <= y1, mm; WINDOW takes what lies wholly inside, CROSSING also what
            reaches in.
    """

    by: SelectCriterion
    how: SelectMode = SelectMode.REPLACE
    ids: frozenset[int] = frozenset()
    box: Box = (0.0, 0.0, 0.0, 0.0)
    layer: str = ""

    def carried_out(self, session: DraftingSession) -> DraftingSession:
        """Return the session with the new selection.

        Raises:
            InputError: an id that the part does not have.
        """
        check_ids(session.part, self.ids)
        if self.by is SelectCriterion.CHAIN:
            found = joined(reachable(session.part), self.ids)
        else:
            found = self.ids if self.by is SelectCriterion.IDS else self._found(session.part)
        if self.how is SelectMode.ADD:
            found = session.selection | found
        elif self.how is SelectMode.REMOVE:
            found = session.selection - found
        return replace(session, selection=found)

    def _found(self, part: Part) -> frozenset[int]:
        return frozenset(
            [e.id for e in reachable(part) if self._takes(e)]
            + [n.id for n in reachable_notes(part) if self._takes_note(n)]
        )

    def _takes_note(self, note: Note) -> bool:
        if self.by is SelectCriterion.LAYER:
            return note.layer == self.layer
        if self.by is SelectCriterion.WINDOW:
            return note_inside(note.shape, self.box)
        if self.by is SelectCriterion.CROSSING:
            return note_crosses(note.shape, self.box)
        return self.by is SelectCriterion.ALL

    def _takes(self, entity: Entity) -> bool:
        if self.by is SelectCriterion.LAYER:
            return entity.layer == self.layer
        if self.by is SelectCriterion.WINDOW:
            return inside(bounds(entity.curve), self.box)
        if self.by is SelectCriterion.CROSSING:
            return crosses(entity.curve, self.box)
        return self.by is SelectCriterion.ALL


class _CurveEnd(NamedTuple):
    """An end of an entity."""

    number: int
    place: Point


def joined(entities: Sequence[Entity], ids: frozenset[int]) -> frozenset[int]:
    """Return these ids, and those of all entities that join them end to end, one after the other."""
    cell = 10 * WELD
    at: dict[tuple[int, int], list[_CurveEnd]] = {}
    ends = {e.id: (e.curve.start, e.curve.end) for e in entities}
    for number, both in ends.items():
        for x, y in both:
            at.setdefault((round(x / cell), round(y / cell)), []).append(_CurveEnd(number, (x, y)))
    found, fresh = set(ids), list(ids)
    while fresh:
        for x, y in ends.get(fresh.pop(), ()):
            column, row = round(x / cell), round(y / cell)
            near = (hit for i in (-1, 0, 1) for j in (-1, 0, 1) for hit in at.get((column + i, row + j), ()))
            new = {number for number, end in near if number not in found and math.dist(end, (x, y)) <= WELD}
            found |= new
            fresh += new
    return frozenset(found)


def reachable(part: Part) -> tuple[Entity, ...]:
    """Return the entities on layers that are visible and not locked."""
    shut = {layer.name for layer in part.layers if not layer.visible or layer.locked}
    return tuple(e for e in part.entities if e.layer not in shut) if shut else part.entities


def reachable_notes(part: Part) -> tuple[Note, ...]:
    """Return the notes on layers that are visible and not locked."""
    shut = {layer.name for layer in part.layers if not layer.visible or layer.locked}
    return tuple(n for n in part.notes if n.layer not in shut)


def note_inside(shape: Shape, box: Box) -> bool:
    """Return whether a note lies within a box; a construction line, which has no end, never does."""
    if isinstance(shape, Guide):
        return False
    points = (shape.at,) if isinstance(shape, Mark) else (*shape.points, shape.place)
    return all(inside((*p, *p), box) for p in points)


def note_crosses(shape: Shape, box: Box) -> bool:
    """Return whether anything of a note lies within a box."""
    if isinstance(shape, Mark):
        return note_inside(shape, box)
    if isinstance(shape, Guide):
        sides = [
            (x - shape.through[0]) * math.sin(shape.angle) - (y - shape.through[1]) * math.cos(shape.angle)
            for x in box[::2]
            for y in box[1::2]
        ]
        return min(sides) <= 0 <= max(sides)
    if inside((*shape.place, *shape.place), box):
        return True
    drawn = dimension_lines(shape, 1.0)
    return any(crosses(line, box) for line in drawn.lines) or any(crosses(arc, box) for arc in drawn.arcs)


def inside(inner: Box, outer: Box) -> bool:
    """Return whether a box lies within another."""
    return inner[0] >= outer[0] and inner[1] >= outer[1] and inner[2] <= outer[2] and inner[3] <= outer[3]


def crosses(curve: Curve, box: Box) -> bool:
    """Return whether any point of a curve lies within a box."""
    extent = bounds(curve)
    if extent[0] > box[2] or extent[2] < box[0] or extent[1] > box[3] or extent[3] < box[1]:
        return False
    if inside(extent, box):
        return True
    points = sample(curve)
    return bool(_segments_reach(points[:-1], points[1:], box).any())


def _segments_reach(a: NDArray[np.float64], b: NDArray[np.float64], box: Box) -> NDArray[np.bool_]:
    """Return for each segment whether it meets the box (Liang-Barsky: the parameter ranges of both slabs overlap)."""
    first, last = np.zeros(len(a)), np.ones(len(a))
    for axis in (0, 1):
        low, high = box[axis] - a[:, axis], box[axis + 2] - a[:, axis]
        step = b[:, axis] - a[:, axis]
        with np.errstate(divide="ignore", invalid="ignore"):
            t0, t1 = low / step, high / step
        flat = step == 0
        hit = (low <= 0) & (high >= 0)
        t0 = np.where(flat, np.where(hit, 0.0, 2.0), t0)
        t1 = np.where(flat, np.where(hit, 1.0, 2.0), t1)
        first, last = np.maximum(first, np.minimum(t0, t1)), np.minimum(last, np.maximum(t0, t1))
    return np.asarray(first <= last)
