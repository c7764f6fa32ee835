"""What a text would draw, tried on a thread a moment after the last key; the next key leaves it."""

from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtCore import QObject, QTimer, Signal

from ....core.errors import InputError
from ....core.progress import Progress
from ....drafting.commands.command import DraftingSession
from ....drafting.difference import DrawingDifference, difference
from ....drafting.document import tried
from ....drafting.expressions.errors import CommandError
from ...framework.worker import JobOutcome, Worker

REST_MS = 250


@dataclass(frozen=True, slots=True)
class TextProblem:
    """What is wrong with a text; line and column count from 1."""

    line: int
    column: int
    reason: str


@dataclass(frozen=True, slots=True)
class TextTrial:
    """What a text would make of the drawing.

    Attributes:
        curves: how many the drawing would have.
    """

    change: DrawingDifference
    curves: int


class TrialRunner(QObject):
    """Tries one text at a time; a newer one takes its place, once the thread of the older one has seen that it should
    stop.

    Signals:
        answered(TextTrial | TextProblem): about the text that was given last. progress(fraction, text).
    """

    answered = Signal(object)
    progress = Signal(float, str)

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.worker = Worker(self, head_start_s=0.0)
        self._timer = QTimer(self)
        self._timer.setSingleShot(True)
        self._timer.setInterval(REST_MS)
        self._timer.timeout.connect(self._start)
        self._text, self._session, self._fresh = "", DraftingSession(), False
        self._alive: set[object] = set()
        self.worker.progress.connect(self.progress)
        self.worker.done.connect(lambda answer: self._on_answer(answer.value))
        self.worker.failed.connect(self._on_failed)

    @property
    def busy(self) -> bool:
        """Whether an answer is still to come."""
        return self._timer.isActive() or self.worker.busy

    def ask(self, text: str, session: DraftingSession, fresh: bool) -> None:
        """Try a text soon.

        Args:
            text: in the shape language.
            session: of the drawing that it is compared with.
            fresh: begin with an empty drawing, not with that one.
        """
        self.worker.cancel()
        self._text, self._session, self._fresh = text, session, fresh
        self._timer.start()

    def leave(self) -> None:
        """Want no answer any more."""
        self._timer.stop()
        self.worker.cancel()

    def _start(self) -> None:
        if self._alive:
            self._timer.start()
            return
        text, session, fresh = self._text, self._session, self._fresh

        def run(progress: Progress) -> TextTrial | TextProblem:
            self._alive.add(progress)
            try:
                return _try(text, session, fresh, progress)
            finally:
                self._alive.discard(progress)

        self.worker.start(run, 0)

    def _on_answer(self, value: object) -> None:
        self.answered.emit(value)

    def _on_failed(self, answer: JobOutcome) -> None:
        self.answered.emit(TextProblem(1, 1, answer.error or ""))


def _try(text: str, session: DraftingSession, fresh: bool, progress: Progress) -> TextTrial | TextProblem:
    try:
        start = tried("clear", session) if fresh else session
        after = tried(text, start, progress)
    except CommandError as error:
        return TextProblem(error.line, error.column, error.reason)
    except InputError as error:
        return TextProblem(1, 1, str(error))
    return TextTrial(difference(session.part, after.part), len(after.part.entities))
