"""The canvas as a hand uses it: the real widget, the real mouse, and lines of the drawing language as the outcome."""

import math

import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtGui import QKeyEvent, QWheelEvent
from pytestqt.qtbot import QtBot

from app.drafting.document import Document
from app.model.curves import Arc, Circle, Line
from app.model.stock_box import StockBox
from app.ui.framework.theme import LIGHT
from app.ui.views.canvas.canvas import BitmapFrame, Canvas, CanvasTool
from app.ui.views.canvas.painting.grid import cells_shown
from app.ui.views.canvas.view_transform import ViewTransform

LEFT, RIGHT, MIDDLE = Qt.MouseButton.LeftButton, Qt.MouseButton.RightButton, Qt.MouseButton.MiddleButton


class Hand:
    """A mouse and a keyboard on a canvas; places are in mm."""

    def __init__(self, qtbot: QtBot, lines: tuple[str, ...] = ()) -> None:
        self.document = Document()
        for line in lines:
            self.document.run(line)
        self.qtbot, self.canvas = qtbot, Canvas(self.document, LIGHT)
        qtbot.addWidget(self.canvas)
        self.canvas.resize(824, 624)
        self.canvas.show()
        self.canvas.set_view(ViewTransform(5.0, 124.0, 574.0))
        self.messages: list[str] = []
        self.canvas.message.connect(self.messages.append)

    def at(self, x: float, y: float) -> QPoint:
        return self.canvas.view.to_screen((x, y)).toPoint()

    def move(self, x: float, y: float) -> None:
        self.qtbot.mouseMove(self.canvas, self.at(x, y))

    def click(
        self,
        *places: tuple[float, float],
        button: Qt.MouseButton = LEFT,
        keys: Qt.KeyboardModifier = Qt.KeyboardModifier.NoModifier,
    ) -> None:
        for place in places:
            self.move(*place)
            self.qtbot.mouseClick(self.canvas, button, keys, self.at(*place))

    def drag(self, a: tuple[float, float], b: tuple[float, float], button: Qt.MouseButton = LEFT) -> None:
        self.qtbot.mousePress(self.canvas, button, pos=self.at(*a))
        target = self.at(*b)
        self.qtbot.mouseMove(self.canvas, (self.at(*a) + target) / 2)
        self.qtbot.mouseMove(self.canvas, target)
        self.qtbot.mouseRelease(self.canvas, button, pos=target)

    def key(self, key: Qt.Key) -> None:
        self.qtbot.keyClick(self.canvas, key)

    def curves(self) -> list[object]:
        return [e.curve for e in self.document.part.entities]

    def said(self) -> list[str]:
        return [line.command for line in self.document.log]


@pytest.fixture
def hand(qtbot: QtBot) -> Hand:
    return Hand(qtbot)


@pytest.fixture
def plate(qtbot: QtBot) -> Hand:
    return Hand(qtbot, ("rect 10,10 60,40", "circle 90,60 10"))


def test_two_clicks_draw_a_rectangle_and_say_so(hand: Hand) -> None:
    hand.canvas.set_tool(CanvasTool.RECTANGLE)
    hand.click((10, 10), (60, 40))
    assert hand.said() == ["rect 10,10 60,40"]
    assert hand.curves()[0] == Line((10, 10), (60, 10))
    assert len(hand.curves()) == 4


def test_two_clicks_draw_a_circle(hand: Hand) -> None:
    hand.canvas.set_tool(CanvasTool.CIRCLE)
    hand.click((50, 50), (58, 56))
    assert hand.curves() == [Circle((50, 50), 10)]


def test_lines_chain_until_enter(hand: Hand) -> None:
    hand.canvas.set_tool(CanvasTool.LINE)
    hand.click((10, 10), (30, 10), (30, 20))
    hand.key(Qt.Key.Key_Return)
    hand.move(80, 80)
    assert hand.said() == ["line 10,10 30,10", "line 30,10 30,20"]
    hand.click((50, 50))
    assert len(hand.curves()) == 2, "the next click begins a new chain"


