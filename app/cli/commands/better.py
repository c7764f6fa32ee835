"""`hitofude better`: a program of passes over a surface becomes a better one, proven by a second cut."""

from __future__ import annotations

import argparse

from ...core.errors import InputError
from ...core.input_file import read_input
from ...formats.scene.write import scene_text
from ...usecases.better.improve import better
from ...usecases.better.picture import stock_picture
from ...usecases.better.report import findings, lines, report_text
from ..better_options import EPILOG, add_better_options, better_options
from ..check_options import units_taken
from ..command import CliCommand
from ..files import check_outputs, named_files, shown_progress
from ..outcome import CommandOutcome
from ..output import finding_lines
from ..setup_options import setup_request
from ..signals import StopFlag


def _run(arguments: argparse.Namespace, stopped: StopFlag) -> int:
    """Do the work and return the exit status: 0 better and within the tolerance, 1 with findings."""
    outputs = named_files(arguments, "output", "scene", "image", "report")
    check_outputs(outputs, [arguments.program])
    progress = shown_progress(arguments.quiet, stopped)
    asked, setup = better_options(arguments), setup_request(arguments)
    data = read_input(arguments.program)
    done = better(arguments.program.name, data, asked, setup, progress)
    files = {outputs["output"]: done.data}
    if "scene" in outputs:
        if done.scene is None:
            raise InputError(
                f"{done.name}: its passes were lifted where they are, which makes no scene; leave --scene out."
            )
        files[outputs["scene"]] = scene_text(done.scene).encode()
    if "image" in outputs:
        pair = done.old_cut.cut.workpiece, done.new_cut.cut.workpiece
        files[outputs["image"]] = stock_picture(*pair, done.smoothed.area)
    if "report" in outputs:
        files[outputs["report"]] = report_text(done).encode()
    found = findings(done)
    counts = any(finding.counts for finding in found)
    said = [*lines(done), *units_taken(arguments, data), *finding_lines(found)]
    return CommandOutcome(files, said, counts).delivered(arguments, progress)


COMMAND = CliCommand(
    "better",
    reads="program",
    needs="the NC program and -o OUT.ngc",
    about=(
        "Make a better program of one that goes over a surface in passes: fewer blocks, smaller bends, nearer to the "
        "true shape, and prove by a second cut that it leaves the same."
    ),
    epilog=EPILOG,
    add_options=add_better_options,
    run=_run,
    examples=("hitofude better raster.ngc -o raster-better.ngc --image metal.png --report better.json",),
)
