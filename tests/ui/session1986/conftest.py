"""A session driven by keys: over a bare widget, or over the real window."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QWidget

from app.ui.views.session1986.controller import SessionController
from app.ui.views.session1986.questions import SessionQuestion
from tests.ui.conftest import WAIT_MS


class Operator:
    """Types on the terminal's keyboard and looks at its screen."""

    def __init__(self, qtbot, opening, document) -> None:
        self.bot, self.open_controller, self.document = qtbot, opening, document
        self.session, self.tube = opening.session, opening.tube

    @property
    def screen(self):
        return self.session.screen

    def key(self, key, modifiers=Qt.KeyboardModifier.NoModifier) -> None:
        self.bot.keyClick(self.tube, key, modifiers)

    def answer(self, text: str = "") -> None:
        self.bot.keyClicks(self.tube, text)
        self.key(Qt.Key.Key_Return)

    def until(self, ask: SessionQuestion) -> None:
        self.bot.waitUntil(lambda: self.session.ask is ask, timeout=WAIT_MS)

    def see_all(self, ask: SessionQuestion) -> None:
        """Have what is shown go to its end, until this is asked."""
        self.until(SessionQuestion.PLAY)
        while self.session.ask is not ask:
            self.key(Qt.Key.Key_Return)

    def to_pocket(self, shape: str = "2") -> None:
        """Answer up to the pocket tool's offset."""
        self.answer(shape)
        self.until(SessionQuestion.CONTOUR)
        self.answer("1.5")
        self.see_all(SessionQuestion.POCKET)

    def said(self) -> str:
        return " ".join(self.screen.talk)


@pytest.fixture
def operator(qtbot, workspace):
    """An operator at the first question, over a bare widget."""
    over = QWidget()
    qtbot.addWidget(over)
    over.resize(1280, 800)
    with qtbot.waitActive(over):
        over.show()
        over.activateWindow()
    opening = SessionController(over, workspace)
    opening.open()
    made = Operator(qtbot, opening, workspace.document)
    yield made
    made.session.finish()


@pytest.fixture
def in_window(qtbot, wiring):
    """An operator at the first question, over an empty window, and the window's wiring."""
    wiring.window_.actions_["session_1986"].trigger()
    made = Operator(qtbot, wiring.session_1986, wiring.document)
    made.wiring = wiring
    yield made
    made.session.finish()
