"""Work that does not depend on what a job does next, on a thread of its own beside it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from concurrent.futures import wait as wait_for
from contextlib import contextmanager
from contextvars import ContextVar, copy_context
from dataclasses import replace
from typing import Generic, NamedTuple, TypeVar

from .errors import Cancelled
from .progress import Progress, waits_reported_to

Result = TypeVar("Result")

_LOOK_S = 0.1
"""Seconds between two looks at whether a job that waits shall stop."""

_IN_TURN = ContextVar("in_turn", default=False)
"""Whether nothing goes on beside anything."""


class _Told(NamedTuple):
    """How far work is, of all of its job, and what it does."""

    fraction: float
    text: str


class BesideWork(Generic[Result]):
    """Work on a thread of its own, or not yet begun."""

    def __init__(self, work: Callable[[Progress], Result], progress: Progress, executor: ThreadPoolExecutor | None):
        """Begin the work; without an executor it is done when its result is asked for.

        Args:
            work: it may use the shared pool.
            progress: of the job; what the work tells is told by whoever waits for it, on that thread.
        """
        self._work, self._progress = work, progress
        self._given_up = False
        self._last = _Told(progress.start, "")
        self._future: Future[Result] | None = None
        if executor is not None:
            self._future = executor.submit(copy_context().run, self._run)

    def _run(self) -> Result:
        with waits_reported_to(lambda text: self._told(self._last.fraction, text)):
            return self._work(replace(self._progress, listener=self._told, remarks=None))

    def _told(self, fraction: float, text: str) -> None:
        stop = self._progress.cancelled
        if self._given_up or (stop is not None and stop.is_set()):
            raise Cancelled
        self._last = _Told(fraction, text or self._last.text)

    def result(self) -> Result:
        """Return what the work gives, once it is done.

        Raises:
            Cancelled: the job was asked to stop, and any error of the work itself.
        """
        if self._future is None:
            self._future = Future()
            self._future.set_result(self._work(self._progress))
        whole = replace(self._progress, start=0.0, stop=1.0)
        while not wait_for([self._future], _LOOK_S).done:
            whole.step(*self._last)
        return self._future.result()

    def give_up(self) -> None:
        """Have the work end at its next step."""
        self._given_up = True


@contextmanager
def one_after_another() -> Iterator[None]:
    """Have nothing go on beside a job: who measures its stages then knows whose the time is."""
    token = _IN_TURN.set(True)
    try:
        yield
    finally:
        _IN_TURN.reset(token)


@contextmanager
def beside(
    work: Callable[[Progress], Result], progress: Progress, at_once: bool = True
) -> Iterator[BesideWork[Result]]:
    """Have work done while a job goes on with what does not need it; it has ended when the context is left.

    Work that computes in compiled code takes the other core where this one is in the interpreter. What both hold at a
    time is held together.

    Args:
        work: takes its progress, and uses nothing that the job changes meanwhile.
        progress: the part of the job that the work is.
        at_once: False: it is done by the job itself when it asks for the result.
    """
    if not at_once or _IN_TURN.get():
        yield BesideWork(work, progress, None)
        return
    with ThreadPoolExecutor(1, thread_name_prefix="beside") as executor:
        begun = BesideWork(work, progress, executor)
        try:
            yield begun
        finally:
            begun.give_up()
