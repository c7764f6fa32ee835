"""What one picture of a cut is painted of: from where, how large, in which light, with what taken away. No Qt, no
OpenGL.
"""

from __future__ import annotations

from dataclasses import dataclass

from ..camera import Camera
from ..cell_picking import SectionPlane
from .render_target import RenderStyle

CLIP_PLANES = (0x3000, 0x3001)
"""GL_CLIP_DISTANCE0 and 1, which moderngl has no names for: the section, and what was cut through."""

FINE = 2
"""Lines of sight across a pixel, and down it, in the fine picture."""

_COARSEST = 4
"""Pixels across, and down, that may share one while things move."""


@dataclass(frozen=True, slots=True)
class CutFrame:
    """One picture to be painted.

    Attributes:
        camera: from where. size: width and height, px, >= 1.
        look: colours and light.
        budget: about how many lines of sight may be followed to the metal; 0 = `FINE` by `FINE` in every pixel.
        section: takes metal away.
        shown: looks of paths that are painted.
    """

    camera: Camera
    size: tuple[int, int]
    look: RenderStyle
    budget: int = 0
    section: SectionPlane | None = None
    shown: frozenset[int] = frozenset(range(4))

    @property
    def clip(self) -> tuple[float, float, float]:
        """The section as the shaders take it; none = everything lies 1 mm on the side that stays."""
        return (*self.section.normal, self.section.offset) if self.section is not None else (0.0, 0.0, 1.0)

    @property
    def rays(self) -> tuple[int, int]:
        """How many lines of sight there are across the picture and down it."""
        width, height = self.size
        if not self.budget:
            return FINE * width, FINE * height
        shared = min(max(1, round((width * height / self.budget) ** 0.5)), _COARSEST)
        return -(-width // shared), -(-height // shared)