def test_a_chain_closes_on_its_first_point(hand: Hand) -> None:
    hand.canvas.set_tool(CanvasTool.LINE)
    hand.click((10, 10), (30, 10), (30, 30), (10.8, 10.6))
    assert hand.curves()[-1] == Line((30, 30), (10, 10))
    hand.click((70, 70))
    assert len(hand.curves()) == 3, "the closed chain has ended"


def test_undo_within_a_chain_goes_on_from_the_line_before(hand: Hand) -> None:
    hand.canvas.set_tool(CanvasTool.LINE)
    hand.click((10, 10), (30, 10), (30, 30))
    hand.document.undo()
    hand.click((50, 20))
    assert hand.curves() == [Line((10, 10), (30, 10)), Line((30, 10), (50, 20))]
    hand.key(Qt.Key.Key_Backspace)
    hand.key(Qt.Key.Key_Backspace)
    hand.click((10, 40))
    assert hand.curves() == [Line((10, 10), (10, 40))]


def test_a_polyline_is_one_line_and_one_undo(hand: Hand) -> None:
    hand.canvas.set_tool(CanvasTool.POLYLINE)
    hand.click((10, 10), (30, 10))
    assert hand.canvas.type_text("a")
    hand.click((35, 15), (30, 20), (10, 20))
    assert hand.canvas.type_text("close")
    assert hand.said() == ["polyline 10,10 30,10 arc 35,15 30,20 10,20 close"]
    assert [type(c) for c in hand.curves()] == [Line, Arc, Line, Line]
    hand.document.undo()
    assert hand.curves() == []


@pytest.mark.parametrize(("way", "ccw"), [((30, 40), True), ((30, 20), False)])
def test_an_arc_turns_the_way_the_mouse_went(hand: Hand, way: tuple[float, float], ccw: bool) -> None:
    hand.canvas.set_tool(CanvasTool.ARC_CENTRE)
    hand.click((30, 30), (50, 30))
    for x, y in ((48, 30 + (way[1] - 30) / 3), way, (12, 30 + (way[1] - 30) / 3)):
        hand.move(x, y)
    hand.click((10, 30))
    (arc,) = hand.curves()
    assert isinstance(arc, Arc)
    assert (arc.ccw, arc.start, arc.end) == (ccw, (50, 30), (10, 30))
    assert arc.centre == pytest.approx((30, 30))


def test_an_arc_by_three_points(hand: Hand) -> None:
    hand.canvas.set_tool(CanvasTool.ARC_THREE)
    hand.click((20, 20), (30, 30), (40, 20))
    assert hand.said() == ["arc 20,20 30,30 40,20"]


def test_the_mouse_snaps_to_ends_middles_centres_and_quadrants(plate: Hand) -> None:
    plate.canvas.set_tool(CanvasTool.LINE)
    for near, exact in (
        ((60.9, 40.7), (60, 40)),
        ((35.5, 9.4), (35, 10)),
        ((90.8, 59.5), (90, 60)),
        ((89.3, 70.6), (90, 70)),
    ):
        plate.move(*near)
        assert plate.canvas.aim is not None
        assert plate.canvas.aim.point == exact
    plate.canvas.set_snap(False)
    assert plate.canvas.aim.point == (89.4, 70.6)


def test_grid_and_ortho_hold_the_mouse(hand: Hand) -> None:
    hand.canvas.set_tool(CanvasTool.LINE)
    hand.canvas.set_grid_snap(True)
    assert hand.canvas.grid_step == 5.0
    hand.click((11, 9), (41.4, 13.6))
    assert hand.said() == ["line 10,10 40,15"]
    hand.canvas.set_ortho(True)
    hand.click((61, 22))
    assert hand.said()[-1] == "line 40,15 60,15"
    hand.click((71, 22), keys=Qt.KeyboardModifier.ShiftModifier)
    assert hand.said()[-1] == "line 60,15 70,20", "Shift is the opposite of the switch"


def test_typed_coordinates_relative_polar_and_distance(hand: Hand) -> None:
    hand.canvas.set_tool(CanvasTool.LINE)
    for text in ("10,10", "@1in,0", "@10<90"):
        assert hand.canvas.type_text(text)
    hand.move(10, 20)
    assert hand.canvas.type_text("5+5")
    assert hand.canvas.type_text("close")
    ends = [c.end for c in hand.curves() if isinstance(c, Line)]
    assert [e for end in ends for e in end] == pytest.approx([35.4, 10, 35.4, 20, 25.4, 20, 10, 10])


