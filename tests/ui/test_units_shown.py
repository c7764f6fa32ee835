"""Inches or millimetres: rulers, raster, status bar, the mouse and what is typed follow; the drawing stays in mm."""

from collections.abc import Iterator

import pytest
from PySide6.QtCore import Qt

from app.core.settings import ShownUnits, load_settings
from app.drafting.document import Document
from app.model.curves import Circle
from app.ui.framework.fields import NumberField, NumberSpec
from app.ui.shell.start import build
from app.ui.shell.window_controller import WindowController
from app.ui.views.canvas.describe import describe_entity
from app.ui.views.canvas.modes import CanvasTool
from app.ui.views.canvas.painting.grid import grid_steps
from app.ui.views.canvas.snap import to_grid
from app.ui.views.canvas.view_transform import ViewTransform


@pytest.fixture
def inches(wiring: WindowController) -> Iterator[WindowController]:
    wiring.window_.canvas.set_view(ViewTransform(5.0, 124.0, 500.0))
    wiring.window_.actions_["units_inch"].trigger()
    yield wiring
    wiring.window_.actions_["units_mm"].trigger()


def test_the_status_bar_counts_in_inches(inches: WindowController) -> None:
    status = inches.window_.status
    status.show_place(25.4, -12.7)
    assert (status.place_x.text(), status.place_y.text(), status.unit.text()) == ("X 1.0000", "Y -0.5000", "in")
    assert status.grid.text() == "Grid 0.2000"
    inches.window_.actions_["units_mm"].trigger()
    assert (status.place_x.text(), status.unit.text()) == ("X 25.400", "mm")
    assert status.grid.text() == "Grid 5.000"


@pytest.mark.parametrize("scale", [0.02, 0.7, 5.0, 130.0, 9000.0])
def test_the_raster_is_round_in_inches(scale: float) -> None:
    minor, major = grid_steps(ViewTransform(scale), 25.4)
    inch = major / 25.4
    assert float(f"{inch:.0e}") == pytest.approx(inch, rel=1e-12)
    assert major * scale >= 99.9
    x, y = to_grid((137.0 * minor + 0.2 * minor, -0.3 * minor), minor)
    assert (x, y) == (pytest.approx(137 * minor, rel=1e-7), 0.0)


def test_rulers_and_raster_are_painted_otherwise(inches: WindowController) -> None:
    canvas = inches.window_.canvas
    seen = canvas.grab().toImage()
    inches.window_.actions_["units_mm"].trigger()
    assert canvas.grab().toImage() != seen


def test_what_the_mouse_draws_on_the_raster_is_written_in_mm(qtbot, inches: WindowController) -> None:
    canvas = inches.window_.canvas
    canvas.set_grid_snap(True)
    canvas.set_tool(CanvasTool.LINE)
    for place in ((0.0, 0.0), (25.0, 13.0)):
        at = canvas.view.to_screen(place).toPoint()
        qtbot.mouseMove(canvas, at)
        qtbot.mouseClick(canvas, Qt.MouseButton.LeftButton, pos=at)
    assert inches.document.log[-1].command == "line 0,0 25.4,15.24"


def test_the_choice_is_remembered(inches: WindowController) -> None:
    assert load_settings().units is ShownUnits.INCH
    window, _ = build()
    assert window.status.unit.text() == "in"
    assert window.canvas.unit == 25.4
    window.close()
    window.deleteLater()


def typed(wiring: WindowController, *texts: str) -> None:
    for text in texts:
        wiring.window_.command_line.entered.emit(text)


def test_what_a_tool_asks_for_is_typed_in_inches(inches: WindowController) -> None:
    typed(inches, "circle", "1,2", "0.5", "fillet")
    circle = inches.document.part.entities[-1].curve
    assert isinstance(circle, Circle)
    assert (circle.centre, circle.radius) == ((25.4, 50.8), pytest.approx(12.7))
    typed(inches, "radius 1/4")
    assert "radius 0.25 in" in inches.window_.canvas.runner.prompt
    typed(inches, "radius 3mm")
    assert "radius 0.1181 in" in inches.window_.canvas.runner.prompt


