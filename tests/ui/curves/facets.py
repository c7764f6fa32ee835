"""A program as a polyhedron gives it: only the ends of its facets lie on the true shape."""

import math

import numpy as np

HEAD = "G21 G90 G17 G94\nT1 M6\nS1000 M3\nG0 X20 Y0 Z5\nG1 Z-1 F100\n"


def facets(count: int = 60, each: int = 12, radius: float = 20.0) -> str:
    """A circle as a polyhedron gives it: so many chords, and points along each."""
    angles = np.linspace(0, 2 * math.pi, count + 1)
    ends = radius * np.column_stack([np.cos(angles), np.sin(angles)])
    share = np.arange(each) / each
    points = np.concatenate(
        [(ends[:-1, None] + share[None, :, None] * np.diff(ends, axis=0)[:, None]).reshape(-1, 2), ends[-1:]]
    )
    lines = "".join(f"X{x:.4f} Y{y:.4f}\n" for x, y in points[1:])
    return f"{HEAD}G1 F300 {lines}G0 Z5\nM2\n"
