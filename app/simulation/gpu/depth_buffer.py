"""Cuts a work piece as it was published in 1999: the sweep in facets, drawn into the depth buffer of the graphics
hardware.

The grid is the frame buffer, a pixel a cell, and the view runs up along the tool's axis: of all that is drawn over a
cell's centre the depth test keeps the lowest. What is read back trims the dexels.

How far heights are from exact: facets leave metal (`facet_error`, square to the surface, and at steep moves as much
again for the overlaps), chords of arcs and splines are off by a quarter of that to either side. Hardware rounds corners
to a part of a pixel, 1/256 as a rule, which is worth as much times the slope; a facet that stands all but on edge then
gives any of its own heights. Depths have 24 bits over the heights that matter, 2e-6 mm of 30 mm.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.progress import NO_PROGRESS, Progress
from ..cutter import Cutter
from ..field.workpiece import Grid, Heights, Workpiece, ensure_memory
from ..sweeps.chains import CutterChains, chains_of
from ..sweeps.course import Course
from .graphics import compiled
from .polyhedron import least_facet
from .wedges import ROOM, Tessellation, chord_of, facets_in

if TYPE_CHECKING:
    import moderngl

FACET_PITCHES = 2.0
"""Size of facets, in pitches of the grid: the published figure."""

OVERLAP_PITCHES = 1.0 / 16.0
"""How far cylinders of level moves reach over their ends: more than hardware rounds by, and worth a 256th of the error
of such facets.
"""

MOST_CELLS = 4096
"""Along a side of what is drawn at a time."""

_DEPTH_CLAMP = 0x864F
"""What lies outside the range of depths is drawn at its end and not left out."""


def usual(grid: Grid) -> Tessellation:
    """Return the facets with which a grid is cut if nobody says otherwise: of the published size d from corner to
    corner.

    A facet of a sphere bends both ways; with sides of d it would lie up to d² / 4r inside, so it lies within d² / 8r.
    """
    return Tessellation(FACET_PITCHES / math.sqrt(2.0) * grid.pitch, overlap=OVERLAP_PITCHES * grid.pitch)


def tessellation(grid: Grid, cutters: Iterable[Cutter], facet: float | None = None) -> Tessellation:
    """Return the facets with which a grid is cut by some cutters: the usual ones, or those that are asked for.

    A deep zoom asks for facets that are smaller than a cutter can be divided in; there they are as small as can be,
    larger than the cells, and lie inside the cutter by less than rounding.

    Args:
        facet: size of the facets, mm; None: as usual for the grid.
    """
    how = usual(grid)
    if facet is not None:
        return replace(how, facet=facet)
    return replace(how, facet=max([how.facet, *(least_facet(cutter.radius) for cutter in cutters)]))


def published(grid: Grid) -> Tessellation:
    """Return the facets with which the published figures were measured: their sides are as long as d."""
    return Tessellation(FACET_PITCHES * grid.pitch, overlap=OVERLAP_PITCHES * grid.pitch)


class DepthBuffer:
    """The engine, on a graphics context that stays its caller's; it must be current wherever something is called."""

    def __init__(self, ctx: moderngl.Context, how: Tessellation | None = None) -> None:
        """Prepare to draw.

        Args:
            ctx: the graphics context.
            how: in which facets; None: the usual ones for each grid.

        Raises:
            moderngl.Error: the graphics system does not take it.
        """
        self._ctx, self._how = ctx, how
        self._program = compiled(ctx, "sweep.vert", "sweep.frag", "SWEEP")
        self._places = ctx.buffer(reserve=ROOM * 48, dynamic=True)
        self._facets = ctx.vertex_array(
            self._program, [(self._places, "3f 3f 3f 3f/i", "a", "b", "c", "d")], mode=ctx.TRIANGLE_STRIP
        )

    def release(self) -> None:
        """Give everything back to the graphics system."""
        for part in (self._facets, self._places, self._program):
            part.release()

    def heights(
        self, workpiece: Workpiece, course: Course, cutters: Mapping[int, Cutter], progress: Progress = NO_PROGRESS
    ) -> Heights:
        """Return what a course leaves of a work piece; rapids do not cut.

        Args:
            workpiece: it is left as it is.
            course: motions and their tools.
            cutters: by T number.
            progress: told as facets are drawn.

        Returns:
            (rows, cols) mm, nowhere above the work piece, nor below its floor.

        Raises:
            ParameterError: a tool that cuts is not among the cutters, the facets are too small for one, or there is too
                little memory.
            Cancelled: the job was asked to stop.
        """
        grid = workpiece.grid
        ensure_memory(grid, 8)
        how = self._how or tessellation(grid, cutters.values())
        sweeps = chains_of(course, cutters, chord_of(course, cutters, how.facet))
        left = workpiece.heights.copy()
        tiles = list(
            _tiles(
                grid, min(MOST_CELLS, *self._ctx.info["GL_MAX_VIEWPORT_DIMS"], self._ctx.info["GL_MAX_TEXTURE_SIZE"])
            )
        )
        for k, (here, part) in enumerate(tiles):
            piece = Workpiece(part, left[here].copy(), workpiece.floor)
            left[here] = self._trimmed(piece, sweeps, how, progress.part(k / len(tiles), (k + 1) / len(tiles)))
        progress.step(1.0, "Cut")
        return left

    def _trimmed(self, piece: Workpiece, sweeps: list[CutterChains], how: Tessellation, progress: Progress) -> Heights:
        """Return what is left of a work piece that can be drawn at once."""
        grid, high = piece.grid, float(piece.heights.max())
        low = max(piece.floor, min((chains.lowest for _, chains in sweeps), default=high))
        if high <= low:
            return piece.heights
        self._program["scale"] = 2 / (grid.cols * grid.pitch), 2 / (grid.rows * grid.pitch), 2 / (high - low)
        texture = self._ctx.depth_texture((grid.cols, grid.rows))
        frame = self._ctx.framebuffer(depth_attachment=texture)
        try:
            frame.clear(depth=1.0)
            for quads, share in _facets(grid, low, sweeps, how):
                self._draw(frame, quads)
                progress.step(share, "Drawing the sweep")
            depths = np.frombuffer(texture.read(), np.float32).reshape(grid.rows, grid.cols)
        finally:
            frame.release()
            texture.release()
        reached = np.maximum(low + depths * (high - low), piece.floor).astype(np.float32)
        return np.where(depths < 1.0, np.minimum(reached, piece.heights), piece.heights)

    def _draw(self, frame: moderngl.Framebuffer, quads: NDArray[np.float32]) -> None:
        """Draw facets (n, 4, 3); of all that was drawn over a pixel's middle the lowest is kept."""
        ctx = self._ctx
        self._places.orphan()
        self._places.write(quads)
        with ctx.scope(frame, ctx.DEPTH_TEST):
            ctx.depth_func = "<"
            ctx.enable_direct(_DEPTH_CLAMP)
            self._facets.render(vertices=4, instances=len(quads))
            ctx.disable_direct(_DEPTH_CLAMP)


