"""Lines of the shape language carried out for the window: short ones at once, long ones on a thread, with progress and
cancel.
"""

from __future__ import annotations

import time
from collections import deque

from PySide6.QtCore import QObject, Signal

from ....core.errors import Cancelled, InputError
from ....core.progress import Progress
from ....drafting.document import Document, evaluated
from ....drafting.language.interpret import Outcome
from ...framework.worker import JobOutcome, Worker
from ..canvas.command_trials import keeps_the_window

AT_ONCE_S = 0.03
"""A line may keep the window for so long; what takes longer begins again on a thread."""

_AT_ONCE_LETTERS = 2_000
"""Longer texts go to the thread unread: reading them alone would be felt."""


class CommandRunner(QObject):
    """Carries out lines one after the other, in the order in which they were given.

    A line that is on its way begins again when the drawing is changed under it, so that what it makes is always made of
    the drawing as it is.

    Signals:
        ran(line, well): it was carried out, or refused.
    """

    ran = Signal(str, bool)

    def __init__(self, document: Document, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._document = document
        self.worker = Worker(self, head_start_s=0.0)
        self._waiting: deque[str] = deque()
        self._line = ""
        self.worker.done.connect(self._on_done)
        self.worker.failed.connect(self._on_failed)

    @property
    def busy(self) -> bool:
        """Whether a line is on its way."""
        return self.worker.busy

    def run(self, line: str) -> None:
        """Carry out a line; what is wrong with it stands in the log."""
        if self.worker.busy:
            self._waiting.append(line)
        else:
            self._run(line)

    def cancel(self) -> None:
        """Leave the line on its way and those that wait; nothing of them is carried out."""
        self._waiting.clear()
        self.worker.cancel()

    def _run(self, line: str) -> None:
        if len(line) > _AT_ONCE_LETTERS or keeps_the_window(line, self._document):
            self._begin(line)
            return
        try:
            self._document.run(line, _for_a_moment())
        except Cancelled:
            self._begin(line)
        except InputError:
            self.ran.emit(line, False)
        else:
            self.ran.emit(line, True)

    def _begin(self, line: str) -> None:
        session, self._line = self._document.session, line
        self.worker.start(lambda progress: evaluated(line, session, progress), self._document.revision)

    def _on_done(self, answer: JobOutcome) -> None:
        if answer.revision != self._document.revision:
            self._begin(self._line)
            return
        assert isinstance(answer.value, Outcome)
        self._document.accept(self._line, answer.value)
        self._go_on(well=True)

    def _on_failed(self, answer: JobOutcome) -> None:
        self._document.refuse(self._line, answer.error or "")
        self._go_on(well=False)

    def _go_on(self, well: bool) -> None:
        self.ran.emit(self._line, well)
        while self._waiting and not self.worker.busy:
            self._run(self._waiting.popleft())


def _for_a_moment() -> Progress:
    """Return a progress that cancels what takes too long for the window's own thread."""
    end = time.monotonic() + AT_ONCE_S

    def listen(fraction: float, text: str) -> None:
        if time.monotonic() > end:
            raise Cancelled

    return Progress(listen)
