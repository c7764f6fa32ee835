"""What light shows of a cut: facets of a program stand in the metal as streaks, where its slope jumps along passes."""

from __future__ import annotations

import math

import numpy as np

from ...model.motion import Floats
from ...simulation.field.workpiece import Workpiece
from .surface import SmoothedSurface, inside

_LIGHT_DEG = 12.0
"""Over the plane; so low that slopes of a tenth of a degree can be seen."""
_CONTRAST = 6.0
_GAP = 8
"""Pixels between the two pictures."""


def streaks(workpiece: Workpiece, smoothed: SmoothedSurface) -> float:
    """Return by how much the metal's slope changes from cell to cell along the passes, root of the mean square,
    radians: over what the passes cut, but for its rim.

    Args:
        workpiece: after the cut. smoothed: the surface of the passes, which tells where they are and how they run.
    """
    along = _along(workpiece, smoothed.raster.frame.angle)
    bends = _derived(along, workpiece.grid.pitch, smoothed.raster.frame.angle) * workpiece.grid.pitch
    grid = workpiece.grid
    x, y = np.meshgrid(
        grid.x0 + (np.arange(grid.cols) + 0.5) * grid.pitch, grid.y0 + (np.arange(grid.rows) + 0.5) * grid.pitch
    )
    over = inside(smoothed.raster, np.column_stack([x.ravel(), y.ravel()])).reshape(x.shape)
    for _ in range(math.ceil(smoothed.raster.pitch / grid.pitch) + 2):  # ends of passes stand as teeth in the rim
        over[1:-1, 1:-1] &= over[:-2, 1:-1] & over[2:, 1:-1] & over[1:-1, :-2] & over[1:-1, 2:]
    return float(np.sqrt(np.mean(bends[over] ** 2))) if over.any() else 0.0


def stock_picture(old: Workpiece, new: Workpiece, smoothed: SmoothedSurface) -> bytes:
    """Return both cuts beside one another as a PNG picture, the old one at the left, lit from low along the passes."""
    import cv2

    sides = [_lit(each, smoothed.raster.frame.angle) for each in (old, new)]
    gap = np.full((len(sides[0]), _GAP), 255, np.uint8)
    return bytes(cv2.imencode(".png", np.hstack([sides[0], gap, sides[1]])[::-1])[1].tobytes())


def _lit(workpiece: Workpiece, angle: float) -> np.ndarray[tuple[int, ...], np.dtype[np.uint8]]:
    slope = np.arctan(_along(workpiece, angle))
    light = np.sin(math.radians(_LIGHT_DEG) - _CONTRAST * (slope - np.median(slope)) / 2)
    return np.asarray(np.clip(128 + 127 * light, 0, 255), np.uint8)


def _along(workpiece: Workpiece, angle: float) -> Floats:
    return _derived(workpiece.heights.astype(np.float64), workpiece.grid.pitch, angle)


def _derived(values: Floats, pitch: float, angle: float) -> Floats:
    down, across = np.gradient(values, pitch)
    return np.asarray(across * math.cos(angle) + down * math.sin(angle), np.float64)
