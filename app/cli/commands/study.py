"""`hitofude study`: one file many ways, by the processes of a batch, and which way takes least time."""

from __future__ import annotations

import argparse
from collections.abc import Sequence

from ...usecases.batch.study import StudyChoice, best_words, ranked, study_csv, study_html
from ...usecases.batch.table import Files
from ...usecases.batch.task import BatchExtras, BatchRow, BatchVerdict
from ..batch_plan import planned_parts
from ..batch_run import carry_out, row_line
from ..command import CliCommand
from ..files import shown_progress
from ..output import tell_lines
from ..signals import StopFlag
from ..study_options import EPILOG, add_study_options, kind_of, listed, studied


def _run(arguments: argparse.Namespace, stopped: StopFlag) -> int:
    """Do what is not done yet and return the exit status: 0 some combination is clean, 1 none."""
    kind, title = kind_of(arguments.file), f"Study of {arguments.file.name}"
    choices = studied(arguments, shown_progress(arguments.quiet, stopped))

    def table(rows: Sequence[BatchRow], files: Files) -> dict[str, bytes]:
        page = study_html(choices, rows, files, title)
        return {"study.csv": study_csv(choices, rows, files), "study.html": page}

    study = planned_parts(arguments, kind, listed(choices, arguments.file), BatchExtras(), table)
    carry_out(arguments, study, "combinations", stopped)
    if not arguments.quiet:
        head = f"{study.store.folder / 'study.html'}: {len(choices)} combinations"
        tell_lines([head, *_told(choices, study.rows)])
    return 0 if any(row.verdict is BatchVerdict.CLEAN for row in study.rows) else 1


_PRINTED = 10
"""Combinations that are printed; the table has all."""


def _told(choices: Sequence[StudyChoice], rows: Sequence[BatchRow]) -> list[str]:
    best = best_words(choices, rows)
    failed = [row for row in rows if row.time_s is None][:_PRINTED]
    return [*([best] if best else []), *(f"  {row_line(rows[at])}" for at in ranked(rows)[:_PRINTED])] or [
        f"  ! {row_line(row)}" for row in failed
    ]


COMMAND = CliCommand(
    "study",
    reads="drawing or program",
    needs="the drawing or program and the folder to write to",
    about="Make or smooth one file with every combination of some options' values, and tell which takes least time.",
    epilog=EPILOG,
    add_options=add_study_options,
    run=_run,
    examples=(
        "hitofude study part.dxf -o study --vary pocket-tool=6,8 --vary stepover=40%,60% --depth 3",
        "hitofude study part.dxf -o study --which-tool",
    ),
)
