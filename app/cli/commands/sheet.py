"""`hitofude sheet`: the paper that goes to the machine with any NC program."""

from __future__ import annotations

import argparse
from pathlib import Path

from ...core.errors import HitofudeError
from ...core.input_file import read_input
from ...core.progress import Progress
from ...formats.sheet.write import sheet_bytes
from ...usecases.cutting.cut import cut
from ...usecases.cutting.ready_setup import SetupRequest, setup_of
from ...usecases.cutting.report import cut_report
from ...usecases.examine import ExaminedProgram
from ...usecases.sheet.program import SheetCut, SheetNotes, program_sheet
from ..command import CliCommand, OptionParser
from ..cut_options import add_cut_options, check_cut_arguments
from ..cut_request import cut_files, examined_programs, requested_look, setup_request
from ..files import check_outputs, sheet_suffix, shown_progress
from ..machining_options import add_note_options
from ..outcome import CommandOutcome
from ..signals import StopFlag

EPILOG = """\
A picture of stock, path and zero, tools with stick-out and holder, times, and a certificate: what was proven, by which
bound, with the SHA-256 of the files. Options are those of cut. Where tools or stock are not known the program is read
only, and the sheet says so. Exit status 0: done and clean; 1: with findings; 2: a file cannot be used.
"""


def add_sheet_options(parser: OptionParser) -> None:
    """Add the options of `hitofude sheet`."""
    parser.add_argument(
        "-o", "--output", metavar="OUT.pdf|html", type=Path, required=True, help="the sheet, for A4 or for a browser"
    )
    add_note_options(parser)
    add_cut_options(parser)


def _run(arguments: argparse.Namespace, stopped: StopFlag) -> int:
    """Do the work and return the exit status: 0 clean, 1 with findings."""
    suffix = sheet_suffix("output", arguments.output)
    cut_files(arguments)
    check_outputs({"output": arguments.output}, arguments.programs)
    progress = shown_progress(arguments.quiet, stopped)
    programs = examined_programs(arguments, progress.part(0.0, 0.2))
    request = setup_request(arguments)
    done, why = _cut(arguments, programs, request, progress.part(0.2, 0.95))
    hashed = {f"Program: {path.name}": read_input(path) for path in arguments.programs}
    if arguments.against is not None:
        hashed = {f"Part: {arguments.against.name}": read_input(arguments.against), **hashed}
    sheet = program_sheet(programs, hashed, done, why, _notes(arguments, request))
    lines = [f"{arguments.output}: {sheet.verdict}"]
    files = {arguments.output: sheet_bytes(sheet, suffix, arguments.language)}
    return CommandOutcome(files, lines, bool(sheet.findings)).delivered(arguments, progress)


def _notes(arguments: argparse.Namespace, request: SetupRequest) -> SheetNotes:
    """Return what is to be written on the sheet: as said, or as the job has it."""
    job = request.job.job if request.job else None
    kept = SheetNotes(job.clamping_note, job.zero_note) if job else SheetNotes()
    clamping, zero = arguments.clamping, arguments.zero
    return SheetNotes(kept.clamping if clamping is None else clamping, kept.zero if zero is None else zero)


def _cut(
    arguments: argparse.Namespace, programs: tuple[ExaminedProgram, ...], request: SetupRequest, progress: Progress
) -> tuple[SheetCut | None, str]:
    """Return the program, cut out of its stock, or why it cannot be."""
    try:
        ready = setup_of(programs, request, progress.part(0.0, 0.1))
    except HitofudeError as error:
        return None, str(error)
    done = cut(ready.setup, requested_look(arguments), progress.part(0.1, 1.0))
    return SheetCut(ready, done, cut_report(done, ready)), ""


COMMAND = CliCommand(
    "sheet",
    needs="the NC program and -o OUT.pdf",
    about="Write the sheet that goes to the machine with an NC program: what is set up, what it does, what is proven.",
    epilog=EPILOG,
    add_options=add_sheet_options,
    run=_run,
    intermixed=True,
    check=check_cut_arguments,
    examples=(
        "hitofude sheet part.ngc -o sheet.pdf --against part.dxf",
        'hitofude sheet other.nc -o other.html --clamping "two vices, jaws 8 mm high"',
    ),
)
