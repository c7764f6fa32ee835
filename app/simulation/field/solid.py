"""A work piece from a solid of triangles, such as an STL file's."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ...core.errors import InputError
from .triangle_tree import TriangleTree
from .workpiece import Grid, Workpiece, ensure_memory

CHUNK = 20_000
"""Triangles that are laid over the grid at a time."""


@dataclass(frozen=True, eq=False)
class SolidStock:
    """A closed solid.

    Attributes:
        triangles: (n, 3, 3) float64 corners, mm; n > 0; counter-clockwise seen from outside.
        turned: how many of them were wound the other way in their file.
        shells: of how many closed surfaces it consists; these may overlap, or one may be a hollow in another.
    """

    triangles: NDArray[np.float64]
    turned: int = 0
    shells: int = 1

    @property
    def box(self) -> tuple[float, float, float, float]:
        """x0, y0, x1, y1, mm."""
        low, high = self.triangles.min(axis=(0, 1)), self.triangles.max(axis=(0, 1))
        return float(low[0]), float(low[1]), float(high[0]), float(high[1])

    @cached_property
    def tree(self) -> TriangleTree:
        """Its triangles, to be asked for near ones; made when somebody asks."""
        return TriangleTree.of(self.triangles)

    def over(self, grid: Grid) -> Workpiece:
        """Return the solid over a grid: its top at each cell's centre, cells that it is met in more than once counted.

        Raises:
            ParameterError: the grid does not fit into memory.
        """
        from .solid_kernels import drop

        ensure_memory(grid, 8)
        floor = float(self.triangles[..., 2].min())
        heights, crossings = (
            np.full((grid.rows, grid.cols), floor, np.float32),
            np.zeros((grid.rows, grid.cols), np.int32),
        )
        where = (float(grid.x0), float(grid.y0), float(grid.pitch))
        for first in range(0, len(self.triangles), CHUNK):
            drop(self.triangles, where, first, min(first + CHUNK, len(self.triangles)), heights, crossings)
        return Workpiece(grid, heights, floor, int(np.count_nonzero(crossings > 2)))

    def wound_words(self, name: str) -> str:
        """Return the sentence that says which triangles of a file were turned over; "" where none was."""
        if not self.turned:
            return ""
        if self.turned == len(self.triangles):
            return (
                f"{name}: the solid is inside out, as all of its triangles are wound clockwise; it is taken right "
                "side out."
            )
        return (
            f"{name}: {self.turned} of {len(self.triangles)} triangles are wound against the others; the solid is "
            "closed, so they are taken the right way round."
        )


def read_solid(name: str, data: bytes) -> SolidStock:
    """Return the solid of an STL file, text or binary, right side out; its numbers are mm.

    Args:
        name: of the file, for errors.
        data: the file.

    Raises:
        InputError: it is no STL file, holds nothing, its surface is not closed, or has no inside.
    """
    from ...surfaces.meshes.orientation import orient_outwards  # few stocks are files, and readers of meshes are many
    from ...surfaces.meshes.read import stl_triangles

    triangles = stl_triangles(name, data)
    wound = orient_outwards(triangles)
    if wound.fault:
        place = "" if wound.place is None else " at ({:.3f}, {:.3f}, {:.3f})".format(*wound.place)
        raise InputError(
            f"{name}: the solid's surface is not closed{place}: {wound.fault}; so nobody can say where its metal is; "
            "repair it, or export it as one closed solid."
        )
    return SolidStock(np.ascontiguousarray(wound.triangles), int(np.count_nonzero(wound.turned)), wound.shells)
