"""`cut --tiles`: heights of more cells than memory holds, by the processes or the cluster that do parts of batches."""

from __future__ import annotations

import argparse
import json
import os
import tempfile
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

import numpy as np

from ..core.atomic import sweep, waiting_prefix, write_atomically
from ..core.errors import HitofudeError, InputError
from ..core.memory import budget_limit
from ..core.progress import Progress
from ..simulation.engines import Engine
from ..simulation.field.workpiece import Grid
from ..usecases.batch.cut_tiles import CutTile, CutTileTask, cut_tile, tiled_grid, tiles_of
from ..usecases.batch.lanes import Lane
from ..usecases.batch.run import BatchRun
from ..usecases.batch.task import BatchResult, BatchVerdict
from ..usecases.cutting.setup import CutSetup
from .command import OptionParser
from .lanes import add_scheduler_option, jobs_given, lanes_of

_ALONE = ("image", "report", "against", "window", "facet")
"""What tiles do not do: they are cut, and nothing is judged."""


def add_tile_options(parser: OptionParser) -> None:
    """Add the options of a cut by tiles."""
    group = parser.add_argument_group("more cells than memory holds")
    group.add_argument(
        "--tiles", action="store_true", help="cut tile by tile, in processes; --heights alone is written"
    )
    group.add_argument("--jobs", metavar="N", type=jobs_given, help="tiles at a time (default: one a core)")
    add_scheduler_option(group)


def check_tile_arguments(arguments: argparse.Namespace) -> None:
    """Refuse arguments that do not go with a cut by tiles.

    Raises:
        InputError: one line that names them.
    """
    if not arguments.tiles:
        for name in ("jobs", "scheduler"):
            if getattr(arguments, name) is not None:
                raise InputError(f"--{name} has no effect without --tiles; add it, or leave --{name} away")
        return
    if arguments.heights is None or arguments.heights.is_char_device():
        raise InputError("--tiles writes heights; add --heights OUT.npy")
    beyond = [name for name in _ALONE if getattr(arguments, name) is not None]
    if beyond or arguments.engine not in (Engine.AUTO.value, Engine.CPU.value):
        raise InputError(
            f"--{beyond[0] if beyond else 'engine'} does not go with --tiles, which cuts and judges nothing; leave one "
            "of them away"
        )


def cut_by_tiles(arguments: argparse.Namespace, setup: CutSetup, progress: Progress) -> str:
    """Write the heights that are left, and where they lie; return a line about them.

    Raises:
        HitofudeError: a tile cannot be cut, or the file not be written. Cancelled: by progress.
    """
    grid, path = tiled_grid(setup.stock.box, arguments.grid), arguments.heights
    tiles, waiting = list(tiles_of(grid)), _waiting(path)
    try:
        with lanes_of(arguments, len(tiles), cut_tile) as lanes:
            memory = None if arguments.scheduler else budget_limit() // len(lanes)  # other machines have their own
            tasks = [CutTileTask(f"tile {number}", setup, tile, memory) for number, tile in enumerate(tiles, 1)]
            low, high = _written(waiting, grid, tasks, lanes, progress)
        os.replace(waiting, path)
    except OSError as error:
        raise InputError(f"--heights {path}: it cannot be written: {error.strerror or error}") from error
    finally:
        with suppress(OSError):
            os.unlink(waiting)
    floor = setup.stock.over(tiles[0].grid).floor
    where = {"x0": grid.x0, "y0": grid.y0, "pitch": grid.pitch, "floor": floor, "engine": Engine.CPU.value}
    write_atomically(path.with_suffix(".json"), (json.dumps(where, indent=1) + "\n").encode())
    return (
        f"{path}: {grid.cols} x {grid.rows} heights every {grid.pitch:.6g} mm in {len(tiles)} tiles, {low:.4f} to "
        f"{high:.4f} mm; nothing was judged"
    )


def _written(
    waiting: Path, grid: Grid, tasks: Sequence[CutTileTask], lanes: Sequence[Lane], progress: Progress
) -> tuple[float, float]:
    """Write the heights of all tiles into a file; return the lowest and the highest, mm."""
    field = np.lib.format.open_memmap(waiting, "w+", np.float32, (grid.rows, grid.cols))
    spans: list[tuple[float, float]] = []

    def finished(place: int, result: BatchResult) -> None:  # on this thread
        spans.append(_take(field, tasks[place].tile, result))

    BatchRun(tasks, lanes, finished).run(progress)
    field.flush()
    return min(low for low, _ in spans), max(high for _, high in spans)


def _waiting(path: Path) -> Path:
    """Return a new file beside another one, whose place it is to take."""
    sweep(path.parent)
    try:
        handle, waiting = tempfile.mkstemp(prefix=waiting_prefix(path.name), suffix=".part", dir=path.parent)
    except OSError as error:
        raise InputError(f"--heights {path}: it cannot be written: {error.strerror or error}") from error
    os.close(handle)
    return Path(waiting)


def _take(field: np.memmap, tile: CutTile, result: BatchResult) -> tuple[float, float]:
    """Put a tile's heights into the field; return the lowest and the highest.

    Raises:
        HitofudeError: it was not cut.
    """
    if result.row.verdict is not BatchVerdict.CLEAN:
        raise HitofudeError(f"{result.row.name}: {result.row.findings[0]}")
    grid, (data,) = tile.grid, result.files.values()
    heights = np.frombuffer(data, np.float32).reshape(grid.rows, grid.cols)
    field[tile.first_row : tile.first_row + grid.rows, tile.first_col : tile.first_col + grid.cols] = heights
    return float(heights.min()), float(heights.max())
