"""What one picture of a cut is painted of: from where, how large, in which light, with what taken away. No Qt, no
OpenGL.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..camera import Camera, Floats
from ..cell_picking import SectionPlane
from ..cut_picture import CutPicture
from .render_target import RenderStyle

CLIP_PLANES = (0x3000, 0x3001)
"""GL_CLIP_DISTANCE0 and 1, which moderngl has no names for: the section, and what was cut through."""

_LEAST_SLANT = 0.02


@dataclass(frozen=True, slots=True)
class CutFrame:
    """One picture to be painted.

    Attributes:
        camera: from where. size: width and height, px, >= 1.
        look: colours and light.
        budget: about how many squares the metal may be painted with; 0 = as many as can be seen, with smooth edges.
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

    def stride(self, picture: CutPicture, cells: int) -> int:
        """Return how many cells lie between two vertices: not finer than a pixel, and within the budget.

        Args:
            picture: whose cells. cells: that can be seen.
        """
        finest = max(1, int(1.0 / (picture.pitch * self.camera.scale)))
        return max(finest, int(np.ceil(np.sqrt(cells / self.budget)))) if self.budget else finest

    def seen_cells(self, picture: CutPicture, highest: float) -> tuple[tuple[int, int], tuple[int, int]]:
        """Return the first and the last column and row that can be in the picture; no cell is higher than `highest`,
        mm.
        """
        width, height = self.size
        rays = [self.camera.ray(at, self.size) for at in ((0, 0), (width, 0), (0, height), (width, height))]
        counts = np.array([picture.columns, picture.rows])
        slant = rays[0].direction[2]
        if abs(slant) < _LEAST_SLANT:
            return (0, 0), (picture.columns - 1, picture.rows - 1)
        levels = (picture.floor, highest)
        places = np.array([ray.origin + (z - ray.origin[2]) / slant * ray.direction for ray in rays for z in levels])
        cells = (places[:, :2] - picture.low[:2]) / picture.pitch
        first = np.clip(np.floor(cells.min(axis=0)) - 1, 0, counts - 1).astype(int)
        last = np.clip(np.ceil(cells.max(axis=0)) + 1, 0, counts - 1).astype(int)
        return (int(first[0]), int(first[1])), (int(last[0]), int(last[1]))


def section_ends(
    section: SectionPlane, low: Floats, high: Floats
) -> tuple[tuple[float, float], tuple[float, float]] | None:
    """Return where a section enters and leaves the stock seen from above, mm; None where it passes by it."""
    normal = np.array(section.normal)
    middle, along = section.offset * normal, np.array([-normal[1], normal[0]])
    begin, end = -np.inf, np.inf
    for axis in (0, 1):
        if abs(along[axis]) > 1e-12:
            bounds = sorted(((low[axis] - middle[axis]) / along[axis], (high[axis] - middle[axis]) / along[axis]))
            begin, end = max(begin, bounds[0]), min(end, bounds[1])
        elif not low[axis] <= middle[axis] <= high[axis]:
            return None
    if begin >= end:
        return None
    first, last = middle + begin * along, middle + end * along
    return (float(first[0]), float(first[1])), (float(last[0]), float(last[1]))
