"""What the arguments of `cut` ask for: files to read and to write, and how they are put together."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from ..core.errors import InputError
from ..core.input_file import FileBytes, read_input
from ..core.progress import Progress
from ..formats.job.toml import read_job
from ..formats.tools.at_path import tools_at
from ..formats.tools.files import read_rows
from ..gcode.interpreter.dialect import Dialect
from ..gcode.tool_offsets import tool_offsets
from ..model.part import Units
from ..model.tool_table import TableRow, ToolTable, row_of
from ..usecases.cutting.cut import CutOptions, Engine
from ..usecases.cutting.ready_setup import ReadySetup, SetupRequest
from ..usecases.cutting.setup_stock import box_stock, read_stock
from ..usecases.cutting.setup_tools import ToolSource
from ..usecases.examine import ExaminedProgram, ExamineOptions, examine
from .cut_options import Corners
from .files import check_outputs, named_files
from .reading_options import reading


def cut_files(arguments: argparse.Namespace) -> dict[str, Path]:
    """Return the files to write by their option, checked before any work is done.

    Raises:
        InputError: one cannot be written, or has a suffix that is not its own.
    """
    outputs = named_files(arguments, "heights", "image", "report")
    for name, suffix in (("heights", ".npy"), ("image", ".png")):
        if name in outputs and outputs[name].suffix.lower() != suffix and not outputs[name].is_char_device():
            raise InputError(f"--{name} {outputs[name]}: it is written as {suffix}; change the name")
    if "heights" in outputs and not outputs["heights"].is_char_device():
        outputs["heights, with its"] = outputs["heights"].with_suffix(".json")
    check_outputs(outputs, list(_inputs(arguments)))
    return outputs


def _inputs(arguments: argparse.Namespace) -> Iterator[Path]:
    """Yield every file that is read."""
    yield from arguments.programs
    yield from named_files(arguments, "job", "tools", "against").values()
    if isinstance(arguments.stock, Path):
        yield arguments.stock
        if arguments.stock.suffix.lower() == ".npy":
            yield arguments.stock.with_suffix(".json")


def examined_programs(arguments: argparse.Namespace, progress: Progress) -> tuple[ExaminedProgram, ...]:
    """Return every program as its control reads it.

    Raises:
        HitofudeError: a file cannot be read.
        Cancelled: the job was asked to stop.
    """
    dialect = Dialect(arguments.dialect) if arguments.dialect else None
    options = ExamineOptions(
        dialect,
        tool_offsets(_rows(arguments)),
        block_delete=arguments.block_delete == "on",
        units=arguments.units,
    )
    count = len(arguments.programs)
    return tuple(
        examine(path.name, read_input(path), options, progress.part(k / count, (k + 1) / count))
        for k, path in enumerate(arguments.programs)
    )


def setup_request(arguments: argparse.Namespace) -> SetupRequest:
    """Return what was asked for, its files read.

    Raises:
        HitofudeError: a file cannot be read.
    """
    job = read_job(arguments.job.name, read_input(arguments.job)) if arguments.job else None
    reported = [ToolSource("--tool", dict(arguments.tool))]
    if job is not None and "tool" in job.tables:
        reported.append(ToolSource("the job file", {tool.number: tool for tool in job.job.tools}))
    if arguments.tools is not None:
        reported.append(_tools(arguments))
    against = FileBytes(arguments.against.name, read_input(arguments.against)) if arguments.against else None
    beside = None if against is None else lambda name: read_input(arguments.against.parent / name)
    return with_stock(
        SetupRequest(
            tools=tuple(reported),
            job=job,
            stock=None,
            against=against,
            beside=beside,
            depth=arguments.depth,
            leave=arguments.stock_to_leave,
            layers=tuple(arguments.layer),
            units=arguments.units,
            origin=arguments.origin,
            join_tolerance=arguments.join_tolerance,
            tolerance=arguments.tolerance,
            held=dict(arguments.holder),
            reading=reading(arguments),
        ),
        arguments.stock,
    )


def _rows(arguments: argparse.Namespace) -> tuple[TableRow, ...]:
    """Return the control's tool table as --tools tells it."""
    if arguments.tools is None:
        return ()
    if arguments.tools.is_dir() or arguments.tools.suffix.lower() == ".fctl":
        return tuple(row_of(tool) for tool in tools_at(arguments.tools).library.tools)
    return read_rows(
        arguments.tools.name, read_input(arguments.tools), Units.INCH if arguments.tool_units == "in" else Units.MM
    )


def _tools(arguments: argparse.Namespace) -> ToolSource:
    """Return the cutters that --tools tells of; a control's table knows diameters, and not of all, but no shapes."""
    name = arguments.tools.name
    if arguments.tools.suffix.lower() == ".tbl":
        tools, _ = ToolTable(_rows(arguments)).tools(name)
        return ToolSource(name, {tool.number: tool for tool in tools}, shapeless=True)
    library, _ = tools_at(arguments.tools)
    return ToolSource(name, {tool.number: tool for tool in library.tools})


def with_stock(request: SetupRequest, given: Corners | Path | None) -> SetupRequest:
    """Return the wishes with the metal that --stock names."""
    if given is None:
        return request
    if not isinstance(given, Path):
        return replace(request, stock=box_stock(given))
    beside = read_input(given.with_suffix(".json")) if given.suffix.lower() == ".npy" else b""
    return replace(request, stock=read_stock(given.name, read_input(given), beside))


def requested_look(arguments: argparse.Namespace) -> CutOptions:
    """Return how finely to look, and by which engine: the published one where the size of its facets is asked for."""
    engine = Engine.PATENT if arguments.facet is not None else Engine(arguments.engine)
    return CutOptions(arguments.grid, arguments.window, engine=engine, facet=arguments.facet)


def ensure_window(window: tuple[float, float, float, float] | None, ready: ReadySetup) -> None:
    """Refuse a window in which there is no stock.

    Raises:
        InputError: it is beside the stock.
    """
    x0, y0, x1, y1 = box = ready.setup.stock.box
    if window is not None and not (window[0] < x1 and window[2] > x0 and window[1] < y1 and window[3] > y0):
        raise InputError(
            f"--window {','.join(f'{value:g}' for value in window)} is beside the stock, "
            f"{','.join(f'{value:.3f}' for value in box)}; choose a part of it"
        )
