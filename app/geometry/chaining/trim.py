"""Two arcs of one circle whose loose ends run past one another: one is trimmed to where the other ends."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core import tolerances
from ...model.curves import Arc, Point
from ..arcs.arcs import equally_far
from .overlap import Overlap
from .pieces import ChainPiece, off_circle

Nodes = NDArray[np.int64]


class TrimmedPieces(NamedTuple):
    """Pieces, their nodes, and the overlaps between them."""

    pieces: list[ChainPiece]
    nodes: Nodes
    overlaps: list[Overlap]


def trimmed(pieces: Sequence[ChainPiece], nodes: Nodes, overlaps: Sequence[Overlap]) -> TrimmedPieces:
    """Return pieces and nodes with arcs that overlap at loose ends cut to meet there, and the overlaps with that noted.

    The shape stays as it was drawn, so that no tolerance is asked: each of both ends lies on the other arc, within
    1 um, and no other curve ends there.
    """
    made, joined, noted = list(pieces), nodes.copy(), []
    gone = {overlap.second for overlap in overlaps if overlap.removed}
    kept = np.array([k not in gone for k in range(len(pieces))], dtype=bool)
    for overlap in overlaps:
        done = False
        if not {overlap.first, overlap.second} & gone:
            for pair in ((overlap.first, overlap.second), (overlap.second, overlap.first)):
                done |= _cut(made, joined, pair, kept)
        noted.append(replace(overlap, trimmed=done))
    return TrimmedPieces(made, joined, noted)


def _cut(pieces: list[ChainPiece], nodes: Nodes, pair: tuple[int, int], kept: NDArray[np.bool_]) -> bool:
    """Let the second arc begin where the first one ends, both seen counter-clockwise, in place; False if they do not
    overlap so.
    """
    one, other = (pieces[k].primitives[0] for k in pair)
    if any(len(pieces[k].primitives) > 1 for k in pair) or not isinstance(one, Arc) or not isinstance(other, Arc):
        return False
    end_side, start_side = int(one.ccw), int(not other.ccw)
    last, first = nodes[pair[0], end_side], nodes[pair[1], start_side]
    alive = nodes[kept]
    if last == first or (alive == last).sum() != 1 or (alive == first).sum() != 1:
        return False
    place, begin = (one.end if one.ccw else one.start), (other.start if other.ccw else other.end)
    shared = (_angle(place, other.centre) - _angle(begin, other.centre)) % math.tau
    if shared >= abs(one.sweep) or shared >= abs(other.sweep):
        return False
    rest = other.end if other.ccw else other.start
    centre = equally_far(place, rest, other.centre)
    short = Arc(place, rest, centre, True) if other.ccw else Arc(rest, place, centre, False)
    if (
        math.dist(centre, other.centre) > tolerances.CURVE + other.radius * 1e-9
        or off_circle(short, other) > 2 * tolerances.CURVE
    ):
        return False
    pieces[pair[1]] = replace(
        pieces[pair[1]], primitives=(short,), deviation=pieces[pair[1]].deviation + off_circle(short, other)
    )
    nodes[pair[1], start_side] = last
    return True


def _angle(point: Point, centre: Point) -> float:
    return math.atan2(point[1] - centre[1], point[0] - centre[0])
