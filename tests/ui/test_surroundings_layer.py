"""What a job puts round the drawing: copies, clamps, tabs by hand; on the real canvas, by real clicks."""

from dataclasses import replace

import pytest
from PySide6.QtCore import QPoint, QPointF, QRectF, Qt

from app.drafting.document import Document
from app.model.contour_operation import ContourOperation
from app.model.curves import Line
from app.model.entry import Tabs
from app.model.job import Copies, Job, Stock
from app.model.part import Entity, Part
from app.model.stock_box import StockBox, drawn_stock, stock_box
from app.ui.framework.theme import LIGHT
from app.ui.panels.changes import Subject, SubjectKind
from app.ui.panels.operation_groups import BY_HAND
from app.ui.panels.side_panel import SidePanel
from app.ui.views.canvas.canvas import Canvas
from app.ui.views.canvas.interactive_viewport import PICK_PX
from app.ui.views.canvas.marker_mode import MarkerMode
from app.ui.views.canvas.painting.stock_outline import DASH_PERIOD, edges_seen


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


def test_the_stock_is_outlined_where_it_is(canvas, document):
    rows = range(-90, 500, 2)  # tenths of a mm along its left edge and beyond its lower end

    def seen(x: float) -> set[str]:
        return {colour(canvas, x, row / 10) for row in rows}

    ground = seen(-6.0)
    canvas.set_stock(StockBox(-6.0, -8.0, -10.0, 46.0, 48.0))
    assert seen(-6.0) != ground and seen(46.0) != ground
    assert {colour(canvas, -6.0, -9.5)} <= ground
    canvas.set_stock(None)
    assert seen(-6.0) == ground


@pytest.mark.parametrize("scale", [0.5, 3.0, 4e4])
def test_edges_of_the_stock_are_dashed_from_their_corners_and_never_long(scale):
    """However a picture is cut into areas: what two of them show of one edge is in step."""
    outline = QRectF(-13.0 * scale, -7.0 * scale, 52.0 * scale, 56.0 * scale)
    for area in (
        QRectF(0, 0, 300, 200),
        QRectF(17.5, 3, 40, 41),
        QRectF(outline.left() - 5, outline.top() - 5, 90, 80),
    ):
        for line in edges_seen(outline, area):
            from_corner = (line.x1() - outline.left()) + (line.y1() - outline.top())
            at_far_edge = outline.width() * (line.x1() == outline.right()) + outline.height() * (
                line.y1() == outline.bottom()
            )
            steps = (from_corner - at_far_edge) / DASH_PERIOD
            assert steps == pytest.approx(round(steps), abs=1e-6)
            assert line.length() <= max(area.width(), area.height()) + DASH_PERIOD
    assert not edges_seen(outline, QRectF(outline.right() + 1, 0, 50, 50))
    assert len(edges_seen(outline, outline)) == 4


def test_the_outline_is_the_stock_that_the_program_tells(qtbot, wiring):
    """Before it is computed round all that is drawn, after it round what is machined; the panel says the same."""
    document, display, window = wiring.document, wiring.display_controller, wiring.window_
    part = Part().with_entities((*square(0, 0, 40, "0", 1), Entity(9, Line((60.0, 0.0), (60.0, 70.0)), "0")))
    document.change_job("Part", replace(document.job, part=part, stock=Stock(margin=2.0)))
    assert window.canvas.around.stock == StockBox(-2.0, -2.0, -10.0, 62.0, 72.0)
    assert window.panel.job.stock.text().startswith("64.000 \u00d7 74.000")
    with qtbot.waitSignal(wiring.computation.finished, timeout=60_000):
        wiring.computation.start()
    made = wiring.computation.made
    assert display.stock() == stock_box(made.job, made.program.regions, made.program.lines)
    assert window.canvas.around.stock == StockBox(-2.0, -2.0, -10.0, 42.0, 42.0)
    assert window.panel.job.stock.text().startswith("44.000 \u00d7 44.000")
    document.change_job("Feed", replace(document.job, stock=Stock(margin=3.0, above=0.5)))
    assert window.canvas.around.stock == StockBox(-3.0, -3.0, -10.0, 43.0, 43.0, 0.5), "the loose line is no part of it"
    assert window.panel.job.stock.text() == "46.000 \u00d7 46.000 \u00d7 10.500 mm"
    document.undo()
    document.run("circle 80,10 5")
    assert window.canvas.around.stock == StockBox(-2.0, -2.0, -10.0, 87.0, 72.0)


