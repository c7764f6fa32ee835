"""How deep bodies that do not cut go into metal that stays as it is, at any cell of the grid."""

from __future__ import annotations

import math
from collections.abc import Sequence
from concurrent.futures import wait
from dataclasses import dataclass, replace
from enum import Enum
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ...core.errors import ParameterError
from ...core.pool import pool
from ...model.motion import Floats
from ...model.tool import Tool
from ..cutter import Cutter
from ..field.workpiece import Workpiece

PARTS = 8
"""In which items are looked at, side by side."""

Whole = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class BodyPaths:
    """Bodies on ways, n items.

    Attributes:
        ways: (w, 6) start and end of each way, x, y, z, mm.
        shapes: (m, 4) rows of bodies (`shape_rows`).
        way, shape: (n,) of each item. low: (n,) what is added to its body's lift, mm.
    """

    ways: Floats
    shapes: Floats
    way: Whole
    shape: Whole
    low: Floats

    def of(self, items: NDArray[np.intp]) -> BodyPaths:
        """Return some items."""
        return BodyPaths(self.ways, self.shapes, self.way[items], self.shape[items], self.low[items])

    def __len__(self) -> int:
        return len(self.way)


@dataclass(frozen=True, eq=False)
class HeightPyramid:
    """The heights of a work piece, and above them the highest of every four, up to one.

    Attributes:
        heights: of all levels, one after the other. levels: (n, 3) where each begins, its rows and columns.
    """

    metal: Workpiece
    heights: NDArray[np.float32]
    levels: Whole

    @staticmethod
    def of(workpiece: Workpiece) -> HeightPyramid:
        """Return the pyramid over a work piece; where there is no metal is far below."""
        ground = np.where(workpiece.heights > workpiece.floor, workpiece.heights, np.float32(-math.inf))
        stack = [ground]
        while len(stack) == 1 or stack[-1].size > 1:
            rows, cols = stack[-1].shape
            even = np.full((rows + rows % 2, cols + cols % 2), -math.inf, np.float32)
            even[:rows, :cols] = stack[-1]
            tall = np.maximum(even[::2], even[1::2])
            stack.append(np.maximum(tall[:, ::2], tall[:, 1::2]))
        begin = np.cumsum([0, *(level.size for level in stack[:-1])])
        levels = np.column_stack([begin, np.array([level.shape for level in stack])]).astype(np.int64)
        return HeightPyramid(workpiece, np.concatenate([level.ravel() for level in stack]), levels)

    def deeper(self, paths: BodyPaths, least: Floats) -> tuple[Floats, Whole]:
        """Return how deep each item goes where it is deeper than its `least` (n,), and in which cell; else `least` and
        -1.
        """
        return self._asked(paths, least, False)

    def deepest(self, paths: BodyPaths, least: Floats) -> tuple[Floats, Whole]:
        """Return what `deeper` does where an item is deeper than all before it of the same shape, and than `least`
        (m,), by shape.

        `least` is raised to what is found. Items are looked at in the order of the list.
        """
        return self._asked(paths, least, True)

    def _asked(self, paths: BodyPaths, least: Floats, shared: bool) -> tuple[Floats, Whole]:
        from .body_kernels import ask

        grid, count = self.metal.grid, len(paths)
        depth, cell = np.zeros(count), np.full(count, -1, np.int64)
        where = (float(grid.x0), float(grid.y0), float(grid.pitch))
        tables = (self.heights, self.levels, where, paths.ways, paths.shapes, paths.way, paths.shape, paths.low)
        if shared:
            ask(*tables, least, True, depth, cell, 0, count)
            return depth, cell
        steps = np.linspace(0, count, PARTS + 1).astype(int).tolist()
        threads = [
            pool().submit(ask, *tables, least, False, depth, cell, first, last)
            for first, last in pairwise(steps)
            if last > first
        ]
        wait(threads)
        for thread in threads:
            thread.result()
        return depth, cell


def shape_rows(bodies: Sequence[Cutter], touch: float) -> Floats:
    """Return the rows of bodies, each slimmer all round by `touch`, mm, as long as that leaves half of its radius.

    Raises:
        ParameterError: one is rounded; bodies are discs and frustums.
    """
    rows = np.zeros((len(bodies), 4))
    for k, body in enumerate(bodies):
        if body.fillet:
            raise ParameterError(
                f"A body with a corner of {body.fillet:g} mm is none; bodies that do not cut are discs and frustums."
            )
        slim = body.shrunk(min(touch, body.radius / 2)) or body
        rows[k] = slim.radius, slim.flat, 0.0 if math.isinf(slim.slope) else slim.slope, slim.lift
    return rows


# What of a tool does not cut, as convex bodies: its shank, and the holder that it stands in.
#
# The shank begins where the flutes end and has its own diameter; of the neck between them nobody tells, so it is taken
# to be as wide as the shank. Metal that stands higher than the flutes in the shank's way is not cut but rubbed,
# whatever the shank's diameter is; a shank as wide as the cutter fits into a wall that the cutter has cut. The holder
# stands on the tip at its stick-out. Both are taken to go on upwards for ever: over a field of heights, what is above
# metal that they meet is met as well.


class HolderPart(Enum):
    """What of a tool does not cut; the value is the word for it."""

    SHANK = "shank"
    HOLDER = "holder"


@dataclass(frozen=True, slots=True)
class Body:
    """A convex body that does not cut; `shape.lift` is its height over the tool's tip, mm."""

    part: HolderPart
    shape: Cutter

    def lifted(self, by: float) -> Body:
        """Return the body, mm higher over the tip."""
        return replace(self, shape=replace(self.shape, lift=self.shape.lift + by))


def bodies_of(tool: Tool) -> tuple[Body, ...]:
    """Return what of a tool does not cut, the shank first.

    A shank is known where the length of the flutes is, as wide as the cutter where nobody tells its diameter; a holder
    where its outline and the stick-out are. Of a tool that cuts threads the flutes' length is that of its teeth, above
    which it is narrower.
    """
    return (*_shank(tool), *(each.lifted(tool.stick_out) for each in holder_of(tool)))


def holder_of(tool: Tool) -> tuple[Body, ...]:
    """Return the holder of a tool as if it stood on the tip: frustums that widen, and a disc under each that does not.

    Empty where the outline or the stick-out is not known. What stands over something as wide is left out.
    """
    if not (tool.holder and tool.stick_out):
        return ()
    made: list[Cutter] = []
    widest = 0.0
    for (height, radius), (above, wider) in pairwise(tool.holder):
        widens = wider > max(widest, radius)
        if radius > widest and not (widens and above > height):
            made.append(Cutter(radius, radius, lift=height))
            widest = radius
        if widens:
            made.append(
                Cutter(wider, radius, slope=(above - height) / (wider - radius), lift=height)
                if above > height
                else Cutter(wider, wider, lift=height)
            )
            widest = wider
    return tuple(Body(HolderPart.HOLDER, shape) for shape in made)


def _shank(tool: Tool) -> tuple[Body, ...]:
    if not tool.flute_length or (tool.kind.threads and not tool.shank_diameter):
        return ()
    radius = (tool.shank_diameter or tool.diameter) / 2
    return (Body(HolderPart.SHANK, Cutter(radius, radius, lift=tool.flute_length)),)
