"""Has the film of a text made when it is to be seen, of its sample or of one's own file, and writes it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QFileDialog

from ....core.atomic import write_together
from ....core.errors import InputError
from ....core.progress import Progress
from ...framework.controller import Controller
from ...framework.figures import counted
from ...framework.missing import NOTHING, MissingHint, failed_hint
from ...framework.worker import JobOutcome, Worker
from ...framework.workspace import Workspace
from .own_cut import own_cut
from .text_film_panel import TextFilmPanel
from .view import StagesView

if TYPE_CHECKING:
    from ....exhibits.films.making import FilmSource
    from ....exhibits.films.step import TextFilm

OwnFile = Callable[[str], "FilmSource | None"]
"""Gives the file that is open for a text, by its letter; None where there is none."""

_NO_OWN = {
    "C": "No scene is open. Open one in Surfaces, or see the sample.",
    "": "No program is shown. Open one in NC, or see the sample.",
}


class TextFilmController(Controller):
    """Follows the choice of the text at the head of the Stages view.

    Signals:
        text_changed(): another text is shown.

    Attributes:
        worker: makes films. error: why the last one could not be made, or "".
    """

    text_changed = Signal()

    def __init__(self, view: StagesView, panel: TextFilmPanel, own: OwnFile, workspace: Workspace) -> None:
        super().__init__(view)
        self._view, self._panel, self._own, self._preferences = view, panel, own, workspace.preferences
        self.worker = Worker(self)
        self.error, self._may_retry = "", False
        self._asked: TextFilmRequest | None = None
        self._seen = False
        workspace.activity.follow(self.worker)
        self.worker.failed.connect(self._on_failed)
        self.worker.cancelled.connect(lambda _: self.changed.emit())
        self.worker.busy_changed.connect(lambda _: self.changed.emit())
        view.text_chosen.connect(lambda _: self._choose())
        view.films.shown.connect(lambda: panel.show_step(view.films.step))
        panel.own_chosen.connect(lambda _: self._follow())
        panel.save_requested.connect(self.choose_folder)

    @property
    def missing(self) -> MissingHint:
        """What there is to say in the place of the film."""
        if self.worker.busy:
            return MissingHint("The steps are being computed.", "Cancel  Shift+F5", "cancel")
        if self.error:
            return failed_hint(self.error, self._may_retry, "stages_again")
        if self._view.films.film is None:
            return MissingHint("The steps are not computed yet.", "Compute the stages", "stages_again")
        return NOTHING

    def see(self, seen: bool) -> None:
        """The view is at the front, or no longer."""
        self._seen = seen
        if seen:
            self._follow()
        else:
            self._view.films.player.pause()

    def again(self) -> None:
        """Make the film, also where that failed or was cancelled."""
        self._asked = None
        self._follow()

    def _choose(self) -> None:
        from ....exhibits.films.step import TEXTS

        text = TEXTS[self._view.text]
        self._panel.show_text(f"{text.value}  {text.title}", text.number)
        self._follow()
        self.text_changed.emit()
        self.changed.emit()

    def _follow(self) -> None:
        """Make the film that is to be seen, unless it is there, on its way, or was asked for and failed."""
        letter = self._view.text
        if not self._seen or letter == "A":
            self._view.films.player.pause()
            return
        wants_own = self._panel.source.value is True
        source = self._own(letter) if wants_own else None
        if wants_own and source is None:
            self.worker.cancel()
            self._asked, self.error, self._may_retry = None, _NO_OWN.get(letter, _NO_OWN[""]), False
            self._show(None)
            return
        asked = TextFilmRequest(letter, source)
        if self._asked is not None and asked.is_alike(self._asked):
            return
        self._asked, self.error = asked, ""
        self._show(None)
        self.worker.start(lambda progress: _made(letter, source, progress), 0, self._on_made)
        self.changed.emit()

    def _show(self, film: TextFilm | None) -> None:
        self._view.films.show_film(film)
        self._panel.show_film(film)
        self.changed.emit()

    def _on_made(self, film: TextFilm) -> None:
        """Show a film, unless another text was chosen meanwhile."""
        if film.text.value == self._view.text:
            self._show(film)

    def _on_written(self, written: WrittenFilm) -> None:
        self.said.emit(f"{counted(written.steps, 'step')} saved in {written.folder}")

    def _on_failed(self, answer: JobOutcome) -> None:
        if self._view.films.film is not None:  # it is there, but could not be written
            self.failed.emit(answer.error or "")
            return
        self.error, self._may_retry = answer.error or "", answer.again  # said in the place of the film
        self._show(None)

    def choose_folder(self) -> None:
        """Ask where all steps go, and write them."""
        film = self._view.films.film
        if film is None:
            return
        start = str(self._preferences.last_folder)
        name = QFileDialog.getExistingDirectory(self._view, "Save all steps", start)
        if name:
            self.save(Path(name))

    def save(self, folder: Path) -> None:
        """Have pictures, tables and figures of all steps written into a folder: whole or not at all."""
        film = self._view.films.film
        if film is not None and not self.worker.busy:
            self.worker.start(lambda progress: _written(film, folder, progress), 0, self._on_written)


@dataclass(frozen=True, slots=True)
class TextFilmRequest:
    """What film was asked for: of which text, by its letter, and of which file; None = the text's sample."""

    letter: str
    source: FilmSource | None

    def is_alike(self, other: TextFilmRequest) -> bool:
        """Tell whether another request comes to the same film: files count by what is in them."""
        return (self.letter, *self._file) == (other.letter, *other._file)

    @property
    def _file(self) -> tuple[object, ...]:
        source = self.source
        return () if source is None else (source.name, source.data, source.reading, dict(source.tools), source.stock)


@dataclass(frozen=True, slots=True)
class WrittenFilm:
    """What was written: how many steps, and where."""

    steps: int
    folder: Path


def _written(film: TextFilm, folder: Path, progress: Progress) -> WrittenFilm:
    """Write a film's files; on the worker's thread.

    Raises:
        InputError: the folder is none, or cannot be written to.
    """
    from ....exhibits.films.making import film_files

    if not folder.is_dir():
        raise InputError(f"{folder} is no folder; choose another one.")
    write_together({folder / name: data for name, data in film_files(film, progress).items()})
    return WrittenFilm(len(film.steps), folder)


def _made(letter: str, source: FilmSource | None, progress: Progress) -> TextFilm:
    """Return a text's film; on the worker's thread."""
    from ....exhibits.films.making import make_film
    from ....exhibits.films.step import TEXTS

    text, cutting = TEXTS[letter], None
    if letter == "B" and source is not None:
        cutting = own_cut(source, progress.part(0.0, 0.1))
    return make_film(text, source, progress=progress.part(0.1, 1.0), cutting=cutting)
