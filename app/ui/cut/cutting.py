"""Shows the cut of the job's program as soon as it is computed."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal

from app.progress import Progress
from app.ui.computation import State
from app.ui.cut.colouring import CutColour, key_of
from app.ui.cut.cut_panel import colour_of
from app.ui.cut.entries import Entry, EntryColour
from app.ui.cut.inks import inks_of
from app.ui.cut.overlay import Pin
from app.ui.cut.shown_cut import ProgramFile, ShownCut, shown_cut
from app.ui.cut.zooming import Zooming
from app.ui.main_window import MainWindow
from app.ui.worker import Answer, Worker

if TYPE_CHECKING:
    from app.workflow.make import Made


def job_shown(made: Made, name: str, colour: CutColour, progress: Progress) -> ShownCut | None:
    """Return the cut that came with the job's program, prepared; None where nothing was cut.

    Raises:
        Cancelled: the job was asked to stop.
    """
    if made.cut is None:
        return None
    files = tuple(ProgramFile(f"{name}{file.suffix}", file.nc.text.encode("ascii")) for file in made.files)
    return shown_cut(made.cut, files, colour, progress)


class Cutting(QObject):
    """Follows the computation; its own worker, so that it never holds up computing.

    Signals:
        shown(): the view shows another cut, or none. failed(sentence).

    Attributes:
        cut: what is shown; None = nothing.
    """

    shown = Signal()
    failed = Signal(str)

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window, self._view, self._computation = window, window.views.cut, window.computation
        self.cut: ShownCut | None = None
        self._made: object = None
        self._job_id: int | None = None
        self.worker = Worker(self)
        self.worker.done.connect(self._on_done)
        self.worker.failed.connect(self._on_failed)
        self.zooming = Zooming(self._view, self)
        self.zooming.failed.connect(self.failed)
        window.status.cancelled.connect(self.worker.cancel)
        for worker in (self.worker, self.zooming.worker, self._view.colours.worker):
            window.closed.connect(worker.finish)
        self._computation.changed.connect(self._follow)
        self._view.colours.known.connect(self._show_key)
        self._panel = window.cut_panel
        self._panel.picked.connect(self._go_to)

    def _follow(self) -> None:
        made = self._computation.made
        if made is self._made or self._computation.state is State.RUNNING:
            return
        self._made = made
        if made is None or made.cut is None:
            self._show(None)
            return
        name, colour = made.job.part.name, self._view.colour
        self._job_id = self.worker.start(lambda progress: job_shown(made, name, colour, progress), 0)

    def _show(self, cut: ShownCut | None) -> None:
        self.cut = cut
        self._view.show_cut(cut.picture if cut is not None else None)
        self.zooming.follow(cut.cut if cut is not None else None)
        self._panel.show_cut(cut)
        self._show_key()
        self.shown.emit()

    def _show_key(self) -> None:
        """The histogram has the colours of the deviation, whatever the metal's tell."""
        if self.cut is not None and self.cut.histogram is not None:
            picture = self.cut.picture
            self._panel.show_key(key_of(picture, CutColour.DEVIATION, inks_of(self._view.colours.theme), picture.span))

    def _go_to(self, entry: Entry) -> None:
        """Glide to a place; gouges and metal left are seen best by their deviation."""
        if entry.place is None:
            return
        if entry.colour is not EntryColour.ACCIDENT and self._view.picture is not None and self._view.picture.deviation is not None:
            self._view.set_colour(CutColour.DEVIATION)
        theme = self._view.colours.theme
        self._view.go_to(Pin(entry.place, entry.title, entry.words, colour_of(entry.colour, theme)), entry.field)

    def _on_done(self, answer: Answer) -> None:
        if answer.job_id == self._job_id and isinstance(answer.value, ShownCut):
            self._show(answer.value)

    def _on_failed(self, answer: Answer) -> None:
        if answer.job_id == self._job_id:
            self.failed.emit(answer.error or "")
