"""What a job puts round the drawing: copies, clamps, tabs by hand; on the real canvas, by real clicks."""

from dataclasses import replace

import pytest
from PySide6.QtCore import QPoint, Qt

from app.drafting.document import Document
from app.model.contour_operation import ContourOperation
from app.model.curves import Line
from app.model.entry import Tabs
from app.model.job import Copies, Job
from app.model.part import Entity, Part
from app.ui.framework.theme import LIGHT
from app.ui.panels.changes import Subject, SubjectKind
from app.ui.panels.operation_groups import BY_HAND
from app.ui.panels.side_panel import SidePanel
from app.ui.views.canvas.canvas import Canvas
from app.ui.views.canvas.marker_mode import MarkerMode


def square(x: float, y: float, side: float, layer: str, first: int) -> tuple[Entity, ...]:
    corners = [(x, y), (x + side, y), (x + side, y + side), (x, y + side)]
    return tuple(Entity(first + k, Line(corners[k], corners[(k + 1) % 4]), layer) for k in range(4))


@pytest.fixture
def document() -> Document:
    part = Part().with_entities((*square(0, 0, 40, "0", 1), *square(10, 10, 8, "clamps", 5)))
    return Document(Job(part))


@pytest.fixture
def canvas(qtbot, document):
    made = Canvas(document, LIGHT)
    made.resize(600, 400)
    qtbot.addWidget(made)
    made.show()
    made.fit_to((-10.0, -10.0, 110.0, 60.0))
    return made


def colour(canvas, x: float, y: float) -> str:
    at = canvas.view.to_screen((x, y)).toPoint()
    return canvas.grab().toImage().pixelColor(at).name()


def test_a_keep_out_area_is_filled_and_hatched(canvas, document):
    before = {colour(canvas, 12 + k / 4, 13) for k in range(16)}
    document.change_job("Clamps", replace(document.job, keep_out_layers=("clamps",)))
    after = {colour(canvas, 12 + k / 4, 13) for k in range(16)}
    assert after != before
    assert len(after) > 1
    document.undo()
    assert {colour(canvas, 12 + k / 4, 13) for k in range(16)} == before


def test_copies_are_drawn_but_clamps_are_not_copied(canvas, document):
    document.change_job("Clamps", replace(document.job, keep_out_layers=("clamps",)))
    empty = colour(canvas, 60.0, 20.0), colour(canvas, 70.0, 14.0)
    document.change_job("Copies", replace(document.job, copies=Copies(2, 1, 60.0, 0.0)))
    assert colour(canvas, 60.0, 20.0) != empty[0]  # the left edge of the copy
    assert colour(canvas, 70.0, 14.0) == empty[1]  # where the clamp's edge would be


def test_a_click_marks_a_place_and_escape_ends(qtbot, canvas):
    places: list[tuple[float, float]] = []
    canvas.mark(MarkerMode("Places", lambda: places, lambda at, reach: places.append(at)))
    assert canvas.prompt == "Places"
    at = canvas.view.to_screen((20.0, 0.0)).toPoint()
    qtbot.mouseClick(canvas, Qt.MouseButton.LeftButton, pos=at)
    assert places[0] == pytest.approx((20.0, 0.0), abs=0.3)
    qtbot.keyClick(canvas, Qt.Key.Key_Escape)
    assert canvas.marker_mode is None
    qtbot.mouseClick(canvas, Qt.MouseButton.LeftButton, pos=at + QPoint(4, 4))
    assert len(places) == 1


def test_tabs_are_put_and_taken_away_by_clicks(qtbot, wiring):
    window = wiring.window_
    document, panel, canvas = window.document, window.panel, window.canvas
    document.change_job("Part", replace(document.job, part=Part().with_entities(square(0, 0, 40, "0", 1))))
    index = next(k for k, each in enumerate(document.job.operations) if isinstance(each, ContourOperation))
    panel.choose(Subject(SubjectKind.OPERATION, index))
    canvas.fit_to((-10.0, -10.0, 60.0, 60.0))
    hand = panel.operation_form.hand
    hand.click()
    assert hand.text() == "Done"
    at = canvas.view.to_screen((20.0, 0.0)).toPoint()
    qtbot.mouseClick(canvas, Qt.MouseButton.LeftButton, pos=at)
    (place,) = document.job.operations[index].tabs.places
    assert place == pytest.approx((20.0, 0.0), abs=0.3)
    assert document.undo_name == "Put tab"
    qtbot.mouseClick(canvas, Qt.MouseButton.LeftButton, pos=at)
    assert document.job.operations[index].tabs.places == ()
    document.undo()
    assert document.job.operations[index].tabs == Tabs(places=(place,))
    qtbot.keyClick(canvas, Qt.Key.Key_Escape)
    assert hand.text() == BY_HAND


def test_the_stock_grows_with_copies_and_not_with_clamps(qtbot, document):
    panel = SidePanel(document)
    qtbot.addWidget(panel)
    panel.show_size((40.0, 40.0), replace(document.job, copies=Copies(3, 2, 50.0, 60.0)))
    assert panel.job.stock.text() == "140.000 \u00d7 100.000 \u00d7 10.000 mm"