def test_a_typed_radius_and_a_typed_command(hand: Hand) -> None:
    assert hand.canvas.type_text("ci")
    assert hand.canvas.tool is CanvasTool.CIRCLE
    assert hand.canvas.type_text("20,20")
    assert hand.canvas.type_text("1/4in")
    assert hand.curves() == [Circle((20, 20), 6.35)]
    assert not hand.canvas.type_text("circle 5,5 2"), "a whole line is the document's business"
    assert not hand.canvas.type_text("undo")


def test_a_wrong_point_is_told_in_a_sentence(hand: Hand) -> None:
    hand.canvas.set_tool(CanvasTool.LINE)
    assert hand.canvas.type_text("5,zz")
    assert hand.canvas.type_text("7")
    assert "'zz' is no" in hand.messages[0] or "number" in hand.messages[0]
    assert "without a direction" in hand.messages[1]
    assert hand.curves() == []


def test_a_shape_that_is_none_is_told_and_the_tool_goes_on(hand: Hand) -> None:
    hand.canvas.set_tool(CanvasTool.ARC_THREE)
    hand.click((20, 20), (30, 20), (40, 20))
    assert "straight line" in hand.messages[0]
    assert hand.canvas.tool is CanvasTool.ARC_THREE


def test_click_selects_and_del_deletes_and_undo_brings_back(plate: Hand) -> None:
    plate.click((35, 10.4))
    assert plate.document.selection == {1}
    plate.click((100, 60), keys=Qt.KeyboardModifier.ControlModifier)
    assert plate.document.selection == {1, 5}
    plate.click((35, 10), keys=Qt.KeyboardModifier.ShiftModifier)
    assert plate.document.selection == {5}
    plate.key(Qt.Key.Key_Delete)
    assert plate.said()[-1] == "delete 5"
    assert len(plate.curves()) == 4
    plate.document.undo()
    assert plate.curves()[-1] == Circle((90, 60), 10)
    plate.click((35, 10), (5, 80))
    assert plate.document.selection == frozenset()


def test_a_window_takes_what_is_inside_and_crossing_what_it_touches(plate: Hand) -> None:
    plate.drag((5, 5), (85, 45))
    assert plate.document.selection == {1, 2, 3, 4}
    plate.drag((85, 65), (55, 20))
    assert plate.document.selection == {2, 3, 5}
    assert plate.said()[-1].startswith("select crossing ")


def test_escape_gives_up_step_by_step(plate: Hand) -> None:
    plate.click((35, 10))
    plate.canvas.set_tool(CanvasTool.CIRCLE)
    plate.click((50, 50))
    plate.key(Qt.Key.Key_Escape)
    assert plate.canvas.tool is CanvasTool.CIRCLE
    plate.key(Qt.Key.Key_Escape)
    assert plate.canvas.tool is CanvasTool.SELECT
    assert plate.document.selection == {1}
    plate.key(Qt.Key.Key_Escape)
    assert plate.document.selection == frozenset()
    assert len(plate.curves()) == 5


def test_right_click_ends_and_enter_repeats(hand: Hand) -> None:
    hand.canvas.set_tool(CanvasTool.RECTANGLE)
    hand.click((10, 10))
    hand.click((20, 20), button=RIGHT)
    assert hand.canvas.tool is CanvasTool.RECTANGLE
    hand.click((20, 20), button=RIGHT)
    assert hand.canvas.tool is CanvasTool.SELECT
    hand.key(Qt.Key.Key_Return)
    assert hand.canvas.tool is CanvasTool.RECTANGLE


def test_prompts_say_what_is_expected_next(hand: Hand, qtbot: QtBot) -> None:
    prompts: list[str] = []
    tools: list[CanvasTool] = []
    hand.canvas.prompt_changed.connect(prompts.append)
    hand.canvas.tool_changed.connect(tools.append)
    hand.canvas.set_tool(CanvasTool.ARC_CENTRE)
    hand.click((10, 10), (20, 10))
    hand.canvas.cancel()
    hand.canvas.cancel()
    assert prompts[:3] == ["Arc: centre", "Arc: start point", "Arc: end point"]
    assert prompts[-1].startswith("Select:")
    assert tools == [CanvasTool.ARC_CENTRE, CanvasTool.SELECT]


