"""What a ball leaves of what it reaches, in plain float64: closing of a height function, and balls set along the moves
of the NC text.

Nothing is shared with the program but the reader of NC: heights are functions, closing is scipy's, the cut is a minimum
over balls.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from app.gcode.interpreter.reader import read_program
from app.model.motion import MotionKind

Floats = np.ndarray
Surface = Callable[[Floats, Floats], Floats]


@dataclass(frozen=True)
class Window:
    """Places that are looked at: x0, y0, x1, y1 and the distance between them, mm."""

    x0: float
    y0: float
    x1: float
    y1: float
    pitch: float

    def places(self, more: float = 0.0) -> tuple[Floats, Floats]:
        """Return x and y (rows, cols) of the window and so much round it, a whole number of steps."""
        steps = round(more / self.pitch)
        cols, rows = (
            round((high - low) / self.pitch) + 2 * steps for low, high in ((self.x0, self.x1), (self.y0, self.y1))
        )
        x = self.x0 + (np.arange(cols) + 0.5 - steps) * self.pitch
        y = self.y0 + (np.arange(rows) + 0.5 - steps) * self.pitch
        return np.meshgrid(x, y)


def reach(surface: Surface, radius: float, window: Window, lowest: float) -> Floats:
    """Return the lowest that a ball cuts in a window without going into a surface, its tip no lower than `lowest`."""
    steps = int(np.ceil(radius / window.pitch)) + 1
    heights = surface(*window.places(2 * steps * window.pitch))
    at = np.arange(-steps, steps + 1) * window.pitch
    square = radius**2 - at[:, None] ** 2 - at[None, :] ** 2
    inside, under = square >= 0, radius - np.sqrt(np.maximum(square, 0.0))
    tip = ndimage.grey_dilation(heights, footprint=inside, structure=np.where(inside, -under, 0.0), mode="nearest")
    tip = np.maximum(tip, lowest)
    low = ndimage.grey_erosion(tip, footprint=inside, structure=np.where(inside, -under, 0.0), mode="nearest")
    return low[2 * steps : -2 * steps, 2 * steps : -2 * steps]


def cut(nc: bytes, radius: float, window: Window, top: float) -> Floats:
    """Return what balls along the moves of a program leave below a stock's top."""
    x, y = window.places()
    heights = np.full(x.shape, float(top))
    motions = read_program(nc).motions
    for start, end, kind in zip(motions.start, motions.end, motions.kind, strict=True):
        assert kind in (MotionKind.LINE, MotionKind.RAPID)
        if not np.isfinite([start, end]).all():
            continue
        count = max(int(np.linalg.norm(end - start) / (window.pitch / 2)), 1) + 1
        for cx, cy, cz in start + np.linspace(0, 1, count)[:, None] * (end - start):
            c0, c1 = (
                np.clip(int((cx + far - window.x0) / window.pitch) + (far > 0), 0, x.shape[1])
                for far in (-radius, radius)
            )
            r0, r1 = (
                np.clip(int((cy + far - window.y0) / window.pitch) + (far > 0), 0, x.shape[0])
                for far in (-radius, radius)
            )
            part = heights[r0:r1, c0:c1]
            square = radius**2 - (x[r0:r1, c0:c1] - cx) ** 2 - (y[r0:r1, c0:c1] - cy) ** 2
            np.minimum(part, np.where(square >= 0, cz + radius - np.sqrt(np.maximum(square, 0.0)), np.inf), out=part)
    return heights
