"""The sheet "Which tool?": filled from the drawing on a worker, used by clicks, undone like anything else."""

from dataclasses import replace
from functools import partial

import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtGui import QWheelEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QAbstractSlider, QApplication, QScrollBar, QWidget

from app.core.resources import resource
from app.formats.readers import read_drawing
from app.model.contour_operation import ContourOperation
from app.model.operation import PocketOperation, RestOperation
from app.ui.framework.figures import clock
from app.ui.panels.side_panel import SidePanel
from app.ui.shell.drawing.advice_controller import AdviceController, clears, follows, with_tool_for
from app.usecases.making.make import export
from tests.ui.conftest import WAIT_MS


@pytest.fixture
def panel(qtbot, workspace):
    sample = resource("samples", "fig2.dxf")
    part = read_drawing(sample.name, sample.read_bytes(), None, ()).part
    workspace.document.load(replace(workspace.document.job, part=part))
    made = SidePanel(workspace.document)
    qtbot.addWidget(made)
    made.resize(328, 700)
    made.show()
    return made


@pytest.fixture
def sheet(qtbot, panel, workspace):
    advising = AdviceController(panel, workspace)
    qtbot.mouseClick(panel.tools.advice_button, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: bool(panel.advice._made) and not advising.worker.busy, timeout=3 * WAIT_MS)
    return panel.advice


def tools_of(job, kind):
    return {job.tool(each.cut.tool).diameter for each in job.operations if isinstance(each, kind)}


def test_a_tool_of_the_list_becomes_that_of_pockets_or_of_contours(qtbot, panel, workspace, sheet):
    names = [tool.diameter for tool in sheet._tools]
    assert names == sorted(names) and len(names) > 3
    qtbot.mouseClick(sheet._made[names.index(8.0)], Qt.MouseButton.LeftButton)
    qtbot.mouseClick(sheet.pocket_button, Qt.MouseButton.LeftButton)
    assert tools_of(workspace.document.job, PocketOperation) == {8.0}
    assert tools_of(workspace.document.job, ContourOperation) == {3.0}
    qtbot.mouseClick(sheet._made[names.index(2.0)], Qt.MouseButton.LeftButton)
    qtbot.mouseClick(sheet.contour_button, Qt.MouseButton.LeftButton)
    assert tools_of(workspace.document.job, (ContourOperation, RestOperation)) == {2.0}
    assert workspace.document.undo_name == "Tool for contours"
    workspace.document.undo()
    workspace.document.undo()
    assert tools_of(workspace.document.job, PocketOperation) == {6.0}


@pytest.mark.exhaustive
def test_programs_are_made_with_the_tools_and_their_times_shown(qtbot, panel, workspace):
    """By the processes of a batch: the time is that of the very program which the job has with that tool."""
    part = read_drawing("plate.draw", b"rect 0,0 24,16", None, ()).part
    workspace.document.load(replace(workspace.document.job, part=part))
    advising = AdviceController(panel, workspace)
    qtbot.mouseClick(panel.tools.advice_button, Qt.MouseButton.LeftButton)
    sheet = panel.advice
    qtbot.waitUntil(lambda: bool(sheet._made) and not advising.worker.busy, timeout=3 * WAIT_MS)
    names = [tool.diameter for tool in sheet._tools]
    shown = [names.index(8.0), names.index(12.0)]
    estimates = [sheet._times[at].text() for at in shown]
    sheet.trials_requested.emit(tuple(sheet._tools[at] for at in shown))
    qtbot.waitUntil(lambda: not advising.trials.busy, timeout=20 * WAIT_MS)
    base = with_tool_for(workspace.document.job, advising._contour, follows)
    for at in shown:
        made = export(with_tool_for(base, sheet._tools[at], clears))
        assert sheet._times[at].text() == clock(made.report.data["time_s"])
        assert sheet._made[at].toolTip().startswith("Made and proven.")
    assert [sheet._times[at].text() for at in shown] != estimates


