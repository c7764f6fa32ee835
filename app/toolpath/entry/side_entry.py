"""Entries from the side: straight down on ground that is cut as deep near a path's beginning, and on to it from
there.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from ...geometry.primitives import fraction_on, point_on
from ...model.curves import Point
from ...model.moves import Purpose
from ..build import Stroke
from .entry import EntryContext
from .links import keeps_off_walls

_AWAY = (0.1, 0.25, 0.5, 1.0, 1.5, 2.0, 3.0)
"""Distances from the beginning that are tried, in cutter's radii."""

_DIRECTIONS = 8

_AROUND = [
    (part, math.cos(angle), math.sin(angle))
    for part in _AWAY
    for angle in (math.tau * k / _DIRECTIONS for k in range(_DIRECTIONS))
]
"""A distance and a direction (x, y) each: the same round every beginning."""


def from_cleared(stroke: Stroke, z: float, ground: EntryContext) -> Stroke:
    """Return a stroke that begins on ground cut down to z near by and goes straight to where it began before.

    The stroke itself where there is no such ground, or a wall is in the way.
    """
    if not ground.beside:
        return stroke
    start = stroke.start
    places = _places(start, z, ground)
    for k in ground.cleared.clear_places(ground.tool, places, z):
        place = places[k]
        if keeps_off_walls(place, start, ground):
            row = np.array([[*place, *start, 0.0, 0.0, 0.0, 0.0]])
            way = replace(stroke, rows=row, purpose=np.array([Purpose.LINK], np.uint8), least_z=None)
            return way.and_then(stroke)
    return stroke


def _places(start: Point, z: float, ground: EntryContext) -> list[Point]:
    """Return places round a path's beginning, the nearest first, and the nearest one of all that were cut along; none
    if all are far.
    """
    radius = ground.tool.radius
    gap, row = ground.cleared.nearest(start, z)
    if row is None or gap > (_AWAY[-1] - 1) * radius:
        return []
    x, y = start
    places = [(x + part * radius * cos, y + part * radius * sin) for part, cos, sin in _AROUND]
    nearest = row.tolist()
    return sorted([*places, point_on(nearest, fraction_on(nearest, start))], key=lambda place: math.dist(place, start))
