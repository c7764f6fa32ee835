"""What plots and pictures in pixels are painted with: finer than these, then averaged, so that lines have no stairs."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

Pixels = NDArray[np.uint8]
"""(rows, columns, 3) blue, green, red; row 0 at the top."""

FINE = 2
"""Times finer than the pixels of the file that everything is painted."""

SHIFT = 4
"""Binary digits of a pixel that positions keep."""


def sheet_of(width: int, height: int, colour: str) -> Pixels:
    """Return a sheet for so many pixels of the file, FINE times as many both ways, all of one colour."""
    return np.full((height * FINE, width * FINE, 3), bgr(colour), np.uint8)


def bgr(colour: str) -> tuple[int, int, int]:
    """Return "#rrggbb" as OpenCV wants it: blue, green, red."""
    return int(colour[5:7], 16), int(colour[3:5], 16), int(colour[1:3], 16)


def fixed(points: NDArray[np.float64]) -> NDArray[np.int32]:
    """Return positions (n, 2), fine pixels, as OpenCV wants them: whole numbers, SHIFT binary digits below a pixel."""
    return np.asarray(np.round(points * 2**SHIFT), np.int32)


def averaged(sheet: Pixels) -> Pixels:
    """Return a sheet in the pixels of the file, each the mean of those painted in it."""
    height, width = sheet.shape[0] // FINE, sheet.shape[1] // FINE
    return np.asarray(cv2.resize(sheet, (width, height), interpolation=cv2.INTER_AREA), np.uint8)
