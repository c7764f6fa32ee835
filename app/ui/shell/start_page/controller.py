"""Fills the page that the window begins with, and does what is pressed there."""

from __future__ import annotations

import time
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from PySide6.QtCore import QObject, Signal
from PySide6.QtGui import QImage

from ....core.resources import resource
from ...framework.figures import counted
from ...framework.theme import Theme
from ...framework.worker import JobOutcome, Worker
from ...framework.workspace import Workspace
from .file_card import FileCard
from .page import COLUMNS, StartPage
from .thumbnail import thumbnail

MOST_FILES = 2 + COLUMNS
_DAY_S = 86_400.0
_SAMPLES = (
    ("plate.draw", "A plate", "cut out, with holes and slots"),
    ("nameplate.draw", "A sign", "engraved lettering"),
    ("die.toml", "A mould", "roughed and finished"),
    ("fig2.dxf", "Fig. 2 of 1986", "the patent's own drawing"),
)


@dataclass(frozen=True, slots=True)
class _Seen:
    """A file, when it was written, s, and the theme that it was painted in."""

    path: Path
    written: float
    theme: str


@dataclass(frozen=True, slots=True)
class _DuePicture:
    """The card whose picture is on its way."""

    card: FileCard
    seen: _Seen


class StartController(QObject):
    """Makes the cards and has their pictures painted one by one, on a worker of its own.

    Signals:
        shown(): the page shall come to the front.
    """

    shown = Signal()

    def __init__(self, page: StartPage, workspace: Workspace) -> None:
        super().__init__(page)
        self._page, self._preferences = page, workspace.preferences
        self._pictures: dict[_Seen, QImage] = {}
        self._left: list[FileCard] = []
        self._painting: _DuePicture | None = None
        self._theme: Theme | None = None
        self.worker = Worker(self)
        self.worker.done.connect(self._on_done)
        self.worker.failed.connect(lambda _: self._show(QImage()))
        workspace.activity.ended.connect(self.worker.finish)

    def open(self, theme: Theme) -> None:
        """Bring the page to the front, with the files as they are now."""
        from ....gcode.posts import post_titles

        self._theme = theme
        names = [Path(name) for name in self._preferences.settings.recent_files]
        files = [FileCard(path, path.name, _when(path)) for path in names if path.is_file()][:MOST_FILES]
        samples = [FileCard(resource("samples", name), title, words) for name, title, words in _SAMPLES]
        self._page.new.show_machines(list(post_titles().items()), "linuxcnc")
        self._page.show_files(files, samples)
        self.shown.emit()
        self._left = [*files, *samples]
        self._next()

    def close(self) -> None:
        """Nobody looks at the page any more."""
        self._left = []
        self.worker.cancel()

    def _next(self) -> None:
        """Have the next picture painted that nobody has painted yet."""
        while self._left and not self.worker.busy and self._theme is not None:
            card = self._left.pop(0)
            seen = _seen(card.path, self._theme)
            if seen is None:
                continue
            if seen in self._pictures:
                card.show_picture(self._pictures[seen])
                continue
            self._painting = _DuePicture(card, seen)
            self.worker.start(partial(thumbnail, card.path, card.picture_size, self._theme), 0)

    def _on_done(self, answer: JobOutcome) -> None:
        assert isinstance(answer.value, QImage)
        self._show(answer.value)

    def _show(self, picture: QImage) -> None:
        """Show the picture that was on its way, empty where there is none, and go on."""
        painting = self._painting
        assert painting is not None
        self._pictures[painting.seen] = picture
        if painting.card in (*self._page.files, *self._page.samples):
            painting.card.show_picture(picture)
        self._next()


def _seen(path: Path, theme: Theme) -> _Seen | None:
    try:
        return _Seen(path, path.stat().st_mtime, theme.name)
    except OSError:
        return None


def _when(path: Path) -> str:
    """Return when a file was written, in words."""
    days = int(time.time() // _DAY_S - path.stat().st_mtime // _DAY_S)
    return {0: "today", 1: "yesterday"}.get(days, f"{counted(days, 'day')} ago")
