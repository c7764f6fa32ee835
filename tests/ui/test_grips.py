"""Grips, dragging and choosing among several with the real mouse on the real canvas."""

import pytest
from PySide6.QtCore import QEvent, QPointF, Qt
from PySide6.QtGui import QMouseEvent
from pytestqt.qtbot import QtBot

from app.model.curves import Circle, Line
from app.model.job import Job
from app.model.notes import Dimension, DimensionKind, Guide, Mark
from app.model.part import Part
from app.ui.views.canvas.grips import GripDragTool, SelectionDragTool
from app.ui.views.canvas.modes import CanvasMode, CanvasTool
from app.ui.views.canvas.view_transform import ViewTransform
from tests.ui.test_canvas import LEFT, Hand


@pytest.fixture
def plate(qtbot: QtBot) -> Hand:
    return Hand(qtbot, ("rect 10,10 60,40", "circle 90,60 10"))


def press(hand: Hand, at: tuple[float, float], keys: Qt.KeyboardModifier = Qt.KeyboardModifier.NoModifier) -> None:
    hand.qtbot.mousePress(hand.canvas, LEFT, keys, hand.at(*at))


def release(hand: Hand, at: tuple[float, float], keys: Qt.KeyboardModifier = Qt.KeyboardModifier.NoModifier) -> None:
    hand.qtbot.mouseRelease(hand.canvas, LEFT, keys, hand.at(*at))


def test_a_corner_dragged_takes_both_lines_in_one_line_of_the_log(plate: Hand) -> None:
    plate.document.run("select 1-4")
    plate.drag((60, 40), (66, 47))
    assert plate.said()[-1] == "pull 2-3 60,40 to 66,47"
    assert plate.curves()[1:3] == [Line((60, 10), (66, 47)), Line((66, 47), (10, 40))]
    assert plate.canvas.runner.tool is None
    plate.document.undo()
    assert plate.curves()[1] == Line((60, 10), (60, 40))


def test_what_a_grip_would_make_is_shown_while_it_is_dragged(plate: Hand) -> None:
    plate.document.run("select 5")
    press(plate, (100, 60))
    plate.move(103, 60)
    tool = plate.canvas.runner.tool
    assert isinstance(tool, GripDragTool) and plate.canvas.aim is not None
    preview = tool.preview(plate.canvas.aim.point)
    assert [e.curve for e in preview.trial.added] == [Circle((90, 60), 13)]
    assert "3.000" in preview.label
    before = plate.canvas.grab().toImage()
    plate.move(106, 60)
    assert plate.canvas.grab().toImage() != before
    plate.key(Qt.Key.Key_Escape)
    release(plate, (106, 60))
    assert plate.canvas.runner.tool is None
    assert plate.said() == ["rect 10,10 60,40", "circle 90,60 10", "select 5"]


def test_a_grip_that_is_clicked_takes_a_typed_length_or_the_next_click(plate: Hand) -> None:
    plate.document.run("select 5")
    plate.click((100, 60))
    assert isinstance(plate.canvas.runner.tool, GripDragTool)
    plate.move(112, 60)
    assert plate.canvas.type_text("5")
    assert plate.said()[-1] == "pull 5 100,60 to 105,60"
    plate.click((105, 60), (108, 60))
    assert plate.said()[-1] == "pull 5 105,60 to 108,60"
    assert plate.canvas.runner.tool is None and plate.document.selection == {5}


def test_grips_snap(plate: Hand) -> None:
    plate.document.run("select 1")
    plate.drag((10, 10), (90.4, 60.5))
    assert plate.said()[-1] == "pull 1 10,10 to 90,60"


def test_the_selection_is_dragged_by_any_of_its_curves_and_ctrl_copies(plate: Hand) -> None:
    plate.document.run("select 1-4")
    press(plate, (20, 10))
    plate.move(25, 15)
    assert isinstance(plate.canvas.runner.tool, SelectionDragTool) and "Move" in plate.canvas.prompt
    plate.canvas.grab()
    plate.move(30, 26)
    release(plate, (30, 26))
    assert plate.said()[-1] == "move @10,16"
    assert plate.curves()[0] == Line((20, 26), (70, 26))
    plate.document.undo()
    press(plate, (20, 10), Qt.KeyboardModifier.ControlModifier)
    plate.canvas.mouseMoveEvent(_moved(plate, (25, 15)))
    plate.canvas.mouseMoveEvent(_moved(plate, (30, 26)))
    assert "Copy" in plate.canvas.prompt
    release(plate, (30, 26), Qt.KeyboardModifier.ControlModifier)
    assert plate.said()[-1] == "copy @10,16"
    assert len(plate.curves()) == 9


def _moved(hand: Hand, at: tuple[float, float]) -> QMouseEvent:
    place = QPointF(hand.at(*at))
    return QMouseEvent(
        QEvent.Type.MouseMove,
        place,
        hand.canvas.mapToGlobal(place),
        Qt.MouseButton.NoButton,
        LEFT,
        Qt.KeyboardModifier.ControlModifier,
    )


