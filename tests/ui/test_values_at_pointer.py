"""Values typed at the pointer: the real canvas, real keys, and the line of the shape language that comes of them."""

from __future__ import annotations

import math
from itertools import pairwise

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QGuiApplication
from PySide6.QtTest import QTest
from pytestqt.qtbot import QtBot

from app.core.catalogue import catalogue
from app.drafting.document import Document
from app.model.curves import Circle, Line, Point
from app.ui.shell.window_controller import WindowController
from app.ui.views.canvas.drawing_tool import DrawingTool, ToolContext
from app.ui.views.canvas.modes import CanvasTool as T
from app.ui.views.canvas.prompt_tool import PromptTool
from app.ui.views.canvas.tool_runner import ToolRunner
from app.ui.views.canvas.tool_table import TOOLS
from app.ui.views.canvas.typed_values import rows_of
from app.ui.views.canvas.value_boxes import PLACE, RADIUS, SIZE, SPAN, STEP, PointBoxes
from app.ui.views.canvas.value_picture import SheetPlace, ValueSheet
from tests.ui.test_canvas import Hand

TAB, BACKTAB, ENTER, ESC, BACK = (
    Qt.Key.Key_Tab,
    Qt.Key.Key_Backtab,
    Qt.Key.Key_Return,
    Qt.Key.Key_Escape,
    Qt.Key.Key_Backspace,
)
PLATE = ("rect 10,10 60,40", "circle 90,60 10")
CROSS = ("line 10,20 90,20", "line 50,0 50,60")

Step = str | Qt.Key | Point


def do(hand: Hand, *steps: Step) -> None:
    """Type a text, press a key, click a place; "move x,y" points there."""
    for step in steps:
        if isinstance(step, Qt.Key):
            hand.key(step)
        elif isinstance(step, tuple):
            hand.click(step)
        elif step.startswith("move "):
            x, y = step.removeprefix("move ").split(",")
            hand.move(float(x), float(y))
        else:
            hand.qtbot.keyClicks(hand.canvas, step)


def boxes(hand: Hand) -> dict[str, str]:
    """What the boxes show."""
    return {row.name: row.text for row in hand.canvas.entry.shown()}


