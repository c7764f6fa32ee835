"""A scanned or painted picture as pixels of ink: decoded, thresholded, cleaned of specks, with a size in mm."""

from __future__ import annotations

import math
import struct
from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from app.bitmap.walls import Mask
from app.errors import InputError, ParameterError

LARGEST_SIDE = 16384
"""Pixels; a picture with a longer side is refused before it is decoded."""

LARGEST_AREA = 100_000_000
"""Pixels of the largest picture."""

MM_PER_INCH = 25.4

Gray = NDArray[np.uint8]
"""(rows, cols), row 0 = top, 0 = black."""


class Shows(Enum):
    """What the ink of a picture is."""

    AUTO = "auto"
    LINES = "lines"
    AREAS = "areas"


@dataclass(frozen=True, slots=True)
class PictureOptions:
    """How to read a picture.

    Attributes:
        threshold: what is darker is ink, 1 ... 255; None = where it parts dark from light best (Otsu).
        invert: the ink is light on dark.
        despeckle: spots of ink or of paper of up to this many pixels are taken away, >= 0.
        pitch: size of a pixel, mm, > 0. dpi: pixels an inch, > 0, instead. None of both = as the file says.
        shows: whether ink lines are the contours of what is to be machined, or inked areas are to be machined; AUTO = lines
            where the ink is thin for the size of what it draws.
    """

    threshold: int | None = None
    invert: bool = False
    despeckle: int = 4
    pitch: float | None = None
    dpi: float | None = None
    shows: Shows = Shows.AUTO

    def __post_init__(self) -> None:
        if self.threshold is not None and not 1 <= self.threshold <= 255:
            raise ParameterError(f"The threshold is {self.threshold}; use 1 to 255.")
        if self.despeckle < 0:
            raise ParameterError(f"Despeckle is {self.despeckle} px; use 0 or more.")
        for name, value, unit in (("pitch", self.pitch, " mm"), ("resolution", self.dpi, " dpi")):
            if value is not None and not 0 < value < 1e5:
                raise ParameterError(f"The {name} is {value:g}{unit}; it must be greater than 0 and less than 100000{unit}.")
        if self.pitch is not None and self.dpi is not None:
            raise ParameterError("A pitch and a resolution say the same in two ways; give one of them.")


@dataclass(frozen=True, eq=False)
class Picture:
    """A picture read.

    Attributes:
        gray: as decoded.
        ink: (rows, cols) what counts as drawn.
        threshold: that was used.
        pitch: size of a pixel, mm.
    """

    gray: Gray
    ink: Mask
    threshold: int
    pitch: float


def read_picture(name: str, data: bytes, options: PictureOptions) -> Picture:
    """Return the picture in a PNG, JPEG or BMP file's bytes.

    Args:
        name: of the file, for messages.

    Raises:
        InputError: it is none of these, damaged, too large, or nobody says how large a pixel is.
    """
    import cv2

    cols, rows = picture_size(name, data)
    if max(cols, rows) > LARGEST_SIDE or cols * rows > LARGEST_AREA:
        raise InputError(f"{name}: the picture has {cols} x {rows} px; {LARGEST_SIDE} px a side and {LARGEST_AREA // 10**6} million in all "
                         "are the most, so make it smaller.")
    gray = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_GRAYSCALE)
    if gray is None:
        raise InputError(f"{name}: the picture is damaged and cannot be decoded; save it again.")
    pitch = _pitch(name, data, options)
    return thresholded(np.asarray(gray, np.uint8), pitch, options)


def thresholded(gray: Gray, pitch: float, options: PictureOptions) -> Picture:
    """Return the ink of a picture that is decoded already.

    Args:
        pitch: size of a pixel, mm, > 0.
    """
    import cv2

    level = options.threshold
    if level is None:
        level = max(int(cv2.threshold(gray, 0, 255, cv2.THRESH_BINARY + cv2.THRESH_OTSU)[0]) + 1, 1)
    ink = (gray >= level) if options.invert else (gray < level)
    for paper in (False, True):
        ink = ink ^ _specks(ink ^ paper, options.despeckle)
    return Picture(gray, ink, level, pitch)


