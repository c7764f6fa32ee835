"""The log: a long reply is read in its line or, whole, in the tip of its line."""

from PySide6.QtCore import QEvent, Qt
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QAbstractButton

from app.drafting.document import LogLine
from app.ui.framework.log_view import LogView, _LinePainter
from app.ui.framework.view import View

SHORT = LogLine("rect 0,0 80,50", "1 rectangle")
LONG = LogLine(
    "propose Pocket T7", "2 slots & bores, through. " + "The tightest place has room for 5 mm at (80, 35). " * 4
)


def test_replies_stand_in_a_column_but_behind_a_long_command(qtbot) -> None:
    painter = _LinePainter()
    column = painter.reply_at(SHORT, 1264)
    assert painter.reply_at(LONG, 1264) == column < 1264 / 4, "whatever the reply's length"
    assert column < painter.reply_at(LogLine(LONG.command * 2, LONG.reply), 1264) < 0.4 * 1264
    assert painter.reply_at(LogLine(LONG.command * 20, LONG.reply), 1264) == int(0.4 * 1264), "no more than its share"


def test_the_tip_of_a_line_has_all_of_it_and_is_wrapped(qtbot) -> None:
    log = LogView()
    qtbot.addWidget(log)
    log.show_lines([SHORT, LONG])
    tip = log.model().data(log.model().index(1, 0), Qt.ItemDataRole.ToolTipRole)
    assert tip.startswith("<p>"), "plain text is one line, however long"
    assert "slots &amp; bores" in tip and LONG.command in tip


def test_what_is_typed_into_the_log_is_not_taken_for_a_search(qtbot) -> None:
    log = LogView()
    qtbot.addWidget(log)
    log.show_lines([SHORT, LONG])
    log.setCurrentIndex(log.model().index(1, 0))
    with qtbot.waitExposed(log):
        log.show()
    log.keyPressEvent(event := QKeyEvent(QEvent.Type.KeyPress, Qt.Key.Key_R, Qt.KeyboardModifier.NoModifier, "r"))
    assert not event.isAccepted() and log.currentIndex().row() == 1


def test_no_letter_is_lost_wherever_the_keyboard_is(qtbot, wiring) -> None:
    window = wiring.window_
    window.command_line.log.show_lines([SHORT, LONG])
    places = {
        View.DRAW: [window.command_line.log, window.status.badge, window.tool_strip.findChild(QAbstractButton)],
        View.NC: [window.views.nc.pane.text, window.views.nc.path],
        View.SURFACES: [window.views.surfaces.canvas],
    }
    for view, widgets in places.items():
        wiring.display_controller.show_view(view)
        for widget in widgets:
            widget.setFocus()
            qtbot.keyClicks(widget, "li")
            assert window.command_line.edit.text() == "li", (view, widget)
            assert window.command_line.edit.hasFocus()
            window.command_line.edit.clear()
