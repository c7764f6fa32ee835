"""`hitofude batch`: makes, checks or smooths many parts, each by itself, and writes a table of what became of them."""

from __future__ import annotations

import argparse
from collections import Counter

from ...usecases.batch.task import BatchVerdict
from ..batch_options import EPILOG, add_batch_options
from ..batch_plan import PlannedBatch, planned
from ..batch_run import carry_out, row_line
from ..command import CliCommand
from ..output import tell_lines
from ..signals import StopFlag


def _run(arguments: argparse.Namespace, stopped: StopFlag) -> int:
    """Do what is not done yet and return the exit status: 0 all clean, 1 not all."""
    batch = planned(arguments)
    carry_out(arguments, batch, "parts", stopped)
    if not arguments.quiet:
        tell_lines(_summary(batch))
    return 0 if all(row.verdict is BatchVerdict.CLEAN for row in batch.rows) else 1


def _summary(batch: PlannedBatch) -> list[str]:
    rows = batch.rows
    counts = Counter(row.verdict for row in rows)
    told = ", ".join(f"{counts[each]} {each.words}" for each in BatchVerdict if counts[each])
    parts = "1 part" if len(rows) == 1 else f"{len(rows)} parts"
    bad = [f"  ! {row_line(row)}" for row in rows if row.verdict is not BatchVerdict.CLEAN][:_PRINTED]
    more = sum(row.verdict is not BatchVerdict.CLEAN for row in rows) - len(bad)
    last = [f"  - {more} more, see the table"] if more else []
    return [f"{batch.store.folder / 'results.html'}: {parts}: {told}", *bad, *last]


_PRINTED = 20
"""Parts that are printed; the table has all."""


COMMAND = CliCommand(
    "batch",
    reads="folder or list",
    needs="the folder or the list of parts and the folder to write to",
    about="Make, check or smooth many parts, each by itself: one that fails, hangs or is killed harms none.",
    epilog=EPILOG,
    add_options=add_batch_options,
    run=_run,
    examples=(
        "hitofude batch parts -o programs --depth 3 --sheets pdf",
        "hitofude batch programs -o checked --check",
    ),
)