class _DrawnFacets(NamedTuple):
    """Facets (n, 4, 3), mm, and the share of the moves that is done."""

    quads: NDArray[np.float32]
    share: float


def _facets(grid: Grid, low: float, sweeps: list[CutterChains], how: Tessellation) -> Iterator[_DrawnFacets]:
    """Yield facets over a grid, from its lower left corner and a height."""
    box = (0.0, 0.0, grid.cols * grid.pitch, grid.rows * grid.pitch)
    done, total = 0, max(sum(len(chains) for _, chains in sweeps), 1)
    for cutter, chains in sweeps:
        for part, share in facets_in(cutter, chains.moved((-grid.x0, -grid.y0, -low)), how, box):
            yield _DrawnFacets(part.quads, (done + share * len(chains)) / total)
        done += len(chains)


class _GridTile(NamedTuple):
    """A part of a grid: where in it, rows and columns, and the part."""

    where: tuple[slice, slice]
    part: Grid


def _tiles(grid: Grid, most: int) -> Iterator[_GridTile]:
    """Yield the parts of a grid of at most so many cells along a side."""
    for row in range(0, grid.rows, most):
        for col in range(0, grid.cols, most):
            rows, cols = min(most, grid.rows - row), min(most, grid.cols - col)
            corner = grid.x0 + col * grid.pitch, grid.y0 + row * grid.pitch
            yield _GridTile((slice(row, row + rows), slice(col, col + cols)), Grid(*corner, grid.pitch, rows, cols))
