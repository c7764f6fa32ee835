"""A job with one tool after the other in the place of its own: each made and proven by a process of a batch."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass, replace

from ...core.errors import Cancelled, HitofudeError
from ...core.memory import budget_limit, within
from ...core.progress import NO_PROGRESS, Progress
from ...model.job import Job
from ..making.make import export
from .lanes import ProcessLane
from .run import BatchRun
from .task import BatchResult, BatchRow, BatchVerdict
from .work import made_row


@dataclass(frozen=True)
class ToolTrial:
    """A job to be tried.

    Attributes:
        name: of the tool, for people. job: with it. memory: bytes that it may take; None = as a job alone.
    """

    name: str
    job: Job
    memory: int | None = None


def try_tool(trial: ToolTrial, progress: Progress = NO_PROGRESS) -> BatchResult:
    """Return what the program of a trial is like: verdict, time, length, what it leaves; no file.

    Raises:
        Cancelled: by progress.
    """
    try:
        with within(trial.memory):
            made = export(trial.job, progress)
    except Cancelled:
        raise
    except HitofudeError as error:
        return BatchResult(BatchRow(trial.name, BatchVerdict.REFUSED, findings=(str(error),), counting=1), {})
    return BatchResult(made_row(trial.name, made), {})


def try_tools(trials: Sequence[ToolTrial], progress: Progress = NO_PROGRESS) -> tuple[BatchRow, ...]:
    """Return what became of each trial, in their order, by as many processes as there are cores.

    Raises:
        Cancelled: by progress; processes are ended.
    """
    count = max(1, min(os.cpu_count() or 1, len(trials)))
    found: dict[int, BatchResult] = {}
    tasks = [replace(each, memory=budget_limit() // count) for each in trials]
    BatchRun(tasks, [ProcessLane(try_tool) for _ in range(count)], found.__setitem__).run(progress)
    return tuple(found[at].row for at in range(len(trials)))
