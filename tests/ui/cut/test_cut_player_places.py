"""The cut is played while other things go on: other views, other cuts, other surfaces, waits, failures, the window's
end.
"""

from dataclasses import replace

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from app.core.errors import HitofudeError
from app.ui.framework.computation import ComputationState
from app.ui.framework.view import View
from app.ui.views.cut import cut_player as player_file
from app.ui.views.cut.cut_player import PlaybackPace
from app.usecases.cutting.timeline import Timeline
from tests.ui.cut.test_cut_player import page, settle

__all__ = ["page"]


@pytest.mark.exhaustive
def test_a_cut_that_was_computed_anew_is_looked_at_closer_without_a_nudge(qtbot, computed, page):
    view = page.view
    view.look_now(replace(view.model.camera, scale=12 * view.model.camera.scale))
    qtbot.waitUntil(lambda: view.model.detail is not None, timeout=30_000)
    before = view.model.picture
    computed.window_.actions_["compute"].trigger()
    qtbot.waitUntil(
        lambda: computed.computation.state is ComputationState.CURRENT and view.model.picture is not before,
        timeout=60_000,
    )
    qtbot.waitUntil(lambda: view.model.detail is not None and page.player.timeline is not None, timeout=30_000)


@pytest.mark.exhaustive
def test_what_is_not_seen_is_not_played_and_nothing_piles_up(qtbot, computed, page):
    player = page.player
    player.set_pace(PlaybackPace.MOVES, 60.0)
    QTest.keyClick(page.view, Qt.Key.Key_Space)
    assert player.playing
    computed.display_controller.show_view(View.NC)
    assert not player.playing
    for motion in range(10, 60, 5):
        player.go(motion)
        settle(qtbot, page)
    waiting = page.view.render_scheduler._patches
    assert sum(patch.heights.size for patch in waiting) <= page.view.model.picture.heights.size
    computed.display_controller.show_view(View.CUT)
    qtbot.waitUntil(lambda: page.view.render_scheduler.fine and not waiting, timeout=20_000)
    shown = page.view.render_scheduler.surface._scene._whole
    data = np.frombuffer(page.view.render_scheduler.surface.work(lambda _: shown._heights.read()), np.float32).reshape(
        page.view.model.picture.heights.shape
    )
    assert np.array_equal(data, page.view.model.picture.heights)


@pytest.mark.exhaustive
def test_a_new_scene_shows_the_moment_too(qtbot, page):
    page.player.go(30)
    settle(qtbot, page)
    qtbot.waitUntil(lambda: page.view.render_scheduler.fine, timeout=20_000)
    before = page.view.render_scheduler.surface.work(lambda scene: scene.pixels().copy())
    page.view.render_scheduler.renew()
    qtbot.waitUntil(lambda: page.view.render_scheduler.fine and not page.view.render_scheduler.due, timeout=20_000)
    after = page.view.render_scheduler.surface.work(lambda scene: scene.pixels().copy())
    assert np.mean(np.any(before != after, axis=2)) < 1e-3


@pytest.mark.exhaustive
def test_the_clock_goes_on_while_the_control_waits_but_not_for_long(qtbot, page):
    player, timeline = page.player, page.player.timeline
    wait = timeline.wait_at(0.0)
    assert wait > 30
    player.set_pace(PlaybackPace.TIME, 1.0)
    player.go(0)
    settle(qtbot, page)
    seen = []
    player.ticked.connect(lambda: seen.append((player.time, page.transport.clock.text())))
    QTest.keyClick(page.view, Qt.Key.Key_Space)
    qtbot.waitUntil(lambda: player.time > wait, timeout=10_000)
    player.pause()
    during = [text for time, text in seen if time < wait]
    assert len(set(during)) > 3


def test_profile_and_facts_are_those_of_the_moment(qtbot, page):
    view, player = page.view, page.player
    x0, y0, x1, y1 = *view.model.picture.low[:2], *view.model.picture.high[:2]
    view.show_line(((x0, (y0 + y1) / 2, 0.0), (x1, (y0 + y1) / 2, 0.0)))
    end = view.profile.drawn.heights.copy()
    player.go(2)
    settle(qtbot, page)
    assert view.profile.drawn.heights.min() == 0.0
    assert end.min() < 0.0
    assert view.model.hit is None


def test_what_cannot_be_played_is_said_once(qtbot, page, monkeypatch):
    def fails(shown, progress):
        raise HitofudeError("There is too little memory.")

    monkeypatch.setattr(player_file, "prepared", fails)
    player, said = page.player, []
    player.failed.connect(said.append)
    player.follow(player.shown, ())
    for _ in range(3):
        page._prepare()
        qtbot.waitUntil(lambda: not player.worker.busy, timeout=10_000)
        qtbot.wait(30)
    assert said == ["There is too little memory."]
    assert page.transport.place.text() == "There is too little memory."
    assert not page.transport.play.isEnabled()


def test_playing_begins_where_one_was_sent_to(qtbot, page):
    player = page.player
    player.set_pace(PlaybackPace.MOVES, 5.0)
    player.go(50)
    player.toggle(1)
    assert player._goal().motion >= 50
    player.pause()


@pytest.mark.exhaustive
def test_frames_do_not_plot_the_way_anew(qtbot, page, monkeypatch):
    page.transport.plot.grab()
    monkeypatch.setattr(Timeline, "sampled", lambda *_: pytest.fail("plotted anew"))
    for motion in (10, 20, 30):
        page.player.go(motion)
        settle(qtbot, page)
        page.transport.plot.grab()


@pytest.mark.exhaustive
def test_recording_is_asked_for_from_any_view_and_one_at_a_time(qtbot, computed, page, tmp_path):
    computed.display_controller.show_view(View.NC)
    computed.window_.actions_["record"].trigger()
    assert computed.display_controller.view is View.CUT
    assert page.sheet.isVisible()
    page.sheet.plan = replace(page.sheet.plan, seconds=0.4, per_second=5.0, width=100)
    said = []
    computed.recorder.failed.connect(said.append)
    computed.recorder.start(tmp_path / "one.gif")
    computed.recorder.ask()
    assert said == ["A recording is being written; wait for it, or cancel it."]
    computed.recorder.start(tmp_path / "two.gif")
    qtbot.waitUntil(lambda: (tmp_path / "one.gif").exists(), timeout=60_000)
    assert not (tmp_path / "two.gif").exists()


@pytest.mark.exhaustive
def test_the_end_of_the_window_is_the_end_of_playing(qtbot, computed, page):
    page.player.set_pace(PlaybackPace.MOVES, 40.0)
    page.player.go(0)
    settle(qtbot, page)
    page.player.toggle(1)
    computed.window_.activity.ended.emit()
    assert not page.player.playing
    assert page.player.timeline is None  # what it kept is let go of
    assert page.view.model.picture is None