def test_what_is_not_selected_is_not_dragged_but_framed(plate: Hand) -> None:
    plate.drag((20, 10), (5, 5))
    assert plate.said()[-1] == "select crossing 20,10 5,5"


def test_a_typed_shift_ends_a_drag(plate: Hand) -> None:
    plate.document.run("select 5")
    press(plate, (90 + 7.0710678, 67.0710678))
    plate.move(110, 80)
    plate.canvas.type_text("@5,-2")
    release(plate, (110, 80))
    assert plate.curves()[-1] == Circle((95, 58), 10)
    assert plate.canvas.runner.tool is None


def test_many_and_locked_have_no_grips(qtbot: QtBot) -> None:
    hand = Hand(qtbot, ("line 0,0 1,0", "array 201 1 @2,0 1", "select 1-200"))
    assert len(hand.canvas.grips.points) == 600
    hand.canvas.set_mode(CanvasMode.PATHS)
    assert hand.canvas.grips.points == (), "paths are looked at, not pulled"
    hand.canvas.set_mode(CanvasMode.DRAW)
    hand.document.run("select 1-201")
    assert hand.canvas.grips.points == ()
    hand.document.run("select 1")
    hand.document.run("lock 0")
    assert hand.canvas.grips.points == ()


def test_clicks_at_one_place_go_from_curve_to_curve(qtbot: QtBot) -> None:
    hand = Hand(qtbot, ("line 10,10 60,10", "line 10,10 60,10", "line 20,10 90,10"))
    chosen = []
    for _ in range(4):
        hand.click((45, 10.4))
        chosen.append(set(hand.document.selection))
    assert chosen == [{3}, {2}, {1}, {3}]
    hand.click((80, 10))
    assert hand.document.selection == {3}


def test_tab_goes_from_one_to_the_next_under_the_mouse_and_a_click_takes_it(qtbot: QtBot) -> None:
    hand = Hand(qtbot, ("line 10,10 60,10", "circle 35,20 10"))
    words: list[str] = []
    hand.canvas.hovered.connect(words.append)
    hand.move(34.4, 10)
    hand.key(Qt.Key.Key_Tab)
    assert {word.split(" ·")[0] for word in words} == {"Circle 2", "Line 1"}
    hand.click((34.4, 10))
    assert f"{next(iter(hand.document.selection))}" == words[-1].split(" ")[1]


def test_notes_are_seen_picked_described_and_pulled(qtbot: QtBot) -> None:
    part = Part().with_note(Mark((30, 30)), "0").with_note(Guide((0, 60), 0.0), "0")
    part = part.with_note(Dimension(DimensionKind.ALIGNED, ((40, 20), (90, 20)), (65, 10)), "0")
    hand = Hand(qtbot)
    empty = hand.canvas.grab().toImage()
    hand.document.load(Job(part))
    hand.canvas.set_view(ViewTransform(5.0, 124.0, 574.0))
    assert hand.canvas.grab().toImage() != empty
    words: list[str] = []
    hand.canvas.hovered.connect(words.append)
    for at in ((30.2, 30), (70, 60.2), (50, 10.2)):
        hand.move(*at)
    assert [w for w in words if w] == [
        "Point 1 · 30.000, 30.000 · layer 0",
        "Construction line 2 · 0.00° · layer 0",
        "Dimension 3 · 50 mm · layer 0",
    ]
    assert [hand.canvas.picture.nearest(at, 1.0).id for at in ((30.2, 30), (70, 60.2), (50, 10.2))] == [1, 2, 3]
    for at, number in (((30.2, 30), 1), ((70, 60.2), 2), ((50, 10.2), 3)):
        hand.click(at)
        assert hand.document.selection == {number}
    hand.document.run("hide 0")
    assert hand.canvas.picture.candidates((30.2, 30), 1.0) == []


def test_what_is_fitted_takes_in_dimensions_and_points_but_no_construction_line(plate: Hand) -> None:
    assert plate.canvas.picture.box == (10, 10, 100, 70)
    for line in ("dimension 10,10 60,10 place 35,-30", "point 140,0", "guide across 0,500"):
        plate.document.run(line)
    assert plate.canvas.picture.box == (10, -30, 140, 70)
    plate.document.load(Job(Part().with_note(Dimension(DimensionKind.ALIGNED, ((0, 0), (400, 0)), (200, 300)), "0")))
    area, shown = plate.canvas.area, [plate.canvas.view.to_screen(at) for at in ((0, 0), (400, 0), (200, 300))]
    assert all(area.contains(place) for place in shown)
    plate.document.run("hide 0")
    assert plate.canvas.picture.box is None


def test_a_tool_in_hand_passes_grips_over(plate: Hand) -> None:
    plate.document.run("select 5")
    plate.canvas.set_tool(CanvasTool.LINE)
    plate.click((100, 60), (110, 70))
    assert plate.said()[-1] == "line 100,60 110,70"


def test_a_double_click_selects_all_that_joins(plate: Hand) -> None:
    plate.click((35, 10.3))
    plate.qtbot.mouseDClick(plate.canvas, LEFT, pos=plate.at(35, 10.3))
    assert plate.said()[-1] == "select chain 1"
    assert plate.document.selection == {1, 2, 3, 4}
