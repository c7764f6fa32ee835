"""Every tool by mouse, key and word on the real canvas: what is done with it becomes this line."""

import pytest
from PySide6.QtCore import Qt
from pytestqt.qtbot import QtBot

from app.drafting.document import Document
from app.model.curves import Arc, Circle, Line
from app.ui.views.canvas import form_tools as form
from app.ui.views.canvas.drawing_tool import Pick, ToolContext
from app.ui.views.canvas.modes import CanvasTool
from app.ui.views.canvas.prompt_tool import PromptTool
from tests.ui.test_canvas import RIGHT, Hand

ENTER = Qt.Key.Key_Return
PLATE = ("rect 10,10 60,40", "circle 90,60 10")
CROSS = ("line 10,20 90,20", "line 50,0 50,60")
T = CanvasTool

Job = tuple[CanvasTool, tuple[str, ...], tuple[object, ...], str]

JOBS: dict[str, Job] = {
    "arc with a radius by the mouse": (T.ARC_RADIUS, (), ((10, 10), (50, 10), (30, 0)), "arc 10,10 50,10 radius 25"),
    "arc with a typed radius": (T.ARC_RADIUS, (), ((10, 10), (50, 10), "move 30,5", "30"), "arc 10,10 50,10 radius 30"),
    "arc with a radius on the other side": (
        T.ARC_RADIUS,
        (),
        ((10, 10), (50, 10), (30, 20)),
        "arc 10,10 50,10 radius 25 cw",
    ),
    "arc onward": (T.ARC_ON, ("line 10,10 30,10",), ((40, 20),), "arc on 40,20"),
    "circle by a diameter": (T.CIRCLE_TWO, (), ((10, 10), (30, 10)), "circle diameter 10,10 30,10"),
    "circle by a typed diameter": (T.CIRCLE_TWO, (), ((10, 10), "move 30,10", "25"), "circle diameter 10,10 35,10"),
    "circle by three points": (T.CIRCLE_THREE, (), ((10, 10), (30, 10), (20, 20)), "circle through 10,10 30,10 20,20"),
    "round rectangle by the mouse": (T.RECTANGLE_ROUND, (), ((10, 10), (60, 40), (55, 40)), "rect 10,10 60,40 round 5"),
    "round rectangle with a typed radius": (
        T.RECTANGLE_ROUND,
        (),
        ((10, 10), (60, 40), "8"),
        "rect 10,10 60,40 round 8",
    ),
    "polygon": (T.POLYGON, (), ((40, 40), (60, 40)), "polygon 6 40,40 60,40"),
    "polygon of typed corners": (T.POLYGON, (), ("5", (40, 40), (60, 40)), "polygon 5 40,40 60,40"),
    "polygon by keys, flat side": (
        T.POLYGON,
        (),
        ((40, 40), Qt.Key.Key_Up, Qt.Key.Key_Up, "side", (60, 40)),
        "polygon 8 40,40 side 60,40",
    ),
    "slot": (T.SLOT, (), ((20, 20), (60, 20), (40, 24)), "slot 20,20 60,20 8"),
    "slot of a typed width": (T.SLOT, (), ((20, 20), (60, 20), "1/2in"), "slot 20,20 60,20 12.7"),
    "ellipse": (T.ELLIPSE, (), ((50, 50), (80, 50), (50, 65)), "ellipse 50,50 80,50 15"),
    "spline": (T.SPLINE, (), ((10, 10), (30, 30), (50, 10), ENTER), "spline 10,10 30,30 50,10"),
    "closed spline": (T.SPLINE, (), ((10, 10), (30, 30), (50, 10), "close"), "spline 10,10 30,30 50,10 close"),
    "move": (T.MOVE, (*PLATE, "select 5"), ((90, 60), (70, 60)), "move @-20,0"),
    "move by a typed distance": (T.MOVE, (*PLATE, "select 5"), ((90, 60), "move 70,60", "25"), "move @-25,0"),
    "copy": (T.COPY, (*PLATE, "select 5"), ((90, 60), (70, 70)), "copy @-20,10"),
    "copy three times": (T.COPY, (*PLATE, "select 5"), ("times 3", (90, 60), "@0,5"), "copy @0,5 times 3"),
    "rotate": (T.ROTATE, (*PLATE, "select 1-4"), ((10, 10), (10, 60)), "rotate 10,10 90"),
    "rotate a copy by a typed angle": (
        T.ROTATE,
        (*PLATE, "select 1-4"),
        ("copy", (10, 10), "30"),
        "rotate 10,10 30 copy",
    ),
    "scale by a factor": (T.SCALE, (*PLATE, "select 1-4"), ((10, 10), "2.5"), "scale 10,10 2.5"),
    "scale from one size to another": (
        T.SCALE,
        (*PLATE, "select 1-4"),
        ((10, 10), (60, 10), (110, 10)),
        "scale 10,10 2",
    ),
    "mirror": (T.MIRROR, (*PLATE, "select 5"), ((70, 10), (70, 50)), "mirror 70,10 70,50"),
    "mirror a copy": (T.MIRROR, (*PLATE, "select 5"), ("copy", (70, 10), (70, 50)), "mirror 70,10 70,50 copy"),
    "array": (T.ARRAY, (*PLATE, "select 5"), ("columns 2", (90, 60), "@25,30"), "array 2 2 @25,30"),
    "polar array": (T.ARRAY_POLAR, (*PLATE, "select 5"), (Qt.Key.Key_Down, (60, 60)), "array polar 60,60 5"),
    "polar array over an angle": (
        T.ARRAY_POLAR,
        (*PLATE, "select 5"),
        ("over", "90", "4", (60, 60)),
        "array polar 60,60 4 over 90",
    ),
    "offset through a point": (T.OFFSET, (*PLATE, "select 5"), ((105, 60),), "offset 5 105,60"),
    "offset at a distance": (T.OFFSET, (*PLATE, "select 5"), ("3", (95, 62)), "offset 3 95,62"),
    "trim": (T.TRIM, CROSS, ((70, 20),), "trim 1 70,20"),
    "extend": (T.EXTEND, ("line 10,20 40,20", "line 50,0 50,60"), ((35, 20),), "extend 1 35,20"),
    "break at a point": (T.BREAK, CROSS, ((30, 20), ENTER), "break 1 30,20"),
    "break between two": (T.BREAK, CROSS, ((30, 20), (40, 20)), "break 1 30,20 40,20"),
    "fillet": (T.FILLET, CROSS, ("6", (70, 20), (50, 40)), "fillet 6 1 70,20 2 50,40"),
    "fillet of every corner": (T.FILLET, (*PLATE, "select 1-4"), (ENTER,), "fillet 5"),
    "chamfer": (T.CHAMFER, CROSS, ((70, 20), (50, 40)), "chamfer 2 1 70,20 2 50,40"),
    "chamfer of two sizes": (
        T.CHAMFER,
        CROSS,
        ("size 3", "second 4", (70, 20), (50, 40)),
        "chamfer 3 and 4 1 70,20 2 50,40",
    ),
    "join": (T.JOIN, ("line 10,20 40,20", "line 40,20 90,20", "select 1-2"), (), "join"),
    "explode": (T.EXPLODE, (*PLATE, "select 5"), (), "explode"),
    "offset of a contour": (T.OFFSET, (*PLATE, "select 1-4"), ("3", (35, 25)), "offset 3 35,25"),
    "measure between points": (T.MEASURE, PLATE, ((10, 10), (60, 10)), "measure 10,10 60,10"),
    "measure what is selected": (T.MEASURE, (*PLATE, "select 1-5"), (), "measure"),
    "reverse": (T.REVERSE, (*PLATE, "select 1-4"), (), "reverse"),
}


