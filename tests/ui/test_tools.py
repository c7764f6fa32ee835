"""The drawing tools without a widget: points in, lines of the drawing language out."""

import math

import pytest

from app.drafting.document import Document
from app.model.curves import Arc, Circle, Curve, Line, Point
from app.model.part import Part
from app.ui.views.canvas.chain_tools import LineTool, PolylineTool
from app.ui.views.canvas.drawing_tool import DrawingTool
from app.ui.views.canvas.modes import CanvasTool
from app.ui.views.canvas.painting.part_layer import PartLayer
from app.ui.views.canvas.round_tools import ArcCentreTool, CircleTool
from app.ui.views.canvas.snap import SnapKind
from app.ui.views.canvas.snapped_point import SnapRules, rounded, snapped_point
from app.ui.views.canvas.tool_runner import ToolRunner
from app.ui.views.canvas.tool_table import TOOLS, RectangleTool
from app.ui.views.canvas.typed_values import TypedValues, rows_of

PLACES = {
    CanvasTool.LINE: [(0.0, 0.0), (10.0, 0.0)],
    CanvasTool.POLYLINE: [(0.0, 0.0), (10.0, 0.0), (10.0, 7.0)],
    CanvasTool.ARC_CENTRE: [(0.0, 0.0), (5.0, 0.0), (0.0, 9.0)],
    CanvasTool.ARC_THREE: [(0.0, 0.0), (5.0, 5.0), (10.0, 0.0)],
    CanvasTool.CIRCLE: [(1.0, 1.0), (4.0, 5.0)],
    CanvasTool.RECTANGLE: [(0.0, 0.0), (4.0, 5.0)],
}


def curves_of(line: str) -> tuple[Curve, ...]:
    document = Document()
    document.run(line)
    return tuple(e.curve for e in document.part.entities)


@pytest.mark.parametrize("kind", PLACES, ids=lambda k: k.value)
def test_every_tool_makes_one_line_that_the_language_reads(kind: CanvasTool) -> None:
    tool = TOOLS[kind]()
    lines = [tool.add(p) for p in PLACES[kind]]
    line = lines[-1] or tool.finish()
    assert line is not None
    assert curves_of(line)
    assert lines[:-1] == [None] * (len(lines) - 1)


@pytest.mark.parametrize("kind", PLACES, ids=lambda k: k.value)
def test_the_preview_is_the_shape_that_a_click_makes(kind: CanvasTool) -> None:
    tool, places = TOOLS[kind](), PLACES[kind]
    for place in places[:-1]:
        tool.add(place)
    shown = tool.preview(places[-1]).curves
    line = tool.add(places[-1]) or tool.finish()
    assert line is not None
    assert shown == curves_of(line)


@pytest.mark.parametrize("kind", PLACES, ids=lambda k: k.value)
def test_a_preview_at_the_point_before_is_no_crash(kind: CanvasTool) -> None:
    tool = TOOLS[kind]()
    assert tool.preview((3.0, 3.0)).curves == ()
    for place in PLACES[kind][:-1]:
        tool.add(place)
        tool.preview(place)


def test_boxes_state_the_live_measures() -> None:
    line, circle, rectangle, arc = LineTool(), CircleTool(), RectangleTool(), ArcCentreTool()
    for tool in (line, circle, rectangle, arc):
        tool.add((0.0, 0.0))
    arc.add((10.0, 0.0))
    assert measures(line, (3.0, 4.0)) == {"Length": 5.0, "Angle": pytest.approx(53.1301, abs=1e-4)}
    assert measures(circle, (3.0, 4.0)) == {"Radius": 5.0, "Diameter": 10.0}
    assert measures(rectangle, (3.0, -4.0)) == {"Width": 3.0, "Height": 4.0}
    assert measures(arc, (0.0, 5.0)) == {"Sweep": pytest.approx(90.0)}


def measures(tool: DrawingTool, pointer: Point) -> dict[str, float | None]:
    return {row.box.name: TypedValues().shown(tool, row, pointer) for row in rows_of(tool)}


def test_an_arc_keeps_its_sense_past_half_a_turn() -> None:
    tool = ArcCentreTool()
    tool.add((0.0, 0.0))
    tool.add((10.0, 0.0))
    for degrees in range(0, -271, -10):
        tool.follow((10 * math.cos(math.radians(degrees)), 10 * math.sin(math.radians(degrees))))
    (arc,) = tool.preview((0.0, 10.0)).curves
    assert isinstance(arc, Arc)
    assert math.degrees(arc.sweep) == pytest.approx(-270)


def test_a_number_goes_towards_the_mouse() -> None:
    tool = LineTool()
    assert tool.number(5.0, (1.0, 0.0)) is None
    tool.add((10.0, 10.0))
    assert tool.number(5.0, (13.0, 14.0)) == pytest.approx((13, 14))
    assert tool.number(5.0, (10.0, 10.0)) is None


