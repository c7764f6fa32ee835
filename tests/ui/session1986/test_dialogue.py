"""A session from the shape to the modern views, by keys alone; nothing that was answered is ever lost."""

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt

from app.model.contour_operation import ContourOperation
from app.model.operation import PocketOperation
from app.ui.framework.computation import ComputationState
from app.ui.framework.view import View
from app.ui.views.session1986.questions import SessionQuestion
from tests.ui.conftest import WAIT_MS

CTRL, SHIFT = Qt.KeyboardModifier.ControlModifier, Qt.KeyboardModifier.ShiftModifier


@pytest.mark.exhaustive
def test_a_whole_session_by_keys(qtbot, in_window) -> None:
    shown: list[int] = []
    in_window.session.playing.changed.connect(lambda: shown.append(int(in_window.screen.head[0].split()[0])))
    in_window.answer()
    in_window.until(SessionQuestion.CONTOUR)
    assert in_window.screen.head[0] == "110 Show the shape"
    shape = in_window.screen.picture.copy()
    in_window.answer("1.25")
    in_window.until(SessionQuestion.POCKET)
    filled = in_window.screen.picture.copy()
    assert shown == [120, 201, 202, 203, 204, 205, 206, 207, 208, 130]
    assert filled.sum() > 5 * shape.sum() and not (filled & shape).any(), (
        "the screen is rewritten with what lies inside"
    )
    in_window.answer("2.5")
    assert in_window.screen.prompt == "POCKET TOOL OVERLAP, MM [2.5]?"
    in_window.answer()
    in_window.until(SessionQuestion.PLAY)
    for _ in range(len(in_window.session.playing._stills) - 1):
        in_window.key(Qt.Key.Key_Right)
    assert in_window.screen.head[0] == "140 The tool paths" and {301, 307, 142, 146, 148, 140, 401, 407} <= set(shown)
    in_window.key(Qt.Key.Key_Space)
    in_window.until(SessionQuestion.LIST)
    in_window.key(Qt.Key.Key_Return)
    assert in_window.session.ask is SessionQuestion.DONE
    assert [line for line in in_window.screen.page if line][-1] == "M2"
    in_window.answer()
    assert in_window.tube.isHidden()
    check_modern_views(qtbot, in_window.wiring)


def check_modern_views(qtbot, wiring) -> None:
    job = wiring.document.job
    assert [(type(each), job.tool(each.cut.tool).radius) for each in job.operations] == [
        (PocketOperation, 2.5),
        (ContourOperation, 1.25),
    ]
    assert wiring.display_controller.view is View.PATHS
    qtbot.waitUntil(lambda: wiring.computation.state is ComputationState.CURRENT, timeout=WAIT_MS)
    assert wiring.computation.made.report.data["gouge"]["max_mm"] <= 1e-6
    assert not wiring.computation.made.program.pitch_mm or not wiring.computation.made.program.given_up_mm, (
        "computed exactly"
    )
    wiring.document.undo()
    assert not wiring.document.part.entities, "undo brings back what was there before"


def test_the_shape_is_drawn_in_words_and_by_the_cross_hair(qtbot, operator) -> None:
    operator.answer("3")
    operator.answer("rect 10,10 90,70")
    assert operator.screen.picture.any()
    qtbot.keyClicks(operator.tube, "CIRCLE")
    operator.tube.session.point((177, 200))
    operator.key(Qt.Key.Key_Left, SHIFT)
    operator.key(Qt.Key.Key_Up)
    operator.key(Qt.Key.Key_Tab)
    assert operator.screen.typed == "CIRCLE 47.5,41.5 "
    operator.answer("12")
    operator.answer("END")
    operator.until(SessionQuestion.CONTOUR)
    circle = operator.session.shape.job.part.entities[-1].curve
    assert (circle.centre, circle.radius) == ((47.5, 41.5), 12.0)
    assert not operator.document.part.entities


