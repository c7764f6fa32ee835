"""How the NC view shows things: only what differs of a second program, long paths in portions, no tools that draw, huge
lines.
"""

import math

import numpy as np
import pytest
from PySide6.QtCore import QPointF, Qt

from app.core.errors import InputError
from app.model.part import Units
from app.ui.framework.view import View
from app.ui.views.nc.motion_shapes import ViewSide
from tests.ui.measure_window import Gaps
from tests.ui.nc.hand_made import long_program
from tests.ui.nc.opened import SMALL, WAIT_MS, nc_of, open_file


def compare_with(qtbot, wiring, text, path):
    path.write_text(text)
    wiring.nc.compare(path)
    qtbot.waitUntil(lambda: nc_of(wiring).compared is not None, timeout=WAIT_MS)
    return nc_of(wiring)


def key_words(nc):
    return [row.words for row in nc.path._key()]


def hues(nc, theme_colour):
    """The places in mm of the pixels of the path that have a colour, (k, 2)."""
    nc.path.repaint_scene()
    image = nc.path.grab().toImage()
    x, y = np.meshgrid(np.arange(24, image.width()), np.arange(24, image.height()))
    same = [
        (a, b)
        for a, b in zip(x.ravel().tolist(), y.ravel().tolist(), strict=True)
        if image.pixelColor(a, b) == theme_colour
    ]
    return np.array([nc.path.view.to_world(QPointF(a, b)) for a, b in same]).reshape(-1, 2)


def test_of_a_second_program_only_what_differs_is_painted(qtbot, wiring, small, tmp_path):
    nc = compare_with(qtbot, wiring, SMALL.replace("G1 X0\n", "G1 X20 Y30\nX0 Y20\n"), tmp_path / "other.ngc")
    alone = nc.path.other.only
    lines = nc.compared.other.program.motions.line[alone].tolist()
    assert lines == [8, 9]
    assert key_words(nc)[-2:] == ["Only in the first", "Only in the second"]
    theme = wiring.window_.theme
    blue, purple = hues(nc, theme.left), hues(nc, theme.parameter)
    assert len(blue) > 20
    inside = blue[:, 1] > 19
    corner = blue[:, 1] > nc.path.view.to_world(nc.path.area.topLeft())[1] - 25
    assert (inside | corner).all(), "the second program's hue is where both are alike"
    assert len(purple) > 20


def test_programs_that_differ_in_their_feed_look_like_one(qtbot, wiring, small, tmp_path):
    nc = compare_with(qtbot, wiring, SMALL.replace("F300", "F250"), tmp_path / "other.ngc")
    assert nc.differences.places
    assert not nc.path.other.some
    assert not any(words.startswith("Only") for words in key_words(nc))


def test_a_side_chosen_while_two_programs_are_shown_has_what_differs_too(qtbot, wiring, small, tmp_path):
    nc = compare_with(qtbot, wiring, SMALL.replace("G1 X40", "G1 X40 Z-2"), tmp_path / "other.ngc")
    nc.set_side(ViewSide.XZ)
    qtbot.waitUntil(lambda: nc.path.picture is not None and nc.path.picture.side is ViewSide.XZ, timeout=WAIT_MS)
    assert nc.path.other.side is ViewSide.XZ
    assert nc.path.other.some


def test_a_side_chosen_while_a_program_is_read_is_shown(qtbot, wiring, tmp_path):
    path = tmp_path / "long.ngc"
    path.write_bytes(long_program(30_000)[0])
    wiring.files.open_file(path)
    qtbot.waitUntil(lambda: wiring.nc.reading.worker.busy, timeout=WAIT_MS)
    nc_of(wiring).set_side(ViewSide.YZ)
    qtbot.waitUntil(lambda: nc_of(wiring).path.picture is not None, timeout=WAIT_MS)
    assert nc_of(wiring).path.picture.side is ViewSide.YZ


def test_a_long_path_that_is_painted_in_portions_is_whole_in_the_end(qtbot, wiring, tmp_path):
    path = tmp_path / "long.ngc"
    path.write_bytes(long_program(60_000)[0])
    nc = open_file(qtbot, wiring, path)
    qtbot.waitUntil(lambda: not nc.path._fresh and not nc.path._later.isActive(), timeout=WAIT_MS)
    qtbot.waitUntil(lambda: next(nc.path._rest, None) is None, timeout=WAIT_MS)
    in_portions = nc.path.grab().toImage()
    nc.path.repaint_scene()
    assert in_portions == nc.path.grab().toImage()


