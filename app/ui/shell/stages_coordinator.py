"""What the controllers of the Stages view have the window show: films of the texts, and pictures that become a part."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QObject

from ..framework.commands import on_trigger
from ..framework.view import View
from ..views.stages.controller import StagesController
from ..views.stages.import_controller import ImportController
from ..views.stages.text_film_controller import TextFilmController
from .display_controller import DisplayController
from .main_window import MainWindow


class StagesCoordinator(QObject):
    """Connects the controllers of the Stages view with the window."""

    def __init__(
        self,
        window: MainWindow,
        display: DisplayController,
        stages: StagesController,
        films: TextFilmController,
        pictures: ImportController,
    ) -> None:
        super().__init__(window)
        self._window, self._display = window, display
        self._stages, self._films, self._pictures = stages, films, pictures
        display.on_picture = lambda: pictures.preview is not None and display.view is View.STAGES
        stages.changed.connect(self._show_missing)
        films.changed.connect(self._show_missing)
        on_trigger(window.actions_, "stages_again", self._again)
        pictures.shown.connect(self._show_picture)
        pictures.taken.connect(self._on_picture_taken)
        view = window.views.stages
        view.hovered.connect(display.show_hovered)
        view.pixels.cursor_moved.connect(window.status.show_place)

    def _again(self) -> None:
        (self._stages if self._window.views.stages.text == "A" else self._films).again()

    def _show_missing(self) -> None:
        self._display.stages_missing = self._stages.missing
        self._display.film_missing = self._films.missing

    def _show_picture(self) -> None:
        """Bring the picture to the front when it comes."""
        if self._pictures.preview is not None and self._display.view is not View.STAGES:
            self._display.show_view(View.STAGES)
        self._display.show_state()

    def _on_picture_taken(self, path: Path) -> None:
        self._window.workspace.preferences.add_recent(path)
        self._window.notice.turn_over()
        self._display.show_view(View.STAGES)
        self._window.canvas.fit()
