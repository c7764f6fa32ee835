"""Entries through holes that were drilled before."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...geometry.distance import DistanceField
from ...model.curves import Point
from ...model.moves import Moves, Purpose
from ...model.tool import Tool
from ..build import Stroke
from ..linking.bridge import fraction_at
from .entry import EntryContext
from .links import keeps_off_walls

_WIDE = 0.5
"""Of the cutter's diameter that a hole must be wide at least: its centre, which cuts badly, meets no metal then."""

_FAR = 10.0
"""Cutter's diameters from a hole to where a path begins at most."""

_TRIED = 8
"""Holes that are tried for one path."""

_SAME = 1e-6


@dataclass(frozen=True, slots=True)
class DrilledHole:
    """A drilled hole: its centre and radius, and the height of the drill's tip at its bottom, mm."""

    x: float
    y: float
    radius: float
    bottom: float

    @property
    def place(self) -> Point:
        """Its centre, mm."""
        return self.x, self.y


def drilled(moves: Moves, tools: Mapping[int, Tool]) -> tuple[DrilledHole, ...]:
    """Return the holes that moves drill."""
    deepest: dict[tuple[float, float, int], float] = {}
    for k in np.flatnonzero(moves.purpose == Purpose.DRILL).tolist():
        x, y, z = moves.end[k].tolist()
        place = (x, y, int(moves.tool[k]))
        deepest[place] = min(deepest.get(place, math.inf), z)
    return tuple(DrilledHole(x, y, tools[tool].radius, z) for (x, y, tool), z in deepest.items() if z < 0)


def usable(holes: Sequence[DrilledHole], ground: EntryContext, floor: float) -> tuple[DrilledHole, ...]:
    """Return the holes that a cutter can go straight down in to a height, mm."""
    return tuple(
        hole for hole in holes if hole.radius >= _WIDE * ground.tool.radius - _SAME and hole.bottom <= floor + _SAME
    )


def from_hole(stroke: Stroke, holes: Sequence[DrilledHole], ground: EntryContext) -> Stroke:
    """Return a stroke that begins in a hole and goes straight to where it began before, or the stroke itself where that
    cannot be.
    """
    if not holes:
        return stroke
    places = np.array([hole.place for hole in holes])
    loop = stroke.closed and stroke.least_z is None and not np.any(stroke.purpose == Purpose.LEAD)
    if loop:
        away, row = DistanceField.of(stroke.rows).nearest(places)
    else:
        away, row = np.hypot(*(places - np.array(stroke.start)).T), np.zeros(len(places), np.int64)
    for k in np.argsort(away, kind="stable")[:_TRIED].tolist():
        if away[k] > _FAR * ground.tool.diameter:
            break
        begun = stroke
        if loop:
            before, after = stroke.split(int(row[k]), fraction_at(stroke.rows[row[k]], places[k]))
            begun = after.and_then(before)
        if away[k] < _SAME:
            return begun
        if ground.beside and keeps_off_walls(holes[k].place, begun.start, ground):
            slot = replace(
                begun,
                rows=np.array([[*holes[k].place, *begun.start, 0.0, 0.0, 0.0, 0.0]]),
                purpose=np.array([Purpose.LINK], np.uint8),
                least_z=None,
            )
            return slot.and_then(begun)
    return stroke


def in_hole(place: Point, holes: Sequence[DrilledHole]) -> bool:
    """Tell whether a place is the centre of a hole."""
    return any(math.dist(place, hole.place) < _SAME for hole in holes)