NOTES = {
    "point": (form.PointTool, [(1.0, 2.0)], "point 1,2"),
    "construction line": (form.GuideTool, [(0.0, 0.0), (5.0, 5.0)], "guide 0,0 5,5"),
    "construction line at an angle": (form.GuideTool, [(0.0, 0.0), 30.0], "guide 0,0 30"),
    "construction line across": (form.GuideTool, ["across", (3.0, 4.0)], "guide across 3,4"),
    "dimension": (form.DimensionTool, [(0.0, 0.0), (30.0, 0.0), (15.0, 9.0)], "dimension 0,0 30,0 place 15,9"),
    "dimension up": (
        form.DimensionTool,
        ["up", (0.0, 0.0), (30.0, 8.0), (40.0, 4.0)],
        "dimension 0,0 30,8 place 40,4 up",
    ),
    "dimension of a curve": (
        form.DimensionTool,
        [Pick(4, (9.0, 9.0), Circle((0, 0), 9)), (20.0, 20.0)],
        "dimension 4 place 20,20",
    ),
    "dimension of an angle": (
        form.DimensionTool,
        ["angle", (0.0, 0.0), (9.0, 0.0), (0.0, 9.0), (5.0, 5.0)],
        "dimension angle 0,0 9,0 0,9 place 5,5",
    ),
    "text": (form.TextTool, [(1.0, 2.0), 'Say "M6"'], "text 1,2 10 \"Say 'M6'\""),
    "text along a curve": (
        form.TextTool,
        ["along", "centre", "back", Pick(4, (9.0, 0.0), Circle((0, 0), 9)), "No. {k + 1}"],
        'text along 4 10 "No. {k + 1}" align centre at 9,0 back',
    ),
    "text in a font": (
        form.TextTool,
        ["font", (1.0, 2.0), "Say", "DejaVu Sans"],
        'text 1,2 10 "Say" font "DejaVu Sans"',
    ),
    "measure": (form.MeasureTool, [(0.0, 0.0), (3.0, 4.0)], "measure 0,0 3,4"),
    "measure a curve": (form.MeasureTool, [Pick(7, (9.0, 9.0), Circle((0, 0), 9))], "measure 7"),
}


