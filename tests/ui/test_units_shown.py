"""Inches or millimetres: rulers, raster and status bar follow; the drawing and what is written of it stay in mm."""

import pytest
from PySide6.QtCore import Qt

from app.settings import ShownUnits, load_settings
from app.ui.canvas.grid import grid_steps
from app.ui.canvas.modes import CanvasTool
from app.ui.canvas.snap import to_grid
from app.ui.canvas.view import View
from app.ui.start import build
from app.ui.wiring import Wiring


@pytest.fixture
def inches(wiring: Wiring) -> Wiring:
    wiring.window_.canvas.set_view(View(5.0, 124.0, 500.0))
    wiring.window_.actions_["units_inch"].trigger()
    return wiring


def test_the_status_bar_counts_in_inches(inches: Wiring) -> None:
    status = inches.window_.status
    status.show_place(25.4, -12.7)
    assert (status.place_x.text(), status.place_y.text(), status.unit.text()) == ("X 1.0000", "Y -0.5000", "in")
    assert status.grid.text() == "Grid 0.2000"
    inches.window_.actions_["units_mm"].trigger()
    assert (status.place_x.text(), status.unit.text()) == ("X 25.400", "mm")
    assert status.grid.text() == "Grid 5.000"


@pytest.mark.parametrize("scale", [0.02, 0.7, 5.0, 130.0, 9000.0])
def test_the_raster_is_round_in_inches(scale: float) -> None:
    minor, major = grid_steps(View(scale), 25.4)
    inch = major / 25.4
    assert float(f"{inch:.0e}") == pytest.approx(inch, rel=1e-12)
    assert major * scale >= 99.9
    x, y = to_grid((137.0 * minor + 0.2 * minor, -0.3 * minor), minor)
    assert (x, y) == (pytest.approx(137 * minor, rel=1e-7), 0.0)


def test_rulers_and_raster_are_painted_otherwise(inches: Wiring) -> None:
    canvas = inches.window_.canvas
    seen = canvas.grab().toImage()
    inches.window_.actions_["units_mm"].trigger()
    assert canvas.grab().toImage() != seen


def test_what_the_mouse_draws_on_the_raster_is_written_in_mm(qtbot, inches: Wiring) -> None:
    canvas = inches.window_.canvas
    canvas.set_grid_snap(True)
    canvas.set_tool(CanvasTool.LINE)
    for place in ((0.0, 0.0), (25.0, 13.0)):
        at = canvas.view.to_screen(place).toPoint()
        qtbot.mouseMove(canvas, at)
        qtbot.mouseClick(canvas, Qt.MouseButton.LeftButton, pos=at)
    assert inches.document.log[-1].command == "line 0,0 25.4,15.24"


def test_the_choice_is_remembered(inches: Wiring) -> None:
    assert load_settings().units is ShownUnits.INCH
    window, _ = build()
    assert window.status.unit.text() == "in"
    assert window.canvas.unit == 25.4
    window.close()
    window.deleteLater()
