"""Shift+F1 explains whatever is clicked, and leads into the manual."""

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QWhatsThisClickedEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QAbstractButton, QAbstractSpinBox, QApplication, QComboBox, QLineEdit, QWhatsThis, QWidget

from app.ui.shell.help.what_is_this import PLACES
from app.ui.shell.start import build


@pytest.fixture(scope="module")
def explained(qapp):
    """A window of their own: what explains itself once does so until the window ends."""
    window, made = build()
    window.resize(1280, 800)
    yield made
    window.close()
    window.deleteLater()


@pytest.fixture
def wiring(explained):
    explained.window_.show()
    yield explained
    QWhatsThis.leaveWhatsThisMode()
    explained.language.help.hide()
    explained.window_.hide()


def told(widget: QWidget | None) -> str:
    """What a click on a widget would show: its own words, or those of what holds it."""
    while widget is not None and not widget.whatsThis():
        widget = widget.parentWidget()
    return widget.whatsThis() if widget is not None else ""


def test_everything_that_can_be_used_says_what_it_is(wiring) -> None:
    wiring.what_is_this.explain()
    kinds = (QAbstractButton, QLineEdit, QComboBox, QAbstractSpinBox)
    silent = [each for kind in kinds for each in wiring.window_.findChildren(kind) if not told(each)]
    assert not silent
    assert all(wiring.window_.findChildren(kind) for kind in PLACES)


def test_shift_f1_asks_and_a_click_on_a_tool_answers_with_a_way_into_the_manual(qtbot, wiring) -> None:
    QTest.keyClick(wiring.window_, Qt.Key.Key_F1, Qt.KeyboardModifier.ShiftModifier)
    assert QWhatsThis.inWhatsThisMode()
    button = wiring.window_.tool_strip.buttons["tool_fillet"]
    assert "language:fillet" in button.whatsThis()
    QTest.mouseClick(button, Qt.MouseButton.LeftButton, pos=QPoint(5, 5))
    assert not QWhatsThis.inWhatsThisMode() and wiring.window_.canvas.tool.name != "FILLET", "asking is no choosing"
    QApplication.sendEvent(button, QWhatsThisClickedEvent("language:fillet"))
    assert wiring.language.help.isVisible() and wiring.language.help.page == "language"


def test_explanations_follow_the_language(wiring) -> None:
    wiring.what_is_this.explain()
    english = wiring.window_.canvas.whatsThis()
    wiring.window_.actions_["language_ja"].trigger()
    wiring.what_is_this.explain()
    assert wiring.window_.canvas.whatsThis() != english
    wiring.window_.actions_["language_en"].trigger()
