"""Random closed solids with a hilly top, written in all formats and spoilt in known ways, and how high they stand."""

from __future__ import annotations

import io
import zipfile
from itertools import pairwise

import numpy as np
import trimesh
from numpy.typing import NDArray

Floats = NDArray[np.float64]

WIDE, DEEP, UNDER = 24.0, 18.0, -12.0
"""mm; the solid stands on (0, 0) to (WIDE, DEEP), its underside at UNDER and its top between -9 and 0."""


class HillySolid:
    """A block whose top is a surface over a grid, two triangles a cell.

    Attributes:
        x, y: of the grid's lines, mm. z: (rows, columns) of its nodes, mm.
    """

    def __init__(self, seed: int) -> None:
        rng = np.random.default_rng(seed)
        columns, rows = int(rng.integers(3, 9)), int(rng.integers(3, 8))
        self.x = np.linspace(0, WIDE, columns)
        self.y = np.linspace(0, DEEP, rows)
        steps = rng.choice([0, 1, 2])
        self.z = -4.5 + 4.5 * np.clip(rng.normal(0, 0.5, (rows, columns)), -1, 1)
        if steps:  # level ground and steep sides
            self.z = np.where(self.z > -4.5, -1.0, -8.0) if steps == 1 else np.round(self.z / 3) * 3
        self.z = self.z.astype(np.float32).astype(np.float64)  # as an STL has it

    def top(self) -> Floats:
        """Return its upper triangles, (n, 3, 3), counter-clockwise from above."""
        x, y = np.meshgrid(self.x, self.y)
        p = np.dstack([x, y, self.z])
        a, b, c, d = p[:-1, :-1], p[:-1, 1:], p[1:, 1:], p[1:, :-1]
        return np.concatenate([np.stack(t, axis=2).reshape(-1, 3, 3) for t in ((a, b, c), (a, c, d))])

    def triangles(self) -> Floats:
        """Return all triangles, wound outwards."""
        top = self.top()
        low = top[:, ::-1].copy()
        low[:, :, 2] = UNDER
        sides = []
        x, y = np.meshgrid(self.x, self.y)
        p = np.dstack([x, y, self.z])
        rims = [p[0], p[:, -1], p[-1, ::-1], p[::-1, 0]]
        for rim in rims:
            for a, b in pairwise(rim):
                fa, fb = np.array([*a[:2], UNDER]), np.array([*b[:2], UNDER])
                sides += [[fa, fb, b], [fa, b, a]]
        return np.concatenate([top, low, np.array(sides)])

    def height(self, x: Floats, y: Floats) -> Floats:
        """Return how high its top is over points within it, mm."""
        column = np.clip(np.searchsorted(self.x, x, "right") - 1, 0, len(self.x) - 2)
        row = np.clip(np.searchsorted(self.y, y, "right") - 1, 0, len(self.y) - 2)
        u = (x - self.x[column]) / (self.x[column + 1] - self.x[column])
        v = (y - self.y[row]) / (self.y[row + 1] - self.y[row])
        a, b = self.z[row, column], self.z[row, column + 1]
        c, d = self.z[row + 1, column + 1], self.z[row + 1, column]
        return np.where(u >= v, a + u * (b - a) + v * (c - b), a + v * (d - a) + u * (c - d))


def written(triangles: Floats, kind: str) -> bytes:
    """Return a file of a mesh: stl, ascii.stl, obj, ply or 3mf."""
    mesh = trimesh.Trimesh(**trimesh.triangles.to_kwargs(triangles), process=False)
    if kind == "ascii.stl":
        return str(trimesh.exchange.stl.export_stl_ascii(mesh)).encode()
    if kind == "stl":
        return bytes(trimesh.exchange.stl.export_stl(mesh))
    if kind == "obj":
        corners = triangles.reshape(-1, 3)
        lines = ["# made elsewhere", "o part", *(f"v {x:.9g} {y:.9g} {z:.9g}" for x, y, z in corners)]
        lines += [f"f {k + 1}//1 {k + 2}//1 {k + 3}//1" for k in range(0, len(corners), 3)]
        return "\n".join([*lines[:2], "vn 0 0 1", *lines[2:], ""]).encode()
    if kind == "3mf":
        return _three_mf(triangles)
    stream = io.BytesIO()
    mesh.export(stream, file_type=kind)
    return stream.getvalue()


def _three_mf(triangles: Floats) -> bytes:
    corners = "".join(f'<vertex x="{x:.9g}" y="{y:.9g}" z="{z:.9g}"/>' for x, y, z in triangles.reshape(-1, 3))
    faces = "".join(f'<triangle v1="{k}" v2="{k + 1}" v3="{k + 2}"/>' for k in range(0, 3 * len(triangles), 3))
    model = (
        '<?xml version="1.0"?><model unit="millimeter" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02">'
        f'<resources><object id="1" type="model"><mesh><vertices>{corners}</vertices><triangles>{faces}</triangles>'
        '</mesh></object></resources><build><item objectid="1"/></build></model>'
    )
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as packed:
        packed.writestr("3D/3dmodel.model", model)
        packed.writestr(
            "_rels/.rels",
            '<?xml version="1.0"?><Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">'
            '<Relationship Target="/3D/3dmodel.model" Id="r" '
            'Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>',
        )
    return stream.getvalue()
