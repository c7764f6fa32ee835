"""How much faster arcs may be gone along: chips measured at many places of the rim against those at the limit."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest

from app.operations.adaptive.chips import DiscArc, feed_pieces

LIMIT = math.radians(53.13)
R = 3.0


def arc_at_the_limit(turn: float, clear: float) -> DiscArc:
    """The arc round a disc as far from a clear one as the limit lets it be."""
    away = clear - math.sqrt(turn * turn + R * R + 2 * turn * R * math.cos(LIMIT))
    cosine = ((clear - R) ** 2 - away * away - turn * turn) / (2 * away * turn)
    return DiscArc(away, turn, math.acos(max(-1.0, min(1.0, cosine))), clear, R)


def thickest(arc: DiscArc, place: float) -> float:
    """The thickest chip, in feeds per tooth, at a place: of all the front of the rim that stands in metal."""
    x, y = arc.away + arc.turn * math.cos(place), arc.turn * math.sin(place)
    theta = np.linspace(0.0, math.pi, 20_001)
    rim = np.hypot(x + R * np.cos(place + theta), y + R * np.sin(place + theta))
    return float(np.sin(theta)[rim > arc.clear + 1e-9].max(initial=0.0))


@pytest.mark.parametrize(("turn", "clear"), [(5.0, 8.2), (2.0, 5.3), (12.0, 14.6), (0.6, 3.4)])
def test_no_chip_is_thicker_than_at_the_limit(turn: float, clear: float) -> None:
    arc = arc_at_the_limit(turn, clear)
    pieces = feed_pieces(arc, LIMIT, 2.0)
    assert pieces[0].begin == -arc.half and pieces[-1].end == arc.half
    assert all(one.end == next_.begin for one, next_ in pairwise(pieces))
    assert min(each.times for each in pieces) == 1.0 and max(each.times for each in pieces) <= 2.0
    for piece in pieces:
        for place in np.linspace(piece.begin, piece.end, 41).tolist():
            assert thickest(arc, place) * piece.times <= math.sin(LIMIT) * 1.002


def test_a_piece_takes_the_feed_that_its_chips_allow() -> None:
    pieces = feed_pieces(arc_at_the_limit(5.0, 8.2), LIMIT, 2.0)
    assert len(pieces) > 2 and sum((p.end - p.begin) * (p.times > 1) for p in pieces) > 0.5
    assert min((p.end - p.begin) for p in pieces) >= 0.3 * R / 5.0


def test_where_nobody_asks_the_arc_is_one_piece() -> None:
    arc = arc_at_the_limit(5.0, 8.2)
    (piece,) = feed_pieces(arc, LIMIT, 1.0)
    assert (piece.begin, piece.end, piece.times) == (-arc.half, arc.half, 1.0)
