"""The NC view in the window, on real programs and the real reader: line to path and back, find, problems, files,
compare.
"""

import math
from dataclasses import replace
from pathlib import Path

import pytest
from PySide6.QtCore import QMimeData, QPoint, QPointF, Qt, QUrl
from PySide6.QtGui import QDragEnterEvent, QDropEvent
from PySide6.QtWidgets import QApplication

from app.core.settings import load_settings
from app.gcode.interpreter.dialect import Dialect
from app.ui.framework.computation import ComputationState
from app.ui.framework.view import View
from app.ui.views.nc.motion_shapes import ViewSide
from app.ui.views.nc.painting.motion_layer import MotionColourBy
from tests.ui.nc.hand_made import long_program
from tests.ui.nc.opened import SMALL, WAIT_MS, nc_of, open_file

CTRL, SHIFT = Qt.KeyboardModifier.ControlModifier, Qt.KeyboardModifier.ShiftModifier


def on_screen(nc, point):
    return nc.path.view.to_screen(point).toPoint()


def state(nc):
    return [f"{item.name} {item.value}".strip() for item in nc.state.items]


def test_a_picked_line_lights_its_motion_and_tells_what_is_in_force(small):
    small.pane.text.pick(6)
    assert small.path.lit.tolist() == [3]
    words = state(small)
    assert words[:6] == ["T1", "M3 1\u2009000 rpm", "G3", "F 300", f"Length {math.pi * 10:.3f} mm", "X 40.000"]
    assert "Y 20.000" in words
    assert "G21" in words


def test_what_is_in_force_is_that_of_the_line_and_not_of_the_next_one(qtbot, wiring, tmp_path):
    path = tmp_path / "stops.ngc"
    path.write_text("G21 G90\nM3 S900\nG0 X1 Y0 Z5\nM5\nG20 G0 X2\nM2\n")
    nc = open_file(qtbot, wiring, path)
    nc.pane.text.pick(2)
    assert {"M3 900 rpm", "G21"} <= set(state(nc))
    nc.pane.text.pick(3)
    assert {"M5 off", "G20", "X 1.000"} <= set(state(nc))


def test_a_line_without_motion_has_the_place_before_and_the_words_to_come(small):
    small.pane.text.pick(1)
    assert small.path.lit.tolist() == []
    assert "T1" in state(small)
    assert not any(word.startswith("X ") for word in state(small))


def test_a_clicked_motion_marks_its_line(qtbot, small):
    qtbot.mouseClick(small.path, Qt.MouseButton.LeftButton, pos=on_screen(small, (50.0, 10.0)))
    assert small.pane.text.current == 6
    assert small.path.lit.tolist() == [3]
    assert "G3" in state(small)


def test_what_is_under_the_mouse_is_told_in_the_status_bar(qtbot, wiring, small):
    qtbot.mouseMove(small.path, on_screen(small, (20.0, 0.0)))
    assert wiring.window_.status.message.text().startswith("Line · line 6 · T1")
    qtbot.mouseMove(small.path, on_screen(small, (20.0, 9.0)))
    assert wiring.window_.status.message.text() == small.summary


def test_a_far_motion_is_brought_into_sight(qtbot, small):
    small.path.set_view(small.path.view.panned(4000, 0))
    small.pane.text.pick(5)
    qtbot.waitUntil(lambda: small.path.rect().contains(on_screen(small, (20.0, 0.0))), timeout=2000)


def test_a_range_of_lines_lights_all_its_motions(small):
    small.pane.text.pick(4)
    small.pane.text.pick(7, extend=True)
    assert small.path.lit.tolist() == [1, 2, 3, 4]


@pytest.mark.parametrize("side", [ViewSide.XZ, ViewSide.YZ])
def test_sides_show_heights(qtbot, wiring, small, side):
    wiring.window_.actions_[f"nc_{side.name.lower()}"].trigger()
    qtbot.waitUntil(lambda: small.path.picture is not None and small.path.picture.side is side, timeout=WAIT_MS)
    at = on_screen(small, (0.0 if side is ViewSide.XZ else 20.0, 2.0))
    qtbot.mouseMove(small.path, at)
    qtbot.mouseClick(small.path, Qt.MouseButton.LeftButton, pos=at)
    assert small.pane.text.current in (3, 4, 8)
    assert small.path_head.side.buttons[side].isChecked()
    assert wiring.window_.status.place_x.text().startswith(side.name[0])


