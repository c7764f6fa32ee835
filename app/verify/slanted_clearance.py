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
from numpy.typing import NDArray

from ..core.pool import in_bands
from ..geometry.distance import DistanceField
from .slanted_kernels import reaches

Floats = NDArray[np.float64]


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
    """Return how far each move's cone reaches beyond a wall at the surface at most, mm (<= 0: nowhere), and where its
    tip is then, (n, 2).

    Args:
        walls: (m, 8) lines and arcs below half a turn.
    """
    depth, places = np.full(len(moves.tip), -np.inf), moves.end[:, :2].copy()
    if not len(walls):
        return depth, places
    field = DistanceField.of(walls)
    table = np.column_stack([moves.start, moves.end, moves.tip, moves.rate, moves.widest])

    def measure(some: slice) -> None:
        reaches(table[some], field.rows, field.boxes, field.order, field.nodes, depth[some], places[some])

    in_bands(measure, len(table))
    return depth, places
