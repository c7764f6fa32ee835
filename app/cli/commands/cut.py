"""`hitofude cut`: cuts any NC program out of its stock, compares what is left with the part, writes what was asked
for.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from ...core.atomic import write_together
from ...core.errors import InputError
from ...core.progress import Progress
from ...formats.job.toml import read_job
from ...formats.tools.files import read_rows, read_tools
from ...gcode.interpreter.dialect import Dialect
from ...gcode.tool_offsets import tool_offsets
from ...model.part import Units
from ...model.tool_table import TableRow, ToolTable
from ...usecases.cut import CutOptions, CutProgram, Engine, cut
from ...usecases.cut_files import heights_of, picture_of
from ...usecases.cut_report import CutReport, cut_report
from ...usecases.examine import ExaminedProgram, ExamineOptions, examine
from ...usecases.setup import ReadySetup, SetupRequest, setup_of
from ...usecases.setup_stock import box_stock, read_stock
from ...usecases.setup_tools import ToolSource
from ..command import CliCommand
from ..cut_options import EPILOG, Corners, add_cut_options, check_cut_arguments
from ..files import check_outputs, read_input, shown_progress
from ..output import REMARKS, finding_lines, tell
from ..reading_options import reading
from ..signals import StopFlag, undisturbed


def _run(arguments: argparse.Namespace, stopped: StopFlag) -> int:
    """Do the work and return the exit status: 0 clean, 1 with findings."""
    outputs = _outputs(arguments)
    progress = shown_progress(arguments.quiet, stopped)
    request = _wishes(arguments)
    ready = setup_of(_programs(arguments, progress.part(0.0, 0.2)), request, progress.part(0.2, 0.25))
    _ensure_window(arguments.window, ready)
    done = cut(
        ready.setup,
        CutOptions(arguments.grid, arguments.window, engine=_engine(arguments), facet=arguments.facet),
        progress.part(0.25, 0.95),
    )
    report = cut_report(done, ready)
    texts = dict(_texts(outputs, ready, done, report))
    progress.step(1.0)
    with undisturbed():
        write_together({outputs[name]: text for name, text in texts.items()})
    if not arguments.quiet:
        tell("\n".join([report.summary(), *finding_lines(report.findings), *_warning_lines(report.warnings)]))
    return 1 if any(finding.counts for finding in report.findings) else 0


def _engine(arguments: argparse.Namespace) -> Engine:
    """Return the engine that is asked for: the published one where the size of its facets is."""
    return Engine.PATENT if arguments.facet is not None else Engine(arguments.engine)


def _outputs(arguments: argparse.Namespace) -> dict[str, Path]:
    """Return the files to write by their option, checked before any work is done."""
    outputs = {name: path for name in ("heights", "image", "report") if (path := getattr(arguments, name)) is not None}
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
    yield from (path for name in ("job", "tools", "against") if (path := getattr(arguments, name)) is not None)
    if isinstance(arguments.stock, Path):
        yield arguments.stock
        if arguments.stock.suffix.lower() == ".npy":
            yield arguments.stock.with_suffix(".json")


def _programs(arguments: argparse.Namespace, progress: Progress) -> tuple[ExaminedProgram, ...]:
    """Return every program as its control reads it."""
    dialect = Dialect(arguments.dialect) if arguments.dialect else None
    options = ExamineOptions(dialect, tool_offsets(_rows(arguments)), block_delete=arguments.block_delete == "on")
    count = len(arguments.programs)
    return tuple(
        examine(path.name, read_input(path), options, progress.part(k / count, (k + 1) / count))
        for k, path in enumerate(arguments.programs)
    )


def _wishes(arguments: argparse.Namespace) -> SetupRequest:
    """Return what was asked for, its files read."""
    job = read_job(arguments.job.name, read_input(arguments.job)) if arguments.job else None
    reported = [ToolSource("--tool", dict(arguments.tool))]
    if job is not None and "tool" in job.tables:
        reported.append(ToolSource("the job file", {tool.number: tool for tool in job.job.tools}))
    if arguments.tools is not None:
        reported.append(_tools(arguments))
    against = (arguments.against.name, read_input(arguments.against)) if arguments.against else None
    beside = None if against is None else lambda name: read_input(arguments.against.parent / name)
    return _with_stock(
        SetupRequest(
            tuple(reported),
            job,
            None,
            against,
            beside,
            arguments.depth,
            arguments.stock_to_leave,
            tuple(arguments.layer),
            arguments.units,
            arguments.origin,
            arguments.join_tolerance,
            arguments.tolerance,
            dict(arguments.holder),
            reading(arguments),
        ),
        arguments.stock,
    )


def _rows(arguments: argparse.Namespace) -> tuple[TableRow, ...]:
    """Return the control's tool table as --tools tells it."""
    if arguments.tools is None:
        return ()
    return read_rows(
        arguments.tools.name, read_input(arguments.tools), Units.INCH if arguments.tool_units == "in" else Units.MM
    )


def _tools(arguments: argparse.Namespace) -> ToolSource:
    """Return the cutters that --tools tells of; a control's table knows diameters, and not of all, but no shapes."""
    name = arguments.tools.name
    if arguments.tools.suffix.lower() == ".tbl":
        tools, _ = ToolTable(_rows(arguments)).tools(name)
        return ToolSource(name, {tool.number: tool for tool in tools}, shapeless=True)
    library, _ = read_tools(name, read_input(arguments.tools))
    return ToolSource(name, {tool.number: tool for tool in library.tools})


def _with_stock(request: SetupRequest, given: Corners | Path | None) -> SetupRequest:
    """Return the wishes with the metal that --stock names."""
    if given is None:
        return request
    if not isinstance(given, Path):
        return replace(request, stock=box_stock(given))
    beside = read_input(given.with_suffix(".json")) if given.suffix.lower() == ".npy" else b""
    return replace(request, stock=read_stock(given.name, read_input(given), beside))


def _ensure_window(window: tuple[float, float, float, float] | None, ready: ReadySetup) -> None:
    x0, y0, x1, y1 = box = ready.setup.stock.box
    if window is not None and not (window[0] < x1 and window[2] > x0 and window[1] < y1 and window[3] > y0):
        raise InputError(
            f"--window {','.join(f'{value:g}' for value in window)} is beside the stock, "
            f"{','.join(f'{value:.3f}' for value in box)}; choose a part of it"
        )


def _warning_lines(warnings: tuple[str, ...]) -> Iterator[str]:
    """Yield the first warnings of the control, and how many more there are."""
    yield from (f"  - {warning}" for warning in warnings[:REMARKS])
    if len(warnings) > REMARKS:
        yield f"  - {len(warnings) - REMARKS} more warnings; --report R.json lists them all"


def _texts(
    outputs: dict[str, Path], ready: ReadySetup, done: CutProgram, report: CutReport
) -> Iterator[tuple[str, bytes]]:
    """Yield what to write, by option."""
    if "report" in outputs:
        yield "report", report.text().encode()
    if "heights" in outputs:
        heights, where = heights_of(done)
        yield "heights", heights
        if "heights, with its" in outputs:
            yield "heights, with its", where
    if "image" in outputs:
        yield "image", picture_of(done, ready.programs[0].name)


COMMAND = CliCommand(
    "cut",
    "",
    "the NC program",
    "Cut any NC program out of its stock, exactly, and tell what is left, what went wrong, and how near it is to the "
    "part.",
    EPILOG,
    add_cut_options,
    _run,
    intermixed=True,
    check=check_cut_arguments,
)