@pytest.mark.parametrize("job", NOTES.values(), ids=NOTES)
def test_notes_and_words_are_one_line(job: tuple[type[PromptTool], list[object], str]) -> None:
    make, answers, line = job
    tool = make()
    tool.desk = ToolContext(Document(), {})
    made = None
    for answer in answers:
        if isinstance(answer, tuple):
            made = tool.add(answer)
        elif isinstance(answer, str):
            made = tool.word(answer)
        elif isinstance(answer, float):
            made = tool.typed(answer)
        else:
            assert isinstance(answer, Pick)
            made = tool.give(answer)
    assert made == line


def do(hand: Hand, what: object) -> None:
    """Click a place, press a key, point somewhere, or type."""
    if isinstance(what, tuple):
        hand.click(what)
    elif isinstance(what, Qt.Key):
        hand.key(what)
    elif isinstance(what, str) and what.startswith("move "):
        x, y = what.split()[1].split(",")
        hand.move(float(x), float(y))
    else:
        assert hand.canvas.type_text(str(what))


@pytest.mark.parametrize("job", JOBS.values(), ids=JOBS)
def test_what_is_done_by_mouse_and_word_is_one_line(qtbot: QtBot, job: Job) -> None:
    tool, before, steps, line = job
    hand = Hand(qtbot, before)
    hand.canvas.set_tool(tool)
    for step in steps:
        do(hand, step)
    assert hand.messages == []
    assert hand.said() == [*before, line]


DRAWN = [job for job in JOBS.values() if job[2] and isinstance(job[2][-1], tuple) and job[0] is not T.MEASURE]


