"""The display memory: one code a pixel."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from .frame import BitmapFrame

Plane = NDArray[np.uint8]
"""Codes (rows, cols), row 0 = top."""


class PixelCode(IntEnum):
    """What a pixel of the display memory holds, as in the 1986 text."""

    EMPTY = 0
    CONTOUR = 1
    TRACED = 2
    """A contour pixel that counts in the parity scan: the contour crosses its row's centre line an odd number of
    times.
    """
    R = 3
    """A contour pixel that does not count: vertex, plateau, overlap line."""
    INSIDE = 4
    """The text's I."""
    PROCESSED = 5
    """The mark of steps 304 and 307: cut, or too near to what must stay."""
    FRAME = 6
    """A pixel of an outermost frame path (steps 143 and 144)."""
    RING = 7
    """A pixel of a path further in (step 146)."""
    CIRCLE = 8
    LONG_LINE = 9
    VERTEX = 10
    SHORT_LINE = 11
    ARC = 12
    SPLINE = 13
    """The last six: what smoothing (steps 401-407) has made of a path's pixel."""


@dataclass(frozen=True)
class Codes:
    """A filled bitmap.

    Attributes:
        plane: (rows, cols) uint8 of PixelCode, row 0 = top.
    """

    frame: BitmapFrame
    plane: Plane

    def __post_init__(self) -> None:
        self.plane.setflags(write=False)

    @property
    def filled(self) -> NDArray[np.bool_]:
        """(rows, cols): inside or on the contour. What the text ends with: 2, R and I become 1."""
        filled: NDArray[np.bool_] = self.plane != PixelCode.EMPTY
        return filled

    @property
    def contour(self) -> NDArray[np.bool_]:
        """(rows, cols): on the contour."""
        contour: NDArray[np.bool_] = (self.plane != PixelCode.EMPTY) & (self.plane != PixelCode.INSIDE)
        return contour

    def near_contour(self) -> NDArray[np.bool_]:
        """Return (rows, cols): the contour pixels and their eight neighbours; by shifts, since a library for one
        picture takes longer to load.
        """
        near = self.contour
        for sideways in (near, near.T):
            contour = sideways.copy()
            sideways[1:] |= contour[:-1]
            sideways[:-1] |= contour[1:]
        return near


@dataclass(frozen=True, slots=True)
class AreaBound:
    """What a bitmap knows of an area.

    Attributes:
        low, high: the area is within these, mm2, whatever the contour does inside a pixel.
        estimate: inside pixels and half of the contour's, mm2.
    """

    low: float
    high: float
    estimate: float


def area_mm2(codes: Codes) -> AreaBound:
    """Return the area of a filled region that lies wholly in its frame, with bounds that hold.

    A contour can pass through the corner of a pixel without being drawn in it, but then it is drawn in one of the
    eight neighbours; so the bounds leave out, and add, the contour's pixels and all of their neighbours.
    """
    doubtful = codes.near_contour()
    inside = codes.plane == PixelCode.INSIDE
    pixel = codes.frame.pitch**2
    certain = int(np.count_nonzero(inside & ~doubtful))
    return AreaBound(
        low=certain * pixel,
        high=(certain + int(np.count_nonzero(doubtful))) * pixel,
        estimate=(int(np.count_nonzero(inside)) + int(np.count_nonzero(codes.contour)) / 2) * pixel,
    )
