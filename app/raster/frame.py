"""Where the bitmap lies on the part, and the only place that turns one's rows into the other's heights."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from ..core.errors import ParameterError
from ..core.memory import MemoryRemedy, ask, fewer

Floats = NDArray[np.float64]

POINTS = 400
"""Rows and columns of the workstation's display."""

PATH_BYTES, STAGES_BYTES = 26, 90
"""Of a pixel: what paths on pixels take at a time (labels, distances and those of the squares, codes), and all stages
with their files.
"""


@dataclass(frozen=True, slots=True)
class BitmapFrame:
    """A grid of square pixels over the part; image row 0 is the TOP row, part coordinates run upwards.

    Attributes:
        rows, cols: size in pixels, 1 ... 32768.
        pitch: size of a pixel, mm, > 0.
        x0, y0: lower left corner of the grid (not the centre of a pixel), mm.
    """

    rows: int = POINTS
    cols: int = POINTS
    pitch: float = 0.25
    x0: float = 0.0
    y0: float = 0.0

    def __post_init__(self) -> None:
        if not (1 <= self.rows <= 32768 and 1 <= self.cols <= 32768):
            raise ParameterError(f"The bitmap is {self.cols} x {self.rows} px; each side must be 1 to 32768 px.")
        if not 0 < self.pitch < 1e6:
            raise ParameterError(f"The pitch is {self.pitch:g} mm; it must be greater than 0.")

    @classmethod
    def around(cls, extent: tuple[float, float, float, float], size: int = POINTS, margin_px: int = 2) -> BitmapFrame:
        """Return a square frame with the extent in its middle.

        Args:
            extent: x0, y0, x1, y1 of what must be seen, mm.
            size: rows and columns, px.
            margin_px: free pixels on every side, 0 <= margin_px < size / 2.
        """
        if not 0 <= 2 * margin_px < size:
            raise ParameterError(f"A margin of {margin_px} px leaves nothing of a bitmap of {size} px.")
        x0, y0, x1, y1 = extent
        longest = max(x1 - x0, y1 - y0)
        pitch = longest / (size - 2 * margin_px) if longest > 0 else 0.25
        half = size * pitch / 2
        return cls(size, size, pitch, (x0 + x1) / 2 - half, (y0 + y1) / 2 - half)

    def ask_memory(self, each: int, picture: bool = False) -> None:
        """Ask for the memory of what is kept of all pixels.

        Args:
            each: bytes of a pixel.
            picture: they are those of a picture, as many as it has.

        Raises:
            MemoryShortError: there is not as much.
        """
        needed, longer = self.rows * self.cols * each, max(self.rows, self.cols)
        fits = fewer(longer, needed, 2)
        pitch = f"{self.pitch * longer / fits:.2g}"
        remedies = (
            [MemoryRemedy(f"make the picture smaller, at most {fits} px along its longer side")]
            if picture
            else [
                MemoryRemedy(f"use at most {fits} px along a side", "bitmap", fits),
                MemoryRemedy(f", or pixels of {pitch} mm or more", "pitch", pitch),
            ]
        )
        ask(needed, f"A bitmap of {self.cols} x {self.rows} px", *remedies)

    def to_px(self, points: Floats) -> Floats:
        """Return (n, 2) image coordinates (column, row from the top) of points (n, 2) in mm; px (r, c) spans [c, c+1) x
        [r, r+1).
        """
        return np.stack(
            [(points[:, 0] - self.x0) / self.pitch, self.rows - (points[:, 1] - self.y0) / self.pitch], axis=1
        )

    def to_mm(self, points: Floats) -> Floats:
        """Return (n, 2) part coordinates in mm of image coordinates (column, row from the top); the inverse of
        `to_px`.
        """
        return np.stack(
            [self.x0 + points[:, 0] * self.pitch, self.y0 + (self.rows - points[:, 1]) * self.pitch], axis=1
        )

    def centres(self) -> tuple[Floats, Floats]:
        """Return x (cols,) of the columns' and y (rows,) of the rows' pixel centres, mm; y[0] is the top row's."""
        x = self.x0 + np.arange(0.5, self.cols, dtype=np.float64) * self.pitch
        y = self.y0 + np.arange(self.rows - 0.5, 0, -1, dtype=np.float64) * self.pitch
        return x, y

    @property
    def extent(self) -> tuple[float, float, float, float]:
        """x0, y0, x1, y1 of the whole grid, mm."""
        return (self.x0, self.y0, self.x0 + self.cols * self.pitch, self.y0 + self.rows * self.pitch)


# The display memory: one code a pixel.


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