def test_a_stock_that_the_job_widens_is_fitted_also_behind_an_edit_that_left_it_as_it_was(qtbot, wiring):
    canvas, document = wiring.window_.canvas, wiring.document
    document.run("rect 0,0 60,40")
    canvas.fit()
    document.run("line 10,10 20,20")
    document.change_job("Margin", replace(document.job, stock=Stock(margin=40.0)))
    corner = canvas.around.stock.x0, canvas.around.stock.y0
    qtbot.waitUntil(lambda: canvas.area.contains(canvas.view.to_screen(corner)), timeout=5000)


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


def drag(qtbot, canvas, start: QPoint, end: QPoint) -> None:
    """Drag from one px to another; what is dragged is shown where the mouse is."""
    qtbot.mousePress(canvas, Qt.MouseButton.LeftButton, pos=start)
    qtbot.mouseMove(canvas, end)
    assert canvas.marked_places == [pytest.approx(canvas.view.to_world(QPointF(end)))]
    qtbot.mouseRelease(canvas, Qt.MouseButton.LeftButton, pos=end)


def test_tabs_are_put_moved_and_taken_away_by_clicks(qtbot, wiring):
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
    aside = at + QPoint(30, 0)
    drag(qtbot, canvas, at, aside)
    (moved,) = document.job.operations[index].tabs.places
    assert moved == pytest.approx(canvas.view.to_world(QPointF(aside)), abs=0.001) and document.undo_name == "Move tab"
    document.undo()
    assert document.job.operations[index].tabs.places == (place,)
    qtbot.mouseClick(canvas, Qt.MouseButton.LeftButton, pos=at)
    assert document.job.operations[index].tabs.places == ()
    document.undo()
    assert document.job.operations[index].tabs == Tabs(places=(place,))
    qtbot.keyClick(canvas, Qt.Key.Key_Escape)
    assert hand.text() == BY_HAND


def drag_and_zoom(qtbot, canvas, start: QPoint, end: QPoint) -> None:
    """Drag from one px to another, and turn the wheel there before the button goes up."""
    qtbot.mousePress(canvas, Qt.MouseButton.LeftButton, pos=start)
    qtbot.mouseMove(canvas, end)
    canvas.zoom_by(3.0, QPointF(end))
    assert canvas.marker_mode is None or canvas.marked_places == [canvas.view.to_world(QPointF(end))]
    qtbot.mouseRelease(canvas, Qt.MouseButton.LeftButton, pos=end)


def test_a_place_is_moved_from_where_the_button_went_down_though_the_view_moves(qtbot, canvas):
    """Kept in px, the start was elsewhere after a turn of the wheel: another tab was put, and none moved."""
    moved: list[tuple] = []
    canvas.mark(MarkerMode("Places", lambda: [(20.0, 0.0)], lambda *_: None, move=lambda *way: moved.append(way)))
    start, end = canvas.view.to_screen((20.3, 0.3)).toPoint(), QPoint(300, 200)
    at, reach = canvas.view.to_world(QPointF(start)), PICK_PX / canvas.view.scale
    drag_and_zoom(qtbot, canvas, start, end)
    assert moved == [(at, canvas.view.to_world(QPointF(end)), reach)]


def test_a_window_selects_from_where_the_button_went_down_though_the_view_moves(qtbot, canvas):
    start, end = (canvas.view.to_screen(place).toPoint() for place in ((-5.0, 45.0), (45.0, -5.0)))
    drag_and_zoom(qtbot, canvas, start, end)
    assert canvas.document.selection == frozenset(range(1, 9))


def test_the_stock_grows_with_copies_and_not_with_clamps(qtbot, document):
    panel = SidePanel(document)
    qtbot.addWidget(panel)
    stock = drawn_stock(replace(document.job, copies=Copies(3, 2, 50.0, -60.0)), (0.0, 0.0, 40.0, 40.0))
    assert (stock.x0, stock.y0, stock.x1, stock.y1) == (0.0, -60.0, 140.0, 40.0)
    panel.show_size((40.0, 40.0), stock.size)
    assert panel.job.stock.text() == "140.000 \u00d7 100.000 \u00d7 10.000 mm"
