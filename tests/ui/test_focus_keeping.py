"""Where the keyboard is after a list has changed: with what took the place of what had it, never on a bar's button."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QToolButton, QWidget
from pytestqt.qtbot import QtBot

from app.ui.framework.samples import Switch
from app.ui.framework.section import ListRow
from app.ui.panels.lists import ListSection
from app.ui.shell.window_controller import WindowController


def settled(qtbot: QtBot, wiring: WindowController) -> QWidget | None:
    qtbot.waitUntil(lambda: not wiring.focus_keeper.waiting)
    return wiring.window_.focusWidget()


def rows(section: ListSection) -> list[ListRow]:
    return [row for row in section.findChildren(ListRow) if row.isVisible()]


def test_a_switch_keeps_the_keys_when_its_list_is_made_anew(qtbot: QtBot, wiring: WindowController) -> None:
    operations = wiring.window_.panel.operations
    for on in (False, True):
        operations.switches[1].setFocus()
        qtbot.keyClick(operations.switches[1], Qt.Key.Key_Space)
        focused = settled(qtbot, wiring)
        assert isinstance(focused, Switch) and focused is operations.switches[1]
        assert focused.isChecked() is on


@pytest.mark.parametrize("at", [0, -1])
def test_a_removed_row_gives_the_keys_to_its_neighbour(qtbot: QtBot, wiring: WindowController, at: int) -> None:
    operations = wiring.window_.panel.operations
    row = rows(operations)[at]
    row.setFocus()
    qtbot.keyClick(row, Qt.Key.Key_Delete)
    focused = settled(qtbot, wiring)
    assert isinstance(focused, ListRow) and operations.isAncestorOf(focused)
    assert focused is rows(operations)[at]


def test_undo_of_a_tool_leaves_the_keys_in_its_list(qtbot: QtBot, wiring: WindowController) -> None:
    tools = wiring.window_.panel.tools
    tools.add_button.click()
    qtbot.waitUntil(lambda: len(rows(tools)) == 3)
    rows(tools)[-1].setFocus()
    wiring.document.undo()
    focused = settled(qtbot, wiring)
    assert focused is rows(tools)[-1] and len(rows(tools)) == 2


def test_what_has_no_successor_gives_the_keys_to_the_view(qtbot: QtBot, wiring: WindowController) -> None:
    window = wiring.window_
    button = QToolButton(window.panel)
    button.setAccessibleName("here for a while")
    button.show()
    button.setFocus()
    button.hide()
    assert settled(qtbot, wiring) is window.canvas
