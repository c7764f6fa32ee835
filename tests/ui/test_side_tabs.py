"""The right side of the window: pages behind tabs."""

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QWidget
from pytestqt.qtbot import QtBot

from app.ui.panels.side_tabs import SideTabs


def _page(width: int) -> QWidget:
    made = QWidget()
    made.setFixedWidth(width)
    return made


def test_the_first_page_is_in_front_and_a_click_brings_another(qtbot: QtBot) -> None:
    side = SideTabs()
    qtbot.addWidget(side)
    first, second = _page(300), _page(420)
    side.add_page("Job", first, "what is cut")
    side.add_page("Text", second, "what is drawn, in words")
    side.show()
    assert side.page == "Job" and first.isVisible() and side.width() == 301
    with qtbot.waitSignal(side.chosen) as told:
        qtbot.mouseClick(side.tabs["Text"], Qt.MouseButton.LeftButton)
    assert told.args == ["Text"] and side.page == "Text"
    assert second.isVisible() and not first.isVisible() and side.width() == 421


def test_tabs_are_reached_by_key(qtbot: QtBot) -> None:
    side = SideTabs()
    qtbot.addWidget(side)
    for name in ("Job", "Text"):
        side.add_page(name, _page(300), name)
    side.show()
    side.tabs["Text"].setFocus()
    qtbot.keyClick(side.tabs["Text"], Qt.Key.Key_Space)
    assert side.page == "Text" and side.tabs["Text"].accessibleName().startswith("Text")