def test_the_button_asks_for_the_tools_that_have_an_estimate(qtbot, sheet):
    sheet.trials_requested.disconnect()
    with qtbot.waitSignal(sheet.trials_requested) as caught:
        qtbot.mouseClick(sheet.trial_button, Qt.MouseButton.LeftButton)
    (tools,) = caught.args
    timed = [tool for tool, time in zip(sheet._tools, sheet._times, strict=True) if time.text()]
    assert list(tools) == timed and 1 < len(timed) < len(sheet._tools)


def test_places_are_shown_and_the_sheet_closes(qtbot, panel, workspace, sheet):
    with qtbot.waitSignal(sheet.place_requested) as caught:
        qtbot.mouseClick(sheet._places[0], Qt.MouseButton.LeftButton)
    assert "Narrowest passage" in sheet._places[0].text()
    x, y = caught.args
    assert 0 < x < 100 and 0 < y < 100
    qtbot.mouseClick(panel.tools.advice_button, Qt.MouseButton.LeftButton)
    assert sheet.isHidden() and panel.operation_form.isVisible()


@pytest.fixture
def low_sheet(qtbot, panel, workspace):
    """The sheet, filled and in sight, in a panel that does not hold all that is above it."""
    panel.resize(328, 500)
    advising = AdviceController(panel, workspace)
    qtbot.mouseClick(panel.tools.advice_button, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: bool(panel.advice._made) and not advising.worker.busy, timeout=3 * WAIT_MS)
    sheet = panel.advice
    qtbot.waitUntil(lambda: sheet.height() >= sheet.sizeHint().height() and in_sight(panel), timeout=WAIT_MS)
    return sheet


def in_sight(panel) -> bool:
    """Return whether the whole sheet is seen, or its head at the top where it is higher than the panel."""
    top = panel.advice.mapTo(panel.viewport(), QPoint(0, 0)).y()
    return top == 0 or (top > 0 and top + panel.advice.height() <= panel.viewport().height())


def test_the_sheet_is_in_sight_once_it_is_filled(panel, low_sheet):
    """While it fills, it grows: seen whole at first, then its head alone."""
    assert low_sheet.height() > panel.viewport().height() > 0
    assert low_sheet.mapTo(panel.viewport(), QPoint(0, 0)).y() == 0


@pytest.mark.parametrize("way", ["bar", "page", "wheel", "tab"])
def test_the_panel_stays_where_the_user_scrolled_it(qtbot, panel, low_sheet, way):
    """Only the wheel counted: dragged by its bar, or moved by keys, the panel jumped back as soon as the sheet grew."""
    bar = panel.verticalScrollBar()
    assert bar.value() > 0
    ways = {
        "bar": partial(drag_to_top, bar),
        "page": partial(bar.triggerAction, QAbstractSlider.SliderAction.SliderToMinimum),
        "wheel": partial(turn_wheel, panel.viewport()),
        "tab": partial(tab_to_top, panel),
    }
    ways[way]()
    at = bar.value()
    assert not in_sight(panel)
    low_sheet.setMinimumHeight(low_sheet.height() + 40)
    qtbot.waitUntil(lambda: low_sheet.height() == low_sheet.minimumHeight(), timeout=WAIT_MS)
    QApplication.processEvents()
    assert bar.value() == at


def drag_to_top(bar: QScrollBar) -> None:
    bar.setSliderDown(True)
    bar.setSliderPosition(bar.minimum())
    bar.setSliderDown(False)


def turn_wheel(viewport: QWidget) -> None:
    at = QPointF(viewport.rect().center())
    buttons, keys = Qt.MouseButton.NoButton, Qt.KeyboardModifier.NoModifier
    phase = Qt.ScrollPhase.NoScrollPhase
    turn = QWheelEvent(at, viewport.mapToGlobal(at), QPoint(), QPoint(0, 12000), buttons, keys, phase, False)
    QApplication.sendEvent(viewport, turn)


def tab_to_top(panel: SidePanel) -> None:
    """Go on from field to field by Tab until the first one is in sight again."""
    for _ in range(200):
        QTest.keyClick(panel.focusWidget() or panel, Qt.Key.Key_Backtab)
        if panel.verticalScrollBar().value() == 0:
            return