JOBS: dict[str, tuple[T, tuple[str, ...], tuple[Step, ...], str]] = {
    "both sizes of a rectangle": (
        T.RECTANGLE,
        (),
        ((10, 10), "move 20,20", "80", TAB, "50", ENTER),
        "rect 10,10 90,60",
    ),
    "sizes lie on the side of the pointer": (
        T.RECTANGLE,
        (),
        ((60, 60), "move 50,70", "20", TAB, "30", ENTER),
        "rect 60,60 40,90",
    ),
    "one size held, the pointer sets the other": (
        T.RECTANGLE,
        (),
        ((10, 10), "move 20,20", "80", TAB, (30, 45)),
        "rect 10,10 90,45",
    ),
    "the first corner too": (
        T.RECTANGLE,
        (),
        ("move 50,50", "0", TAB, "5", ENTER, "80", TAB, "50", ENTER),
        "rect 0,5 80,55",
    ),
    "a point typed in a box": (T.RECTANGLE, (), ((10, 10), "move 20,20", "60,40", ENTER), "rect 10,10 60,40"),
    "a point relative to the one before": (T.RECTANGLE, (), ((10, 10), "@80,50", ENTER), "rect 10,10 90,60"),
    "sizes, then the radius": (
        T.RECTANGLE_ROUND,
        (),
        ((10, 10), "move 20,20", "80", TAB, "50", ENTER, "8", ENTER),
        "rect 10,10 90,60 round 8",
    ),
    "a length towards the pointer": (T.LINE, (), ((10, 10), "move 40,50", "100", ENTER), "line 10,10 70,90"),
    "length and angle": (T.LINE, (), ((10, 10), "move 40,50", "20", TAB, "90", ENTER), "line 10,10 10,30"),
    "an angle held, the pointer sets the length": (
        T.LINE,
        (),
        ((10, 10), "move 40,50", TAB, TAB, "90", (40, 50)),
        "line 10,10 10,50",
    ),
    "an expression": (T.CIRCLE, (), ((50, 50), "move 60,50", "25.4/2", ENTER), "circle 50,50 12.7"),
    "a unit": (T.CIRCLE, (), ((50, 50), "move 60,50", "1in", ENTER), "circle 50,50 25.4"),
    "a diameter": (T.CIRCLE, (), ((50, 50), "move 60,50", TAB, TAB, "12", ENTER), "circle 50,50 6"),
    "the diameter in the place of the radius": (
        T.CIRCLE,
        (),
        ((50, 50), "move 60,50", "9", TAB, "12", ENTER),
        "circle 50,50 6",
    ),
    "how far an arc goes round": (
        T.ARC_CENTRE,
        (),
        ((50, 50), (60, 50), "move 55,58", "90", ENTER),
        "arc 60,50 50,60 centre 50,50",
    ),
    "the other way round": (
        T.ARC_CENTRE,
        (),
        ((50, 50), (60, 50), "move 55,42", "270", ENTER),
        "arc 60,50 50,60 centre 50,50 cw",
    ),
    "the width of a slot": (T.SLOT, (), ((20, 20), "move 50,20", "40", ENTER, "8", ENTER), "slot 20,20 60,20 8"),
    "corners and radius of a polygon": (
        T.POLYGON,
        (),
        ((50, 50), "move 60,50", "20", TAB, TAB, "8", ENTER),
        "polygon 8 50,50 70,50",
    ),
    "half axes": (
        T.ELLIPSE,
        (),
        ((50, 50), "move 60,50", "30", ENTER, "12.5", ENTER),
        "ellipse 50,50 80,50 12.5",
    ),
    "the angle of a construction line": (T.GUIDE, (), ((10, 10), "30", ENTER), "guide 10,10 30"),
    "a distance to move": (T.MOVE, (*PLATE, "select 5"), ((90, 60), "move 70,60", "25", ENTER), "move @-25,0"),
    "copies": (
        T.COPY,
        (*PLATE, "select 5"),
        ((90, 60), "move 90,70", "15", TAB, TAB, "3", ENTER),
        "copy @0,15 times 3",
    ),
    "an angle to rotate by": (T.ROTATE, (*PLATE, "select 1-4"), ((10, 10), "-30", ENTER), "rotate 10,10 -30"),
    "a factor": (T.SCALE, (*PLATE, "select 1-4"), ((10, 10), "2.5", ENTER), "scale 10,10 2.5"),
    "a factor after the old size": (
        T.SCALE,
        (*PLATE, "select 1-4"),
        ((10, 10), (60, 10), "3", ENTER),
        "scale 10,10 3",
    ),
    "columns, rows and steps": (
        T.ARRAY,
        (*PLATE, "select 5"),
        ("4", TAB, "3", ENTER, (90, 60), "25", TAB, "-30", ENTER),
        "array 4 3 @25,-30",
    ),
    "places round a centre": (
        T.ARRAY_POLAR,
        (*PLATE, "select 5"),
        ("8", ENTER, (60, 60)),
        "array polar 60,60 8",
    ),
    "an offset's distance, then its side": (T.OFFSET, (*PLATE, "select 5"), ("3", ENTER, (95, 62)), "offset 3 95,62"),
    "an offset's distance taken by the click": (T.OFFSET, (*PLATE, "select 5"), ("3", (95, 62)), "offset 3 95,62"),
    "a fillet's radius": (T.FILLET, CROSS, ("6", ENTER, (70, 20), (50, 40)), "fillet 6 1 70,20 2 50,40"),
    "two sizes of a chamfer": (
        T.CHAMFER,
        CROSS,
        ("3", TAB, "4", ENTER, (70, 20), (50, 40)),
        "chamfer 3 and 4 1 70,20 2 50,40",
    ),
    "a value edited with Backspace": (T.CIRCLE, (), ((50, 50), "move 60,50", "75", BACK, ENTER), "circle 50,50 7"),
    "the box before": (
        T.RECTANGLE,
        (),
        ((10, 10), "move 20,20", "8", TAB, "50", BACKTAB, "80", ENTER),
        "rect 10,10 90,60",
    ),
}


