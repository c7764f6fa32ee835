"""How a drawing or a picture gets onto the display memory."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import PurePath

import numpy as np

from ...core.errors import ParameterError
from ...raster.frame import POINTS, BitmapFrame
from ...raster.picture_options import PictureOptions

PICTURES = (".png", ".jpg", ".jpeg", ".bmp")
"""Suffixes of pictures that can be read, in lower case."""

MARGIN_PX = 2
"""Empty pixels round a drawing on its bitmap."""

LARGEST_SIDE = 8192
"""Pixels; a larger bitmap is refused before it is made."""


@dataclass(frozen=True)
class BitmapSize:
    """How finely a drawing is seen.

    Attributes:
        points: rows and columns, 16 ... 8192; with a pitch, the least.
        pitch: size of a pixel, mm, > 0; None = as large as the drawing allows.
    """

    points: int = POINTS
    pitch: float | None = None

    def __post_init__(self) -> None:
        if not 16 <= self.points <= LARGEST_SIDE:
            raise ParameterError(f"The bitmap is {self.points} px wide; use 16 to {LARGEST_SIDE} px.")
        if self.pitch is not None and not 0 < self.pitch < 1e5:
            raise ParameterError(f"The pitch is {self.pitch:g} mm; it must be greater than 0 and less than 100000 mm.")

    def frame(self, extent: tuple[float, float, float, float]) -> BitmapFrame:
        """Return a frame round an extent x0, y0, x1, y1, mm; its corner lies on a whole multiple of the pitch where one
        was given.

        Raises:
            ParameterError: at this pitch the drawing is larger than the largest bitmap.
        """
        if self.pitch is None:
            return BitmapFrame.around(extent, self.points, MARGIN_PX)
        x0, y0 = (int(np.floor(low / self.pitch)) - MARGIN_PX for low in extent[:2])
        need = max(
            int(np.ceil(high / self.pitch)) + MARGIN_PX - low for high, low in zip(extent[2:], (x0, y0), strict=True)
        )
        if need > LARGEST_SIDE:
            raise ParameterError(
                f"At a pitch of {self.pitch:g} mm the drawing is {need} px wide; {LARGEST_SIDE} px are the most, "
                "so use a larger pitch."
            )
        side = max(need, self.points)
        return BitmapFrame(side, side, self.pitch, x0 * self.pitch, y0 * self.pitch)


@dataclass(frozen=True)
class BitmapOptions:
    """How a drawing or a picture gets onto the display memory.

    Attributes:
        size: of the bitmap, for drawings; a picture has its own.
        picture: how to read one.
    """

    size: BitmapSize = field(default_factory=BitmapSize)
    picture: PictureOptions = field(default_factory=PictureOptions)


def is_picture(name: str) -> bool:
    """Tell whether a file is a picture, by its suffix."""
    return PurePath(name).suffix.lower() in PICTURES
