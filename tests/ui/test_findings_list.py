"""The list of findings: a click shows the contour that it names, whole and marked; a button mends what one button
can.
"""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QLabel, QPushButton

from app.core.memory import within
from app.model.finding import Finding, FindingKind
from app.ui.framework.computation import ComputationState
from app.ui.framework.view import View
from app.ui.shell.window_controller import WindowController
from tests.ui.conftest import WAIT_MS


def compute(qtbot, wiring: WindowController) -> None:
    wiring.computation.start()
    qtbot.waitUntil(lambda: wiring.computation.state is ComputationState.CURRENT, timeout=WAIT_MS)


def listed(qtbot, wiring: WindowController, words: str):
    wiring.display_controller.open_findings()
    return next(row for row in wiring.window_.findings_list.rows if words in row.accessibleName())


def seen(wiring: WindowController) -> tuple[float, float, float, float]:
    canvas = wiring.window_.canvas
    return canvas.view.world_box(canvas.area)


@pytest.mark.parametrize("view", [View.DRAW, View.PATHS, View.NC])
def test_a_click_shows_the_whole_contour_and_selects_it(qtbot, wiring, view) -> None:
    for line in ("rect 0,0 60,40", "line 150,0 150,80 230,80"):
        wiring.document.run(line)
    compute(qtbot, wiring)
    wiring.display_controller.show_view(view)
    row = listed(qtbot, wiring, "is open")
    qtbot.mouseClick(row, Qt.MouseButton.LeftButton)
    assert wiring.document.selection == {5, 6}
    qtbot.waitUntil(lambda: seen(wiring)[0] < 150 and seen(wiring)[2] > 230, timeout=WAIT_MS)
    x0, y0, x1, y1 = seen(wiring)
    assert y0 < 0 and y1 > 80 and (x1 - x0) < 400, "the contour is not seen whole, or too far away"
    assert wiring.display_controller.view is (View.DRAW if view is View.DRAW else View.PATHS)


def test_a_small_contour_is_looked_at_closely(qtbot, wiring) -> None:
    wiring.document.run("rect 0,0 600,400")
    wiring.document.run("circle 700,100 0.5")
    compute(qtbot, wiring)
    qtbot.mouseClick(listed(qtbot, wiring, "is too small"), Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: seen(wiring)[2] - seen(wiring)[0] < 40, timeout=WAIT_MS)


def test_a_finding_that_names_curves_and_no_place_leads_to_them(qtbot, wiring) -> None:
    wiring.document.run("circle 300,200 5")
    wiring.display_controller.go_to(Finding(FindingKind.TINY_ENTITY, "Entity 1 is left out.", entity_ids=(1,)))
    qtbot.waitUntil(lambda: abs(sum(seen(wiring)[::2]) / 2 - 300) < 0.1, timeout=WAIT_MS)
    assert wiring.document.selection == {1}


def test_a_finding_about_no_place_is_no_button(qtbot, wiring) -> None:
    wiring.computation.forget((Finding(FindingKind.LEFT_OUT, "Left out: 2 TEXT.", counts=False),))
    row = listed(qtbot, wiring, "Left out")
    qtbot.mouseClick(row, Qt.MouseButton.LeftButton)
    assert wiring.window_.findings_list.isVisible() and row.focusPolicy() is Qt.FocusPolicy.NoFocus
    assert row.cursor().shape() is Qt.CursorShape.ArrowCursor


def test_a_layer_of_lines_that_bound_nothing_is_hidden_by_its_finding(qtbot, wiring) -> None:
    for line in ("rect 0,0 60,40", 'layer "CENTER"', *(f"line -5,{y} 65,{y}" for y in (5, 15, 25, 35))):
        wiring.document.run(line)
    compute(qtbot, wiring)
    row = listed(qtbot, wiring, "Layer CENTER has 4 lines that bound nothing")
    button = row.findChild(QPushButton)
    assert button.text() == "Hide layer CENTER" and button.isVisible()
    qtbot.mouseClick(button, Qt.MouseButton.LeftButton)
    assert not wiring.window_.findings_list.isVisible()
    assert not next(layer for layer in wiring.document.part.layers if layer.name == "CENTER").visible
    compute(qtbot, wiring)
    assert not [finding for finding in wiring.display_controller.findings if finding.counts]
    wiring.document.undo()
    assert next(layer for layer in wiring.document.part.layers if layer.name == "CENTER").visible


def test_a_run_that_failed_says_why_before_what_is_known_of_the_drawing(qtbot, wiring) -> None:
    """The view sent to the badge, whose list was headed "No findings" and did not have the reason."""
    wiring.document.run("rect 0,0 60,40")
    wiring.computation.forget((Finding(FindingKind.LEFT_OUT, "Left out: 2 TEXT.", counts=False),))
    wiring.display_controller.show_view(View.PATHS)
    with within(1_000), qtbot.waitSignal(wiring.computation.failed, timeout=WAIT_MS) as told:
        wiring.computation.start()
    empty, error = wiring.window_.views.empty, told.args[0]
    assert "memory" in error and empty.sentence.text() == error
    assert empty.button.isVisible() and empty.button.text() == "Compute again", "there may be more of it by then"
    wiring.display_controller.open_findings()
    said = [label.text() for label in wiring.window_.findings_list.findChildren(QLabel)]
    assert said[:3] == ["Could not be computed", error, "1 remark"] and "Left out: 2 TEXT." in said
    qtbot.mouseClick(empty.button, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: wiring.computation.state is ComputationState.CURRENT, timeout=WAIT_MS)
