"""The cut is played in the window: keys, buttons, the plot; what is seen and picked is the metal of the moment."""

from dataclasses import replace

import cv2
import numpy as np
import pytest
from PySide6.QtCore import QEvent, QPoint, QPointF, Qt
from PySide6.QtGui import QMouseEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from app.ui.framework.view import View
from app.ui.views.cut.cell_colours import CutColourBy, values_of
from app.ui.views.cut.cut_player import RANGES, PlaybackPace, TimelineMark
from app.ui.views.cut.findings import FindingColour
from app.ui.views.cut.record_sheet import RecordFormat, RecordPlan
from app.ui.views.cut.relief import relief
from app.ui.views.cut.time_plot import exact_clock
from app.ui.views.cut.transport import notch_of, speed_of
from app.usecases.cutting.cut import CutOptions
from app.usecases.cutting.cut import cut as cut_of
from app.usecases.cutting.timeline import TimelinePlace
from tests.ui.cut.pictures import without_a_screen
from tests.usecases.test_playback import from_start

NONE, SHIFT = Qt.KeyboardModifier.NoModifier, Qt.KeyboardModifier.ShiftModifier


@pytest.fixture
def page(qtbot, computed):
    without_a_screen().release()
    computed.display_controller.show_view(View.CUT)
    made = computed.window_.views.cut_page
    qtbot.waitUntil(lambda: made.player.timeline is not None and made.view.render_scheduler.fine, timeout=60_000)
    return made


def settle(qtbot, page):
    qtbot.waitUntil(lambda: not page.player.worker.busy and page.player._goal() == page.player.at, timeout=20_000)


def shows(page, motion):
    """Whether the view's metal is, bit for bit, what so many motions leave."""
    want, picture = from_start(page.player.shown.cut, motion), page.view.model.picture
    return np.array_equal(picture.heights, want.heights) and np.array_equal(picture.move, want.owner)


def press(page, key, held=NONE):
    QTest.keyClick(page.view, key, held)


@pytest.mark.exhaustive
def test_it_stands_at_its_end_and_shows_no_tool(page):
    player = page.player
    assert player.at_end
    assert page.transport.isVisible()
    assert page.view.playback.tool is None
    assert page.view.model.picture is player.shown.picture
    assert page.transport.clock.text() == f"{exact_clock(player.timeline.total)} / {exact_clock(player.timeline.total)}"


@pytest.mark.exhaustive
def test_anywhere_at_once(qtbot, page):
    player, end = page.player, page.player.shown.picture.heights.copy()
    for motion in (60, 100, 3, len(player.timeline) - 2):
        player.go(motion)
        settle(qtbot, page)
        assert shows(page, motion)
        assert page.view.playback.tip == pytest.approx(player.timeline.place(TimelinePlace(motion)))
        assert page.view.playback.tool.number == player.timeline.tool[motion - 1]
        line = player.timeline.line[motion - 1]
        assert page.transport.place.text().startswith(f"line {line} · T{player.timeline.tool[motion - 1]} ")
        assert page.transport.place.text().endswith(player.shown.texts[0].line(int(line) - 1))
        assert page.transport.place.text().startswith(page.transport.place.shown), "no word is cut off"
    player.go(10**6)
    settle(qtbot, page)
    assert np.array_equal(page.view.model.picture.heights, end)
    assert page.view.playback.tool is None
    assert np.array_equal(player.shown.picture.heights, end)


@pytest.mark.exhaustive
def test_light_and_colours_are_those_of_the_moment(qtbot, page):
    player, view = page.player, page.view
    for colour in (CutColourBy.DEPTH, CutColourBy.TOOL, CutColourBy.MOVE):
        view.set_colour(colour)
        player.go(40 + 20 * len(colour.value))
        settle(qtbot, page)
        picture = view.model.picture
        assert np.array_equal(picture.relief, relief(picture.heights, picture.pitch))
        want = values_of(type(picture)(**{**vars_of(picture), "values": {}}), colour, player.shown.picture.span)
        assert np.array_equal(picture.values[colour], want)


def vars_of(picture):
    return {name: getattr(picture, name) for name in picture.__dataclass_fields__}


