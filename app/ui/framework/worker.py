"""The only place that starts jobs: a function runs on its own thread, its answer comes back as a signal."""

from __future__ import annotations

import gc
import sys
import threading
import time
import traceback
from collections.abc import Callable
from contextlib import suppress
from contextvars import Context, copy_context
from dataclasses import dataclass
from functools import cache, partial
from typing import Any, NamedTuple, TypeVar

from PySide6.QtCore import QCoreApplication, QObject, Qt, Signal, Slot
from shiboken6 import isValid

from ...core.errors import Cancelled, HitofudeError
from ...core.memory import MemoryShortError, budget_limit, in_words, within
from ...core.progress import Progress, waits_reported_to

Answer = TypeVar("Answer")
"""What a job returns."""
HEAD_START_S = 0.04
"""Seconds in which the window shows that it computes, before the job competes with it for the interpreter."""

_TOLD_EVERY_S = 0.04
SWITCH_INTERVAL_S = 0.0005
"""Python threads change hands this often while a job runs: keeps painting quick (PLATFORM, Threads)."""


@dataclass(frozen=True, slots=True)
class JobOutcome:
    """What a job ended with.

    Attributes:
        job_id, revision: which job, and the document's revision that it was started for.
        value: what the function returned, or None.
        error: a sentence for the user, or None.
        again: whether the same job may do better another time: it ran out of memory, or the program made a mistake.
            What is wrong with its input is wrong every time.
    """

    job_id: int
    revision: int
    value: object = None
    error: str | None = None
    again: bool = False


@dataclass(frozen=True, slots=True)
class _PendingJob:
    """A job on its way: what to run and who takes what it returns."""

    job_id: int
    revision: int
    function: Callable[[Progress], Any]
    cancelled: threading.Event
    take: Callable[[Any], None] | None


class _Held(NamedTuple):
    """What a job's thread holds while it runs."""

    work: _PendingJob
    worker: Worker
    context: Context


class _JobsEnd(QObject):
    """Where jobs end: on the window's thread, which alone collects garbage and lets go of what a job held.

    A widget or controller that another thread frees is freed under Qt's feet, and the program is gone. So the collector
    pauses while jobs run, goes on from here, and a job's thread keeps nothing. With a large drawing one pass would stop
    every thread for 0.1 to 0.2 s besides.
    """

    ended = Signal(object)

    def __init__(self) -> None:
        super().__init__()
        self._jobs = 0
        self.ended.connect(self._on_ended, Qt.ConnectionType.QueuedConnection)

    def begin(self) -> None:
        """Count a job that is about to start."""
        self._jobs += 1
        gc.disable()

    @Slot(object)
    def _on_ended(self, held: list[_Held]) -> None:
        held.clear()
        self._jobs -= 1
        if self._jobs == 0:
            gc.enable()


@cache
def _jobs_end() -> _JobsEnd:
    """Return the one that there is; it belongs to the thread that asks first, the window's."""
    return _JobsEnd()


class _Runner(threading.Thread):
    """Runs one job. A daemon: a library call that does not return never keeps the program from ending."""

    def __init__(self, work: _PendingJob, worker: Worker) -> None:
        super().__init__(name=f"job {work.job_id}", daemon=True)
        self._held = [_Held(work, worker, copy_context())]
        self._end = _jobs_end()
        self._told, self._fraction = 0.0, 0.0
        self._head_start = worker.head_start_s

    def run(self) -> None:
        """Run the function and answer; nothing may escape from here. What the function holds is let go of with it."""
        try:
            self._start()
        finally:
            with suppress(RuntimeError):  # the program ends
                self._end.ended.emit(self._held)

    def _start(self) -> None:
        (held,) = self._held
        if not held.work.cancelled.wait(self._head_start):
            held.context.run(self._run, held.work)

    @property
    def _worker(self) -> Worker:
        return self._held[0].worker

    def _tell(self, job_id: int, fraction: float, text: str) -> None:
        self._fraction, now = fraction, time.monotonic()
        if now - self._told >= _TOLD_EVERY_S:
            self._told = now
            self._send(lambda: self._worker.told.emit(job_id, fraction, text))

    def _remark(self, job_id: int, text: str) -> None:
        self._send(lambda: self._worker.remark_told.emit(job_id, text))

    def _send(self, emit: Callable[[], None]) -> None:
        """Emit a signal of the worker; where the window has gone, and it with it, nobody waits for the job.

        Raises:
            Cancelled: it has gone.
        """
        try:
            emit()
        except RuntimeError as gone:
            if isValid(self._worker):
                raise
            raise Cancelled from gone

    def _run(self, work: _PendingJob) -> None:
        value, error, again = None, None, True
        try:
            progress = Progress(
                partial(self._tell, work.job_id), work.cancelled, remarks=partial(self._remark, work.job_id)
            )
            waits = waits_reported_to(lambda text: progress.step(self._fraction, text))
            with within(budget_limit()), waits:
                value = work.function(progress)
        except Cancelled:
            return
        except MemoryShortError as short:
            error = short.in_window()
        except MemoryError:
            limit = in_words(budget_limit())
            error = (
                f"The memory that a job may take ({limit}) ran out; allow more in the menu Compute, Memory of a job, "
                "or ask for less: a larger tool, fewer cells, a coarser bitmap. Your drawing is safe."
            )
        except HitofudeError as sentence:
            error, again = str(sentence), False
        except Exception as fault:
            traceback.print_exc()
            error = (
                f"The program made a mistake here ({type(fault).__name__}: {fault}). Your drawing is safe; please "
                "report this."
            )
        if not work.cancelled.is_set():
            outcome = JobOutcome(work.job_id, work.revision, value, error, again and error is not None)
            with suppress(Cancelled):
                self._send(lambda: self._worker.answered.emit(outcome))


