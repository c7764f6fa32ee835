"""`hitofude check`: reads any NC program, tells what is wrong with it, how far it reaches and how long it takes."""

from __future__ import annotations

import argparse

from ...core.input_file import read_input
from ...usecases.examine import compared, examine
from ..check_lines import difference_lines, examined_lines
from ..check_options import EPILOG, add_check_options, check_files, examine_options
from ..command import CliCommand
from ..files import shown_progress
from ..outcome import CommandOutcome, by_path
from ..signals import StopFlag


def _run(arguments: argparse.Namespace, stopped: StopFlag) -> int:
    """Do the work and return the exit status: 0 clean, 1 with problems or differences."""
    outputs = check_files(arguments)
    progress = shown_progress(arguments.quiet, stopped)
    data = read_input(arguments.program)
    examined = examine(arguments.program.name, data, examine_options(arguments), progress.part(0.0, 0.5))
    lines, differences = examined_lines(examined), None
    if arguments.compare is not None:
        other = arguments.compare.name
        differences = compared(examined, other, read_input(arguments.compare), progress.part(0.5, 0.8))
        lines += difference_lines(other, differences)
    texts = {}
    if "report" in outputs:
        texts["report"] = examined.text(differences).encode()
    if "frame" in outputs:
        texts["frame"] = examined.frame().encode("ascii")
    if "output" in outputs:
        from ...gcode.rework.restart import RestartOptions, restart

        texts["output"] = restart(data, arguments.restart_at, RestartOptions(examined.read))
    counts = bool(examined.problems) or (differences is not None and not differences.same_motion)
    return CommandOutcome(by_path(outputs, texts), lines, counts).delivered(arguments, progress)


COMMAND = CliCommand(
    "check",
    reads="program",
    needs="the NC program",
    about="Read an NC program as its control would, and tell what there is to know of it.",
    epilog=EPILOG,
    add_options=add_check_options,
    run=_run,
    examples=(
        "hitofude check program.nc --machine vmc --report found.json",
        "hitofude check program.nc --restart-at 1234 -o rest.nc",
    ),
)