def test_a_click_puts_the_point_under_the_mouse(qtbot, operator) -> None:
    operator.answer("3")
    rect = operator.tube.screen_rect()
    assert rect.width() == 800
    qtbot.mouseClick(operator.tube, Qt.MouseButton.LeftButton, pos=QPoint(rect.left() + 2 * 120, rect.top() + 2 * 100))
    assert operator.screen.typed == "30,60.5 "
    assert operator.screen.head[1] == "X 30 Y 60.5"


@pytest.mark.parametrize(
    ("ask", "bad", "told"),
    [
        (SessionQuestion.SHAPE, "9", "? ENTER 1, 2 OR 3."),
        (SessionQuestion.SHAPE, "1", "? NOTHING IS DRAWN IN THE JOB. ENTER 2 OR 3."),
        (SessionQuestion.CONTOUR, "ABC", "? "),
        (SessionQuestion.CONTOUR, "0", "OUT OF RANGE"),
        (SessionQuestion.CONTOUR, "99", "OUT OF RANGE"),
        (SessionQuestion.POCKET, "-3", "OUT OF RANGE"),
        (SessionQuestion.OVERLAP, "6", "OUT OF RANGE"),
    ],
)
def test_a_bad_answer_is_told_and_the_line_is_empty_again(operator, ask, bad, told) -> None:
    if ask is not SessionQuestion.SHAPE:
        operator.answer("2")
        operator.until(SessionQuestion.CONTOUR)
    if ask in (SessionQuestion.POCKET, SessionQuestion.OVERLAP):
        operator.answer()
        operator.see_all(SessionQuestion.POCKET)
    if ask is SessionQuestion.OVERLAP:
        operator.answer("3")
    picture, head = operator.screen.picture.copy(), operator.screen.head
    operator.answer(bad)
    assert operator.session.ask is ask
    assert told in operator.said()
    assert f"? {bad} " in operator.said(), "what was refused is still to be read"
    assert operator.screen.typed == ""
    assert np.array_equal(operator.screen.picture, picture) and operator.screen.head == head


def test_an_answer_after_a_refused_one_stands_alone(operator) -> None:
    operator.answer("2")
    operator.until(SessionQuestion.CONTOUR)
    for bad in ("-1", "0", "abc"):
        operator.answer(bad)
    assert "-1 MM IS OUT OF RANGE" in operator.said() and "? 0 MM IS OUT OF RANGE" in operator.said()
    operator.answer("1.5")
    operator.see_all(SessionQuestion.POCKET)
    assert operator.session.given.contour == 1.5


def test_a_contour_tool_that_is_the_larger_one_is_said_and_the_session_goes_on(operator) -> None:
    operator.to_pocket()
    operator.answer("1.5")
    assert operator.session.ask is SessionQuestion.OVERLAP and "SMALLER THAN THE CONTOUR TOOL" not in operator.said()
    operator.answer("back")
    operator.answer("1.25")
    assert operator.session.ask is SessionQuestion.OVERLAP
    assert "! SMALLER THAN THE CONTOUR TOOL. ENTER BACK TO CHANGE THE AMOUNTS." in operator.said()
    operator.answer()
    operator.see_all(SessionQuestion.DONE)


def test_tools_that_do_not_fit_are_refused_by_what_they_leave(operator) -> None:
    operator.answer("2")
    operator.until(SessionQuestion.CONTOUR)
    operator.answer("30")
    operator.until(SessionQuestion.CONTOUR)
    assert "NOTHING IS LEFT OF THE SHAPE WITH AN OFFSET OF 30 MM" in operator.said()
    assert operator.screen.head[0] == "110 Show the shape"
    operator.answer("1")
    operator.see_all(SessionQuestion.POCKET)
    operator.answer("25")
    operator.answer("40")
    operator.until(SessionQuestion.POCKET)
    assert "NOTHING IS LEFT OF THE AREA WITH AN OFFSET OF 25 MM" in operator.said()
    assert operator.screen.head[0] == "130 The area is filled"


