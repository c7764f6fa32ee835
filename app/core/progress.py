"""How a long computation tells how far it is, and learns that it should stop."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace

from .errors import Cancelled

Listener = Callable[[float, str], None]
Remarks = Callable[[str], None]


@dataclass(frozen=True)
class Progress:
    """One job's progress, or a part of it.

    Attributes:
        listener: called with (fraction in [0, 1] of the whole job, text); called on the job's own thread.
        cancelled: set by anybody who wants the job to stop.
        start, stop: the part of the whole job, in [0, 1], that this object reports on.
        remarks: called with a sentence that is to be heard at once, not at the end; on the job's own thread.
    """

    listener: Listener | None = None
    cancelled: threading.Event | None = None
    start: float = 0.0
    stop: float = 1.0
    remarks: Remarks | None = None

    def step(self, fraction: float, text: str = "") -> None:
        """Report that `fraction` in [0, 1] of this part is done.

        Raises:
            Cancelled: the job was asked to stop.
        """
        if self.cancelled is not None and self.cancelled.is_set():
            raise Cancelled
        if self.listener is not None:
            self.listener(self.start + (self.stop - self.start) * fraction, text)

    def remark(self, sentence: str) -> None:
        """Say something that its user should hear before the work goes on."""
        if self.remarks is not None:
            self.remarks(sentence)

    def part(self, start: float, stop: float) -> Progress:
        """Return a progress for the sub-step from `start` to `stop`, both in [0, 1] of this part."""
        span = self.stop - self.start
        return replace(self, start=self.start + span * start, stop=self.start + span * stop)


NO_PROGRESS = Progress()


Waiter = Callable[[str], None]


class _WaitListeners(threading.local):
    """Who is told what a job waits for: on this thread, or else on all."""

    everywhere: Waiter | None = None
    here: Waiter | None = None


_WAITS = _WaitListeners()


@contextmanager
def waits_reported_to(waiter: Waiter, everywhere: bool = False) -> Iterator[None]:
    """Have `waiter` told, again and again, what work waits for that can say no fraction of its own.

    Args:
        waiter: called on the thread that waits; it may raise Cancelled.
        everywhere: on all threads that have no waiter of their own, instead of on this one.
    """
    holder, name = (_WaitListeners, "everywhere") if everywhere else (_WAITS, "here")
    before = getattr(holder, name)
    setattr(holder, name, waiter)
    try:
        yield
    finally:
        setattr(holder, name, before)


def report_wait(text: str) -> None:
    """Tell whoever wants to know that this thread waits.

    Raises:
        Cancelled: there is no need to wait any longer.
    """
    waiter = _WAITS.here or _WaitListeners.everywhere
    if waiter is not None:
        waiter(text)