@pytest.mark.parametrize("job", JOBS.values(), ids=JOBS)
def test_what_is_typed_at_the_pointer_is_one_line(qtbot: QtBot, job: tuple[T, tuple[str, ...], tuple[Step, ...], str]):
    tool, before, steps, line = job
    hand = Hand(qtbot, before)
    hand.canvas.set_tool(tool)
    do(hand, *steps)
    assert hand.messages == []
    assert hand.said() == [*before, line]


def test_boxes_follow_the_pointer_and_hold_what_was_typed(qtbot: QtBot) -> None:
    hand = Hand(qtbot)
    hand.canvas.set_tool(T.RECTANGLE)
    assert boxes(hand) == {}, "where there is nothing to start from, nothing is in the way"
    do(hand, (10, 10), "move 30,25")
    assert boxes(hand) == {"Width": "20.000", "Height": "15.000"}
    do(hand, "80", TAB, "move 40,50")
    assert boxes(hand) == {"Width": "80.000", "Height": "40.000"}
    assert [row.held for row in hand.canvas.entry.shown()] == [True, False]
    assert hand.canvas.runner.preview(hand.canvas.entry.at).curves[0] == Line((10, 10), (90, 10))


def test_a_value_shapes_the_preview_while_it_is_typed(qtbot: QtBot) -> None:
    hand = Hand(qtbot)
    hand.canvas.set_tool(T.CIRCLE)
    do(hand, (50, 50), "move 60,50", "1")
    radii = []
    for more in ("", "2", ".5"):
        do(hand, more)
        (curve,) = hand.canvas.runner.preview(hand.canvas.entry.at).curves
        assert isinstance(curve, Circle)
        radii.append(curve.radius)
    assert radii == pytest.approx([1.0, 12.0, 12.5])


def test_a_number_of_the_tool_shapes_the_preview_and_esc_brings_back_the_old_one(qtbot: QtBot) -> None:
    hand = Hand(qtbot, (*PLATE, "select 5"))
    hand.canvas.set_tool(T.OFFSET)
    do(hand, "move 104,60", "7")
    (new,) = hand.canvas.runner.preview(hand.canvas.entry.at).trial.added
    assert new.curve == Circle((90, 60), 17)
    do(hand, ESC)
    (new,) = hand.canvas.runner.preview(hand.canvas.entry.at).trial.added
    assert new.curve == Circle((90, 60), 14)


def test_escape_gives_up_the_values_first_then_the_shape(qtbot: QtBot) -> None:
    hand = Hand(qtbot)
    hand.canvas.set_tool(T.RECTANGLE)
    do(hand, (10, 10), "move 30,25", "80", TAB, "5", ESC)
    assert boxes(hand) == {"Width": "20.000", "Height": "15.000"}
    assert hand.canvas.runner.busy
    do(hand, ESC)
    assert not hand.canvas.runner.busy


def test_backspace_in_an_empty_box_releases_its_value_and_takes_no_point_back(qtbot: QtBot) -> None:
    hand = Hand(qtbot)
    hand.canvas.set_tool(T.RECTANGLE)
    do(hand, (10, 10), "move 30,25", "8", BACK, BACK)
    assert hand.canvas.runner.busy
    assert boxes(hand)["Width"] == "20.000"
    do(hand, ESC, BACK)
    assert not hand.canvas.runner.busy, "with no box open it takes the point back, as ever"


def test_enter_goes_to_a_box_that_neither_value_nor_pointer_sets(qtbot: QtBot) -> None:
    hand = Hand(qtbot)
    hand.canvas.set_tool(T.RECTANGLE)
    do(hand, (10, 10), "80", ENTER)
    assert hand.document.log == [] and hand.canvas.runner.busy, "the mouse is still on the first corner"
    do(hand, "50", ENTER)
    assert hand.said() == ["rect 10,10 90,60"]


