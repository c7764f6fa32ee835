"""A scanned or painted picture as pixels of ink: decoded, thresholded, cleaned of specks, with a size in mm."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from ..core.errors import InputError, ParameterError
from ..core.memory import MemoryRemedy, ask, fewer
from ..core.options import option
from .frame import PATH_BYTES
from .picture_file import MM_PER_INCH, Gray, PictureDensity, decoded, density_of, picture_size
from .picture_options import PictureOptions
from .walls import Mask

LARGEST_SIDE = 16384
"""Pixels; a picture with a longer side is refused before it is decoded."""

LARGEST_AREA = 100_000_000
"""Pixels of the largest picture."""


@dataclass(frozen=True, eq=False)
class RasterPicture:
    """A picture read.

    Attributes:
        gray: as decoded, its pixels made square.
        ink: (rows, cols) what counts as drawn.
        threshold: that was used.
        pitch: size of a pixel, mm.
        stretched: its pixels were not square in the file.
    """

    gray: Gray
    ink: Mask
    threshold: int
    pitch: float
    stretched: bool = False

    @property
    def remarks(self) -> tuple[str, ...]:
        """What to know of how it was read, a sentence each."""
        rows, cols = self.ink.shape
        square = (
            f"The picture's pixels are not square, so it was made {cols} x {rows} square ones; columns and rows count "
            "these.",
        )
        full = (
            "All of the picture is ink, so all of it is machined; change the threshold or invert it if that is wrong.",
        )
        return square * self.stretched + full * bool(self.ink.all())


def read_picture(name: str, data: bytes, options: PictureOptions) -> RasterPicture:
    """Return the picture in a PNG, JPEG or BMP file's bytes.

    Args:
        name: of the file, for messages.

    Raises:
        InputError: it is none of these, damaged, too large, or nobody says how large a pixel is.
    """
    _check_size(name, size := picture_size(name, data))
    _ask_memory(name, size)
    gray, density = decoded(name, data), density_of(data)
    pitch = _pitch(name, density, options)
    square = gray if density is None else _squared(name, gray, density)
    return replace(thresholded(square, pitch, options), stretched=square is not gray)


def _check_size(name: str, size: tuple[int, int]) -> None:
    cols, rows = size
    if max(size) > LARGEST_SIDE or cols * rows > LARGEST_AREA:
        raise InputError(
            f"{name}: the picture has {cols} x {rows} px; {LARGEST_SIDE} px a side and {LARGEST_AREA // 10**6} "
            "million in all are the most, so make it smaller."
        )


def _ask_memory(name: str, size: tuple[int, int]) -> None:
    """Ask for what reading a picture takes, and making paths of its pixels."""
    cols, rows = size
    needed = cols * rows * PATH_BYTES
    fits = fewer(max(size), needed, 2)
    ask(
        needed,
        f"{name}, a picture of {cols} x {rows} px,",
        MemoryRemedy(f"make it smaller, at most {fits} px along its longer side"),
    )


def _squared(name: str, gray: Gray, density: PictureDensity) -> Gray:
    """Return the picture with square pixels, as small as its own are where they are smallest."""
    import cv2

    rows, cols = density.square_shape(gray.shape)
    if (rows, cols) == gray.shape:
        return gray
    _check_size(name, (cols, rows))
    return np.asarray(cv2.resize(gray, (cols, rows), interpolation=cv2.INTER_LINEAR), np.uint8)


def thresholded(gray: Gray, pitch: float, options: PictureOptions) -> RasterPicture:
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
    return RasterPicture(gray, ink, level, pitch)


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
        raise ParameterError(
            f"Two points {apart:g} px and {distance:g} mm apart say nothing of the pitch; choose two that are apart."
        )
    return distance / apart


def _pitch(name: str, density: PictureDensity | None, options: PictureOptions) -> float:
    """Return the size of a pixel, mm, as the options or the file say.

    Raises:
        InputError: neither says it.
    """
    if options.pitch is not None:
        return options.pitch
    if options.dpi is not None:
        return MM_PER_INCH / options.dpi
    if density is None or density.pitch is None:
        raise InputError(
            f"{name}: the picture does not say how large it is; give the size of a pixel ({option('pitch', 'MM')}) "
            f"or the resolution ({option('dpi', 'N')})."
        )
    return density.pitch
