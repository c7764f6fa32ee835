"""The text of a program: keys, mouse, selection, marks, what is painted."""

import math

import pytest
from PySide6.QtCore import QEvent, QPoint, Qt
from PySide6.QtGui import QColor, QGuiApplication, QHelpEvent
from PySide6.QtWidgets import QApplication, QToolTip

from app.gcode.interpreter.program import ProgramProblem, Severity
from app.ui.framework.theme import DARK, LIGHT
from app.ui.views.nc.line_marks import line_marks
from app.ui.views.nc.painting.text_painter import LINE_PX, MARKS_PX
from app.ui.views.nc.program_text import program_text
from app.ui.views.nc.text_view import NcTextView

LINES = b"".join(b"G1 X%d Y2 F300\n" % k for k in range(500))


@pytest.fixture
def view(qtbot):
    made = NcTextView()
    qtbot.addWidget(made)
    made.resize(400, 20 * LINE_PX)
    made.show_text(program_text(LINES))
    made.show()
    return made


def top_row(view):
    return view.verticalScrollBar().value() / LINE_PX


def rows_in_sight(view):
    return range(int(top_row(view)), int(top_row(view)) + view.rows_in_sight)


def press(qtbot, view, key, *modifiers):
    held = Qt.KeyboardModifier.NoModifier
    for modifier in modifiers:
        held |= modifier
    qtbot.keyClick(view, key, held)


CTRL, SHIFT = Qt.KeyboardModifier.ControlModifier, Qt.KeyboardModifier.ShiftModifier


def test_keys_walk_and_the_line_stays_in_sight(qtbot, view):
    view.setFocus()
    press(qtbot, view, Qt.Key.Key_Down)
    assert view.current == 0
    for _ in range(3):
        press(qtbot, view, Qt.Key.Key_PageDown)
    assert view.current == 3 * (view.rows_in_sight - 1)
    assert view.current in rows_in_sight(view)
    press(qtbot, view, Qt.Key.Key_PageUp)
    press(qtbot, view, Qt.Key.Key_Up)
    assert view.current == 2 * (view.rows_in_sight - 1) - 1
    press(qtbot, view, Qt.Key.Key_End, CTRL)
    assert view.current == 499
    assert view.current in rows_in_sight(view)
    press(qtbot, view, Qt.Key.Key_Down)
    assert view.current == 499
    press(qtbot, view, Qt.Key.Key_Home, CTRL)
    assert (view.current, top_row(view)) == (0, 0)


def test_shift_picks_a_range_that_is_copied(qtbot, view):
    with qtbot.waitSignal(view.rows_picked) as caught:
        view.pick(3)
    assert caught.args == [3, 3]
    for _ in range(2):
        press(qtbot, view, Qt.Key.Key_Down, SHIFT)
    assert view.selection == (3, 5)
    press(qtbot, view, Qt.Key.Key_C, CTRL)
    assert QGuiApplication.clipboard().text() == "G1 X3 Y2 F300\nG1 X4 Y2 F300\nG1 X5 Y2 F300\n"
    press(qtbot, view, Qt.Key.Key_Up)
    assert view.selection == (4, 4)
    press(qtbot, view, Qt.Key.Key_A, CTRL)
    assert view.selection == (0, 499)


def test_mouse_picks_drags_and_jumps_beside_the_scroll_bar(qtbot, view):
    port = view.viewport()
    qtbot.mouseClick(port, Qt.MouseButton.LeftButton, pos=QPoint(100, 4 * LINE_PX + 5))
    assert view.selection == (4, 4)
    qtbot.mouseClick(port, Qt.MouseButton.LeftButton, SHIFT, QPoint(100, 7 * LINE_PX + 5))
    assert view.selection == (4, 7)
    qtbot.mousePress(port, Qt.MouseButton.LeftButton, pos=QPoint(100, LINE_PX + 5))
    qtbot.mouseMove(port, QPoint(100, 3 * LINE_PX + 5))
    qtbot.mouseRelease(port, Qt.MouseButton.LeftButton)
    qtbot.mouseClick(port, Qt.MouseButton.LeftButton, pos=QPoint(port.width() - MARKS_PX // 2, port.height() // 2))
    assert view.current == pytest.approx(250, abs=15)
    assert view.current in rows_in_sight(view)


def test_wheel_scrolls_three_lines_a_notch(qtbot, view):
    view.verticalScrollBar().setValue(100 * LINE_PX)
    view.verticalScrollBar().triggerAction(view.verticalScrollBar().SliderAction.SliderSingleStepAdd)
    assert top_row(view) == 101


def test_a_very_long_line_is_shown_at_once_and_scrolls_sideways(qtbot, view):
    view.show_text(program_text(b"G1 X1 " * 1_700_000 + b"\nG0 Z5\n"))
    with qtbot.captureExceptions() as caught:
        view.grab()
        view.pick(0)
        press(qtbot, view, Qt.Key.Key_End)
    assert not caught
    bar = view.horizontalScrollBar()
    assert bar.maximum() > 1_000_000
    assert bar.value() > bar.maximum() - view.viewport().width()
    press(qtbot, view, Qt.Key.Key_Home)
    assert bar.value() == 0


def test_words_have_colours_and_follow_the_theme(view):
    view.set_theme(LIGHT)
    light = view.grab().toImage()
    seen = {light.pixelColor(x, y).rgb() for x in range(40, 200) for y in range(2, 18)}
    for colour in (LIGHT.accent_text, LIGHT.warning, LIGHT.ink):
        assert any(math.dist(QColor(each).getRgb(), colour.getRgb()) < 12 for each in seen)
    view.set_theme(DARK)
    dark = view.grab().toImage()
    assert dark.pixelColor(200, 200) == DARK.canvas


def problem_view(view, column=4, word="X7"):
    view.show_looks(line_marks(500, None, [ProgramProblem(8, column, word, "X is too far; use less.", Severity.ERROR)]))
    return view


def test_a_problem_is_underlined_marked_and_told(qtbot, view):
    plain = view.grab().toImage()
    image = problem_view(view).grab().toImage()
    y = 7 * LINE_PX + LINE_PX - 3

    def reddish(picture):
        return sum(
            picture.pixelColor(x, y + d).red() > 1.5 * picture.pixelColor(x, y + d).green()
            for x in range(80, 110)
            for d in (-1, 0, 1)
        )

    assert reddish(image) > reddish(plain) + 5
    right = view.viewport().width() - MARKS_PX // 2
    marks = {
        image.pixelColor(right, y).name()
        for y in range(int(7 / 500 * image.height()), int(7 / 500 * image.height()) + 4)
    }
    assert LIGHT.error.name() in marks
    at = QPoint(100, 7 * LINE_PX + 5)
    QApplication.sendEvent(view.viewport(), QHelpEvent(QEvent.Type.ToolTip, at, view.viewport().mapToGlobal(at)))
    assert QToolTip.text() == "X is too far; use less."


def test_found_words_are_tinted(view):
    before = view.grab().toImage()
    view.show_found("y2", (0, 1, 2))
    after = view.grab().toImage()
    changed = [x for x in range(380) if before.pixelColor(x, 4) != after.pixelColor(x, 4)]
    assert changed
    letter = view.fontMetrics().horizontalAdvance("0")
    assert max(changed) - min(changed) < 5 * letter
