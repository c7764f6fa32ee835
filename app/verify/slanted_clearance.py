"""How far a cone that goes up or down along straight moves reaches beyond walls: closed forms, nothing is sampled.

At the surface a cone whose tip is at height z is tip - z tan a wide, which is linear along a move. What it reaches
beyond a wall is that less the distance from the wall. To a point the distance along a move is a root of a square, so
the most is where the slope of the root is that of the width; to a line it is linear between the feet of its ends, and
to a circle's arc it is the distance to the centre, less the radius. So the most is at an end of the move, at the best
place for one of the wall's ends or its centre, or where the move crosses the wall.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray

from ..geometry.primitives import CX, TURN, X0, X1, R, sweeps
from ..geometry.tree_queries import near
from ..toolpath.coverage.flat import lines

Floats = NDArray[np.float64]

_ROUGH = 0.02
"""mm; moves and walls are flattened within this to find which pairs can be near."""

_PORTION = 4000


@dataclass(frozen=True, eq=False)
class SlantedMoves:
    """Straight moves of cones, n of them.

    Attributes:
        start, end: (n, 3) of the tip, mm, the surface at Z 0.
        tip: (n,) radius of the flat at the cone's end, mm.
        rate: (n,) mm of radius per mm of height.
        widest: (n,) radius where the cone ends, mm.
    """

    start: Floats
    end: Floats
    tip: Floats
    rate: Floats
    widest: Floats

    def only(self, chosen: NDArray[np.int64]) -> SlantedMoves:
        """Return some of them."""
        return SlantedMoves(*(getattr(self, name)[chosen] for name in ("start", "end", "tip", "rate", "widest")))

    def width(self, share: Floats) -> Floats:
        """Return how wide the cone is at the surface at fractions (n,) of the moves, mm; above it, the less."""
        z = self.start[:, 2] + (self.end[:, 2] - self.start[:, 2]) * share
        width: Floats = np.minimum(self.tip - z * self.rate, self.widest)
        return width

    def at(self, share: Floats) -> Floats:
        """Return the places (n, 2) at fractions (n,) of the moves."""
        places: Floats = self.start[:, :2] + (self.end[:, :2] - self.start[:, :2]) * share[:, None]
        return places


def reach_beyond(moves: SlantedMoves, walls: Floats) -> tuple[Floats, Floats]:
    """Return how far each move's cone reaches beyond a wall at the surface at most, mm (<= 0: nowhere; -inf: no wall is
    near), and where its tip is then, (n, 2).

    Args:
        walls: (m, 8) lines and arcs below half a turn.
    """
    depth, places = np.full(len(moves.tip), -np.inf), moves.end[:, :2].copy()
    tree = shapely.STRtree(lines(walls, _ROUGH))
    most = np.maximum(moves.width(np.zeros(len(depth))), moves.width(np.ones(len(depth))))
    for first in range(0, len(depth), _PORTION):
        some = slice(first, first + _PORTION)
        paths = shapely.linestrings(np.stack([moves.start[some, :2], moves.end[some, :2]], axis=1))
        move, wall = near(tree, paths, np.maximum(most[some], 0.0) + 4 * _ROUGH)
        if not len(move):
            continue
        short, where = _worst(moves.only(move + first), walls[wall])
        order = np.lexsort((short, move))
        worst = order[np.flatnonzero(np.diff(move[order], append=-1))]
        depth[first + move[worst]], places[first + move[worst]] = short[worst], where[worst]
    return depth, places


def _worst(moves: SlantedMoves, walls: Floats) -> tuple[Floats, Floats]:
    """Return the most that each move reaches beyond the wall beside it, and where, (n, 2)."""
    count = len(moves.tip)
    way = moves.end[:, :2] - moves.start[:, :2]
    size = np.maximum(np.hypot(*way.T), 1e-300)
    slope = (moves.start[:, 2] - moves.end[:, 2]) * moves.rate / size
    arcs = walls[:, TURN] != 0
    shares = [np.zeros(count), np.ones(count)]
    for points in (walls[:, X0:X1], walls[:, X1:CX], np.where(arcs[:, None], walls[:, CX:R], walls[:, X0:X1])):
        along, aside = _beside(moves, way / size[:, None], points)
        gentle = np.clip(slope, -1 + 1e-12, 1 - 1e-12)
        shares.append((along + aside * gentle / np.sqrt(1 - gentle**2)) / size)
        reach = np.sqrt(np.maximum(walls[:, R] ** 2 - aside**2, 0.0))
        shares += [(along - reach) / size, (along + reach) / size]
    shares.append(_crossing(moves, way, walls))
    # where the cone is as wide as it gets
    with np.errstate(divide="ignore", invalid="ignore"):
        rise = (moves.start[:, 2] - moves.end[:, 2]) * moves.rate
        shares.append((moves.widest - moves.tip + moves.start[:, 2] * moves.rate) / rise)
    best, places = np.full(count, -np.inf), moves.end[:, :2].copy()
    for share in shares:
        share = np.clip(np.nan_to_num(share, nan=0.0, posinf=1.0, neginf=0.0), 0.0, 1.0)
        where = moves.at(share)
        reach = moves.width(share) - _distance(where, walls)
        more = reach > best
        best[more], places[more] = reach[more], where[more]
    return best, places


def _beside(moves: SlantedMoves, unit: Floats, points: Floats) -> tuple[Floats, Floats]:
    """Return how far along moves and how far aside of them points (n, 2) are, mm."""
    off = points - moves.start[:, :2]
    along = np.einsum("ni,ni->n", off, unit)
    return along, np.abs(off[:, 0] * unit[:, 1] - off[:, 1] * unit[:, 0])


def _crossing(moves: SlantedMoves, way: Floats, walls: Floats) -> Floats:
    """Return at which fraction moves cross the straight lines that go through both ends of walls."""
    side = walls[:, X1:CX] - walls[:, X0:X1]
    off = walls[:, X0:X1] - moves.start[:, :2]
    with np.errstate(divide="ignore", invalid="ignore"):
        share: Floats = (off[:, 0] * side[:, 1] - off[:, 1] * side[:, 0]) / (
            way[:, 0] * side[:, 1] - way[:, 1] * side[:, 0]
        )
    return share


def _distance(points: Floats, walls: Floats) -> Floats:
    """Return the distance of points (n, 2) from the wall beside each, mm."""
    side = walls[:, X1:CX] - walls[:, X0:X1]
    size = np.maximum(np.einsum("ni,ni->n", side, side), 1e-300)
    share = np.clip(np.einsum("ni,ni->n", points - walls[:, X0:X1], side) / size, 0.0, 1.0)
    straight = np.hypot(*(points - walls[:, X0:X1] - side * share[:, None]).T)
    ends = np.minimum(np.hypot(*(points - walls[:, X0:X1]).T), np.hypot(*(points - walls[:, X1:CX]).T))
    out, begin = points - walls[:, CX:R], walls[:, X0:X1] - walls[:, CX:R]
    turned = np.arctan2(begin[:, 0] * out[:, 1] - begin[:, 1] * out[:, 0], np.einsum("ni,ni->n", begin, out))
    turned = np.mod(turned * walls[:, TURN], 2 * np.pi)
    within = turned <= np.abs(sweeps(walls))
    round_ = np.where(within, np.minimum(np.abs(np.hypot(*out.T) - walls[:, R]), ends), ends)
    distance: Floats = np.where(walls[:, TURN] == 0, straight, round_)
    return distance