def _specks(spots: Mask, most: int) -> Mask:
    """Return the pixels of connected spots of no more than `most` pixels."""
    import cv2

    _, label, stats, _ = cv2.connectedComponentsWithStats(spots.astype(np.uint8), connectivity=8)
    small = stats[:, cv2.CC_STAT_AREA] <= most
    small[0] = False
    return np.asarray(small[label], np.bool_)


def pitch_of(first: tuple[float, float], second: tuple[float, float], distance: float) -> float:
    """Return the size of a pixel, mm, from two points whose distance is known.

    Args:
        first, second: (column, row), px.
        distance: between them, mm, > 0.

    Raises:
        ParameterError: the points are one, or the distance is not greater than 0.
    """
    apart = math.dist(first, second)
    if apart == 0 or not distance > 0:
        raise ParameterError(f"Two points {apart:g} px and {distance:g} mm apart say nothing of the pitch; choose two that are apart.")
    return distance / apart


def picture_size(name: str, data: bytes) -> tuple[int, int]:
    """Return (columns, rows) as a picture's header says, without decoding it.

    Raises:
        InputError: it is no PNG, JPEG or BMP, or its header is cut off.
    """
    try:
        if data[:8] == b"\x89PNG\r\n\x1a\n":
            return _whole(struct.unpack(">II", data[16:24]))
        if data[:2] == b"BM":
            cols, rows = struct.unpack("<ii", data[18:26])
            return _whole((cols, abs(rows)))
        if data[:2] == b"\xff\xd8":
            return _jpeg_size(data)
    except (struct.error, IndexError, ValueError) as error:
        raise InputError(f"{name}: the picture's header is damaged; save it again.") from error
    raise InputError(f"{name}: this is no PNG, JPEG or BMP picture; save it as one of these.")


def _whole(size: tuple[int, ...]) -> tuple[int, int]:
    cols, rows = size
    if cols < 1 or rows < 1:
        raise ValueError("no pixels")
    return cols, rows


def _segments(data: bytes) -> list[tuple[int, int]]:
    """Return (marker, place of its length) of a JPEG's segments, up to the first frame header."""
    found, at = [], 2
    while True:
        while data[at] == 0xFF:
            at += 1
        marker = data[at]
        found.append((marker, at + 1))
        if 0xC0 <= marker <= 0xCF and marker not in (0xC4, 0xC8, 0xCC):
            return found
        at += 1 + struct.unpack(">H", data[at + 1 : at + 3])[0]


def _jpeg_size(data: bytes) -> tuple[int, int]:
    _, at = _segments(data)[-1]
    rows, cols = struct.unpack(">HH", data[at + 3 : at + 7])
    return _whole((cols, rows))


def _pitch(name: str, data: bytes, options: PictureOptions) -> float:
    """Return the size of a pixel, mm, as the options or the file say.

    Raises:
        InputError: neither says it.
    """
    if options.pitch is not None:
        return options.pitch
    per_mm = options.dpi / MM_PER_INCH if options.dpi is not None else _pixels_per_mm(data)
    if not per_mm:
        raise InputError(f"{name}: the picture does not say how large it is; give the size of a pixel (--pitch MM) "
                         "or the resolution (--dpi N).")
    return 1 / per_mm


def _pixels_per_mm(data: bytes) -> float:
    """Return the resolution that the file names, or 0."""
    if data[:2] == b"BM":
        return float(struct.unpack("<i", data[38:42])[0] / 1000) if len(data) >= 42 else 0.0
    if data[:2] == b"\xff\xd8":
        for marker, at in _segments(data):
            if marker == 0xE0 and data[at + 2 : at + 7] == b"JFIF\0":
                unit, x = data[at + 9], struct.unpack(">H", data[at + 10 : at + 12])[0]
                return float({1: x / MM_PER_INCH, 2: x / 10}.get(unit, 0.0))
        return 0.0
    at = data.find(b"pHYs", 8, 4096)
    return float(struct.unpack(">I", data[at + 4 : at + 8])[0] / 1000) if at > 0 and data[at + 12] == 1 else 0.0