@pytest.mark.exhaustive
def test_colours_chosen_on_the_way_are_of_the_moment(qtbot, page):
    player, view = page.player, page.view
    player.go(50)
    settle(qtbot, page)
    view.set_colour(CutColourBy.DEVIATION)
    qtbot.waitUntil(
        lambda: view.model.colour_shown is CutColourBy.DEVIATION and CutColourBy.DEVIATION in view.model.picture.values,
        timeout=10_000,
    )
    settle(qtbot, page)
    end, now = player.shown.picture, view.model.picture
    left = now.heights > end.heights + 0.5
    assert left.sum() > 10_000
    assert np.allclose(now.deviation[left], (end.deviation + now.heights - end.heights)[left])
    shades = now.values[CutColourBy.DEVIATION][left]
    assert shades.min() > 127  # metal is left there, on the scale from gouged to left


@pytest.mark.exhaustive
def test_keys_step_to_lines_moves_and_tools(qtbot, page):
    player, timeline = page.player, page.player.timeline
    press(page, Qt.Key.Key_Home)
    settle(qtbot, page)
    assert player.at == TimelinePlace(0)
    press(page, Qt.Key.Key_Period)
    settle(qtbot, page)
    assert player.at.motion == timeline.line_ends[0]
    press(page, Qt.Key.Key_Greater, SHIFT)
    settle(qtbot, page)
    assert player.at.motion == timeline.line_ends[0] + 1
    press(page, Qt.Key.Key_BracketRight)
    settle(qtbot, page)
    assert player.at.motion == timeline.tool_changes[0]
    press(page, Qt.Key.Key_Comma)
    settle(qtbot, page)
    assert player.at.motion == timeline.line_ends[timeline.line_ends < timeline.tool_changes[0]][-1]
    press(page, Qt.Key.Key_End)
    settle(qtbot, page)
    assert player.at_end


@pytest.mark.exhaustive
def test_findings_are_stepped_to(qtbot, page):
    player = page.player
    player.marks = (TimelineMark(30, FindingColour.ACCIDENT), TimelineMark(90, FindingColour.GOUGE))
    page.transport.show_state()
    assert sum(button.isVisible() for button in page.transport.steps) == 6
    press(page, Qt.Key.Key_Home)
    for motion in (30, 90, len(player.timeline)):
        press(page, Qt.Key.Key_N)
        settle(qtbot, page)
        assert player.at.motion == motion
    press(page, Qt.Key.Key_N, SHIFT)
    settle(qtbot, page)
    assert player.at.motion == 90


@pytest.mark.exhaustive
@pytest.mark.parametrize("pace", list(PlaybackPace))
def test_it_plays_to_the_end_and_back(qtbot, page, pace):
    player = page.player
    player.set_pace(pace, {PlaybackPace.TIME: 130.0, PlaybackPace.MOVES: 90.0, PlaybackPace.TOOLS: 1.0}[pace])
    seen = []
    player.moved.connect(lambda: seen.append(player.at))
    press(page, Qt.Key.Key_Space)
    assert player.playing == 1
    qtbot.waitUntil(lambda: not player.playing, timeout=30_000)
    settle(qtbot, page)
    assert player.at_end
    places = [moment.motion + moment.fraction for moment in seen]
    assert places[1:] == sorted(places[1:])
    assert len(set(places)) > 3
    press(page, Qt.Key.Key_Space, SHIFT)
    assert player.playing == -1
    qtbot.waitUntil(lambda: not player.playing, timeout=30_000)
    settle(qtbot, page)
    assert player.at.motion == 0
    assert shows(page, 0)


@pytest.mark.exhaustive
def test_within_a_long_move_the_tool_goes_on(qtbot, page):
    player, timeline = page.player, page.player.timeline
    long = int(np.argmax(np.where(timeline.volume > 0, timeline.ends - timeline.begins, 0)))
    player.set_pace(PlaybackPace.TIME, 1.0)
    player.go(long)
    settle(qtbot, page)
    before = page.view.model.picture.heights.sum()
    page.transport.play.click()
    qtbot.waitUntil(lambda: player.at.fraction > 0, timeout=10_000)
    qtbot.wait(300)
    page.transport.play.click()
    assert not player.playing
    settle(qtbot, page)
    assert player.at.motion == long
    assert page.view.model.picture.heights.sum() < before
    assert not np.allclose(page.view.playback.tip, timeline.place(TimelinePlace(long)))


