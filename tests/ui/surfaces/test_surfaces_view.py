"""The Surfaces view as it is used: a scene is opened, looked at in space, from above and plane by plane."""

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest

from app.core.resources import resource
from app.ui.framework.view import View
from app.ui.views.surfaces.scene_computation import SceneState
from app.ui.views.surfaces.scene_raster import SceneColourBy, SceneLayer
from app.ui.views.surfaces.shown_scene import is_scene
from app.ui.views.surfaces.view import ViewDirection
from app.usecases.scene.lines import LineRole

WAIT_MS = 60_000
COMPOUND = resource("samples", "compound.toml")


@pytest.fixture
def opened(qtbot, wiring):
    """The sample scene in the Surfaces view."""
    wiring.files.open_file(COMPOUND)
    qtbot.waitUntil(lambda: wiring.scenes.work.state is SceneState.PROVEN, timeout=WAIT_MS)
    return wiring


def place_of(canvas, point) -> QPoint:
    """Where a place in space is on the canvas."""
    x, y, _ = canvas.camera.project(np.array([point]), (float(canvas.width()), float(canvas.height())))[0]
    return QPoint(round(x), round(y))


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
    assert opened.display_controller.view is View.SURFACES
    assert window.views.currentWidget() is window.views.surfaces
    assert not window.views.empty.isVisible()
    assert not window.side.isVisible()
    assert window.scene_side.isVisible()
    assert window.preferences.settings.recent_files[0] == str(COMPOUND.absolute())
    assert {each.role for each in shown.space.strands} == {
        LineRole.PATH,
        LineRole.LINK,
        LineRole.RAPID,
        LineRole.PLUNGE,
    }
    assert f"{len(shown.computed.scene.surfaces)} surfaces" in window.views.surfaces.summary


def test_every_move_is_in_one_strand(opened):
    shown = opened.window_.views.surfaces.shown
    moves = shown.computed.moves.moves
    known = np.isfinite(moves.start).all(axis=1)
    long = sum(
        np.linalg.norm(np.diff(each.points, axis=0)[each.joined[:-1]], axis=1).sum() for each in shown.space.strands
    )
    assert sum(int(each.joined.sum()) for each in shown.space.strands) == known.sum()
    assert long == pytest.approx(np.linalg.norm(moves.end - moves.start, axis=1)[known].sum(), rel=1e-12)


def test_without_a_scene_the_view_says_what_to_do_and_opens_figure_1(qtbot, wiring):
    QTest.keyClick(wiring.window_, Qt.Key.Key_6, Qt.KeyboardModifier.ControlModifier)
    assert wiring.display_controller.view is View.SURFACES
    assert "No scene is open" in wiring.window_.views.empty.sentence.text()
    assert not wiring.window_.scene_side.isVisible()
    wiring.window_.views.empty.button.click()
    qtbot.waitUntil(lambda: wiring.window_.views.surfaces.shown is not None, timeout=WAIT_MS)
    assert wiring.window_.scene.name == "compound.toml"


def test_while_a_scene_is_computed_the_view_says_so_and_can_leave_it(wiring):
    empty = wiring.window_.views.empty
    wiring.files.open_file(COMPOUND)
    assert "being computed" in empty.sentence.text()
    empty.button.click()
    assert wiring.scenes.work.state is SceneState.CHANGED
    assert "not computed" in empty.sentence.text()
    assert wiring.window_.views.surfaces.shown is None


def test_the_section_is_what_lies_on_the_plane(opened):
    view = opened.window_.views.surfaces
    view.set_look(ViewDirection.SECTION)
    view.plane.setValue(4)
    family, plane = view.shown.planes[4]
    picture = view.shown.section(family, plane)
    top = [each for each in picture.strands if each.role is LineRole.PATH]
    runs = [run for run in family.surface.runs if run.plane == plane]
    assert view.at.text() == f"5 / {len(view.shown.planes)}"
    assert sum(len(each.points) - 1 for each in top) == sum(len(run.owner) for run in runs)
    assert all(each.points[:, 1].max() == 0 for each in picture.strands)
    nearest = np.array(
        [min(np.hypot(*(each.points - mark)[:, [0, 2]].T).min() for each in top) for mark in picture.marks]
    )
    assert len(nearest)
    assert nearest.max() < 1e-9


