"""`hitofude batch`: makes, checks or smooths many parts, each by itself, and writes a table of what became of them."""

from __future__ import annotations

import argparse
import os
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace

from ...core.durations import minutes_words
from ...core.errors import InputError
from ...core.memory import budget_limit
from ...usecases.batch.lanes import ExecutorLane, Lane, ProcessLane
from ...usecases.batch.run import BatchRun
from ...usecases.batch.task import BatchResult, BatchRow, BatchVerdict
from ..batch_options import EPILOG, add_batch_options
from ..batch_plan import PlannedBatch, planned
from ..command import CliCommand
from ..files import shown_progress
from ..output import tell
from ..signals import StopFlag, undisturbed


def _run(arguments: argparse.Namespace, stopped: StopFlag) -> int:
    """Do what is not done yet and return the exit status: 0 all clean, 1 not all."""
    batch = planned(arguments)
    try:
        return _done(arguments, batch, stopped)
    finally:
        batch.store.close()


def _done(arguments: argparse.Namespace, batch: PlannedBatch, stopped: StopFlag) -> int:
    """Do what is planned and return the exit status."""
    stopped.kept = "what was done is kept, and the same command goes on with the rest"
    progress = shown_progress(arguments.quiet, stopped)
    done = len(batch.rows) - len(batch.pending)
    if done and batch.pending:
        progress.remark(f"{done} of {len(batch.rows)} parts are done already")

    def finished(number: int, result: BatchResult) -> None:
        part = batch.pending[number]
        batch.store.keep(part.task.output, part.key, result)
        batch.rows[part.place] = result.row
        progress.remark(_line(result.row))

    try:
        with _lanes(arguments, len(batch.pending)) as lanes:
            share = None if arguments.scheduler else budget_limit() // len(lanes)  # other machines have their own
            tasks = [replace(part.task, memory=share) for part in batch.pending]
            BatchRun(tasks, lanes, finished, arguments.limit * 60).run(progress)
    finally:
        with undisturbed():
            batch.store.write_table(batch.rows, batch.outputs, batch.title)
    progress.step(1.0)
    if not arguments.quiet:
        tell("\n".join(_summary(batch)))
    return 0 if all(row.verdict is BatchVerdict.CLEAN for row in batch.rows) else 1


@contextmanager
def _lanes(arguments: argparse.Namespace, parts: int) -> Iterator[list[Lane]]:
    """Give the lanes that parts are done on: processes of this machine, or places on a cluster.

    Raises:
        InputError: there is no cluster, or what talks to it is not installed.
    """
    if arguments.scheduler is None:
        yield [ProcessLane() for _ in range(min(arguments.jobs or os.cpu_count() or 1, max(parts, 1)))]
        return
    try:
        from distributed import Client
    except ImportError as error:
        raise InputError("--scheduler: Dask is not installed; pip install 'hitofude[cluster]'") from error
    try:
        client = Client(arguments.scheduler, timeout="10s")
    except (OSError, ValueError) as error:
        raise InputError(
            f"--scheduler {arguments.scheduler}: no cluster answers there ({error}); check the address"
        ) from error
    with client:
        threads = sum(client.nthreads().values())
        executor = client.get_executor(pure=False)
        yield [ExecutorLane(executor) for _ in range(min(arguments.jobs or threads or 1, max(parts, 1)))]


def _line(row: BatchRow) -> str:
    time = "" if row.time_s is None else f", {minutes_words(row.time_s)} min"
    why = f": {row.findings[0]}" if row.findings and row.verdict is not BatchVerdict.CLEAN else ""
    return f"{row.name}: {row.verdict.words}{time}{why}"


def _summary(batch: PlannedBatch) -> list[str]:
    rows = batch.rows
    counts = Counter(row.verdict for row in rows)
    told = ", ".join(f"{counts[each]} {each.words}" for each in BatchVerdict if counts[each])
    parts = "1 part" if len(rows) == 1 else f"{len(rows)} parts"
    bad = [f"  ! {_line(row)}" for row in rows if row.verdict is not BatchVerdict.CLEAN][:_PRINTED]
    more = sum(row.verdict is not BatchVerdict.CLEAN for row in rows) - len(bad)
    last = [f"  - {more} more, see the table"] if more else []
    return [f"{batch.store.folder / 'results.html'}: {parts}: {told}", *bad, *last]


_PRINTED = 20
"""Parts that are printed; the table has all."""


COMMAND = CliCommand(
    "batch",
    "folder or list",
    "the folder or the list of parts and the folder to write to",
    "Make, check or smooth many parts, each by itself: one that fails, hangs or is killed harms none.",
    EPILOG,
    add_batch_options,
    _run,
)
