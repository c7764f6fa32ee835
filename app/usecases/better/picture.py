"""What light shows of a cut: facets of a program stand in the metal as streaks, where its slope jumps along passes."""

from __future__ import annotations

import math

import numpy as np

from ...model.motion import Floats
from ...simulation.field.workpiece import Workpiece
from .area import PassArea

_LIGHT_DEG = 12.0
"""Over the plane; so low that slopes of a tenth of a degree can be seen."""
_CONTRAST = 6.0
"""Times as steep as they are slopes are shown."""
_GAP = 8
"""Pixels between the two pictures."""


def streaks(workpiece: Workpiece, area: PassArea) -> float:
    """Return by how much the metal's slope changes from cell to cell along the passes, root of the mean square,
    radians: over what the passes cut, but for its rim.

    Args:
        workpiece: after the cut. area: where the passes are and how they run.
    """
    places = _cells(workpiece)
    angles = area.angles(places).reshape(workpiece.heights.shape)
    bends = _bends(workpiece, angles) * workpiece.grid.pitch
    over = area.inside(places).reshape(angles.shape)
    for _ in range(math.ceil(area.pitch / workpiece.grid.pitch) + 2):  # ends of passes stand as teeth in the rim
        over[1:-1, 1:-1] &= over[:-2, 1:-1] & over[2:, 1:-1] & over[1:-1, :-2] & over[1:-1, 2:]
    return float(np.sqrt(np.mean(bends[over] ** 2))) if over.any() else 0.0


def stock_picture(old: Workpiece, new: Workpiece, area: PassArea) -> bytes:
    """Return both cuts beside one another as a PNG picture, the old one at the left, lit from low along the passes."""
    import cv2

    ways = np.exp(2j * area.angles(np.concatenate([line[:, :2] for line in area.lines])))
    sides = [_lit(each, float(np.angle(ways.mean()) / 2)) for each in (old, new)]
    gap = np.full((len(sides[0]), _GAP), 255, np.uint8)
    return bytes(cv2.imencode(".png", np.hstack([sides[0], gap, sides[1]])[::-1])[1].tobytes())


def _cells(workpiece: Workpiece) -> Floats:
    """Return the middles (n, 2) of all cells, row by row."""
    grid = workpiece.grid
    x, y = np.meshgrid(
        grid.x0 + (np.arange(grid.cols) + 0.5) * grid.pitch, grid.y0 + (np.arange(grid.rows) + 0.5) * grid.pitch
    )
    return np.column_stack([x.ravel(), y.ravel()])


def _lit(workpiece: Workpiece, angle: float) -> np.ndarray[tuple[int, ...], np.dtype[np.uint8]]:
    slope = np.arctan(_along(workpiece, angle))
    light = np.sin(math.radians(_LIGHT_DEG) - _CONTRAST * (slope - np.median(slope)) / 2)
    return np.asarray(np.clip(128 + 127 * light, 0, 255), np.uint8)


def _along(workpiece: Workpiece, angle: float) -> Floats:
    """Return the slope of each cell along an angle, radians."""
    down, across = np.gradient(workpiece.heights.astype(np.float64), workpiece.grid.pitch)
    return np.asarray(across * math.cos(angle) + down * math.sin(angle), np.float64)


def _bends(workpiece: Workpiece, angles: Floats) -> Floats:
    """Return the second derivative of each cell's height along its own angle, whichever way that is gone, 1/mm."""
    pitch, c, s = workpiece.grid.pitch, np.cos(angles), np.sin(angles)
    down, across = np.gradient(workpiece.heights.astype(np.float64), pitch)
    (mixed, twice_across), twice_down = np.gradient(across, pitch), np.gradient(down, pitch, axis=0)
    return np.asarray(c**2 * twice_across + 2 * c * s * mixed + s**2 * twice_down, np.float64)