class Worker(QObject):
    """Runs one job at a time for the window.

    A newer job replaces the one before, whose answer is dropped. `cancel` takes effect at once: the job is asked to
    stop, and whatever it still answers is dropped.

    Attributes:
        head_start_s: how long the window has for itself before a job begins, s; jobs that take less than that need
            none.
    """

    progress = Signal(float, str)
    remarked = Signal(str)
    done = Signal(JobOutcome)
    failed = Signal(JobOutcome)
    cancelled = Signal(int)
    busy_changed = Signal(bool)
    told = Signal(int, float, str)
    remark_told = Signal(int, str)
    answered = Signal(JobOutcome)

    def __init__(self, parent: QObject | None = None, head_start_s: float = HEAD_START_S) -> None:
        super().__init__(parent)
        self.head_start_s = head_start_s
        sys.setswitchinterval(SWITCH_INTERVAL_S)
        self._threads: list[_Runner] = []
        self._next_id = 1
        self._current: _PendingJob | None = None
        self.told.connect(self._on_told, Qt.ConnectionType.QueuedConnection)
        self.remark_told.connect(self._on_remark, Qt.ConnectionType.QueuedConnection)
        self.answered.connect(self._on_answered, Qt.ConnectionType.QueuedConnection)

    @property
    def busy(self) -> bool:
        """True while a job runs whose answer is still wanted."""
        return self._current is not None

    @property
    def job_id(self) -> int | None:
        """The job whose answer is still wanted; None where there is none."""
        return self._current.job_id if self._current is not None else None

    def start(
        self, function: Callable[[Progress], Answer], revision: int, take: Callable[[Answer], None] | None = None
    ) -> int:
        """Run `function(progress)` on another thread; its inputs must be a snapshot that nobody changes.

        Args:
            take: called on this thread with what the function returned, after `done`; not where it failed or was left.

        Returns:
            The job's id, as in the answer.
        """
        replaced = self._drop()
        work = _PendingJob(self._next_id, revision, function, threading.Event(), take)
        self._next_id += 1
        self._current = work
        self._threads = [thread for thread in self._threads if thread.is_alive()]
        runner = _Runner(work, self)
        self._threads.append(runner)
        _jobs_end().begin()
        runner.start()
        if replaced is not None:
            self.cancelled.emit(replaced.job_id)
        self.busy_changed.emit(True)
        return work.job_id

    def cancel(self) -> None:
        """Leave the running job at once; its answer will be dropped."""
        dropped = self._drop()
        if dropped is not None:
            self.cancelled.emit(dropped.job_id)
            self.busy_changed.emit(False)

    def finish(self, wait_s: float = 2.0) -> None:
        """Leave the running job and wait for its thread, before the program ends."""
        self._drop()
        for thread in self._threads:
            thread.join(wait_s)
        end = _jobs_end()
        if isValid(end):  # the program may be at its end
            QCoreApplication.sendPostedEvents(end)

    def _drop(self) -> _PendingJob | None:
        work, self._current = self._current, None
        if work is not None:
            work.cancelled.set()
        return work

    @Slot(int, float, str)
    def _on_told(self, job_id: int, fraction: float, text: str) -> None:
        if self._current is not None and self._current.job_id == job_id:
            self.progress.emit(fraction, text)

    @Slot(int, str)
    def _on_remark(self, job_id: int, sentence: str) -> None:
        if self._current is not None and self._current.job_id == job_id:
            self.remarked.emit(sentence)

    @Slot(JobOutcome)
    def _on_answered(self, answer: JobOutcome) -> None:
        if self._current is None or self._current.job_id != answer.job_id:
            return
        take, self._current = self._current.take, None
        self.busy_changed.emit(False)
        if answer.error is not None:
            self.failed.emit(answer)
            return
        self.done.emit(answer)
        if take is not None:
            take(answer.value)
