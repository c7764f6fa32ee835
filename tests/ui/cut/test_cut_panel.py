"""The panel beside the cut, in the real window: a click on a place leads there."""

from dataclasses import replace

import pytest
from PySide6.QtCore import QEvent, QPoint, QPointF, Qt
from PySide6.QtGui import QMouseEvent
from PySide6.QtWidgets import QApplication

from app.ui.framework.labels import Elided
from app.ui.framework.verdict import VerdictLevel, VerdictSummary
from app.ui.framework.view import View
from app.ui.views.cut.cell_colours import CutColourBy
from app.ui.views.cut.findings import CutFinding, FindingColour
from app.ui.views.cut.panel import CutPanel
from tests.ui.cut.real_cut import real_shown

WAIT_MS = 20_000


@pytest.fixture
def beside(qtbot, wiring):
    wiring.display_controller.show_view(View.CUT)
    wiring.cut_controller._show(real_shown())
    qtbot.waitUntil(lambda: wiring.window_.views.cut.render_scheduler.fine, timeout=WAIT_MS)
    return wiring


def test_the_panel_stands_in_the_job_panels_place_while_there_is_a_cut(qtbot, beside):
    window = beside.window_
    assert window.cut_panel.isVisible() and not window.panel.isVisible()
    assert window.cut_panel.nc.isVisible() and not window.cut_panel.histogram.isVisible(), "the text comes first"
    window.resize(1280, 1050)
    qtbot.waitUntil(window.cut_panel.histogram.isVisible)
    assert "mm²" in window.cut_panel.histogram.sums.text()
    beside.display_controller.show_view(View.DRAW)
    assert window.panel.isVisible() and not window.cut_panel.isVisible()


def test_the_panel_is_as_wide_as_its_border_was_dragged(qtbot, beside):
    panel, window = beside.window_.cut_panel, beside.window_
    usual, at = panel.width(), QPoint(2, 200)
    qtbot.mousePress(panel.grip, Qt.MouseButton.LeftButton, pos=at)
    start = panel.grip.mapToGlobal(at)
    for way in (60, 150):
        move = QMouseEvent(
            QEvent.Type.MouseMove,
            QPointF(at),
            QPointF(start - QPoint(way, 0)),
            Qt.MouseButton.NoButton,
            Qt.MouseButton.LeftButton,
            Qt.KeyboardModifier.NoModifier,
        )
        QApplication.sendEvent(panel.grip, move)
        assert panel.width() == usual + way
    qtbot.mouseRelease(panel.grip, Qt.MouseButton.LeftButton, pos=at)
    window.resize(1300, 800)
    qtbot.waitUntil(lambda: window.width() == 1300)
    assert panel.width() == usual + 150, "it stays"
    panel.choose_width(5000)
    assert panel.width() <= 0.6 * window.width() + 1, "the cut keeps room"
    qtbot.mouseDClick(panel.grip, Qt.MouseButton.LeftButton, pos=at)
    assert panel.width() == usual


def test_what_is_wrong_is_read_whole_and_where_gives_way(qtbot):
    panel = CutPanel()
    qtbot.addWidget(panel)
    titles = ("Shank in metal, 12.500 deep", "Rapid through metal, 2.000 deep")
    panel.entries = tuple(
        CutFinding(title, "A sentence.", FindingColour.ACCIDENT, True, (112.3, 4.5, -1.0), line=1234)
        for title in titles
    )
    panel._fill()
    panel.resize(panel.maximumWidth(), 600)
    panel.show()
    for row, title in zip(panel.rows, titles, strict=True):
        named, where = row.findChildren(Elided)
        assert named.text() == title and named.width() >= named.fontMetrics().horizontalAdvance(title)
        assert where.width() < where.sizeHint().width() and where.text() in row.toolTip()
        assert where.shown in ("(112.3, 4.5)", "line 1234", ""), "either of them whole, or none"


