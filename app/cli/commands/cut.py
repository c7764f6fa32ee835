"""`hitofude cut`: cuts any NC program out of its stock, compares what is left with the part, writes what was asked
for.
"""

from __future__ import annotations

import argparse

from ...usecases.cut_files import cut_texts
from ...usecases.cutting.cut import cut
from ...usecases.cutting.ready_setup import setup_of
from ...usecases.cutting.report import cut_report
from ..command import CliCommand, OptionParser
from ..cut_options import EPILOG, add_cut_options, check_cut_arguments
from ..cut_request import cut_files, ensure_window, examined_programs, requested_look, setup_request
from ..cut_tiles import add_tile_options, check_tile_arguments, cut_by_tiles
from ..files import shown_progress
from ..outcome import CommandOutcome, by_path
from ..output import REMARKS, finding_lines
from ..signals import StopFlag


def _add_options(parser: OptionParser) -> None:
    add_cut_options(parser)
    add_tile_options(parser)


def _check(arguments: argparse.Namespace) -> None:
    check_cut_arguments(arguments)
    check_tile_arguments(arguments)


def _run(arguments: argparse.Namespace, stopped: StopFlag) -> int:
    """Do the work and return the exit status: 0 clean, 1 with findings."""
    outputs = cut_files(arguments)
    progress = shown_progress(arguments.quiet, stopped)
    request = setup_request(arguments)
    ready = setup_of(examined_programs(arguments, progress.part(0.0, 0.2)), request, progress.part(0.2, 0.25))
    if arguments.tiles:
        return CommandOutcome(
            {}, [cut_by_tiles(arguments, ready.setup, progress.part(0.25, 1.0))], counts=False
        ).delivered(arguments, progress)
    ensure_window(arguments.window, ready)
    done = cut(ready.setup, requested_look(arguments), progress.part(0.25, 0.95))
    report = cut_report(done, ready)
    lines = [*report.summary(), *finding_lines(report.findings), *_warning_lines(report.warnings)]
    texts = by_path(outputs, cut_texts(done, report, ready.programs[0].name, set(outputs)))
    counts = any(finding.counts for finding in report.findings)
    return CommandOutcome(texts, lines, counts).delivered(arguments, progress)


def _warning_lines(warnings: tuple[str, ...]) -> list[str]:
    """Return the first warnings of the control, and how many more there are."""
    more = len(warnings) - REMARKS
    last = [f"  - {more} more warnings; --report R.json lists them all"] if more > 0 else []
    return [*(f"  - {warning}" for warning in warnings[:REMARKS]), *last]


COMMAND = CliCommand(
    "cut",
    needs="the NC program",
    about=(
        "Cut any NC program out of its stock, exactly, and tell what is left, what went wrong, and how near it is to "
        "the part."
    ),
    epilog=EPILOG,
    add_options=_add_options,
    run=_run,
    intermixed=True,
    check=_check,
    examples=(
        "hitofude cut part.ngc --against part.dxf --image cut.png",
        "hitofude cut other.nc --tool 1=ball:6 --stock 0,0,-10,80,60,0 --heights left.npy",
    ),
)
