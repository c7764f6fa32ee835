"""`hitofude tools`: which tools a drawing wants: narrowest passage, smallest inner radius, the largest tool that still
clears.
"""

from __future__ import annotations

import argparse
import json

from ...core.input_file import read_input
from ...usecases.advice import advice_for
from ..command import CliCommand
from ..files import check_outputs, named_files, shown_progress
from ..outcome import CommandOutcome
from ..signals import StopFlag
from ..tools_lines import advice_lines
from ..tools_options import EPILOG, add_tools_options, advice_options


def _run(arguments: argparse.Namespace, stopped: StopFlag) -> int:
    """Do the work and return the exit status: 0 clean, 1 with findings."""
    outputs = named_files(arguments, "report")
    check_outputs(outputs, [*named_files(arguments, "drawing", "tools").values()])
    options = advice_options(arguments)
    progress = shown_progress(arguments.quiet, stopped)
    name = arguments.drawing.name
    advised = advice_for(name, read_input(arguments.drawing), options, progress)
    report = (json.dumps(advised.report(), indent=2, allow_nan=False) + "\n").encode()
    counts = any(finding.counts for finding in advised.findings)
    files = dict.fromkeys(outputs.values(), report)
    return CommandOutcome(files, advice_lines(name, advised), counts).delivered(arguments, progress)


COMMAND = CliCommand(
    "tools",
    reads="drawing",
    needs="the drawing",
    about="Tell which tools a drawing wants.",
    epilog=EPILOG,
    add_options=add_tools_options,
    run=_run,
    examples=("hitofude tools part.dxf --depth 4",),
)