def test_colour_by_motion_changes_text_and_path(qtbot, small):
    before = small.grab().toImage()
    qtbot.mouseClick(small.path_head.colour.buttons[MotionColourBy.MOTION], Qt.MouseButton.LeftButton)
    after = small.grab().toImage()
    assert before != after


def test_find_counts_goes_round_and_marks(qtbot, wiring, small):
    qtbot.keyClick(small.pane.text, Qt.Key.Key_F, CTRL)
    finder = small.pane.finder
    assert finder.isVisible()
    qtbot.keyClicks(finder.edit, "g1")
    assert (finder.count.text(), small.pane.text.current) == ("1 of 4", 0)
    qtbot.keyClick(finder.edit, Qt.Key.Key_Return)
    assert (finder.count.text(), small.pane.text.current) == ("2 of 4", 4)
    qtbot.keyClick(finder.edit, Qt.Key.Key_F3)
    assert small.pane.text.current == 5
    qtbot.keyClick(small.pane.text, Qt.Key.Key_F3, SHIFT)
    assert small.pane.text.current == 4
    assert wiring.window_.actions_["snap"].isChecked(), "F3 reached the drawing"
    qtbot.keyClicks(finder.edit, "x")
    assert finder.count.text() == "Not found"
    qtbot.keyClick(finder.edit, Qt.Key.Key_Escape)
    assert not finder.isVisible()
    assert small.pane.text.hasFocus()


def test_go_to_line(qtbot, small):
    qtbot.keyClick(small.pane.text, Qt.Key.Key_G, CTRL)
    qtbot.keyClicks(small.pane.finder.edit, "7")
    qtbot.keyClick(small.pane.finder.edit, Qt.Key.Key_Return)
    assert small.pane.text.current == 6
    assert not small.pane.finder.isVisible()


def test_text_with_an_error_is_shown_up_to_there(qtbot, wiring, data):
    nc = open_file(qtbot, wiring, data / "nc" / "helical-thread-milling.gcode")
    assert len(nc.shown.shapes) == 1
    assert nc.pane.text.current == 4
    assert nc.pane.panel.isVisible()
    error = nc.shown.program.error
    told = [nc.pane.panel.list.item(k).text() for k in range(nc.pane.panel.list.count())]
    assert f"5:{error.column}   {error.word}: {error.text}" in told
    assert wiring.window_.command_line.log.lines[-1].error
    nc.pane.text.pick(0)
    places = []
    for _ in told:
        wiring.window_.actions_["nc_problem"].trigger()
        places.append(nc.pane.text.current)
    assert places == [3, 4], "the warning that it begins in G91, then the error"


@pytest.mark.exhaustive
def test_foreign_program_leaves_the_job_alone_and_goes_back(qtbot, computed, data):
    job, made = computed.document.job, computed.computation.made
    nc = open_file(qtbot, computed, data / "nc" / "test_pycam.ngc")
    assert computed.display_controller.view is View.NC
    assert (computed.document.job, computed.computation.made) == (job, made)
    assert nc.pane.banner.isVisible()
    assert nc.pane.head.name.text() == "test_pycam.ngc"
    assert "33\u2009444 lines" in computed.window_.command_line.log.lines[-1].reply
    qtbot.mouseClick(nc.pane.banner.button, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: nc.shown is not None and nc.shown.source.name == "fig2.ngc", timeout=WAIT_MS)
    assert not nc.pane.banner.isVisible()
    assert nc.pane.text.text.text == made.nc.text


def test_the_path_of_the_jobs_program_is_that_of_its_text(computed):
    nc, made = nc_of(computed), computed.computation.made
    row = int(made.nc.lines[40]) - 1
    nc.pane.text.pick(row)
    end = nc.shown.program.motions.end[nc.path.lit[-1]]
    assert end == pytest.approx(made.program.moves.end[40], abs=1e-4)


@pytest.mark.exhaustive
def test_changed_job_says_that_the_program_is_old(qtbot, computed):
    computed.document.run("circle 150,50 10")
    computed.display_controller.show_view(View.NC)
    banner = nc_of(computed).pane.banner
    assert banner.isVisible()
    assert "changed" in banner.sentence.text()
    qtbot.mouseClick(banner.button, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: computed.computation.state is ComputationState.CURRENT, timeout=WAIT_MS)
    assert not banner.isVisible()


