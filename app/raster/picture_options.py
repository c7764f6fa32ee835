"""What a user may say of how a picture is read."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from ..core.errors import ParameterError


class InkMeaning(Enum):
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
        pitch: size of a pixel, mm, > 0. dpi: pixels an inch, > 0, instead. None of both = as the file says. Where the
            file says that pixels are not square, this is of the square ones that they are made.
        shows: whether ink lines are the contours of what is to be machined, or inked areas are to be machined; AUTO =
            lines where the ink is thin for the size of what it draws.
    """

    threshold: int | None = None
    invert: bool = False
    despeckle: int = 4
    pitch: float | None = None
    dpi: float | None = None
    shows: InkMeaning = InkMeaning.AUTO

    def __post_init__(self) -> None:
        if self.threshold is not None and not 1 <= self.threshold <= 255:
            raise ParameterError(f"The threshold is {self.threshold}; use 1 to 255.")
        if self.despeckle < 0:
            raise ParameterError(f"Despeckle is {self.despeckle} px; use 0 or more.")
        for name, value, unit in (("pitch", self.pitch, " mm"), ("resolution", self.dpi, " dpi")):
            if value is not None and not 0 < value < 1e5:
                raise ParameterError(
                    f"The {name} is {value:g}{unit}; it must be greater than 0 and less than 100000{unit}."
                )
        if self.pitch is not None and self.dpi is not None:
            raise ParameterError("A pitch and a resolution say the same in two ways; give one of them.")