def test_the_wheel_keeps_the_point_under_the_mouse(plate: Hand) -> None:
    at = QPointF(plate.at(60, 40))
    before, scale = plate.canvas.view.to_world(at), plate.canvas.view.scale
    wheel = QWheelEvent(
        at,
        plate.canvas.mapToGlobal(at),
        QPoint(),
        QPoint(0, 240),
        Qt.MouseButton.NoButton,
        Qt.KeyboardModifier.NoModifier,
        Qt.ScrollPhase.NoScrollPhase,
        False,
    )
    plate.canvas.wheelEvent(wheel)
    assert plate.canvas.view.scale == pytest.approx(scale * 1.44)
    assert plate.canvas.view.to_world(at) == pytest.approx(before)


def test_the_middle_button_and_space_pan(plate: Hand) -> None:
    view = plate.canvas.view
    plate.drag((10, 10), (20, 30), MIDDLE)
    assert (plate.canvas.view.ox, plate.canvas.view.oy) == (view.ox + 50, view.oy - 100)
    plate.qtbot.keyPress(plate.canvas, Qt.Key.Key_Space)
    plate.drag((20, 30), (10, 10))
    plate.qtbot.keyRelease(plate.canvas, Qt.Key.Key_Space)
    assert (plate.canvas.view.ox, plate.canvas.view.oy) == (view.ox, view.oy)
    assert plate.document.selection == frozenset()


@pytest.mark.parametrize("step", [(3, 0), (0, -5), (-40, 25), (300, -200), (2000, 0)])
def test_a_panned_picture_equals_one_painted_anew(plate: Hand, step: tuple[int, int]) -> None:
    plate.canvas.grab()
    plate.canvas.set_view(plate.canvas.view.panned(*step))
    shifted = plate.canvas.grab().toImage()
    plate.canvas.repaint_scene()
    assert shifted == plate.canvas.grab().toImage()


def test_home_glides_to_the_whole_part(plate: Hand) -> None:
    plate.key(Qt.Key.Key_Home)
    plate.qtbot.waitUntil(lambda: plate.canvas.view.scale > 7, timeout=2000)
    plate.qtbot.wait(250)
    box = plate.canvas.view.world_box(plate.canvas.area)
    assert box[0] < 10 and box[1] < 10 and box[2] > 100 and box[3] > 70
    middle = plate.canvas.view.to_world(plate.canvas.area.center())
    assert middle == pytest.approx((55, 40))


def test_a_resized_widget_keeps_its_middle(plate: Hand) -> None:
    before = plate.canvas.view.to_world(QPointF(412, 312))
    plate.canvas.resize(1000, 700)
    assert plate.canvas.view.to_world(QPointF(500, 350)) == pytest.approx(before)


def test_what_was_fitted_stays_fitted_when_the_widget_changes(qtbot: QtBot) -> None:
    document = Document()
    canvas = Canvas(document, LIGHT)
    qtbot.addWidget(canvas)
    canvas.resize(800, 600)
    canvas.show()
    canvas.resize(500, 300)
    box = canvas.view.world_box(canvas.area)
    assert box[0] < 0 and box[1] < 0 and box[2] > 100 and box[3] > 100
    canvas.zoom_by(3.0)
    scale = canvas.view.scale
    canvas.resize(800, 600)
    assert canvas.view.scale == scale


def test_cells_show_when_a_pixel_is_six_screen_pixels(hand: Hand) -> None:
    hand.canvas.set_view(ViewTransform(23.9, 100, 500))
    assert not cells_shown(hand.canvas.view, hand.canvas.frame)
    hand.canvas.set_view(ViewTransform(24.0, 100, 500))
    assert cells_shown(hand.canvas.view, hand.canvas.frame)
    hand.canvas.frame = BitmapFrame(100, 100, 0.1)
    assert not cells_shown(hand.canvas.view, hand.canvas.frame)


