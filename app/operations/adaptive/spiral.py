"""The first disc of an area: a small circle where the cutter has come down, and a spiral of half turns from there on.

Half turns go round two centres in turn that lie on one line, so they join smoothly. Of radius rho_j = rho_(j-1) + e_j,
the half turn j finds ground clear as far as rho_(j-1) + r - e_j round its own centre, if e never falls: on one side
because of the half turn before, on the other because of the one before that. So e_j is chosen that the cutter is
engaged by the limit, all the way, and the last turn is a whole one.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from ...geometry.primitives import Rows
from .cleared_discs import Point
from .limit import DigitGrid, EngagementLimit

_HALVINGS = 60
"""Of the first radius, until the turns end at the last circle: no double is left between."""
_MOST_TURNS = 20_000
"""Half turns of a spiral; more are no clearing that anybody waits for."""


def spiral(centre: Point, turn: float, limit: EngagementLimit, seed: float) -> Rows:
    """Return arcs (n, 8) from the middle of a disc outwards, counter-clockwise, the last circle about its centre.

    Args:
        turn: radius of the last circle, mm.
        seed: least radius of the first circle, mm; it is the first two rows, and nothing bounds what it engages.
    """
    radii = _radii(turn, limit, min(seed, turn))
    if limit.grid is not None:
        radii = _on_grid(radii, limit.grid)
    side = 1.0
    x, y = centre
    rows = [_half(x, y, turn, -side), _half(x, y, turn, side)]
    for j in range(len(radii) - 1, 0, -1):
        # a half turn begins on its side of the centre, where the one before it ends
        x += side * (radii[j] - radii[j - 1])
        side = -side
        rows.append(_half(x, y, radii[j - 1], side))
    if len(radii) > 1:
        rows.append(_half(x, y, radii[0], -side))
    return np.array(rows[::-1])


def _on_grid(radii: list[float], grid: DigitGrid) -> list[float]:
    """Return radii that are whole numbers of steps, up to the same last one; from each to the next they grow by no less
    than before, and by less than a step more than they did.
    """
    counts = [round(each / grid.step) for each in radii]
    grown = [after - before for before, after in pairwise(counts)]
    for k in range(len(grown) - 1, 0, -1):
        grown[k - 1] = min(grown[k - 1], grown[k])
    made = [counts[-1]]
    for each in reversed(grown):
        made.append(made[-1] - each)
    return [grid.step * each for each in reversed(made)]


def _half(x: float, y: float, radius: float, side: float) -> tuple[float, ...]:
    """Return the half turn that begins on a side of its centre."""
    return (x + side * radius, y, x - side * radius, y, x, y, radius, 1.0)


def _radii(turn: float, limit: EngagementLimit, seed: float) -> list[float]:
    """Return radii of half turns that grow as fast as they may, from about a seed up to `turn` exactly."""
    radii = [seed]
    while radii[-1] < turn and len(radii) < _MOST_TURNS:
        radii.append(radii[-1] + limit.growth(radii[-1]))
    if len(radii) < 3:
        return [turn]
    low, high, count = seed, radii[1], len(radii) - 2
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        if _grown(middle, count, limit) < turn:
            low = middle
        else:
            high = middle
    radii = [low]
    for _ in range(count):
        radii.append(radii[-1] + limit.growth(radii[-1]))
    return [*radii[:-1], turn]


def _grown(radius: float, count: int, limit: EngagementLimit) -> float:
    for _ in range(count):
        radius += limit.growth(radius)
    return radius
