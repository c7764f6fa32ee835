"""The page of the drawing in words, at the right of the drawing."""

from __future__ import annotations

from PySide6.QtCore import QObject

from ..framework.section import theme_children
from ..framework.view import View
from .display_controller import DisplayController
from .drawing.shape_language_controller import ShapeLanguageController
from .main_window import MainWindow

PAGE = "Text"


class TextPageCoordinator(QObject):
    """Puts the page into the window, and lets its controller know when it is seen."""

    def __init__(self, window: MainWindow, display: DisplayController, language: ShapeLanguageController) -> None:
        super().__init__(window)
        self._window, self._display, self._text = window, display, language.control
        language.help.set_theme(window.theme)
        window.side.add_page(PAGE, self._text.page, "the drawing in words")
        theme_children(window.side, window.theme)
        window.side.chosen.connect(self._on_side_page)
        self._text.page.editor.left.connect(window.canvas.setFocus)
        self._text.tried.connect(window.canvas.show_trial)
        self._text.front_requested.connect(self._show)
        display.view_changed.connect(lambda _: self._see())

    def _on_side_page(self, name: str) -> None:
        self._display.writing = name == PAGE
        self._display.show_missing()
        self._see()

    def _see(self) -> None:
        self._text.see(self._display.view in (View.DRAW, View.PATHS))

    def _show(self) -> None:
        if self._display.view not in (View.DRAW, View.PATHS):
            self._display.show_view(View.DRAW)
        self._window.side.show_page(PAGE)