def test_dropped_program_is_shown_and_in_the_recent_files(qtbot, wiring, data):
    path = data / "nc" / "tux.ngc"
    mime = QMimeData()
    mime.setUrls([QUrl.fromLocalFile(str(path))])
    how = (Qt.DropAction.CopyAction, mime, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier)
    enter, drop = QDragEnterEvent(QPoint(400, 10), *how), QDropEvent(QPointF(400, 10), *how)
    QApplication.sendEvent(wiring.window_, enter)
    assert enter.isAccepted()
    QApplication.sendEvent(wiring.window_, drop)
    qtbot.waitUntil(lambda: nc_of(wiring).shown is not None, timeout=WAIT_MS)
    assert not wiring.window_.views.empty.isVisible()
    assert wiring.window_.preferences.settings.recent_files[0] == str(path)
    wiring.window_.close()
    assert load_settings().recent_files[0] == str(path)


def test_dialect_is_guessed_and_can_be_said(qtbot, wiring, tmp_path):
    path = tmp_path / "part.nc"
    path.write_text("%\nO1000 (PART)\nG21 G90 G94\nG0 X1000 Y0 Z5.\nM30\n%\n")
    nc = open_file(qtbot, wiring, path)
    assert nc.shown.dialect is Dialect.FANUC
    assert nc.shown.program.motions.end[-1, 0] == pytest.approx(1.0)
    box = nc.pane.head.dialect
    assert box.currentText() == "Auto: Fanuc"
    at = box.findData(Dialect.LINUXCNC)
    box.setCurrentIndex(at)
    box.activated.emit(at)
    qtbot.waitUntil(lambda: nc.shown.dialect is Dialect.LINUXCNC, timeout=WAIT_MS)
    assert box.currentData() is Dialect.LINUXCNC


def test_saved_text_has_the_very_bytes(wiring, small, tmp_path):
    target = tmp_path / "copy.ngc"
    wiring.nc.save(target)
    assert target.read_bytes() == SMALL.encode()


def test_file_that_cannot_be_read_says_so_and_leaves_the_view(qtbot, wiring, small):
    with qtbot.waitSignal(wiring.nc.failed, timeout=WAIT_MS) as caught:
        wiring.nc.open(Path("/nowhere/part.ngc"))
    assert "part.ngc" in caught.args[0]
    assert small.shown.source.name == "small.ngc"


def test_empty_view_offers_to_open_a_program(qtbot, wiring):
    wiring.display_controller.show_view(View.NC)
    assert wiring.window_.views.empty.isVisible()
    assert wiring.window_.views.empty.button.text() == "Open an NC program"


def test_comparing_marks_lines_in_both_and_jumps(qtbot, wiring, small, tmp_path):
    other = tmp_path / "other.ngc"
    other.write_text(SMALL.replace("G1 X40 F300\n", "G1 X20 F300\nG1 X60\nG1 X40\n"))
    wiring.nc.compare(other)
    qtbot.waitUntil(lambda: small.compared is not None, timeout=WAIT_MS)
    assert small.other.isVisible()
    assert small.path.other is not None
    assert small.differences.isVisible()
    qtbot.keyClick(small.pane.text, Qt.Key.Key_F7)
    assert small.pane.text.current in (5, 6)
    assert small.other.text.current in (5, 6, 7)
    assert len(small.path.lit)
    qtbot.mouseClick(small.path, Qt.MouseButton.LeftButton, pos=on_screen(small, (55.0, 0.0)))
    assert small.other.text.current in (6, 7), "the way that only the second program has is not found"
    qtbot.mouseClick(small.other.text.viewport(), Qt.MouseButton.LeftButton, pos=QPoint(100, 5))
    assert small.active is small.other
    wiring.window_.actions_["nc_compare_end"].trigger()
    assert not small.other.isVisible()
    assert small.path.other is None
    assert not small.differences.isVisible()


def test_programs_that_do_the_same_are_said_to(qtbot, wiring, small, tmp_path):
    other = tmp_path / "same.ngc"
    other.write_text("(again)\n" + SMALL)
    wiring.nc.compare(other)
    qtbot.waitUntil(lambda: small.compared is not None, timeout=WAIT_MS)
    assert small.differences.title.text() == "Both programs do the same."


