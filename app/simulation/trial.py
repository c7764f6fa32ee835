"""A small job that every way to compute heights is tried on: all kinds of cutters, arcs, plunges, slopes up and
down.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from functools import cache

import numpy as np

from ..fitting.fitted import arcs_between
from ..model.motion import Floats
from ..model.stock_box import StockBox
from .cutter import Cutter
from .field.workpiece import TOLERANCE, BoxStock, Grid, HeightDifference, Heights, Workpiece, height_difference
from .sweeps.course import Course
from .sweeps.trim import trim

Compute = Callable[[Workpiece, Course, Mapping[int, Cutter]], Heights]

SIDE = 30.0
"""mm, of the block."""

CELLS = 160
"""Along a side of it."""

CUTTERS: dict[int, Cutter] = {
    1: Cutter(2.0, 0.0, 2.0),
    2: Cutter(2.0, 2.0),
    3: Cutter(2.0, 1.25, 0.75),
    4: Cutter(2.0, 0.4, 0.0, 1.5),
    5: Cutter(2.0, 0.0, 0.5, 3.0),
}
"""A ball, a flat end, a bull nose, a blunt cone, a taper."""

_WALK = np.array(
    [
        [0.0, 0.0, 2.0],
        [0.0, 0.0, -1.5],
        [3.1, 0.7, -1.5],
        [4.0, 3.0, -3.2],
        [3.2, 4.1, -0.3],
        [0.6, 3.7, -2.0],
        [0.61, 3.71, -2.01],
        [0.4, 2.0, -6.0],
        [1.3, 2.3, -5.0],
        [5.0, 2.9, -4.0],
        [5.0, 2.9, -7.0],
        [5.0, 2.9, 2.0],
    ]
)
"""mm; what each cutter does in a place of its own."""

_PLACES = ((2.3, 2.1), (12.4, 3.2), (21.7, 2.6), (3.1, 13.3), (13.9, 12.7))
"""X and Y of the place of each cutter, mm."""
_MIDDLE, _TURN = (21.7, 22.3), 1.9
"""Of the arcs: round where, and how far, radians."""


def trial() -> tuple[Workpiece, Course]:
    """Return the block and what is done to it: each cutter goes its walk, then round an arc."""
    piece = BoxStock(StockBox(0, 0, -9.0, SIDE, SIDE)).over(Grid.over((0.0, 0.0, SIDE, SIDE), CELLS))
    places, half = [], []
    for number, (x, y) in zip(CUTTERS, _PLACES, strict=True):
        ends = [_round(0.8 + 1.1 * number, angle, -0.7 * number) for angle in (number, number + _TURN)]
        arc = [[*ends[0][:2], 2.0], *ends, [*ends[1][:2], 2.0]]
        places.append(np.vstack([_WALK + [x, y, 0.0], arc]))
        half.append(np.zeros(len(places[-1])))
        half[-1][len(_WALK) + 1] = _TURN / 2
    way = np.concatenate(places)
    motions = arcs_between(way, np.concatenate(half)[:-1], np.zeros(len(way) - 1, np.uint8))
    return piece, Course(motions, np.repeat(np.array(list(CUTTERS), np.int32), len(places[0]))[:-1])


def tried(compute: Compute, allowed: float | Floats = TOLERANCE) -> HeightDifference:
    """Return how far the heights that somebody computes of the trial are from those of the engine of record.

    Args:
        compute: computes them. allowed: difference that counts as none, mm; or (rows, cols) of them.
    """
    piece, course = trial()
    return height_difference(record(), compute(piece, course, CUTTERS), allowed)


@cache
def record() -> Heights:
    """Return the heights that the engine of record leaves."""
    return trim(*trial(), CUTTERS).heights


def _round(radius: float, angle: float, z: float) -> list[float]:
    return [_MIDDLE[0] + radius * math.cos(angle), _MIDDLE[1] + radius * math.sin(angle), z]
