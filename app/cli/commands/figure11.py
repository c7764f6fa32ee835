"""`hitofude figure11`: the published comparison of software and depth buffer, measured again on this machine."""

from __future__ import annotations

import argparse
import json

from ...core.errors import InputError
from ...exhibits.die_programs import PROGRAMS
from ...exhibits.figure_eleven import FigureOptions, figure_eleven
from ...exhibits.films.program_input import program_input
from ..command import CliCommand
from ..figure_options import EPILOG, add_figure_options
from ..files import check_outputs, named_files, shown_progress
from ..film_program import program_source
from ..outcome import CommandOutcome
from ..setup_options import setup_request
from ..signals import StopFlag


def _run(arguments: argparse.Namespace, stopped: StopFlag) -> int:
    """Do the work and return the exit status, 0."""
    outputs = named_files(arguments, "report")
    check_outputs(outputs, arguments.own)
    progress = shown_progress(arguments.quiet, stopped)
    if not arguments.own and (arguments.tool or arguments.stock is not None):
        raise InputError("--tool and --stock are those of programs of your own; name one, or leave them out")
    told = setup_request(arguments)
    own = tuple(program_input(program_source(path), told=told) for path in arguments.own)
    names = arguments.programs if arguments.programs is not None else () if own else tuple(PROGRAMS)
    done = figure_eleven(FigureOptions(names, arguments.grid, arguments.repeat, own, arguments.facet), progress)
    report = (json.dumps(done.report(), indent=2, allow_nan=False) + "\n").encode()
    return CommandOutcome(dict.fromkeys(outputs.values(), report), done.text().splitlines()).delivered(
        arguments, progress
    )


COMMAND = CliCommand(
    "figure11",
    about=(
        "Measure how long plain software, the published depth buffer, and this program's engines take for the same "
        "cuts."
    ),
    epilog=EPILOG,
    add_options=add_figure_options,
    run=_run,
    examples=("hitofude figure11 --programs A --grid 512",),
)
