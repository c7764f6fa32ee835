"""The strip of tools in the window: kinds behind buttons, the menu at the mouse, and words and keys that do the
same.
"""

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest

from app.ui.framework.view import View
from app.ui.shell.bars.actions import menus
from app.ui.shell.bars.tool_strip import GROUPS, SIDE
from app.ui.views.canvas.modes import CanvasTool

LEFT, RIGHT = Qt.MouseButton.LeftButton, Qt.MouseButton.RightButton
ARCS = "tool_arc_three"


def enter(wiring, text: str) -> None:
    """Type into the command line."""
    edit = wiring.window_.command_line.edit
    edit.setFocus()
    QTest.keyClicks(edit, text)
    QTest.keyClick(edit, Qt.Key.Key_Return)


def test_every_tool_is_in_a_menu_and_on_the_strip(wiring):
    listed = {spec.name for _, specs in menus() for spec in specs}
    shown = {name for group in GROUPS for names in group for name in names}
    for tool in CanvasTool:
        assert f"tool_{tool.value}" in listed
        assert f"tool_{tool.value}" in shown


def test_a_button_takes_its_tool_and_shows_it(wiring, qtbot):
    button = wiring.window_.tool_strip.buttons["tool_slot"]
    qtbot.mouseClick(button, LEFT, pos=QPoint(10, 10))
    assert wiring.window_.canvas.tool is CanvasTool.SLOT
    assert button.isChecked()


@pytest.mark.parametrize(
    ("how", "at"), [(RIGHT, QPoint(10, 10)), (LEFT, QPoint(SIDE - 3, SIDE - 3))], ids=["right click", "corner"]
)
def test_the_kinds_of_a_tool_open_and_the_one_taken_stays(wiring, qtbot, how, at):
    button = wiring.window_.tool_strip.buttons[ARCS]
    qtbot.mousePress(button, how, pos=at)
    assert button.row is not None and button.row.isVisible()
    qtbot.mouseRelease(button, how, pos=at)
    qtbot.mouseClick(button.row.buttons["tool_arc_radius"], LEFT)
    assert not button.row.isVisible()
    assert wiring.window_.canvas.tool is CanvasTool.ARC_RADIUS
    assert button.defaultAction() is wiring.window_.actions_["tool_arc_radius"]


def test_a_held_button_opens_the_kinds_and_does_not_click(wiring, qtbot):
    button = wiring.window_.tool_strip.buttons[ARCS]
    qtbot.mousePress(button, LEFT, pos=QPoint(8, 8))
    qtbot.waitUntil(lambda: button.row.isVisible(), timeout=3000)
    qtbot.mouseRelease(button, LEFT, pos=QPoint(8, 8))
    assert wiring.window_.canvas.tool is CanvasTool.SELECT
    button.row.hide()


def test_a_kind_taken_from_the_menu_is_shown_on_the_strip(wiring):
    wiring.window_.actions_["tool_circle_two"].trigger()
    assert (
        wiring.window_.tool_strip.buttons["tool_circle"].defaultAction() is wiring.window_.actions_["tool_circle_two"]
    )


def test_all_buttons_can_be_seen_at_1280_by_800_with_the_log(wiring, qtbot):
    strip = wiring.window_.tool_strip
    assert wiring.window_.command_line.log.isVisible()
    lowest = max(button.geometry().bottom() for button in strip.buttons.values())
    assert lowest < strip.height()


def test_a_low_window_takes_more_columns(wiring, qtbot):
    strip = wiring.window_.tool_strip
    before = strip.width()
    wiring.window_.resize(1280, 560)
    qtbot.waitUntil(lambda: strip.width() > before, timeout=2000)
    assert max(button.geometry().bottom() for button in strip.buttons.values()) < strip.height()


def test_a_tool_that_does_its_work_at_once_leaves_select_in_hand(wiring):
    wiring.document.run("line 0,0 10,0")
    wiring.document.run("select 1")
    wiring.window_.actions_["tool_reverse"].trigger()
    assert wiring.document.log[-1].command == "reverse"
    assert wiring.window_.actions_["tool_select"].isChecked()


def test_a_word_typed_begins_a_tool_and_option_words_go_to_it(wiring):
    wiring.document.run("rect 10,10 60,40")
    wiring.document.run("select all")
    enter(wiring, "ro")
    assert wiring.window_.canvas.tool is CanvasTool.ROTATE
    for text in ("copy", "10,10", "45"):
        enter(wiring, text)
    assert wiring.document.log[-1].command == "rotate 10,10 45 copy"
    assert wiring.window_.canvas.tool is CanvasTool.SELECT


def test_a_tool_taken_elsewhere_shows_the_drawing(wiring):
    wiring.display_controller.show_view(View.NC)
    enter(wiring, "slot")
    assert wiring.display_controller.view is View.DRAW


def test_the_menu_at_the_mouse_selects_what_lies_there_and_offers_what_can_be_done(wiring, qtbot):
    wiring.document.run("circle 50,50 20")
    canvas = wiring.window_.canvas
    canvas.fit()
    qtbot.wait(400)
    at = canvas.view.to_screen((70, 50)).toPoint()
    qtbot.mouseMove(canvas, at)
    qtbot.mousePress(canvas, RIGHT, pos=at)
    assert wiring.document.selection == {1}
    names = [action.text() for action in wiring.context_menu.menu.actions()]
    assert names[0].startswith("Repeat")
    assert "Select chain" in names
    assert wiring.window_.actions_["tool_move"] in wiring.context_menu.menu.actions()
    wiring.context_menu.menu.hide()
    qtbot.mouseRelease(canvas, RIGHT, pos=at)


def test_right_with_a_tool_in_hand_opens_no_menu(wiring, qtbot):
    canvas = wiring.window_.canvas
    wiring.window_.actions_["tool_line"].trigger()
    qtbot.mousePress(canvas, RIGHT, pos=canvas.rect().center())
    qtbot.mouseRelease(canvas, RIGHT, pos=canvas.rect().center())
    assert canvas.tool is CanvasTool.SELECT
    assert wiring.context_menu.menu is None or not wiring.context_menu.menu.isVisible()
