"""Heights by graphics hardware: a quad for each piece of a path, the exact height in each of its cells, the lowest one
stays.

The depth buffer of the published method holds the nearest of many small facets. Here nothing is made of facets: a quad
covers the cells that a piece may lower, the same ones that the engine of record evaluates, and each of its fragments is
a cell whose height is computed in closed form, float32, as the engine of record does. The picture has one float a cell,
and blending keeps the least.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ...core.progress import NO_PROGRESS, Progress
from ...model.motion import Floats
from ..cutter import Cutter
from ..field.workpiece import Grid, Heights, Workpiece, ensure_memory
from ..sweeps.course import Course, Rapids, TrimOptions
from ..sweeps.pieces import QUARTER, SweepPieces
from ..sweeps.sweeps import Sweeps
from .graphics import compiled

if TYPE_CHECKING:
    import moderngl

LARGEST = 8192
"""Cells along a side of a picture, at most; graphics systems may know less."""

PORTION = 65_536
"""Pieces that are made at a time."""

WORK = 2e8
"""Cells that are painted before the graphics system is waited for, so that a job can be stopped."""

ARC = "ARC"
_STRAIGHT, _ROUND = ("4f 4f 4f/i", "anchor", "way", "reach"), ("4f 4f 4f 4f/i", "anchor", "circle", "ends", "box")
_KINDS = ("BALL", "FLAT_END", "CONE", "TAPER", "BULL")
"""By the kinds of `sweep_kernels`."""

Quads = NDArray[np.float32]
"""Rows for the shaders, as `quad_kernels` writes them."""

Shape = tuple[float, ...]
"""A cutter's row for the kernels."""


def quad_heights(
    ctx: moderngl.Context,
    workpiece: Workpiece,
    course: Course,
    cutters: Mapping[int, Cutter],
    progress: Progress = NO_PROGRESS,
) -> Heights:
    """Return what a course leaves of a work piece, (rows, cols) mm: what `trim` does, but for rounding.

    Rapids, and what is left out, cut nothing. Beside a vertical wall a cell whose centre is on the wall may fall to
    either side.

    Args:
        ctx: the graphics context, current on this thread.
        workpiece: it is left as it is.
        course: motions and their tools.
        cutters: by T number.
        progress: told as pieces are painted.

    Raises:
        ParameterError: a tool that cuts is not among the cutters, or the heights would not fit into memory.
        Cancelled: the job was asked to stop.
        moderngl.Error: the graphics system fails.
    """
    ensure_memory(workpiece.grid, 8)
    way, heights = _PreparedCourse(workpiece, course, cutters), np.empty_like(workpiece.heights)
    parts = list(_parts(workpiece.grid, min(LARGEST, int(ctx.info["GL_MAX_TEXTURE_SIZE"]))))
    brushes: dict[str, moderngl.Program] = {}
    try:
        for k, (rows, cols, grid) in enumerate(parts):
            picture = _HeightPicture(ctx, grid, workpiece.heights[rows, cols], brushes)
            with picture.least_stays():
                picture.paint(way, progress.part(k / len(parts), (k + 1) / len(parts)))
                heights[rows, cols] = picture.heights()
    finally:
        for brush in brushes.values():
            brush.release()
    progress.step(1.0, "Cut")
    return np.maximum(heights, np.float32(workpiece.floor), out=heights)


class _PreparedCourse:
    """A course made ready: what each motion does, and with which cutter; its pieces."""

    def __init__(self, workpiece: Workpiece, course: Course, cutters: Mapping[int, Cutter]) -> None:
        self._sweeps = Sweeps(workpiece.grid, course, cutters, TrimOptions(Rapids.IGNORED, touch=0.0))

    def portions(self) -> Iterator[tuple[SweepPieces, float]]:
        """Yield the pieces of motions that follow one another, and which part of all pieces is done with them."""
        ends, first = np.cumsum(self._sweeps.splitter.counts), 0
        while first < len(ends):
            done = int(ends[first - 1]) if first else 0
            last = max(first + 1, int(np.searchsorted(ends, done + PORTION, "right")))
            yield self._sweeps.splitter.pieces(first, last), float(ends[last - 1] / ends[-1])
            first = last

    def quads(self, pieces: SweepPieces, grid: Grid, top: float) -> Iterator[tuple[str, Shape, Quads, float]]:
        """Yield the quads of pieces, cutter by cutter.

        Args:
            top: no metal is higher, mm.

        Yields:
            The part of the shaders that paints them, the cutter's row, the quads, and about how many cells they cover.
        """
        from ..sweeps.tile_kernels import survey
        from .quad_kernels import ROUND, STRAIGHT, STRETCH, round_quads, straight_quads

        for array in (pieces.start, pieces.end):
            array.setflags(write=False)
        cutter, corner = self._sweeps.cutter[pieces.motion], (float(grid.x0), float(grid.y0), float(grid.pitch))
        tables = (
            pieces.start,
            pieces.end,
            self._sweeps.does[pieces.motion],
            cutter,
            pieces.arc,
            self._sweeps.shapes,
            pieces.arcs,
        )
        spans, met = np.empty((len(pieces), 2)), np.empty((len(pieces), 5), np.int16)
        survey(*tables, corner, (grid.rows, grid.cols), 0, len(pieces), True, top, spans, met)
        comes, frame = met[:, 1] >= met[:, 0], (*corner, float(grid.cols), float(grid.rows))
        for k in np.unique(cutter[comes]).tolist():
            shape, mine = tuple(self._sweeps.shapes[k].tolist()), comes & (cutter == k)
            straight, round_ = np.flatnonzero(mine & (pieces.arc < 0)), np.flatnonzero(mine & (pieces.arc >= 0))
            if len(straight):
                length = np.maximum(spans[straight, 1] - spans[straight, 0], 2 * shape[0])
                quads = np.empty((_most(length / STRETCH), STRAIGHT), np.float32)
                count, cells = straight_quads(pieces.start, pieces.end, spans, straight, shape, frame, quads)
                yield _KINDS[int(shape[6])], shape, quads[:count], cells
            if len(round_):
                size = pieces.arcs[pieces.arc[round_], 2]
                quads = np.empty(
                    (_most(QUARTER * np.maximum(size / STRETCH, 0.5 * np.sqrt(size / shape[0]))), ROUND), np.float32
                )
                count, cells = round_quads(
                    pieces.start, pieces.end, pieces.arc, pieces.arcs, round_, shape, frame, quads
                )
                yield ARC, shape, quads[:count], cells