def test_values_alone_draw_while_the_mouse_is_elsewhere(qtbot: QtBot) -> None:
    hand = Hand(qtbot)
    hand.canvas.set_tool(T.RECTANGLE)
    do(hand, "10", TAB, "20", ENTER, "80", TAB, "50", ENTER)
    assert hand.said() == ["rect 10,20 90,70"]


def test_an_unlikely_length_is_shown_before_it_is_taken(qtbot: QtBot) -> None:
    hand = Hand(qtbot)
    hand.canvas.set_tool(T.LINE)
    do(hand, (10, 10), "move 40,50", "8050", ENTER)
    assert hand.document.log == []
    assert "8\u2009050 mm" in hand.canvas.entry.doubt
    do(hand, ENTER)
    assert hand.said() == ["line 10,10 4840,6450"]


def test_an_unlikely_length_is_not_taken_by_the_first_click_either(qtbot: QtBot) -> None:
    hand = Hand(qtbot)
    hand.canvas.set_tool(T.LINE)
    do(hand, (10, 10), "move 40,50", "8050", (40, 50))
    assert hand.document.log == [] and hand.canvas.entry.doubt
    do(hand, BACK, BACK, (40, 50))
    assert hand.said() == ["line 10,10 58,74"]


@pytest.mark.parametrize(
    ("tool", "steps", "text", "reason"),
    [
        (T.CIRCLE, ((50, 50),), "25.4/", "expected"),
        (T.CIRCLE, ((50, 50),), "-3", "more than 0"),
        (T.RECTANGLE, ((50, 50),), "0", "Width is 0"),
        (T.POLYGON, (), "2.5", "whole number"),
        (T.LINE, ((50, 50),), "5kg", "no unit"),
    ],
)
def test_a_text_that_is_no_value_says_why_and_is_not_taken(
    qtbot: QtBot, tool: T, steps: tuple[Step, ...], text: str, reason: str
) -> None:
    hand = Hand(qtbot)
    hand.canvas.set_tool(tool)
    do(hand, *steps, "move 60,60", text)
    assert reason in hand.canvas.entry.wrong
    do(hand, ENTER, (70, 70))
    assert hand.document.log == [] and hand.canvas.entry.editing
    do(hand, ESC)
    assert hand.canvas.entry.wrong == ""


def test_a_wrong_radius_keeps_the_rectangle_in_sight(qtbot: QtBot) -> None:
    hand = Hand(qtbot)
    hand.canvas.set_tool(T.RECTANGLE_ROUND)
    do(hand, (10, 10), (60, 40))
    for radius in ("", "40", "4"):
        do(hand, radius)
        shown = hand.canvas.runner.preview(hand.canvas.entry.at)
        assert shown.curves or shown.trial.added, "between two questions, and with a radius that does not fit"


def test_paste_goes_into_the_box(qtbot: QtBot) -> None:
    hand = Hand(qtbot)
    hand.canvas.set_tool(T.CIRCLE)
    do(hand, (50, 50), "move 60,50", TAB)
    QGuiApplication.clipboard().setText("12.5")
    qtbot.keyClick(hand.canvas, Qt.Key.Key_V, Qt.KeyboardModifier.ControlModifier)
    do(hand, ENTER)
    assert hand.said() == ["circle 50,50 12.5"]


def test_without_a_tool_a_figure_is_text_for_the_command_line(qtbot: QtBot) -> None:
    hand = Hand(qtbot)
    with qtbot.waitSignal(hand.canvas.key_typed) as typed:
        qtbot.keyClicks(hand.canvas, "4")
    assert typed.args == ["4"] and not hand.canvas.entry.editing


def test_undo_takes_back_what_the_values_drew(qtbot: QtBot) -> None:
    hand = Hand(qtbot)
    hand.canvas.set_tool(T.LINE)
    do(hand, (10, 10), "move 40,50", "10", ENTER, "move 70,50", "20", ENTER)
    assert len(hand.curves()) == 2
    hand.document.undo()
    assert len(hand.curves()) == 1
    assert not hand.canvas.entry.editing


