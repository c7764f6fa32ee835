"""Solids in closed form for tests: a block of 40 x 30 x 10 with a pocket of 20 x 16 x 4, as triangles and as a file."""

import struct
from itertools import pairwise

import numpy as np

Point = tuple[float, float, float]

BLOCK_MM3 = 40 * 30 * 10 - 20 * 16 * 4
FLOOR = slice(26, 28)
"""Of the pocket; before it two triangles for each of its walls, from that at Y 7 on, counter-clockwise."""
WALL = slice(20, 22)
"""The pocket's wall at X 30."""


def _quad(a: Point, b: Point, c: Point, d: Point) -> list[tuple[Point, Point, Point]]:
    return [(a, b, c), (a, c, d)]


def _ring(x0: float, y0: float, x1: float, y1: float, z: float) -> list[Point]:
    return [(x0, y0, z), (x1, y0, z), (x1, y1, z), (x0, y1, z), (x0, y0, z)]


def pocketed_block() -> np.ndarray:
    """Its triangles (28, 3, 3), right side out: Z -10 to 0, the pocket at X 10 to 30, Y 7 to 23."""
    low, high, mouth, floor = (
        _ring(0, 0, 40, 30, -10),
        _ring(0, 0, 40, 30, 0),
        _ring(10, 7, 30, 23, 0),
        _ring(10, 7, 30, 23, -4),
    )
    found = _quad(*low[3::-1])
    for (a, b), (c, d) in zip(pairwise(high), pairwise(mouth), strict=True):
        found += _quad(a, b, d, c)
    for (a, b), (c, d) in zip(pairwise(low), pairwise(high), strict=True):
        found += _quad(a, b, d, c)
    for (a, b), (c, d) in zip(pairwise(mouth), pairwise(floor), strict=True):
        found += _quad(a, b, d, c)
    return np.array([*found, *_quad(*floor[:4])], float)


def stl(triangles: np.ndarray, header: bytes = b"") -> bytes:
    """Triangles as a binary STL file."""
    records = b"".join(struct.pack("<12fH", 0, 0, 0, *triangle.ravel().tolist(), 0) for triangle in triangles)
    return header.ljust(80, b"\0") + struct.pack("<I", len(triangles)) + records


def bossed_block(degrees: float = 0.0) -> np.ndarray:
    """A block of 40 x 30 round the zero, Z -20 to -10, with a boss of 20 x 14 x 10 in its middle, turned by an angle:
    (28, 3, 3).
    """
    low, high = _ring(-20, -15, 20, 15, -20), _ring(-20, -15, 20, 15, -10)
    foot, top = _ring(-10, -7, 10, 7, -10), _ring(-10, -7, 10, 7, 0)
    found = [*_quad(*low[3::-1]), *_quad(*top[:4])]
    for outer, inner in ((low, high), (high, foot), (foot, top)):
        for (a, b), (c, d) in zip(pairwise(outer), pairwise(inner), strict=True):
            found += _quad(a, b, d, c)
    cos, sin = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return np.array(found, float) @ np.array([[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]])
