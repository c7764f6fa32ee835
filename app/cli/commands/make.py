"""`hitofude make`: reads the files, runs the make workflow, writes the files."""

from __future__ import annotations

import argparse
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path

from ...core.beside import one_after_another
from ...core.errors import InputError
from ...core.input_file import read_input
from ..command import CliCommand
from ..files import identity, shown_progress
from ..make_options import EPILOG, add_make_options, make_files, read_make_options
from ..outcome import CommandOutcome, by_path
from ..output import finding_lines
from ..signals import StopFlag
from ..timings import StageTimes


def _run(arguments: argparse.Namespace, stopped: StopFlag) -> int:
    """Do the work and return the exit status: 0 clean, 1 with findings."""
    from ...usecases.make_files import other_files  # not for its options alone, as a batch reads them
    from ...usecases.making.make import make

    outputs, options = make_files(arguments), read_make_options(arguments)
    times = StageTimes() if arguments.timings else None
    progress = shown_progress(arguments.quiet, stopped)
    watched = times.watch(progress) if times else progress
    drawing = read_input(arguments.drawing)
    with one_after_another() if times else nullcontext():
        made = make(arguments.drawing.name, drawing, options, watched)
    if times:
        made = replace(made, report=made.report.with_timings(times.seconds()))
    programs = {file.named(arguments.output): file.nc.text.encode("ascii") for file in made.files}
    others = by_path(outputs, other_files(made, outputs, drawing, arguments.language))
    _ensure_apart(outputs["output"], [*programs], [*others])
    summary = made.report.summary(", ".join(map(str, programs)))
    lines = [summary, *made.proposed(), *finding_lines(made.findings), *(times.lines() if times else [])]
    return CommandOutcome(others | programs, lines, not made.clean).delivered(arguments, progress)


def _ensure_apart(output: Path, programs: list[Path], others: list[Path]) -> None:
    """Refuse a file that is written twice: what programs of several files are called is known when they are made."""
    if {identity(path) for path in programs} & {identity(path) for path in others}:
        raise InputError(
            f"--output {output} makes {', '.join(map(str, programs))}, and one of these is another output; "
            "give every file its own name"
        )


COMMAND = CliCommand(
    "make",
    reads="drawing",
    needs="the drawing and the NC program to write",
    about=(
        "Turn a drawing or a picture into tool paths for pockets, rests, contours and holes, and write them as an NC "
        "program, read back and proven the same."
    ),
    epilog=EPILOG,
    add_options=add_make_options,
    run=_run,
    examples=(
        "hitofude make part.dxf -o part.ngc --pocket-tool 6 --contour-tool 3 --depth 4 --stepdown 2",
        "hitofude make part.dxf -o part.ngc --side outside --tabs 4 --sheet part.pdf",
        "hitofude make part.dxf -o part.ngc --propose --thickness 5 --write-job job.toml",
    ),
)