@pytest.mark.parametrize("kind", TOOLS, ids=lambda kind: kind.value)
def test_every_box_of_every_tool_has_a_japanese_name(kind: T) -> None:
    document = Document()
    for line in PLATE:
        document.run(line)
    tool, words = TOOLS[kind](), catalogue("ja")
    if isinstance(tool, PromptTool):
        tool.desk = ToolContext(document, {})
    for _ in range(4):
        names = {row.box.name for row in rows_of(tool)} - {"X", "Y"}
        assert {name for name in names if words.look_up(name) is None} == set()
        if isinstance(tool, PromptTool):
            tool.answers = [*tool.answers, (3.0, 4.0)]
        tool.points = [*tool.points, (3.0, 4.0)]


COORDINATE = st.integers(-400, 400).map(lambda tenths: tenths / 10)
AWAY = st.tuples(COORDINATE, COORDINATE).filter(lambda p: abs(p[0]) > 0.5 and abs(p[1]) > 0.5)
VALUE = st.integers(1, 900).map(lambda tenths: tenths / 10)


@settings(max_examples=60, deadline=None)
@given(base=AWAY, away=AWAY, first=VALUE, second=VALUE)
def test_boxes_and_pointer_give_the_line_that_typing_gives(
    base: Point, away: Point, first: float, second: float
) -> None:
    """The same shape, once by values held beside a pointer, once as the command line has always taken it."""
    pointer = (round(base[0] + away[0], 3), round(base[1] + away[1], 3))
    x, y = math.copysign(first, away[0]), math.copysign(second, away[1])
    cases: tuple[tuple[T, dict[int, float], str], ...] = (
        (T.RECTANGLE, {0: first, 1: second}, f"@{x},{y}"),
        (T.LINE, {0: first}, f"{first}"),
        (T.LINE, {0: first, 1: second}, f"@{first}<{second}"),
        (T.CIRCLE, {0: first}, f"{first}"),
        (T.CIRCLE, {1: first}, f"{first}/2"),
        (T.CIRCLE_TWO, {0: first}, f"{first}"),
        (T.POLYGON, {0: first, 1: second}, f"@{first}<{second}"),
    )
    for kind, held, text in cases:
        lines = []
        for by_boxes in (True, False):
            document = Document()
            runner = ToolRunner(document, pytest.fail)
            runner.start(kind)
            runner.click(base)
            runner.aim_at(pointer)
            if by_boxes:
                assert runner.tool is not None
                for part, value in held.items():
                    runner.typed.hold(runner.tool, part, value)
                runner.click(pointer)
            else:
                assert runner.type_text(text)
            (line,) = (entry.command for entry in document.log)
            lines.append(line)
        assert lines[0] == lines[1], kind


@settings(max_examples=100, deadline=None)
@given(base=AWAY, away=AWAY, values=st.tuples(VALUE, VALUE), which=st.tuples(st.booleans(), st.booleans()))
def test_a_held_value_is_what_the_point_measures(
    base: Point, away: Point, values: tuple[float, float], which: tuple[bool, bool]
) -> None:
    pointer = (base[0] + away[0], base[1] + away[1])
    for asked in (SPAN, SIZE, STEP, PLACE, RADIUS):
        held = [value if on else None for value, on in zip(values, which, strict=True)]
        if asked.either and all(which):
            held[0] = None
        point = asked.point(base, pointer, held)
        measured = asked.values(base, point)
        for value, found in zip(held, measured, strict=True):
            assert value is None or found == pytest.approx(value, abs=1e-9)
        if not any(which):
            assert point == pointer


def test_angles_of_a_span_reach_all_round() -> None:
    for degrees in range(0, 360, 15):
        x, y = SPAN.point((1.0, 2.0), (9.0, 9.0), (10.0, float(degrees)))
        assert math.degrees(math.atan2(y - 2, x - 1)) % 360 == pytest.approx(degrees % 360, abs=1e-9)


AREA = QRectF(24, 24, 800, 600)
PX = st.tuples(st.floats(24, 824), st.floats(24, 624)).map(lambda p: QPointF(*p))


