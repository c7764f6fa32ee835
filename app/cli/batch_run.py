"""A planned batch or study, carried out: what is done is kept at once, and the table written whatever happens."""

from __future__ import annotations

import argparse
from contextlib import closing
from dataclasses import replace

from ..core.durations import minutes_words
from ..core.memory import budget_limit
from ..usecases.batch.run import BatchRun
from ..usecases.batch.task import BatchResult, BatchRow, BatchVerdict
from .batch_plan import PlannedBatch
from .files import shown_progress
from .lanes import lanes_of
from .signals import StopFlag, undisturbed


def carry_out(arguments: argparse.Namespace, batch: PlannedBatch, what: str, stopped: StopFlag) -> None:
    """Do what is planned and not done yet, and let go of its folder.

    Args:
        what: the batch is of, in words, such as "parts".

    Raises:
        HitofudeError: a file cannot be written, or there is no cluster. Cancelled: by Ctrl+C.
    """
    stopped.kept = "what was done is kept, and the same command goes on with the rest"
    progress = shown_progress(arguments.quiet, stopped)
    done = len(batch.rows) - len(batch.pending)
    if done and batch.pending:
        progress.remark(f"{done} of {len(batch.rows)} {what} are done already")

    def finished(number: int, result: BatchResult) -> None:
        part = batch.pending[number]
        batch.store.keep(part.task.output, part.key, result)
        batch.rows[part.place] = result.row
        progress.remark(row_line(result.row))

    with closing(batch.store):
        try:
            with lanes_of(arguments, len(batch.pending)) as lanes:
                share = None if arguments.scheduler else budget_limit() // len(lanes)  # other machines have their own
                tasks = [replace(part.task, memory=share) for part in batch.pending]
                BatchRun(tasks, lanes, finished, arguments.limit * 60).run(progress)
        finally:
            with undisturbed():
                batch.store.write_table(batch.rows, batch.outputs, batch.table)
    progress.step(1.0)


def row_line(row: BatchRow) -> str:
    """Return a row of the table in a line."""
    time = "" if row.time_s is None else f", {minutes_words(row.time_s)} min"
    why = f": {row.findings[0]}" if row.findings and row.verdict is not BatchVerdict.CLEAN else ""
    return f"{row.name}: {row.verdict.words}{time}{why}"
