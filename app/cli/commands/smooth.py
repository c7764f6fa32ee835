"""`hitofude smooth`: any NC program's straight moves into lines, arcs or splines within a proven tolerance."""

from __future__ import annotations

import argparse
from collections import Counter

from ...core.input_file import read_input
from ...core.wording import counted
from ...gcode.interpreter.dialect import DIALECT_RULES
from ...usecases.smoothing.report import certificate, findings, report_text
from ...usecases.smoothing.result import SmoothedProgram
from ..check_options import units_taken
from ..command import CliCommand
from ..files import check_outputs, named_files, shown_progress
from ..outcome import CommandOutcome
from ..output import REMARKS, finding_lines
from ..signals import StopFlag
from ..smooth_options import EPILOG, add_smooth_options, smooth_options


def _run(arguments: argparse.Namespace, stopped: StopFlag) -> int:
    """Do the work and return the exit status: 0 done, 1 with findings."""
    from ...usecases.smoothing.smooth import smooth  # not for its options alone, as a batch reads them

    outputs = named_files(arguments, "output", "report")
    check_outputs(outputs, [arguments.program])
    progress = shown_progress(arguments.quiet, stopped)
    data = read_input(arguments.program)
    done = smooth(arguments.program.name, data, smooth_options(arguments), progress)
    files = {outputs["output"]: done.data}
    if "report" in outputs:
        files[outputs["report"]] = report_text(done).encode()
    said = [*_lines(done), *units_taken(arguments, data)]
    return CommandOutcome(files, said, bool(findings(done))).delivered(arguments, progress)


def _lines(done: SmoothedProgram) -> list[str]:
    """Return what was done, for people."""
    head, *rest = certificate(done)
    kept = [
        f"  - {n} move{'s' if n > 1 else ''} left alone: {reason.value}" for reason, n in done.found.left.items() if n
    ]
    stayed = Counter(piece.kept for piece in done.pieces if piece.kept)
    kept += [f"  - {counted(n, 'stretch', 'stretches')} as before: {why}" for why, n in stayed.items()]
    found = [*finding_lines(findings(done)), *_warnings(done)]
    return [f"{done.name}: {head.partition(': ')[2]}", *(f"  {line}" for line in rest), *kept, *found]


def _warnings(done: SmoothedProgram) -> list[str]:
    """Return as what control the program was read, and what that control's reader warns of."""
    reported = [f"  - {problem.message(done.name)} (a warning)" for problem in done.source.problems]
    more = [f"  - {len(reported) - REMARKS} more warnings; check tells them all"] if len(reported) > REMARKS else []
    return [f"  read as {DIALECT_RULES[done.dialects[0]].title} does", *reported[:REMARKS], *more]


COMMAND = CliCommand(
    "smooth",
    reads="program",
    needs="the NC program and -o OUT.ngc",
    about=(
        "Write the straight moves of an NC program as fewer lines, as arcs, or as splines, within a tolerance that "
        "is proven."
    ),
    epilog=EPILOG,
    add_options=add_smooth_options,
    run=_run,
    examples=(
        "hitofude smooth part.ngc -o smooth.ngc --tolerance 0.01",
        "hitofude smooth part.ngc -o smooth.ngc --as nurbs --post fanuc",
    ),
)