def test_a_long_path_lets_the_window_listen_before_it_is_whole(qtbot, wiring, tmp_path, monkeypatch):
    monkeypatch.setattr("app.ui.views.nc.path_view._AT_ONCE_S", 0.0)
    path = tmp_path / "long.ngc"
    path.write_bytes(long_program(60_000)[0])
    nc = open_file(qtbot, wiring, path)
    nc.path.repaint()
    assert nc.path._later.isActive()
    first = nc.path._scene.toImage()
    qtbot.waitUntil(lambda: not nc.path._later.isActive(), timeout=WAIT_MS)
    assert nc.path._scene.toImage() != first


def test_the_nc_view_has_no_tools_that_draw_but_a_fit_of_its_own(qtbot, wiring, small):
    window = wiring.window_
    assert not window.tool_strip.isVisible()
    small.path.set_view(small.path.view.panned(4000, 0))
    qtbot.mouseClick(small.path_head.fit, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: small.path.area.contains(small.path.view.to_screen((20.0, 10.0))), timeout=2000)
    for view in (View.DRAW, View.PATHS):
        wiring.display_controller.show_view(view)
        assert window.tool_strip.isVisible()


@pytest.mark.parametrize("line", [b"G1 X1 Y2 ", b"(T1 6mm tool stock) ", b"(Contour T1: depth) ", b"X[", b" "])
def test_a_line_of_ten_megabytes_does_not_stop_the_window(qtbot, wiring, tmp_path, line):
    path = tmp_path / "line.ngc"
    path.write_bytes(b"G21\n" + line * math.ceil(1e7 / len(line)) + b"\nG1 X5 F100\n")
    gaps = Gaps()
    nc = open_file(qtbot, wiring, path)
    nc.pane.text.pick(1)
    nc.pane.begin_find("X1")
    nc.pane.find_next()
    qtbot.wait(100)
    assert nc.shown.program.error is not None
    assert max(gaps.busiest.values()) < 500, "of processor time, which others beside do not change"


def test_a_tool_that_draws_is_taken_to_the_drawing(qtbot, wiring, small):
    window = wiring.window_
    prompt = window.command_line.edit.placeholderText()
    assert "Ctrl+F" in prompt
    window.actions_["tool_line"].trigger()
    assert wiring.display_controller.view is View.DRAW
    assert window.tool_strip.buttons["tool_line"].isChecked()
    assert window.command_line.edit.placeholderText() == window.canvas.prompt != prompt


def test_escape_in_the_command_line_gives_the_keys_back_to_the_program(qtbot, wiring, small):
    edit = wiring.window_.command_line.edit
    edit.setFocus()
    qtbot.keyClick(edit, Qt.Key.Key_Escape)
    assert small.pane.text.hasFocus()


def test_the_view_before_fades_where_it_was(qtbot, wiring):
    views = wiring.window_.views
    views.fade.begin(views.grab())
    left = views.mapToGlobal(views.rect().topLeft()).x()
    wiring.window_.tool_strip.hide()
    wiring.window_.lay_out_now()
    qtbot.waitUntil(lambda: views.mapToGlobal(views.rect().topLeft()).x() < left, timeout=2000)
    assert views.fade.size() == views.size()


def test_the_frame_is_offered_when_there_is_a_job_to_go_round(qtbot, wiring):
    assert not wiring.window_.actions_["nc_frame"].isEnabled()
    wiring.files.open_sample()
    qtbot.waitUntil(wiring.window_.actions_["nc_frame"].isEnabled, timeout=WAIT_MS)


def test_a_program_that_names_no_units_asks_for_them(qtbot, wiring, tmp_path):
    """As a tool table does; what was said is what its cut is read in, and its own text has to say it to be smoothed."""
    path = tmp_path / "nobody_said.ngc"
    path.write_text(SMALL.replace("G21 ", ""))
    nc, notice = open_file(qtbot, wiring, path), wiring.window_.notice
    assert notice.isVisibleTo(wiring.window_) and "names no units" in notice.text.text()
    assert [button.text() for button in notice.buttons] == ["Keep mm", "Read in inch"]
    assert nc.shown.shapes.high[:, 0].max() == pytest.approx(45.0, abs=6)
    qtbot.mouseClick(notice.buttons[1], Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: nc.shown.source.units is Units.INCH, timeout=WAIT_MS)
    assert nc.shown.program.motions.end[:, 0].max() == pytest.approx(40 * 25.4)
    with pytest.raises(InputError, match="write G20"):
        nc.shown.source.named_units()


def test_a_program_that_names_its_units_is_not_asked(small, wiring):
    assert not wiring.window_.notice.isVisibleTo(wiring.window_)