@pytest.mark.parametrize("job", DRAWN, ids=lambda job: job[3])
def test_what_is_shown_before_the_click_is_what_it_makes(qtbot: QtBot, job: Job) -> None:
    tool, before, steps, _ = job
    hand = Hand(qtbot, before)
    hand.canvas.set_tool(tool)
    for step in steps[:-1]:
        do(hand, step)
    hand.move(2, 100)
    hand.move(*steps[-1])  # type: ignore[misc]
    hand.canvas.grab()
    assert hand.canvas.aim is not None
    trial = hand.canvas.runner.preview(hand.canvas.aim.point).trial
    assert trial.added
    known = {e.id: e for e in hand.document.part.entities}
    hand.click(steps[-1])  # type: ignore[arg-type]
    assert trial.added == tuple(e for e in hand.document.part.entities if known.get(e.id) != e)


def test_without_a_selection_a_tool_asks_for_one_and_enter_goes_on(qtbot: QtBot) -> None:
    hand = Hand(qtbot, PLATE)
    hand.canvas.set_tool(CanvasTool.MOVE)
    assert "select" in hand.canvas.prompt
    hand.drag((5, 5), (65, 45))
    hand.click((100, 60))
    assert hand.document.selection == {1, 2, 3, 4, 5}, "clicks and windows add"
    hand.key(ENTER)
    assert "base point" in hand.canvas.prompt
    hand.click((10, 10), (10, 20))
    assert hand.said()[-1] == "move @0,10"
    assert hand.canvas.tool is CanvasTool.SELECT, "a move is done once"


def test_right_click_ends_the_selection_within_a_tool(qtbot: QtBot) -> None:
    hand = Hand(qtbot, PLATE)
    hand.canvas.set_tool(CanvasTool.ROTATE)
    hand.click((35, 10))
    hand.click((35, 25), button=RIGHT)
    assert "centre" in hand.canvas.prompt


def test_copies_go_on_until_enter(qtbot: QtBot) -> None:
    hand = Hand(qtbot, (*PLATE, "select 5"))
    hand.canvas.set_tool(CanvasTool.COPY)
    hand.click((90, 60), (70, 80), (110, 80))
    assert hand.said()[-2:] == ["copy @-20,20", "copy @20,20"]
    hand.key(ENTER)
    hand.key(ENTER)
    assert hand.canvas.tool is CanvasTool.SELECT


def test_a_fillet_that_fails_keeps_the_first_curve_and_takes_a_smaller_radius(qtbot: QtBot) -> None:
    hand = Hand(qtbot, ("line 10,10 20,10", "line 20,10 20,20"))
    hand.canvas.set_tool(CanvasTool.FILLET)
    assert hand.canvas.type_text("50")
    hand.click((14, 10), (20, 16))
    assert "radius 50.000" in hand.messages[-1]
    assert hand.canvas.type_text("2")
    hand.click((20, 16))
    assert hand.said()[-1] == "fillet 2 1 14,10 2 20,16"
    assert [type(c) for c in hand.curves()] == [Line, Line, Arc]


def test_a_tool_remembers_its_numbers(qtbot: QtBot) -> None:
    hand = Hand(qtbot)
    hand.canvas.set_tool(CanvasTool.POLYGON)
    assert hand.canvas.type_text("8")
    hand.canvas.set_tool(CanvasTool.LINE)
    hand.canvas.set_tool(CanvasTool.POLYGON)
    hand.click((40, 40), (60, 40))
    assert hand.said()[-1].startswith("polygon 8 ")


def test_trim_goes_on_and_says_what_cannot_be_trimmed(qtbot: QtBot) -> None:
    hand = Hand(qtbot, (*CROSS, "line 10,50 30,50"))
    hand.canvas.set_tool(CanvasTool.TRIM)
    hand.move(20, 50)
    assert hand.canvas.aim is not None
    assert "Nothing crosses" in hand.canvas.runner.preview(hand.canvas.aim.point).label
    hand.click((70, 20), (50, 10))
    assert hand.said()[-2:] == ["trim 1 70,20", "trim 2 50,10"]
    hand.click((100, 100))
    assert "No curve" in hand.messages[-1]
    assert hand.canvas.tool is CanvasTool.TRIM


