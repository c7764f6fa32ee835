"""The Surfaces view as it is used: a scene is opened, looked at in space, from above and plane by plane."""

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest

from app.resources import resource
from app.ui.surfaces.shown_scene import Role, is_scene
from app.ui.surfaces.surfaces_view import Look
from app.ui.views import View

WAIT_MS = 60_000
COMPOUND = resource("samples", "compound.toml")


@pytest.fixture
def opened(qtbot, wiring):
    """The sample scene in the Surfaces view."""
    wiring.files.open_file(COMPOUND)
    view = wiring.window_.views.surfaces
    qtbot.waitUntil(lambda: view.shown is not None, timeout=WAIT_MS)
    return wiring


def test_scenes_are_told_from_jobs_by_what_they_hold(tmp_path):
    other = tmp_path / "torus.txt"
    other.write_bytes(COMPOUND.read_bytes())
    assert is_scene(COMPOUND)
    assert not is_scene(resource("samples", "job.toml"))
    assert not is_scene(other)
    assert not is_scene(tmp_path / "none.toml")


def test_a_scene_that_is_opened_comes_to_the_front(opened):
    window = opened.window_
    shown = window.views.surfaces.shown
    assert opened.showing.view is View.SURFACES
    assert window.views.currentWidget() is window.views.surfaces
    assert not window.views.empty.isVisible()
    assert not window.side.isVisible()
    assert window.settings.recent_files[0] == str(COMPOUND.absolute())
    assert {line.role for line in shown.space.lines} == {Role.SURFACE, Role.PATH, Role.RAPID}
    assert f"{len(shown.computed.scene.surfaces)} surfaces" in window.views.surfaces.summary


def test_without_a_scene_the_view_says_what_to_do(wiring):
    QTest.keyClick(wiring.window_, Qt.Key.Key_6, Qt.KeyboardModifier.ControlModifier)
    assert wiring.showing.view is View.SURFACES
    assert "No scene is open" in wiring.window_.views.empty.sentence.text()


def test_while_a_scene_is_computed_the_view_says_so_and_can_leave_it(wiring):
    empty = wiring.window_.views.empty
    wiring.files.open_file(COMPOUND)
    assert "being computed" in empty.sentence.text()
    empty.button.click()
    assert "No scene is open" in empty.sentence.text()
    assert wiring.window_.views.surfaces.shown is None


def test_what_is_wrong_with_a_scene_is_told_and_the_one_before_stays(qtbot, opened, tmp_path):
    view = opened.window_.views.surfaces
    before, path = view.shown, tmp_path / "wrong.toml"
    path.write_text('name = "wrong"\n[[surface]]\nname = "a"\n')
    with qtbot.waitSignal(opened.scenes.failed, timeout=WAIT_MS) as told:
        opened.files.open_file(path)
    assert "wrong.toml" in told.args[0]
    assert view.shown is before


def test_the_section_is_what_lies_on_the_plane(opened):
    view = opened.window_.views.surfaces
    view.set_look(Look.SECTION)
    view.plane.setValue(4)
    family, plane = view.shown.planes[4]
    picture = view.shown.section(family, plane)
    top = [line for line in picture.lines if line.role is Role.PATH]
    runs = [run for run in family.surface.runs if run.plane == plane]
    assert view.at.text() == f"5 / {len(view.shown.planes)}"
    assert sum(len(line.points) - 1 for line in top) == sum(len(run.owner) for run in runs)
    assert all(line.points[:, 1].max() == 0 for line in picture.lines)
    nearest = np.array([min(np.hypot(*(line.points - mark)[:, [0, 2]].T).min() for line in top) for mark in picture.marks])
    assert len(nearest)
    assert nearest.max() < 1e-9


def test_dragging_turns_the_scene_and_shifts_the_plan(qtbot, opened):
    view = opened.window_.views.surfaces
    for look, turns in ((Look.SPACE, True), (Look.PLAN, False)):
        view.set_look(look)
        before = view.canvas.camera
        QTest.mousePress(view.canvas, Qt.MouseButton.LeftButton, pos=QPoint(200, 200))
        QTest.mouseMove(view.canvas, QPoint(260, 230))
        QTest.mouseRelease(view.canvas, Qt.MouseButton.LeftButton, pos=QPoint(260, 230))
        assert (view.canvas.camera.yaw != before.yaw) is turns
        assert (view.canvas.camera.target != before.target) is not turns
        view.canvas.fit()


def test_zoom_keeps_the_middle(opened):
    canvas = opened.window_.views.surfaces.canvas
    before = canvas.camera
    opened.window_.actions_["zoom_in"].trigger()
    assert canvas.camera.scale > before.scale
    assert canvas.camera.target == pytest.approx(before.target)


def test_each_surface_is_seen_in_its_colour(opened):
    view = opened.window_.views.surfaces
    view.set_look(Look.PLAN)
    image = view.canvas.grab().toImage()
    seen = {image.pixelColor(x, y).name() for x in range(image.width()) for y in range(0, image.height(), 3)}
    used = {view.shown.colours[line.surface].lower() for line in view.shown.space.lines if line.role is Role.PATH}
    assert len(used) > 1
    assert used <= seen


@pytest.mark.parametrize(("suffix", "begins"), [(".ngc", b"(Scene compound)"), (".svg", b"<?xml"), (".pdf", b"%PDF"), (".png", b"\x89PNG"),
                                                (".hpgl", b"IN;"), (".csv", b"kind,tool"), (".json", b"{")])  # fmt: skip
def test_ctrl_e_writes_program_plot_table_or_report(qtbot, opened, tmp_path, suffix, begins):
    path = tmp_path / f"out{suffix}"
    opened.scene_export.choose_file = lambda first: path
    with qtbot.waitSignal(opened.scene_export.written, timeout=WAIT_MS):
        QTest.keyClick(opened.window_, Qt.Key.Key_E, Qt.KeyboardModifier.ControlModifier)
    assert path.read_bytes().startswith(begins)
    assert path.name in opened.window_.status.message.text()


def test_f5_computes_the_scene_as_its_file_is_now(qtbot, wiring, tmp_path):
    path = tmp_path / "scene.toml"
    path.write_bytes(COMPOUND.read_bytes())
    assert not is_enabled(wiring, "compute")
    wiring.files.open_file(path)
    view = wiring.window_.views.surfaces
    qtbot.waitUntil(lambda: view.shown is not None, timeout=WAIT_MS)
    planes = len(view.shown.planes)
    path.write_bytes(COMPOUND.read_bytes().replace(b"pitch = 5", b"pitch = 10"))
    assert is_enabled(wiring, "compute") and is_enabled(wiring, "export")
    QTest.keyClick(wiring.window_, Qt.Key.Key_F5)
    qtbot.waitUntil(lambda: len(view.shown.planes) < planes, timeout=WAIT_MS)
    wiring.showing.show_view(View.DRAW)
    assert not is_enabled(wiring, "compute")  # nothing is drawn


def is_enabled(wiring, action):
    return wiring.window_.actions_[action].isEnabled()
