"""The drawing's page at the right side: who brings it to the front, and what is asked before a layer goes."""

from __future__ import annotations

from functools import partial

from PySide6.QtCore import QObject

from ...drafting.expressions.words import name_text
from ..framework.figures import counted
from ..framework.section import Section
from .main_window import MainWindow
from .showing import Showing
from .views import View

PAGE = "Drawing"


class Inspecting(QObject):
    """Shows properties, layers and history when the user asks for them."""

    def __init__(self, window: MainWindow, showing: Showing) -> None:
        super().__init__(window)
        self._window, self._showing = window, showing
        page = window.drawing_page
        for name, section in (
            ("properties", page.properties),
            ("layers", page.layers),
            ("history", page.history),
            ("clean_up", page.cleanup),
            ("reading", page.reading),
        ):
            window.actions_[name].triggered.connect(partial(self._show, section))
        page.refused.connect(lambda sentence: window.notice.ask(sentence, error=True))
        page.layers.removal.connect(self._ask_removal)

    def _show(self, section: Section, *_: object) -> None:
        """Bring a section of the page to the front, beside the drawing."""
        if self._window.side.isHidden():
            self._showing.show_view(View.DRAW)
        self._window.side.show_page(PAGE)
        self._window.drawing_page.show_section(section)

    def _ask_removal(self, layer: str, on_it: int) -> None:
        question = f"Layer {layer} has {counted(on_it, 'curve')} on it. Remove the layer with all that is on it?"
        remove = partial(self._window.drawing_page.run, f"remove layer {name_text(layer)}")
        self._window.notice.ask(question, (("Remove", remove), ("Keep", lambda: None)))
