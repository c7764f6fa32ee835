"""How a long computation tells how far it is, and learns that it should stop."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass

from app.errors import Cancelled

Listener = Callable[[float, str], None]


@dataclass(frozen=True)
class Progress:
    """One job's progress, or a part of it.

    Attributes:
        listener: called with (fraction in [0, 1] of the whole job, text); called on the job's own thread.
        cancelled: set by anybody who wants the job to stop.
        start, stop: the part of the whole job, in [0, 1], that this object reports on.
    """

    listener: Listener | None = None
    cancelled: threading.Event | None = None
    start: float = 0.0
    stop: float = 1.0

    def step(self, fraction: float, text: str = "") -> None:
        """Report that `fraction` in [0, 1] of this part is done.

        Raises:
            Cancelled: the job was asked to stop.
        """
        if self.cancelled is not None and self.cancelled.is_set():
            raise Cancelled
        if self.listener is not None:
            self.listener(self.start + (self.stop - self.start) * fraction, text)

    def part(self, start: float, stop: float) -> Progress:
        """Return a progress for the sub-step from `start` to `stop`, both in [0, 1] of this part."""
        span = self.stop - self.start
        return Progress(self.listener, self.cancelled, self.start + span * start, self.start + span * stop)


NO_PROGRESS = Progress()
