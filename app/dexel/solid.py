"""A work piece from a solid of triangles, such as an STL file's."""

from __future__ import annotations

import io
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.dexel.workpiece import Grid, Workpiece, ensure_memory
from app.errors import InputError

CHUNK = 20_000
"""Triangles that are laid over the grid at a time."""

HEADER, TRIANGLE = 84, 50
"""Bytes of a binary STL file: its header with the number of triangles, and each triangle."""


@dataclass(frozen=True, eq=False)
class SolidStock:
    """A closed solid.

    Attributes:
        triangles: (n, 3, 3) float64 corners, mm; n > 0.
    """

    triangles: NDArray[np.float64]

    @property
    def box(self) -> tuple[float, float, float, float]:
        """x0, y0, x1, y1, mm."""
        low, high = self.triangles.min(axis=(0, 1)), self.triangles.max(axis=(0, 1))
        return float(low[0]), float(low[1]), float(high[0]), float(high[1])

    def over(self, grid: Grid) -> Workpiece:
        """Return the solid over a grid: its top at each cell's centre, cells that it is met in more than once counted.

        Raises:
            ParameterError: the grid does not fit into memory.
        """
        from app.dexel.solid_kernels import drop

        ensure_memory(grid, 8)
        floor = float(self.triangles[..., 2].min())
        heights, crossings = np.full((grid.rows, grid.cols), floor, np.float32), np.zeros((grid.rows, grid.cols), np.int32)
        where = (float(grid.x0), float(grid.y0), float(grid.pitch))
        for first in range(0, len(self.triangles), CHUNK):
            drop(self.triangles, where, first, min(first + CHUNK, len(self.triangles)), heights, crossings)
        return Workpiece(grid, heights, floor, int(np.count_nonzero(crossings > 2)))


def read_solid(name: str, data: bytes) -> SolidStock:
    """Return the solid of an STL file, text or binary; its numbers are mm.

    Args:
        name: of the file, for errors.
        data: the file.

    Raises:
        InputError: it is no STL file, holds nothing, or its surface is not closed.
    """
    import trimesh

    try:
        mesh = trimesh.load_mesh(io.BytesIO(_plain(data)), file_type="stl")
        triangles = np.array(mesh.triangles, np.float64, order="C")
    except Exception as error:  # the library lets through whatever its parsers trip over
        raise InputError(f"{name}: this is no STL file, or it is damaged; export the solid again, as binary STL.") from error
    if not len(triangles) or not np.isfinite(triangles).all():
        raise InputError(f"{name}: the STL file holds no triangles; export the solid again.")
    if not mesh.is_watertight:
        raise InputError(f"{name}: the solid's surface is not closed, so nobody can say where its metal is; "
                         "repair it, or export it as one closed solid.")
    return SolidStock(triangles)


def _plain(data: bytes) -> bytes:
    """Return the file for the library's parsers: of a text only plain letters, as names may be spelled in any code page."""
    text = data.lstrip()[:5].lower() == b"solid" and len(data) != HEADER + TRIANGLE * int.from_bytes(data[HEADER - 4 : HEADER], "little")
    return data.decode("latin-1").encode("ascii", "replace") if text else data