def test_a_long_verdict_is_read_whole_at_its_head(qtbot):
    panel = CutPanel()
    qtbot.addWidget(panel)
    panel.resize(panel.width(), 700)
    panel.show()
    panel.title.setText("Material left 59.3 mm² at (25.8, 17.2) · 1 more")
    QApplication.processEvents()
    title = panel.title
    room = title.fontMetrics().boundingRect(title.contentsRect(), Qt.TextFlag.TextWordWrap, title.text())
    assert title.contentsRect().contains(room), (title.contentsRect(), room)


def test_a_place_is_gone_to_and_its_line_is_shown(qtbot, beside):
    panel, view = beside.window_.cut_panel, beside.window_.views.cut
    at = next(k for k, entry in enumerate(panel.entries) if entry.colour is FindingColour.GOUGE and entry.line == 13)
    qtbot.mouseClick(panel.rows[at], Qt.MouseButton.LeftButton)
    assert panel.rows[at].property("chosen") == "true"
    assert panel.nc.text.isVisible() and panel.nc.text.current == 12
    assert view.colour is CutColourBy.DEVIATION
    place = panel.entries[at].place
    qtbot.waitUntil(lambda: _near_the_middle(view, place), timeout=WAIT_MS)
    assert view.overlay.pin.place == place
    qtbot.keyClick(panel.rows[at], Qt.Key.Key_Down)
    assert panel.chosen is panel.entries[at + 1]
    view.setFocus()
    qtbot.keyClick(view, Qt.Key.Key_Escape)
    assert view.overlay.pin is None


def test_the_heading_tells_what_the_badge_tells(beside):
    panel = beside.window_.cut_panel
    panel.show_told(VerdictSummary(VerdictLevel.NONE, "Out of date: compute again"))
    assert panel.title.text() == "Out of date: compute again" and panel.title.property("role") == ""
    panel.show_told(None)
    assert panel.title.text().endswith("to look at") and panel.title.property("role") == "error"


def test_no_area_too_deep_is_not_red(beside):
    plot = beside.window_.cut_panel.histogram
    red = plot._theme.error.name()
    assert red in plot._sums(plot.shown) and red not in plot._sums(replace(plot.shown, gouge=0.0))


def _near_the_middle(view, place):
    x, y, _ = view.model.camera.project([place], (view.width(), view.height()))[0]
    return abs(y - view.height() / 2) < 5 and 0 < x < view.width() - view.legend.width()


def test_what_is_said_of_a_place_fits_into_a_small_window(qtbot, beside):
    window = beside.window_
    window.resize(1100, 700)
    qtbot.mouseClick(window.cut_panel.rows[0], Qt.MouseButton.LeftButton)
    assert not window.cut_panel.histogram.isVisible()
    assert window.cut_panel.go.isVisible()
    window.resize(1100, 1200)
    qtbot.waitUntil(window.cut_panel.histogram.isVisible, timeout=WAIT_MS)


def test_the_metal_that_is_pointed_at_shows_its_line_beside_it(beside):
    panel, view = beside.window_.cut_panel, beside.window_.views.cut
    motion = int(view.model.picture.move.max())
    panel.nc.mark(motion)
    assert panel.nc.text.current + 1 == view.model.picture.moves.line[motion]


def test_a_cut_that_comes_while_it_is_not_seen_costs_no_rows_and_no_plot_until_it_is(qtbot, wiring):
    panel = wiring.window_.cut_panel
    wiring.window_.resize(1280, 1050)
    wiring.display_controller.show_view(View.DRAW)
    wiring.cut_controller._show(real_shown())
    assert panel.entries and not panel.rows and panel.histogram._plot is None
    wiring.display_controller.show_view(View.CUT)
    assert len(panel.rows) == len(panel.entries)
    qtbot.waitUntil(lambda: panel.histogram._plot is not None, timeout=WAIT_MS)