def _most(parts: Floats) -> int:
    """Return how many quads there are at most of pieces that fall into so many parts each."""
    return int(np.sum(np.ceil(parts + 1e-6))) + len(parts)


class _HeightPicture:
    """The heights of a grid as a picture of one float a cell, in which the least of what is painted stays."""

    def __init__(
        self, ctx: moderngl.Context, grid: Grid, before: Heights, brushes: dict[str, moderngl.Program]
    ) -> None:
        """Begin with heights; brushes are programs by the part that they paint, kept from picture to picture."""
        self._ctx, self._grid, self._brushes, self._top, self._waiting = ctx, grid, brushes, float(before.max()), 0.0
        self._texture = ctx.texture((grid.cols, grid.rows), 1, np.ascontiguousarray(before), dtype="f4")
        self._target = ctx.framebuffer([self._texture])

    @contextmanager
    def least_stays(self) -> Iterator[None]:
        """Let the picture be painted on, the least staying, and leave the context as it was."""
        try:
            with self._ctx.scope(self._target, enable_only=self._ctx.BLEND):
                self._ctx.blend_equation = self._ctx.MIN, self._ctx.MIN
                yield
        finally:
            self._ctx.blend_equation = self._ctx.FUNC_ADD, self._ctx.FUNC_ADD
            self._target.release()
            self._texture.release()

    def heights(self) -> Heights:
        """Return (rows, cols) what is painted, mm."""
        return np.frombuffer(self._texture.read(), np.float32).reshape(self._grid.rows, self._grid.cols)

    def paint(self, way: _PreparedCourse, progress: Progress) -> None:
        """Lower the heights under all pieces."""
        for pieces, done in way.portions():
            for part, shape, quads, cells in way.quads(pieces, self._grid, self._top):
                if not len(quads):
                    continue
                self._paint(self._brush(part, shape), _ROUND if part == ARC else _STRAIGHT, quads)
                self._waiting += cells
                if self._waiting > WORK:
                    self._ctx.finish()
                    self._waiting = 0.0
            progress.step(done, "Cutting")

    def _paint(self, brush: moderngl.Program, layout: tuple[str, ...], quads: Quads) -> None:
        buffer = self._ctx.buffer(quads)
        array = self._ctx.vertex_array(brush, [(buffer, *layout)])
        array.render(self._ctx.TRIANGLE_STRIP, vertices=4, instances=len(quads))
        array.release()
        buffer.release()

    def _brush(self, part: str, shape: Shape) -> moderngl.Program:
        """Return the program that paints with a cutter."""
        brush = self._brushes.get(part)
        if brush is None:
            brush = self._brushes[part] = compiled(self._ctx, "sweep_quad.vert", "sweep_quad.frag", part)
        radius, flat, fillet, span, slope, _, _ = shape
        grid = self._grid
        numbers = {
            "size": (grid.cols, grid.rows),
            "pitch": grid.pitch,
            "tool": (radius, flat, fillet, slope),
            "span": span,
        }
        for name, value in numbers.items():
            if name in brush:  # a program has only what it uses
                brush[name] = value
        return brush


def _parts(grid: Grid, largest: int) -> Iterator[tuple[slice, slice, Grid]]:
    """Yield the rows, the columns and the grid of each picture that a grid falls into."""
    for row in range(0, grid.rows, largest):
        for col in range(0, grid.cols, largest):
            rows, cols = slice(row, min(row + largest, grid.rows)), slice(col, min(col + largest, grid.cols))
            corner = grid.x0 + col * grid.pitch, grid.y0 + row * grid.pitch
            yield rows, cols, Grid(*corner, grid.pitch, rows.stop - row, cols.stop - col)
