"""A picture that lies under the drawing to be traced; it is never machined."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from ..core.errors import ParameterError
from .curves import Point


@dataclass(frozen=True, slots=True)
class Underlay:
    """Where a picture lies and how it looks.

    Attributes:
        path: of its file.
        origin: its lower left corner, mm.
        mm_per_px: size of its pixels, mm, > 0.
        angle: its lower edge from +X, rad.
        opacity: 0 not seen ... 1 covering the paper.
    """

    path: str
    origin: Point = (0.0, 0.0)
    mm_per_px: float = 0.25
    angle: float = 0.0
    opacity: float = 0.5

    def __post_init__(self) -> None:
        if not (
            0 < self.mm_per_px < 1e6 and 0 <= self.opacity <= 1 and all(map(math.isfinite, (*self.origin, self.angle)))
        ):
            raise ParameterError(
                f"The picture {self.path} cannot lie there: its pixels must be larger than 0 mm, its opacity 0 to 1."
            )

    def moved(self, dx: float, dy: float) -> Underlay:
        """Return the picture shifted, mm."""
        return replace(self, origin=(self.origin[0] + dx, self.origin[1] + dy))

    def scaled(self, about: Point, factor: float) -> Underlay:
        """Return the picture enlarged; the point `about`, mm, stays where it is."""
        x, y = (c + (o - c) * factor for c, o in zip(about, self.origin, strict=True))
        return replace(self, origin=(x, y), mm_per_px=self.mm_per_px * factor)

    def turned(self, about: Point, angle: float) -> Underlay:
        """Return the picture turned counter-clockwise about a point, rad."""
        dx, dy = self.origin[0] - about[0], self.origin[1] - about[1]
        c, s = math.cos(angle), math.sin(angle)
        return replace(self, origin=(about[0] + c * dx - s * dy, about[1] + s * dx + c * dy), angle=self.angle + angle)
