"""Heights of a cut on more cells than memory holds: tile by tile, in any process, each bit for bit as in the whole.

Cells are where they are in the whole without rounding: the pitch has few binary digits, and the grid's corner is a
multiple of it. So a tile is a grid of its own, and the motions that do not come near it are left out.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from ...core.errors import HitofudeError
from ...core.memory import within
from ...core.progress import NO_PROGRESS, Progress
from ...simulation.cutter import cutter_of
from ...simulation.field.workpiece import Grid, Heights, ensure_memory
from ...simulation.sweeps.course import TrimOptions
from ...simulation.sweeps.trim import trim
from ...verify.course import course_of
from ..cutting.cut import TRIM_BYTES_A_CELL
from ..cutting.setup import CutSetup
from .task import BatchResult, BatchRow, BatchVerdict

SIDE = 2048
"""Cells along a tile: 75 MB while it is cut. A multiple of the 256 that the kernels cut at a time, so that these are
the same in a tile and in the whole.
"""

_DIGITS = 20
"""Of the pitch: with 15 for the number of a cell and one for its middle, every place fits into a float's 53."""


@dataclass(frozen=True)
class CutTile:
    """Some cells of a large grid.

    Attributes:
        first_row, first_col: of its first cell, in the whole. grid: of its cells.
    """

    first_row: int
    first_col: int
    grid: Grid


@dataclass(frozen=True, eq=False)
class CutTileTask:
    """A tile to be cut.

    Attributes:
        name: of it, for people. setup: what is cut out of what. memory: bytes that it may take; None = as a job alone.
    """

    name: str
    setup: CutSetup
    tile: CutTile
    memory: int | None = None


def tiled_grid(box: tuple[float, float, float, float], cells: int) -> Grid:
    """Return a grid over a rectangle whose cells lie without rounding wherever they are counted from.

    Args:
        box: x0, y0, x1, y1, mm. cells: along its longer side; one more or less where its edges lie between two.

    Raises:
        ParameterError: the rectangle is empty, or there are too many cells.
    """
    mantissa, exponent = math.frexp(Grid.over(box, cells).pitch)
    pitch = math.ldexp(math.ceil(math.ldexp(mantissa, _DIGITS)), exponent - _DIGITS)
    col, row = math.floor(box[0] / pitch), math.floor(box[1] / pitch)
    return Grid(col * pitch, row * pitch, pitch, math.ceil(box[3] / pitch) - row, math.ceil(box[2] / pitch) - col)


def tiles_of(grid: Grid, side: int = SIDE) -> Iterator[CutTile]:
    """Yield the tiles of a grid, row by row.

    Args:
        side: cells along each, a multiple of 256.
    """
    for row in range(0, grid.rows, side):
        for col in range(0, grid.cols, side):
            rows, cols = min(side, grid.rows - row), min(side, grid.cols - col)
            yield CutTile(
                row, col, Grid(grid.x0 + col * grid.pitch, grid.y0 + row * grid.pitch, grid.pitch, rows, cols)
            )


def heights_on(setup: CutSetup, grid: Grid, progress: Progress = NO_PROGRESS) -> Heights:
    """Return what all programs leave on a grid, by the engine of record; nothing is traced nor judged.

    Raises:
        HitofudeError: a tool makes no shape, or there are more cells than memory holds. Cancelled: by progress.
    """
    ensure_memory(grid, TRIM_BYTES_A_CELL)
    cutters = {number: cutter_of(tool) for number, tool in setup.tools.items()}
    workpiece, count = setup.stock.over(grid), len(setup.programs)
    for k, program in enumerate(setup.programs):
        far = progress.part(k / count, (k + 1) / count)
        workpiece = trim(workpiece, course_of(program).course, cutters, TrimOptions(trace=False), far).workpiece
    return workpiece.heights


def cut_tile(task: CutTileTask, progress: Progress = NO_PROGRESS) -> BatchResult:
    """Return the heights of a tile, as the only file of a part of a batch: float32, row by row.

    Raises:
        Cancelled: by progress.
    """
    try:
        with within(task.memory):
            heights = heights_on(task.setup, task.tile.grid, progress)
    except HitofudeError as error:
        return BatchResult(BatchRow(task.name, BatchVerdict.REFUSED, findings=(str(error),), counting=1), {})
    return BatchResult(BatchRow(task.name, BatchVerdict.CLEAN), {task.name: heights.tobytes()})