def test_characters_go_to_the_command_line(hand: Hand) -> None:
    typed: list[str] = []
    hand.canvas.key_typed.connect(typed.append)
    for character in "l@1":
        hand.canvas.keyPressEvent(QKeyEvent(QKeyEvent.Type.KeyPress, 0, Qt.KeyboardModifier.NoModifier, character))
    assert "".join(typed) == "l@1"


def test_the_status_hears_the_mouse_and_what_lies_under_it(plate: Hand) -> None:
    places: list[tuple[float, float]] = []
    hovered: list[str] = []
    plate.canvas.cursor_moved.connect(lambda x, y: places.append((x, y)))
    plate.canvas.hovered.connect(hovered.append)
    plate.move(35, 10)
    plate.move(35, 25)
    assert places[0] == (35, 10)
    assert hovered[0] == "Line 1 · 50.000 mm · layer 0"
    assert hovered[-1] == ""


def test_the_mouse_alone_never_repaints_the_scene(plate: Hand) -> None:
    plate.canvas.grab()
    scene = plate.canvas._scene.toImage()
    plate.canvas.set_tool(CanvasTool.LINE)
    plate.click((20, 60))
    plate.move(40, 70)
    plate.canvas.grab()
    assert plate.canvas._scene.toImage() == scene
    plate.click((40, 70))
    plate.canvas.grab()
    assert plate.canvas._scene.toImage() != scene


def test_a_double_click_gives_no_line_without_length(hand: Hand) -> None:
    hand.canvas.set_tool(CanvasTool.LINE)
    hand.click((10, 10))
    hand.qtbot.mouseDClick(hand.canvas, LEFT, pos=hand.at(10, 10))
    assert hand.messages == []
    assert hand.curves() == []


def test_every_click_sequence_replays(plate: Hand) -> None:
    plate.canvas.set_tool(CanvasTool.CIRCLE)
    plate.click((33.3, 71.7), (41.2, 76.9))
    plate.canvas.set_tool(CanvasTool.ARC_CENTRE)
    plate.click((60, 40), (71, 43), (55, 61))
    again = Document()
    again.run_script("\n".join(plate.said()))
    assert again.part == plate.document.part
    (arc,) = [c for c in plate.curves() if isinstance(c, Arc)]
    assert math.dist(arc.start, arc.centre) == pytest.approx(math.dist(arc.end, arc.centre), abs=1e-9)


def test_marks_of_the_display_are_no_riddle_in_a_drawing_that_does_not_fit_it(qtbot):
    hand = Hand(qtbot, ("rect 0,0 80,50",))
    hand.canvas.show()
    hand.canvas.fit_to((-5.0, -5.0, 125.0, 45.0))
    x, y = hand.canvas.view.to_screen((100.0, 0.0)).toTuple()

    def marked() -> bool:
        picture = hand.canvas.grab().toImage()
        along = [picture.pixelColor(round(x), round(y) - px).lightness() for px in range(2, 8)]
        return max(along) < 200

    assert marked(), "its lower right corner"
    hand.document.run("rect 0,0 120,40")
    assert not marked()


def test_a_stock_that_the_job_makes_larger_is_fitted_anew_unless_the_view_was_moved(plate: Hand) -> None:
    canvas, qtbot = plate.canvas, plate.qtbot
    canvas.set_stock(StockBox(10, 10, -10, 100, 70))
    canvas.fit_to((10, 10, 100, 70))
    canvas.set_stock(StockBox(-20, -20, -10, 130, 100))
    qtbot.waitUntil(lambda: canvas.area.contains(canvas.view.to_screen((130, 100))))
    assert canvas.area.contains(canvas.view.to_screen((-20, -20)))
    plate.document.run("line 0,0 400,0")
    still = canvas.view
    canvas.set_stock(StockBox(-20, -20, -10, 430, 100))
    assert canvas.view == still, "what is drawn does not move the view under the mouse"
    canvas.zoom_by(2.0)
    moved = canvas.view
    canvas.set_stock(StockBox(-50, -50, -10, 460, 130))
    qtbot.wait(200)
    assert canvas.view == moved
