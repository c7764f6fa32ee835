"""Lanes: each does one part of a batch at a time, in a process of its own or on an executor of others, such as a
cluster's.
"""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
from collections.abc import Callable
from concurrent.futures import BrokenExecutor, Executor, Future, ProcessPoolExecutor
from contextlib import suppress
from dataclasses import dataclass
from multiprocessing.connection import Connection
from time import monotonic
from typing import Any, Protocol

from ...core.progress import NO_PROGRESS, Progress
from .task import BatchResult, BatchTask, NamedTask

Work = Callable[[Any, Progress], BatchResult]

_EVERY = 0.2
"""Seconds between two words of a worker about how far it is."""


@dataclass(frozen=True)
class LaneNews:
    """How far a lane is with its part.

    Attributes:
        fraction: of the part, in [0, 1]. text: what it does; "" = nobody knows.
    """

    fraction: float = 0.0
    text: str = ""


def do_part(task: BatchTask, progress: Progress = NO_PROGRESS) -> BatchResult:
    """Do a part of a batch; what it takes is imported where it is done, and not by whoever hands parts out."""
    from .work import work

    return work(task, progress)


class Lane(Protocol):
    """What does one part at a time."""

    def submit(self, task: NamedTask) -> Future[BatchResult]:
        """Begin with a part; the future raises BrokenExecutor, or whatever the executor says, where the process of the
        part has died.
        """

    def news(self) -> LaneNews:
        """Return how far the part is."""

    @property
    def ready(self) -> bool:
        """Whether what does the part is there, so that its time runs."""

    def renew(self, future: Future[BatchResult]) -> None:
        """Give up the part and be ready for the next."""

    def close(self) -> None:
        """End, whatever is still being done."""


class ProcessLane:
    """A process of this machine. Whoever kills it ends the one part that it works on."""

    def __init__(self, work: Work = do_part) -> None:
        """Make a lane; its process begins with the first part.

        Args:
            work: does a part.
        """
        self._work = work
        self._context = multiprocessing.get_context("spawn")  # a copy of a process with threads may wait for ever
        self._executor: ProcessPoolExecutor | None = None
        self._hears: Connection | None = None
        self._pid = 0
        self._news = LaneNews()

    @property
    def pid(self) -> int:
        """The process's number; 0 until it has begun."""
        self._listen()
        return self._pid

    @property
    def ready(self) -> bool:
        """Whether its process has begun."""
        return self.pid != 0

    def submit(self, task: NamedTask) -> Future[BatchResult]:
        """Begin with a part."""
        self._news = LaneNews()
        try:
            return self._begun().submit(_told_work, self._work, task)
        except BrokenExecutor:  # it died between two parts
            self.close()
            return self._begun().submit(_told_work, self._work, task)

    def _begun(self) -> ProcessPoolExecutor:
        if self._executor is None:
            self._hears, tells = self._context.Pipe(duplex=False)
            self._executor = ProcessPoolExecutor(1, self._context, _begin, (tells,))
        return self._executor

    def news(self) -> LaneNews:
        """Return how far the part is."""
        self._listen()
        return self._news

    def _listen(self) -> None:
        with suppress(EOFError, OSError):
            while self._hears is not None and self._hears.poll():
                heard = self._hears.recv()
                if isinstance(heard, LaneNews):
                    self._news = heard
                else:
                    self._pid = int(heard)

    def renew(self, future: Future[BatchResult]) -> None:
        """End the process; the next part begins another one."""
        self.close()

    def close(self) -> None:
        """End the process."""
        if self._executor is None:
            return
        self._listen()
        for child in multiprocessing.active_children():
            if child.pid == self._pid:
                child.kill()
        self._executor.shutdown(wait=self._pid != 0, cancel_futures=True)
        if self._hears is not None:
            self._hears.close()
        self._executor, self._hears, self._pid = None, None, 0


_TELLS: list[Connection] = []
"""In a worker: where it says how far it is."""


def _begin(tells: Connection) -> None:
    """Make a process a worker: Ctrl+C is its parent's to hear, and it ends with its parent."""
    for name in ("SIGINT", "SIGHUP"):
        if hasattr(signal, name):
            signal.signal(getattr(signal, name), signal.SIG_IGN)
    _TELLS[:] = [tells]
    tells.send(os.getpid())
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)


def _told_work(work: Work, task: NamedTask) -> BatchResult:
    """Do a part and say on the way how far it is."""
    said = 0.0

    def told(fraction: float, text: str) -> None:
        nonlocal said
        if monotonic() - said > _EVERY:
            said = monotonic()
            with suppress(OSError):
                _TELLS[0].send(LaneNews(fraction, text))

    return work(task, Progress(told))


class ExecutorLane:
    """A place on an executor of somebody else's, such as `Client.get_executor()` of Dask, which has its own ways with
    workers that die.
    """

    def __init__(self, executor: Executor, work: Work = do_part) -> None:
        """Make a lane of an executor; several may share it.

        Args:
            executor: stays open.
            work: does a part.
        """
        self._executor, self._work = executor, work
        self._futures: set[Future[BatchResult]] = set()

    def submit(self, task: NamedTask) -> Future[BatchResult]:
        """Begin with a part."""
        future = self._executor.submit(self._work, task)  # type: ignore[call-arg]  # its progress has a default
        self._futures = {future}
        return future

    @property
    def ready(self) -> bool:
        """Nobody knows, so its time runs."""
        return True

    def news(self) -> LaneNews:
        """Nobody knows how far it is."""
        return LaneNews()

    def renew(self, future: Future[BatchResult]) -> None:
        """Give up the part, where the executor can."""
        future.cancel()

    def close(self) -> None:
        """Give up what is still being done."""
        for future in self._futures:
            future.cancel()