def test_a_click_on_the_plot_goes_there(qtbot, page):
    plot, player = page.transport.plot, page.player
    for share in (0.3, 0.75):
        at = QPoint(round(plot._room().left() + share * plot._room().width()), 30)
        qtbot.mouseClick(plot, Qt.MouseButton.LeftButton, pos=at)
        settle(qtbot, page)
        assert player.time == pytest.approx(share * player.timeline.total, rel=0.01)
    words = plot.words_at(0.3 * player.timeline.total)
    assert "line" in words
    assert "mm²" in words
    nothing = Qt.MouseButton.NoButton
    place = QPointF(200, 30)
    QApplication.sendEvent(
        plot, QMouseEvent(QEvent.Type.MouseMove, place, plot.mapToGlobal(place), nothing, nothing, NONE)
    )


def test_a_place_is_picked_on_the_metal_of_the_moment(qtbot, page):
    player, view = page.player, page.view
    row, column = np.argwhere(player.shown.picture.move == player.shown.picture.move.max())[0].tolist()
    assert view.model.picture.height_at(*place_of(view.model.picture, row, column)) < 0
    player.go(2)
    settle(qtbot, page)
    assert view.model.picture.height_at(*place_of(view.model.picture, row, column)) == 0
    assert view.model.picture.move_at(row, column) == -1


def place_of(picture, row, column):
    return picture.x0 + (column + 0.5) * picture.pitch, picture.y0 + (row + 0.5) * picture.pitch


@pytest.mark.exhaustive
def test_another_cut_is_followed_from_its_end(qtbot, computed, page):
    page.player.go(30)
    settle(qtbot, page)
    computed.files.new()
    qtbot.waitUntil(lambda: page.view.model.picture is None, timeout=10_000)
    assert page.player.timeline is None
    assert not page.transport.isVisible()
    assert page.view.playback.tool is None


def test_speeds_are_evenly_spread() -> None:
    for pace, (low, high) in RANGES.items():
        assert speed_of(pace, 0) == pytest.approx(low, rel=0.05)
        assert speed_of(pace, 100) == pytest.approx(high, rel=0.05)
        for notch in (0, 17, 50, 99, 100):
            assert abs(notch_of(pace, speed_of(pace, notch)) - notch) <= 1


def test_times_are_told_to_a_tenth() -> None:
    assert [exact_clock(each) for each in (0, 61.27, 3599.99, 3725)] == ["0:00.0", "1:01.2", "59:59.9", "1:02:05"]


@pytest.mark.exhaustive
@pytest.mark.parametrize("form", list(RecordFormat))
def test_it_is_recorded(qtbot, computed, page, tmp_path, form):
    page.player.go(50)
    settle(qtbot, page)
    before = page.view.model.picture.heights.copy()
    computed.recorder.ask()
    assert page.sheet.isVisible()
    page.sheet.plan = RecordPlan(0.6, 10, 200)
    target = tmp_path / ("cut.gif" if form is RecordFormat.GIF else "cut")
    computed.recorder.start(target)
    qtbot.waitUntil(lambda: target.exists() and not computed.recorder.worker.busy, timeout=60_000)
    assert not page.sheet.isVisible()
    if form is RecordFormat.GIF:
        done, animation = cv2.imreadanimation(str(target))
        assert done
        frames = animation.frames
    else:
        frames = [cv2.imread(str(path)) for path in sorted(target.iterdir())]
    assert len(frames) == 6
    assert {frame.shape[1] for frame in frames} == {200}
    assert len({frame[..., :3].tobytes() for frame in frames}) >= 4  # at first the tool is changed
    assert np.array_equal(page.view.model.picture.heights, before)


@pytest.mark.exhaustive
def test_a_rest_is_looked_at_closer_at_its_own_moment(qtbot, computed, page):
    player, view = page.player, page.view
    player.go(60)
    settle(qtbot, page)
    x, y, z = view.playback.tip
    view.look_now(replace(view.model.camera, target=(x, y, z), scale=12 * view.model.camera.scale))
    qtbot.waitUntil(lambda: view.model.detail is not None, timeout=30_000)
    low, high = view.model.detail.low, view.model.detail.high
    assert view.model.detail.pitch < 0.5 * view.model.picture.pitch
    options = CutOptions(1024, (low[0], low[1], high[0], high[1]), judge=False, stop=60)
    want = cut_of(player.shown.cut.setup, options).cut.heights
    assert np.array_equal(view.model.detail.heights, want)
    finished = cut_of(player.shown.cut.setup, replace(options, stop=None)).cut.heights
    assert not np.array_equal(view.model.detail.heights, finished)
    player.go(3)
    settle(qtbot, page)
    assert view.model.detail is None or not np.array_equal(view.model.detail.heights, want)