def test_an_open_drawing_is_kept_to_be_closed(operator) -> None:
    operator.answer("3")
    operator.answer("line 0,0 50,0 50,50")
    operator.answer("end")
    operator.until(SessionQuestion.DRAW)
    assert "THERE IS NO CLOSED CONTOUR" in operator.said()
    operator.answer("line 50,50 0,0")
    operator.answer("end")
    operator.until(SessionQuestion.CONTOUR)


def test_back_and_new_go_back_and_keep_the_answers(operator) -> None:
    operator.to_pocket()
    operator.answer("2")
    operator.answer("back")
    assert (operator.session.ask, operator.screen.prompt) == (SessionQuestion.POCKET, "POCKET TOOL OFFSET, MM [2]?")
    operator.answer("back")
    assert (operator.session.ask, operator.screen.head[0]) == (SessionQuestion.CONTOUR, "110 Show the shape")
    operator.answer("new")
    assert operator.session.ask is SessionQuestion.SHAPE
    assert operator.screen.prompt == "SHAPE [2]?"


def test_ctrl_c_breaks_off_what_runs(operator) -> None:
    operator.answer("2")
    operator.key(Qt.Key.Key_C, CTRL)
    assert operator.session.ask is SessionQuestion.SHAPE and not operator.session.worker.busy
    assert "? BREAK." in operator.said()
    operator.to_pocket()
    operator.answer("3")
    operator.answer()
    operator.until(SessionQuestion.PLAY)
    operator.key(Qt.Key.Key_C, CTRL)
    assert (operator.session.ask, operator.screen.head[0]) == (SessionQuestion.OVERLAP, "130 The area is filled")


def test_space_holds_and_arrows_step(qtbot, operator) -> None:
    operator.answer("2")
    operator.until(SessionQuestion.CONTOUR)
    operator.answer()
    operator.until(SessionQuestion.PLAY)
    operator.key(Qt.Key.Key_Space)
    at = operator.session.playing.at
    qtbot.wait(1500)
    assert operator.session.playing.at == at and operator.screen.head[1].startswith("HELD")
    operator.key(Qt.Key.Key_Right)
    operator.key(Qt.Key.Key_Right)
    operator.key(Qt.Key.Key_Left)
    assert operator.session.playing.at == at + 1


def test_escape_leaves_at_any_time_and_the_session_goes_on_where_it_was(in_window) -> None:
    document, window = in_window.wiring.document, in_window.wiring.window_
    revision = document.revision
    in_window.to_pocket()
    in_window.bot.keyClicks(in_window.tube, "2.2")
    in_window.key(Qt.Key.Key_Escape)
    assert in_window.tube.isHidden() and document.revision == revision
    assert window.focusWidget() is window.canvas
    window.actions_["session_1986"].trigger()
    assert in_window.tube.isVisible() and (in_window.session.ask, in_window.screen.typed) == (
        SessionQuestion.POCKET,
        "2.2",
    )
    in_window.answer()
    in_window.answer()
    in_window.key(Qt.Key.Key_Escape)
    assert not in_window.session.worker.busy and in_window.session.ask is SessionQuestion.OVERLAP
    window.actions_["session_1986"].trigger()
    in_window.answer()
    in_window.until(SessionQuestion.PLAY)
    in_window.key(Qt.Key.Key_Escape)
    assert in_window.session.playing.held


def test_a_long_listing_ends_soon_and_can_be_read_again(operator) -> None:
    operator.to_pocket()
    operator.answer("1")
    operator.answer("1.5")
    operator.see_all(SessionQuestion.DONE)
    assert "METAL MAY NOT" not in operator.said() and "KEEP UP TO" in operator.said()
    page = operator.screen.page
    assert page[0].startswith("(PART FIG2")
    end = operator.screen.bits()
    operator.key(Qt.Key.Key_PageUp)
    operator.key(Qt.Key.Key_Up)
    assert operator.screen.up == 22
    assert not np.array_equal(operator.screen.bits(), end)
