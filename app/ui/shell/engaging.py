"""Colours the paths by engagement when that is asked for: measured on a worker of its own, once for each result."""

from __future__ import annotations

from PySide6.QtCore import QObject

from ...core.progress import Progress
from ...usecases.make import Made
from ..framework.worker import Answer, Worker
from ..views.canvas.modes import ColourBy
from ..views.canvas.program_picture import ProgramPicture
from .computation import Computation
from .main_window import MainWindow


def engaged_picture(made: Made, progress: Progress) -> ProgramPicture:
    """Return the moves of a result prepared for painting, stretch by stretch of engagement."""
    from ...toolpath.engagement.engagement import look
    from ..views.canvas.stretches import stretches

    seen = look(made.program, made.job, progress)
    return ProgramPicture(made.program, made.coverage.places, stretches(made.program.moves, seen))


class Engaging(QObject):
    """Follows the legend's choice and the computation."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self._computation: Computation = window.computation
        self.worker = Worker(self)
        self._for: Made | None = None
        window.views.legend.colour_chosen.connect(lambda _: self._follow())
        self._computation.changed.connect(self._follow)
        self.worker.done.connect(self._on_done)
        self.worker.progress.connect(window.status.show_progress)
        self.worker.busy_changed.connect(self._on_busy)
        window.status.cancelled.connect(self.worker.cancel)
        window.closed.connect(self.worker.finish)

    def _follow(self) -> None:
        """Measure what is shown, where it is to be coloured so and was not measured yet."""
        made = self._computation.made
        if self._window.canvas.colour_by is not ColourBy.ENGAGEMENT or made is None or made is self._for:
            return
        self._for = made
        self.worker.start(lambda progress: (made, engaged_picture(made, progress)), 0)

    def _on_done(self, answer: Answer) -> None:
        assert isinstance(answer.value, tuple)
        made, picture = answer.value
        if made is self._computation.made:
            self._window.canvas.set_program(picture)

    def _on_busy(self, busy: bool) -> None:
        if busy or not self._window.worker.busy:
            self._window.status.show_progress(0.0 if busy else None)
