"""How much faster an arc may be gone along where less is engaged than at the limit, so that chips come out as thick.

A tooth at theta from the direction away from the path's centre takes a chip of (feed per tooth) sin theta. Of the rim
in front, metal stands from the outside up to some theta, never beyond the limit: as thick a chip as there is at the
limit comes of sin(limit) / sin(theta) times the feed. Along the arc that clears one disc out of another theta rises
once and falls once, and is 0 at both ends.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

_STEPS = 8
"""Feeds from one to two times the tool's: a program whose feed changes all the time is no better."""

_LOOKED = 64
"""Pieces of an arc at whose ends the engaged angle is looked at."""
_SHORTEST = 0.3
"""Radii of the cutter; a piece that is shorter has the feed of the slower one beside it."""


@dataclass(frozen=True)
class DiscArc:
    """An arc that clears a disc, out of another one that is clear.

    Attributes:
        away: how far their centres are apart, mm, > 0.
        turn: radius of the arc, mm. half: radians of it to either side of the direction away from the clear disc.
        clear: radius of the clear disc, mm. radius: of the cutter, mm.
    """

    away: float
    turn: float
    half: float
    clear: float
    radius: float

    def farthest_engaged(self, places: Floats) -> Floats:
        """Return the greatest theta (n,) at which metal is met at places of the arc, radians from its middle; 0 where
        none is.
        """
        far = np.sqrt(self.away**2 + self.turn**2 + 2 * self.away * self.turn * np.cos(places))
        far = np.maximum(far, 1e-12)
        cosine = (self.clear**2 - far**2 - self.radius**2) / (2 * far * self.radius)
        wide = np.arccos(np.clip(cosine, -1.0, 1.0))
        ahead = np.arcsin(np.clip(-self.away * np.sin(places) / far, -1.0, 1.0))
        theta: Floats = np.where(wide > 0, np.clip(ahead + wide, 0.0, np.pi), 0.0)
        return theta


@dataclass(frozen=True)
class FeedPiece:
    """A piece of an arc, radians from its middle, and how many times the tool's feed it takes."""

    begin: float
    end: float
    times: float


def feed_pieces(arc: DiscArc, limit: float, most: float) -> list[FeedPiece]:
    """Return the pieces of an arc with their feeds, in its direction.

    Args:
        limit: angle at which the tool's feed is meant, radians. most: times the tool's feed, >= 1.
    """
    if most <= 1.0:
        return [FeedPiece(-arc.half, arc.half, 1.0)]
    edges = np.linspace(-arc.half, arc.half, _LOOKED + 1)
    theta = arc.farthest_engaged(edges)
    worst = np.maximum(theta[:-1], theta[1:])
    # it rises once and falls once: only beside the greatest is there more between two places than at both
    first, last = max(int(np.argmax(theta)) - 1, 0), min(int(np.argmax(theta)) + 1, _LOOKED)
    worst[first:last] = arc.farthest_engaged(np.linspace(edges[first], edges[last], _LOOKED + 1)).max()
    worst = np.minimum(worst, math.pi / 2)
    times = np.minimum(math.sin(min(limit, math.pi / 2)) / np.maximum(np.sin(worst), 1e-9), most)
    times = np.maximum(1.0, np.floor(times * _STEPS + 1e-9) / _STEPS)
    pieces: list[FeedPiece] = []
    for begin, end, each in zip(edges[:-1].tolist(), edges[1:].tolist(), times.tolist(), strict=True):
        if pieces and pieces[-1].times == each:
            begin = pieces.pop().begin
        pieces.append(FeedPiece(begin, end, each))
    return _no_short_ones(pieces, _SHORTEST * arc.radius / arc.turn)


def _no_short_ones(pieces: list[FeedPiece], least: float) -> list[FeedPiece]:
    """Return pieces of which none is shorter than so many radians, each joined with what is slower beside it."""
    while len(pieces) > 1:
        k = min(range(len(pieces)), key=lambda each: pieces[each].end - pieces[each].begin)
        if pieces[k].end - pieces[k].begin >= least:
            break
        beside = [j for j in (k - 1, k + 1) if 0 <= j < len(pieces)]
        # what is slower takes it along; between two that are faster, the one that loses less slows down
        j = min(
            beside, key=lambda each: (pieces[each].times > pieces[k].times, abs(pieces[each].times - pieces[k].times))
        )
        low, high = min(j, k), max(j, k)
        joined = FeedPiece(pieces[low].begin, pieces[high].end, min(pieces[low].times, pieces[high].times))
        pieces[low : high + 1] = [joined]
    return pieces