def test_in_a_section_the_tool_stands_on_its_path(opened):
    view = opened.window_.views.surfaces
    view.set_look(ViewDirection.SECTION)
    picture = view.shown.section(*view.shown.planes[view.plane.value()])
    along, low = picture.lows[len(picture.lows) // 3]
    ball = picture.tool[picture.tool[:, 1] <= 3.0]
    assert np.hypot(ball[:, 0], ball[:, 1] - 3.0) == pytest.approx(3.0)
    before = view.canvas.grab().toImage()
    QTest.mouseMove(view.canvas, place_of(view.canvas, (along, 0.0, low + 20)))
    after = view.canvas.grab().toImage()
    side = place_of(view.canvas, (along + 3.0, 0.0, low + 6.0))
    changed = [x for x in range(side.x() - 2, side.x() + 3) if before.pixel(x, side.y()) != after.pixel(x, side.y())]
    assert changed


def test_dragging_turns_the_scene_and_shifts_the_plan(qtbot, opened):
    view = opened.window_.views.surfaces
    for look, turns in ((ViewDirection.SPACE, True), (ViewDirection.PLAN, False)):
        view.set_look(look)
        before = view.canvas.camera
        QTest.mousePress(view.canvas, Qt.MouseButton.LeftButton, pos=QPoint(200, 200))
        QTest.mouseMove(view.canvas, QPoint(260, 230))
        QTest.mouseRelease(view.canvas, Qt.MouseButton.LeftButton, pos=QPoint(260, 230))
        assert (view.canvas.camera.yaw != before.yaw) is turns
        assert (view.canvas.camera.target != before.target) is not turns
        view.canvas.fit()


def test_keys_turn_zoom_and_fit(opened):
    canvas = opened.window_.views.surfaces.canvas
    fitted = canvas.camera
    QTest.keyClick(canvas, Qt.Key.Key_Left)
    assert canvas.camera.yaw != fitted.yaw
    QTest.keyClick(canvas, Qt.Key.Key_Plus)
    assert canvas.camera.scale > fitted.scale
    QTest.keyClick(canvas, Qt.Key.Key_F)
    canvas.look(ViewDirection.SPACE.value)
    assert canvas.camera.scale == pytest.approx(fitted.scale)


def test_zoom_keeps_the_middle(opened):
    canvas = opened.window_.views.surfaces.canvas
    before = canvas.camera
    opened.window_.actions_["zoom_in"].trigger()
    assert canvas.camera.scale > before.scale
    assert canvas.camera.target == pytest.approx(before.target)


def test_each_surface_is_seen_in_its_colour(opened):
    view = opened.window_.views.surfaces
    view.set_look(ViewDirection.PLAN)
    image = view.canvas.grab().toImage()
    seen = {image.pixelColor(x, y).name() for x in range(image.width()) for y in range(0, image.height(), 3)}
    used = {view.shown.colours[each.surface].lower() for each in view.shown.space.strands if each.role is LineRole.PATH}
    assert len(used) == 3
    assert used <= seen


def test_layers_and_colours_are_switched(opened):
    view = opened.window_.views.surfaces
    whole = view.canvas.grab().toImage()
    view.switches[SceneLayer.SURFACES].setChecked(False)
    assert view.canvas.layers is SceneLayer.ALL & ~SceneLayer.SURFACES
    bare = view.canvas.grab().toImage()
    assert (view.canvas.drawn.owners < 0).all()
    assert bare != whole
    for by in (SceneColourBy.TOOL, SceneColourBy.LINE):
        view.colours.setCurrentIndex(view.colours.findData(by))
        view.colours.activated.emit(view.colours.currentIndex())
        assert view.canvas.colour_by is by
        assert view.canvas.grab().toImage() != bare


def test_the_mouse_names_what_it_is_over_and_a_click_chooses_it(opened):
    window = opened.window_
    view, panel = window.views.surfaces, window.scene_side.panel
    view.set_look(ViewDirection.PLAN)
    view.canvas.grab()
    QTest.mouseMove(view.canvas, place_of(view.canvas, (50.0, 38.5, 0.0)))
    name, _, place = window.status.message.text().partition(" at ")
    assert name == "12b dome"
    assert [float(each) for each in place.split(",")] == pytest.approx([50.0, 38.5, 23.95], abs=0.3)
    QTest.mouseClick(view.canvas, Qt.MouseButton.LeftButton, pos=place_of(view.canvas, (50.0, 38.5, 0.0)))
    assert panel.subject == ("surface", 1)
    point = view.points[5]
    QTest.mouseMove(view.canvas, place_of(view.canvas, point.place))
    assert window.status.message.text().startswith("CR")
    QTest.mouseClick(view.canvas, Qt.MouseButton.LeftButton, pos=place_of(view.canvas, point.place))
    assert window.scene_side.page == "Points"
    assert window.scene_side.points.table.currentIndex().row() == 5


def test_a_row_of_the_table_goes_to_its_plane(opened):
    window = opened.window_
    view, page = window.views.surfaces, window.scene_side.points
    view.set_look(ViewDirection.SECTION)
    for number in (0, 7, 33):
        page.choose(number)
        assert view.plane.value() == page.model.points[number].plane
        picture = view.shown.section(*view.shown.planes[view.plane.value()])
        assert picture.labels[view.canvas.marked] == page.model.points[number].name
    text = [page.model.data(page.model.index(7, column)) for column in range(6)]
    assert text[0] == page.model.points[7].name
    assert text[4] == f"{page.model.points[7].place[2]:.3f}"


@pytest.mark.parametrize(
    ("suffix", "begins"),
    [
        (".ngc", b"(Scene compound)"),
        (".svg", b"<?xml"),
        (".pdf", b"%PDF"),
        (".png", b"\x89PNG"),
        (".hpgl", b"IN;"),
        (".csv", b"kind,tool"),
        (".json", b"{"),
    ],
)
def test_ctrl_e_writes_program_plot_table_or_report(qtbot, opened, tmp_path, suffix, begins):
    path = tmp_path / f"out{suffix}"
    opened.scene_export.choose_file = lambda first: path
    with qtbot.waitSignal(opened.scene_export.written, timeout=WAIT_MS):
        QTest.keyClick(opened.window_, Qt.Key.Key_E, Qt.KeyboardModifier.ControlModifier)
    assert path.read_bytes().startswith(begins)
    assert path.name in opened.window_.status.message.text()
