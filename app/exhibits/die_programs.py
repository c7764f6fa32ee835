"""Finishing programs to measure by: zigzags over a curved die, 100 mm square, by ball cutters, moves as published."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache

import numpy as np

from ..fitting.fitted import lines_between
from ..model.motion import Floats
from ..model.stock_box import StockBox
from ..simulation.cutter import Cutter
from ..simulation.field.workpiece import BoxStock, Grid, Workpiece
from ..simulation.sweeps.course import Course

SIZE = 100.0
"""Side of the die, mm."""

STOCK = BoxStock(StockBox(0.0, 0.0, -25.0, SIZE, SIZE))
_HILLS = ((35, 40, 14, 11), (70, 65, 10, 9), (65, 28, 9, -5), (28, 75, 11, -5))
"""Place, width and height of round hills and hollows, mm."""


@dataclass(frozen=True, slots=True)
class DieProgram:
    """A zigzag of moves along X over the die, in lines, by a ball of a radius, mm."""

    moves: int
    radius: float
    lines: int

    @property
    def cutters(self) -> dict[int, Cutter]:
        """The ball, T1."""
        return {1: Cutter(self.radius, 0.0, self.radius)}

    def course(self) -> Course:
        """Return what is cut along; it is kept."""
        return _course(self)


PROGRAMS = {"A": DieProgram(9542, 5.0, 201), "B": DieProgram(35391, 3.0, 286), "C": DieProgram(300_000, 1.0, 667)}
"""A and B have the moves and the radii of the published figures; C is a modern one."""


def block(cells: int) -> Workpiece:
    """Return the block that the die is cut out of, with so many cells along each side."""
    return STOCK.over(Grid.over((0.0, 0.0, SIZE, SIZE), cells))


def die(x: Floats, y: Floats) -> Floats:
    """Return the height of the die, mm, in about [-20, 0]."""
    rounds = sum(
        height * np.exp(-((x - cx) ** 2 + (y - cy) ** 2) / (2 * width * width)) for cx, cy, width, height in _HILLS
    )
    return np.asarray(-14 + rounds + 1.2 * np.sin(x / 9.0) * np.cos(y / 11.0))


def centre_surface(radius: float, count: int = 480) -> tuple[Floats, Floats]:
    """Return places along a side, (count,), and the heights (count, count) of the ball's centre where it touches the
    die from above, mm.
    """
    grid = np.linspace(-radius - 1, SIZE + radius + 1, count)
    x, y = np.meshgrid(grid, grid)
    z = die(np.clip(x, 0, SIZE), np.clip(y, 0, SIZE))
    step = grid[1] - grid[0]
    k = int(radius / step)
    padded, out = np.pad(z, k, mode="edge"), np.full_like(z, -1e9)
    for j in range(-k, k + 1):
        for i in range(-k, k + 1):
            square = (i * i + j * j) * step * step
            if square <= radius * radius:
                np.maximum(
                    out,
                    padded[k + j : k + j + count, k + i : k + i + count] + math.sqrt(radius * radius - square),
                    out=out,
                )
    return grid, out


def finishing(program: DieProgram) -> Floats:
    """Return (moves + 1, 3) places of the tip, mm; they are denser where the path bends."""
    from scipy.ndimage import gaussian_filter1d, map_coordinates

    grid, centres = centre_surface(program.radius)
    step, lines = grid[1] - grid[0], program.lines
    xs = np.linspace(0, SIZE, 4001)
    rows = []
    for i, y in enumerate(np.linspace(0, SIZE, lines)):
        count = (program.moves + 1) // lines + (1 if i < (program.moves + 1) % lines else 0)
        z = map_coordinates(centres, [np.full_like(xs, (y - grid[0]) / step), (xs - grid[0]) / step], order=1)
        z = gaussian_filter1d(z, 25, mode="nearest")
        density = np.sqrt(np.abs(np.gradient(np.gradient(z, xs), xs)) + 0.005)
        along = np.concatenate([[0], np.cumsum((density[1:] + density[:-1]) / 2)])
        x = np.interp(np.linspace(0, 1, count), along / along[-1], xs)
        x = x[::-1] if i & 1 else x
        rows.append(np.stack([x, np.full_like(x, y), np.interp(x, xs, z) - program.radius], 1))
    return np.concatenate(rows)


@cache
def _course(program: DieProgram) -> Course:
    motions = lines_between(finishing(program))
    return Course(motions, np.ones(len(motions), np.int32))
