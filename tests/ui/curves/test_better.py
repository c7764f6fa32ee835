"""One button makes a better program of passes over a surface, and shows it."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from app.ui.framework.view import View
from tests import raster_program as made
from tests.ui.nc.opened import WAIT_MS, open_file


def press(qtbot, wiring) -> None:
    QTest.mouseClick(wiring.window_.curves_panel.better.button, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: not wiring.better_controller.reading.worker.busy, timeout=12 * WAIT_MS)


@pytest.mark.exhaustive
def test_the_button_makes_a_better_program_and_shows_it(qtbot, wiring, tmp_path) -> None:
    path = tmp_path / "raster.ngc"
    path.write_text(made.text(made.rows(wide=12.0, deep=8.0)))
    open_file(qtbot, wiring, path)
    wiring.display_controller.show_view(View.CURVES)
    form = wiring.window_.curves_panel.better
    assert form.isVisible() and form.button.isEnabled()
    before = len(wiring.nc.shown.program.motions)
    press(qtbot, wiring)
    qtbot.waitUntil(lambda: wiring.nc.shown.source.name == "raster-better.ngc", timeout=6 * WAIT_MS)
    assert len(wiring.nc.shown.program.motions) < 0.3 * before
    assert "Blocks" in form.outcome.text() and not form.reason.isVisible() and path.read_text().count("\n") > before


def test_a_program_of_another_kind_is_refused_beside_the_button(qtbot, wiring, tmp_path) -> None:
    path = tmp_path / "two.ngc"
    path.write_text(made.text(made.rows(wide=8.0, deep=0.5)))
    open_file(qtbot, wiring, path)
    wiring.display_controller.show_view(View.CURVES)
    press(qtbot, wiring)
    form = wiring.window_.curves_panel.better
    assert "2 passes are" in form.reason.text() and not form.outcome.isVisible()