def test_angles_counts_and_factors_stay_what_they_are(inches: WindowController) -> None:
    typed(inches, "line 1,0 2,0", "select 1", "rotate", "0,0", "90")
    assert inches.document.log[-1].command == "rotate 0,0 90"
    typed(inches, "scale", "0,0", "2")
    assert inches.document.log[-1].command == "scale 0,0 2"
    inches.window_.canvas.set_tool(CanvasTool.POLYGON)
    typed(inches, "5", "0,0", "1,0")
    assert inches.document.log[-1].command == "polygon 5 0,0 25.4,0"


def test_a_whole_line_says_in_the_log_that_it_is_in_inches_and_its_text_draws_the_same(
    inches: WindowController,
) -> None:
    typed(
        inches,
        "rect 0,0 4,2 round 1/8",
        "circle 1,1 0.25",
        "layer holes",
        "repeat 3 as k; circle (1 + k),0.5 3mm; end",
        "undo",
        "redo",
    )
    lines = [line.command for line in inches.document.log]
    assert lines[:3] == ["units in; rect 0,0 4,2 round 1/8; end", "units in; circle 1,1 0.25; end", "layer holes"]
    assert lines[-2:] == ["undo", "redo"]
    again = Document()
    again.run_script(inches.document.recorded.text())
    assert again.part == inches.document.part


def test_in_millimetres_a_line_stays_as_it_was_typed(wiring: WindowController) -> None:
    typed(wiring, "circle 1,1 0.25")
    assert wiring.document.log[-1].command == "circle 1,1 0.25"


def test_the_measures_at_the_mouse_are_in_inches(inches: WindowController) -> None:
    entry = inches.window_.canvas.entry
    typed(inches, "line", "0,0")
    entry.pointer = (25.4, 0.0)
    assert [(row.text, row.unit) for row in entry.shown()] == [("1.0000", "in"), ("0.00", "\u00b0")]
    inches.window_.actions_["units_mm"].trigger()
    entry.pointer = (25.4, 0.0)
    assert [(row.text, row.unit) for row in entry.shown()] == [("25.400", "mm"), ("0.00", "\u00b0")]


def put(field: NumberField, text: str) -> None:
    field.edit.setText(text)
    field.edit.setModified(True)
    field.edit.editingFinished.emit()


def test_properties_are_shown_and_typed_in_inches(inches: WindowController) -> None:
    typed(inches, "circle 1,2 0.5", "select 1")
    properties = inches.window_.drawing_page.properties
    properties.refresh(None)
    radius = properties.fields["radius"]
    assert isinstance(radius, NumberField)
    assert (radius.edit.text(), radius.unit.text()) == ("0.5000", "in")
    put(radius, "3/4")
    assert inches.document.log[-1].command == "set 1 radius 19.05"
    put(radius, "10mm")
    assert inches.document.log[-1].command == "set 1 radius 10"
    inches.window_.actions_["units_mm"].trigger()
    assert properties.fields["radius"].edit.text() == "10.000"


def test_fields_of_the_job_change_their_unit_and_keep_their_value(inches: WindowController) -> None:
    depth = NumberField(NumberSpec("Depth", high=50.8))
    feed = NumberField(NumberSpec("Feed", "mm/min", 1, 100_000, 0, False))
    turns = NumberField(NumberSpec("Speed", "rpm", 1, 100_000, 0, False))
    depth.show_value(12.7)
    assert (depth.edit.text(), depth.unit.text(), feed.unit.text(), turns.unit.text()) == (
        "0.5000",
        "in",
        "in/min",
        "rpm",
    )
    for field, text in ((depth, "1/4"), (feed, "20"), (turns, "8000")):
        put(field, text)
    assert (depth.value, feed.value, turns.value) == (pytest.approx(6.35), pytest.approx(508), 8000)
    put(depth, "3")
    assert depth.reason.text() == "Depth is 3 in; use 0 to 2."
    assert depth.value == pytest.approx(6.35)


def test_per_cent_of_the_diameter_are_per_cent_in_inches_too(inches: WindowController) -> None:
    panel = inches.window_.side
    found = [field for field in panel.findChildren(NumberField) if field.spec.name == "Stepover"]
    put(found[0], "50%")
    assert found[0].reason.text() == ""
    assert found[0].value == pytest.approx(inches.document.job.tools[0].diameter / 2)


def test_what_is_under_the_mouse_is_told_in_inches(inches: WindowController) -> None:
    typed(inches, "line 0,0 2,0")
    assert describe_entity(inches.document.part.entities[-1]).split(" · ")[1] == "2.0000 in"
