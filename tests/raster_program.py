"""Passes of a ball over a polyhedron whose corners lie on a known shape: programs as CAM systems write them."""

from __future__ import annotations

import numpy as np

from app.model.motion import Floats

WIDE, DEEP, SIDE, PITCH, RADIUS = 24.0, 16.0, 2.0, 0.5, 3.0
"""Of the patch, of its squares (each two triangles), from pass to pass, of the ball; mm."""
DROP = 4.0


def tips(x: Floats, y: Floats) -> Floats:
    """Height of the ball's tip over the true shape, mm: its corners lie on that."""
    return np.asarray(4.0 * np.cos(x / 12.0) * np.cos(y / 10.0) - DROP)


def square_off(points: Floats) -> Floats:
    """How far places of the tip (n, 3) are from the true ones, square to them, mm."""
    x, y = points[:, 0], points[:, 1]
    along, across = -np.sin(x / 12) * np.cos(y / 10) / 3.0, -0.4 * np.cos(x / 12) * np.sin(y / 10)
    return np.asarray((points[:, 2] - tips(x, y)) / np.sqrt(1 + along**2 + across**2))


def polyhedron(x: Floats, y: Floats, side: float = SIDE) -> Floats:
    """Height over the polyhedron, mm."""
    i, j = np.floor(x / side), np.floor(y / side)
    a, b = x / side - i, y / side - j
    at = {(p, q): tips((i + p) * side, (j + q) * side) for p in (0, 1) for q in (0, 1)}
    low = at[0, 0] + a * (at[1, 0] - at[0, 0]) + b * (at[1, 1] - at[1, 0])
    high = at[0, 0] + b * (at[0, 1] - at[0, 0]) + a * (at[1, 1] - at[0, 1])
    return np.asarray(np.where(a >= b, low, high))


def rows(side: float = SIDE, pitch: float = PITCH, wide: float = WIDE, deep: float = DEEP) -> list[Floats]:
    """Passes along X: points where a pass crosses an edge, and two between; rounded to four decimals."""
    found = []
    for y in np.arange(0.0, deep + 1e-9, pitch).tolist():
        diagonals = np.arange(0, round(wide / side)) * side + y % side
        edges = np.unique(np.concatenate([np.arange(0, wide + 1e-9, side), diagonals, [wide]]).round(6))
        edges = edges[edges <= wide]
        between = [edges[:-1] + share * np.diff(edges) for share in (1 / 3, 2 / 3)]
        x = np.sort(np.concatenate([edges, *between]))
        found.append(np.column_stack([x, np.full(len(x), y), polyhedron(x, np.full(len(x), y), side)]).round(4))
    return found


def text(passes: list[Floats], head: str = "", angle: float = 0.0, tool: str = "ball,6") -> str:
    """A program of passes there and back, turned by an angle, radians."""
    c, s = np.cos(angle), np.sin(angle)
    turned = [np.column_stack([r[:, 0] * c - r[:, 1] * s, r[:, 0] * s + r[:, 1] * c, r[:, 2]]).round(4) for r in passes]
    points = np.concatenate([row if k % 2 == 0 else row[::-1] for k, row in enumerate(turned)])
    low, high = points[:, :2].min(axis=0) - 4, points[:, :2].max(axis=0) + 4
    box = f"{low[0]:.1f},{low[1]:.1f},-14,{high[0]:.1f},{high[1]:.1f},1"
    notes = ["program=1", "units=mm", f"stock_mm={box}", f"tool=1,{tool}"]
    x, y, z = points[0].tolist()
    start = ["G21 G90 G17 G94 G40 G49 G80", "T1 M6", "S8000 M3", "G0 Z10.0", f"G0 X{x:.4f} Y{y:.4f}"]
    lines = [f"X{x:.4f} Y{y:.4f} Z{z:.4f}" for x, y, z in points[1:].tolist()]
    blocks = [head, *(f"(hitofude: {note})" for note in notes), *start, f"G1 Z{z:.4f} F200", f"G1 {lines[0]} F600"]
    return "\n".join([*(each for each in blocks if each), *lines[1:], "G0 Z10.0", "M5", "M2"]) + "\n"


def sample() -> str:
    """The sample `raster.ngc`."""
    return text(rows(), "(A patch of 24 x 16 mm from a polyhedron of 192 facets: only their corners lie on the shape.)")