def test_a_polyline_closes_on_its_first_point() -> None:
    tool = PolylineTool()
    for place in ((0.0, 0.0), (5.0, 0.0), (5.0, 5.0)):
        tool.add(place)
    assert tool.add((0.0, 0.0)) == "polyline 0,0 5,0 5,5 close"
    assert tool.points == []


def test_a_polyline_may_close_by_an_arc() -> None:
    tool = PolylineTool()
    for place in ((0.0, 0.0), (5.0, 0.0), (5.0, 5.0)):
        tool.add(place)
    tool.word("arc")
    tool.add((0.0, 5.0))
    line = tool.add((0.0, 0.0))
    assert line == "polyline 0,0 5,0 5,5 arc 0,5 0,0"
    assert len(curves_of(line)) == 3


def test_points_of_a_polyline_can_be_taken_back() -> None:
    tool = PolylineTool()
    for place in ((0.0, 0.0), (5.0, 0.0)):
        tool.add(place)
    tool.word("a")
    tool.add((6.0, 1.0))
    tool.add((5.0, 2.0))
    tool.word("a")
    tool.add((9.0, 9.0))
    for _ in range(2):
        tool.back()
    assert (tool.arc, tool.points[-1]) == (False, (5.0, 2.0))
    tool.back()
    tool.add((8.0, 8.0))
    assert tool.finish() == "polyline 0,0 5,0 8,8"


def test_shift_makes_a_rectangle_a_square() -> None:
    tool = RectangleTool()
    tool.add((0.0, 0.0))
    assert tool.held_straight((3.0, -8.0)) == (8.0, -8.0)


def test_a_free_point_is_rounded_to_less_than_a_pixel() -> None:
    for scale in (0.5, 6.0, 24.0, 5000.0):
        x, y = rounded((12.3456789, -7.7654321), scale)
        assert max(abs(x - 12.3456789), abs(y + 7.7654321)) <= 0.51 / scale
        assert len(repr(x)) <= 8


def test_points_of_the_drawing_win_over_straight_and_grid() -> None:
    tool = LineTool()
    tool.add((0.0, 0.0))
    rules = SnapRules(snap=True, grid=True, straight=True, grid_step=5.0, scale=10.0)
    drawn, empty = PartLayer(), PartLayer()
    drawn.update(Part().with_curves((Line((20.0, 7.0), (30.0, 7.0)),), "0"))
    found = snapped_point((20.4, 7.3), tool, drawn, rules)
    assert (found.point, found.snap and found.snap.kind) == ((20.0, 7.0), SnapKind.END)
    free = snapped_point((20.4, 7.3), tool, empty, rules)
    assert free.point == (20.0, 0.0)


def test_the_chain_may_snap_to_its_own_first_point() -> None:
    tool = LineTool()
    for place in ((0.0, 0.0), (10.0, 0.0), (10.0, 10.0)):
        tool.add(place)
    rules = SnapRules(snap=True, grid=False, straight=False, grid_step=1.0, scale=10.0)
    assert snapped_point((0.4, 0.4), tool, PartLayer(), rules).point == (0.0, 0.0)


def test_the_runner_carries_lines_out_and_tells_errors() -> None:
    document, said = Document(), []
    runner = ToolRunner(document, said.append)
    runner.start(CanvasTool.CIRCLE)
    runner.click((0.0, 0.0))
    assert runner.type_text("-5") is True
    assert runner.type_text("0") is True
    assert said, "a circle without size is told"
    runner.click((0.0, 0.0))
    assert runner.type_text("5") is True
    assert document.part.entities[-1].curve == Circle((0, 0), 5)


@pytest.mark.parametrize("text", ["", "undo", "line 0,0 5,5", "hello", "select all"])
def test_what_is_nothing_for_a_tool_is_handed_back(text: str) -> None:
    runner = ToolRunner(Document(), print)
    runner.start(CanvasTool.LINE)
    assert runner.type_text(text) is False


def test_names_can_be_typed_into_a_running_tool_and_statements_go_to_the_document() -> None:
    document = Document()
    document.run_script("let w = 40\nlet p = 10,20")
    runner = ToolRunner(document, lambda text: None)
    runner.start(CanvasTool.CIRCLE)
    assert runner.type_text("p") and runner.type_text("w/10 + 1")
    runner.start(CanvasTool.LINE)
    assert runner.type_text("p + (1,1)") and runner.type_text("@w,0")
    assert [e.curve for e in document.part.entities] == [Circle((10, 20), 5), Line((11, 21), (51, 21))]
    for line in (
        "repeat 3 as k; circle w+k*10,12 3; end",
        "let a = 3; circle a,a 2",
        "let b = 4",
        "if 1 > 0; circle 0,0 1; end",
    ):
        assert not runner.type_text(line)