def test_escape_gives_up_answers_first_then_the_tool(qtbot: QtBot) -> None:
    hand = Hand(qtbot, (*PLATE, "select 5"))
    hand.canvas.set_tool(CanvasTool.ROTATE)
    hand.click((10, 10))
    hand.key(Qt.Key.Key_Escape)
    assert (hand.canvas.tool, "centre" in hand.canvas.prompt) == (CanvasTool.ROTATE, True)
    hand.key(Qt.Key.Key_Escape)
    assert hand.canvas.tool is CanvasTool.SELECT
    assert hand.document.selection == {5}


def test_a_word_alone_begins_a_tool_and_an_alias_does(qtbot: QtBot) -> None:
    hand = Hand(qtbot)
    for word, tool in (
        ("slot", CanvasTool.SLOT),
        ("tr", CanvasTool.TRIM),
        ("mi", CanvasTool.MIRROR),
        ("arc", CanvasTool.ARC_THREE),
    ):
        assert hand.canvas.type_text(word)
        assert hand.canvas.tool is tool


def test_a_large_selection_is_shown_by_some_of_it_and_moved_whole(qtbot: QtBot) -> None:
    hand = Hand(qtbot, ("repeat 900 as k; circle k/10,50 1; end", "select all"))
    hand.canvas.set_tool(CanvasTool.MOVE)
    hand.click((5, 5))
    hand.move(5, 25)
    assert hand.canvas.aim is not None
    assert 100 < len(hand.canvas.runner.preview(hand.canvas.aim.point).trial.added) <= 400
    hand.click((5, 25))
    assert all(isinstance(c, Circle) and c.centre[1] == 70 for c in hand.curves())


def test_an_option_is_no_words_while_words_are_asked_for(qtbot: QtBot) -> None:
    hand = Hand(qtbot)
    hand.canvas.set_tool(CanvasTool.TEXT)
    hand.click((10, 10))
    hand.canvas.choose("font")
    hand.canvas.choose("height")
    assert hand.canvas.type_text("5")
    assert "type the words" in hand.canvas.prompt and "font on, height 5" in hand.canvas.prompt
    assert hand.canvas.type_text("font") and "name of a font" in hand.canvas.prompt
    assert hand.canvas.type_text("DejaVu Sans")
    assert hand.said() == ['text 10,10 5 "font" font "DejaVu Sans"'] and hand.messages == []


def test_a_font_that_is_not_there_loses_no_words(qtbot: QtBot) -> None:
    hand = Hand(qtbot)
    hand.canvas.set_tool(CanvasTool.TEXT)
    hand.canvas.choose("font")
    hand.click((10, 10))
    assert hand.canvas.type_text("Mt Fuji") and hand.canvas.type_text("No such font")
    assert "There is no font" in hand.messages[-1] and "name of a font" in hand.canvas.prompt
    assert hand.canvas.type_text("DejaVu Serif")
    assert hand.said()[-1] == 'text 10,10 10 "Mt Fuji" font "DejaVu Serif"'


def test_words_are_seen_while_they_are_typed(qtbot: QtBot) -> None:
    hand = Hand(qtbot)
    hand.canvas.set_tool(CanvasTool.TEXT)
    hand.canvas.choose("font")
    hand.click((10, 10))
    assert hand.canvas.runner.preview((10.0, 10.0)).label == "type the words"
    hand.canvas.see_words("HI")
    strokes = hand.canvas.runner.preview((10.0, 10.0)).trial.added
    assert strokes and hand.document.part.entities == ()
    hand.canvas.type_text("HI")
    hand.canvas.see_words("DejaVu Sans")
    outlines = hand.canvas.runner.preview((10.0, 10.0)).trial.added
    assert len(outlines) > len(strokes), "in the font"
    hand.canvas.see_words("")
    assert len(hand.canvas.runner.preview((10.0, 10.0)).trial.added) == len(strokes), "until one is named"
