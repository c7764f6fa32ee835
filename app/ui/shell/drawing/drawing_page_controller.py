"""The drawing's page at the right side: who brings it to the front, and what is asked before a layer goes."""

from __future__ import annotations

from functools import partial

from ....drafting.expressions.words import name_text
from ...framework.commands import Commands, on_trigger
from ...framework.controller import Controller
from ...framework.figures import counted
from ...framework.notice import Notice
from ...framework.section import PanelSection
from ...panels.drawing_page import DrawingPage

PAGE = "Drawing"


class DrawingPageController(Controller):
    """Shows properties, layers and history when the user asks for them; `front_requested` asks for the whole page."""

    def __init__(self, page: DrawingPage, notice: Notice, commands: Commands) -> None:
        super().__init__(page)
        self._page, self._notice = page, notice
        for name, section in (
            ("properties", page.properties),
            ("layers", page.layers),
            ("history", page.history),
            ("clean_up", page.cleanup),
            ("reading", page.reading),
        ):
            on_trigger(commands, name, partial(self._show, section))
        page.refused.connect(lambda sentence: notice.ask(sentence, error=True))
        page.layers.removal.connect(self._ask_removal)

    def _show(self, section: PanelSection) -> None:
        """Bring a section of the page to the front, beside the drawing."""
        self.front_requested.emit()
        self._page.show_section(section)

    def _ask_removal(self, layer: str, on_it: int) -> None:
        question = f"Layer {layer} has {counted(on_it, 'curve')} on it. Remove the layer with all that is on it?"
        remove = partial(self._page.run, f"remove layer {name_text(layer)}")
        self._notice.ask(question, (("Remove", remove), ("Keep", lambda: None)))
