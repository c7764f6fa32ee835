"""Where labels of points find room on paper among lines, points and each other."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Place = tuple[float, float]

_CELL = 0.4
"""Side of the squares of paper that are either free or taken, mm."""

_MOST_CELLS = 2e7
"""Of the table of what is taken; on larger paper cells are larger."""
_GAP, _POINT, _ROUND = 0.5, 0.7, 3.5
"""mm on paper: round a label, half the side of a point, how far labels may stand beyond all points."""
_WIDE, _BODY = 0.62, 0.75
"""Greatest width of a letter and height of a capital, of the height of a text."""


def free_places(lines: Sequence[Floats], points: Floats, texts: Sequence[str], height: float) -> list[Place | None]:
    """Return where the foot of each point's text begins; None where there is no room.

    Args:
        lines: polylines (n, 2) that labels keep off. points: (m, 2) to be labelled. texts: m. height: of the letters.
            All mm on paper.
    """
    if not len(points):
        return []
    every = np.concatenate([*lines, points])
    corner, far = every.min(axis=0) - _ROUND, every.max(axis=0) + _ROUND
    cell = max(_CELL, math.sqrt(float(np.prod(far - corner)) / _MOST_CELLS))
    taken = np.zeros(np.ceil((far - corner) / cell).astype(int) + 1, bool)
    for line in lines:
        at = np.floor((_dense(line, cell / 2) - corner) / cell).astype(int)
        taken[at[:, 0], at[:, 1]] = True
    for point in points:
        _cells(taken, (point - corner - _POINT) / cell, (point - corner + _POINT) / cell)[:] = True
    found = [
        _place(taken, _LabelledPoint(at, points - corner, cell), len(text) * height * _WIDE, height * _BODY)
        if text
        else None
        for at, text in enumerate(texts)
    ]
    return [None if place is None else (place[0] + float(corner[0]), place[1] + float(corner[1])) for place in found]


class _LabelledPoint(NamedTuple):
    """The number of a point among all, (m, 2), and the side of the squares of paper, mm."""

    number: int
    points: Floats
    cell: float


def _place(taken: NDArray[np.bool_], where: _LabelledPoint, wide: float, high: float) -> Place | None:
    """Return a free place beside one of the points, nearer to it than to the others, and take it; to the right and
    above first.
    """
    number, points, cell = where
    point = points[number]
    for away in (1.0, 2.0, 3.2):
        for side, up in ((1, 1), (-1, 1), (1, -1), (-1, -1), (0, 1), (0, -1), (1, 0), (-1, 0)):
            centre = point + (side * (wide / 2 + away * (0.7 if up else 1.0)), up * (high / 2 + away))
            half = np.array([wide / 2 + _GAP, high / 2 + _GAP])
            cells = _cells(taken, (centre - half) / cell, (centre + half) / cell)
            if not cells.size or cells.any() or np.hypot(*(points - centre).T).argmin() != number:
                continue
            cells[:] = True
            x, y = (centre - (wide / 2, high / 2)).tolist()
            return x, y
    return None


def _cells(taken: NDArray[np.bool_], low: Floats, high: Floats) -> NDArray[np.bool_]:
    """Return the squares of a rectangle; none where it leaves the paper."""
    (x0, y0), (x1, y1) = np.floor(low).astype(int).tolist(), (np.floor(high).astype(int) + 1).tolist()
    inside = min(x0, y0) >= 0 and x1 <= taken.shape[0] and y1 <= taken.shape[1]
    return taken[x0:x1, y0:y1] if inside else taken[:0]


def _dense(line: Floats, step: float) -> Floats:
    """Return places along a polyline no farther apart than a step."""
    along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))])
    at = np.union1d(along, np.arange(0.0, along[-1], step))
    return np.stack([np.interp(at, along, line[:, axis]) for axis in (0, 1)], axis=1)