def test_restart_from_a_line_is_shown_and_goes_on_with_the_same_text(qtbot, wiring, small, tmp_path):
    small.pane.text.pick(6)
    qtbot.keyClick(small.pane.text, Qt.Key.Key_R, CTRL)
    qtbot.waitUntil(lambda: small.shown.source.name == "small-from-7.ngc", timeout=WAIT_MS)
    assert small.pane.banner.isVisible()
    assert small.shown.program.error is None
    assert small.pane.text.text.text.endswith("".join(SMALL.splitlines(keepends=True)[6:]))
    wiring.nc.save(tmp_path / "rest.ngc")
    assert (tmp_path / "rest.ngc").read_bytes() == small.shown.source.data


def test_restart_that_cannot_be_safe_says_why(qtbot, wiring, tmp_path):
    path = tmp_path / "loop.ngc"
    path.write_text("G21 G90 G17\nG0 X0 Y0 Z5\no1 repeat [3]\nG1 X1 F100\no1 endrepeat\nM2\n")
    nc = open_file(qtbot, wiring, path)
    nc.pane.text.pick(3)
    with qtbot.waitSignal(wiring.nc.failed, timeout=WAIT_MS) as caught:
        wiring.window_.actions_["nc_restart"].trigger()
    assert "ine 4" in caught.args[0]
    assert wiring.window_.notice.text.text() == caught.args[0]
    assert nc.shown.source.path == path


@pytest.mark.exhaustive
def test_a_post_with_a_file_for_each_tool_offers_its_files(qtbot, computed):
    computed.document.change_job("Change post", replace(computed.document.job, post="grbl"))
    computed.compute()
    nc = nc_of(computed)
    qtbot.waitUntil(
        lambda: computed.computation.state is ComputationState.CURRENT and nc.shown is not None, timeout=WAIT_MS
    )
    computed.display_controller.show_view(View.NC)
    files = nc.pane.head.files
    assert files.isVisible()
    assert files.count() == 2
    first = nc.pane.text.text.text
    files.setCurrentIndex(1)
    files.activated.emit(1)
    qtbot.waitUntil(lambda: nc.shown is not None and nc.shown.source.name == files.itemText(1), timeout=WAIT_MS)
    assert nc.pane.text.text.text == computed.computation.made.files[1].nc.text != first


def test_cutter_compensation_takes_the_diameters_of_the_jobs_tools(qtbot, wiring, tmp_path):
    path = tmp_path / "wall.ngc"
    path.write_text("G21 G90 G17 G94\nT1 M6\nG0 X0 Y0 Z0\nG41 D1 G1 X10 F300\nX50\nG40 X60\nM2\n")
    nc = open_file(qtbot, wiring, path)
    assert nc.shown.program.error is None
    radius = wiring.document.job.tools[0].radius
    assert abs(nc.shown.program.motions.end[2, 1]) == pytest.approx(radius)


@pytest.mark.exhaustive
def test_cancelled_reading_leaves_what_was_shown(qtbot, wiring, small, tmp_path):
    path = tmp_path / "long.ngc"
    path.write_bytes(long_program(100_000)[0])
    wiring.nc.open(path)
    assert wiring.window_.status.cancel.isVisible()
    qtbot.mouseClick(wiring.window_.status.cancel, Qt.MouseButton.LeftButton)
    assert not wiring.window_.status.cancel.isVisible()
    qtbot.wait(600)
    assert small.shown.source.name == "small.ngc"


def test_opening_a_program_does_not_disturb_the_computation(qtbot, wiring, samples, data):
    wiring.files.open_sample()
    qtbot.waitUntil(lambda: wiring.computation.state is ComputationState.RUNNING, timeout=WAIT_MS)
    wiring.files.open_file(data / "nc" / "tux.ngc")
    qtbot.waitUntil(lambda: wiring.computation.state is ComputationState.CURRENT, timeout=WAIT_MS)
    qtbot.waitUntil(lambda: nc_of(wiring).shown is not None, timeout=WAIT_MS)
    assert nc_of(wiring).shown.source.name == "tux.ngc"


def test_frame_of_the_job_is_shown(qtbot, computed):
    computed.window_.actions_["nc_frame"].trigger()
    nc = nc_of(computed)
    qtbot.waitUntil(lambda: nc.shown is not None and nc.shown.source.name == "fig2_frame.ngc", timeout=WAIT_MS)
    assert nc.shown.program.error is None
    assert set(nc.shown.program.motions.kind.tolist()) == {0}
    assert nc.pane.banner.isVisible()