@settings(max_examples=200, deadline=None)
@given(mouse=PX, base=PX, end=PX, width=st.floats(60, 300), height=st.floats(30, 140))
def test_the_sheet_stays_inside_and_covers_neither_pointer_nor_end(
    mouse: QPointF, base: QPointF, end: QPointF, width: float, height: float
) -> None:
    sheet = SheetPlace(mouse, base, end, AREA).sheet(width, height)
    assert AREA.contains(sheet)
    assert not sheet.contains(mouse)
    assert not sheet.contains(end)


def test_the_sheet_moves_with_the_mouse(qtbot: QtBot) -> None:
    hand = Hand(qtbot)
    hand.canvas.set_tool(T.LINE)
    do(hand, (10, 10), "move 40,50")
    sheets = []
    for x in (40, 50, 60):
        do(hand, f"move {x},50")
        mouse = hand.canvas.mouse
        assert mouse is not None
        sheets.append(SheetPlace(mouse, None, mouse, hand.canvas.area).sheet(120, 60).left())
    assert [b - a for a, b in pairwise(sheets)] == pytest.approx([50, 50], abs=1), "10 mm at 5 px"
    assert ValueSheet.of(hand.canvas.entry, []).rows[0].name == "Length"


class Counting:
    """A mouse and a keyboard on the real window that count clicks and values."""

    def __init__(self, qtbot: QtBot, wiring: WindowController) -> None:
        self._qtbot, self._window = qtbot, wiring.window_
        self.clicks = self.values = 0

    def tool(self, kind: T) -> None:
        """Click the tool's button."""
        self.clicks += 1
        self._window.actions_[f"tool_{kind.value}"].trigger()

    def type(self, *values: str) -> None:
        """Type values, Tab between them, Enter behind the last; keys go where the focus is."""
        for at, value in enumerate(values):
            self.values += 1
            self._qtbot.keyClicks(self._window.focusWidget(), value)
            self._qtbot.keyClick(self._window.focusWidget(), TAB if at + 1 < len(values) else ENTER)


def test_a_plate_with_round_corners_and_two_holes_takes_two_clicks_and_eleven_values(
    qtbot: QtBot, wiring: WindowController
) -> None:
    hand = Counting(qtbot, wiring)
    hand.tool(T.RECTANGLE_ROUND)
    hand.type("0", "0")
    hand.type("80", "50")
    hand.type("8")
    hand.tool(T.CIRCLE)
    for x in ("15", "65"):
        hand.type(x, "25")
        hand.type("3")
    assert [line.command for line in wiring.document.log] == [
        "rect 0,0 80,50 round 8",
        "circle 15,25 3",
        "circle 65,25 3",
    ]
    assert (hand.clicks, hand.values) == (2, 11)
    assert wiring.window_.canvas.hasFocus()


def test_every_question_for_a_point_has_boxes() -> None:
    """A tool without a declaration of its own has the usual ones."""
    tool = TOOLS[T.DIMENSION]()
    assert isinstance(tool, DrawingTool)
    assert tool.boxes is PLACE
    tool.points = [(1.0, 2.0)]
    assert isinstance(tool.boxes, PointBoxes) and tool.boxes is SPAN


def test_a_curve_that_was_picked_stays_lit_until_the_tool_has_both(qtbot: QtBot) -> None:
    hand = Hand(qtbot, CROSS)
    hand.canvas.set_tool(T.FILLET)
    middle = hand.at(30.0, 20.0)

    def lit() -> bool:
        around = [hand.canvas.grab().toImage().pixelColor(middle.x(), middle.y() + off) for off in (-2, 2)]
        return all(colour.green() > colour.red() + 20 for colour in around)

    QTest.mouseMove(hand.canvas.windowHandle(), hand.at(80.0, 55.0))  # wherever a test before has left it
    assert not lit()
    hand.click((20.0, 20.0))
    QTest.mouseMove(hand.canvas.windowHandle(), hand.at(80.0, 55.0))  # also where another window lies above
    assert lit(), "where nothing is under the mouse"
    hand.key(ESC)
    assert not lit()
