"""The Cut view without a screen: it shows what OpenGL painted elsewhere, and does what mouse and keys ask."""

from dataclasses import replace

import numpy as np
import pytest
from PySide6.QtCore import QEvent, QPoint, QPointF, Qt
from PySide6.QtGui import QMouseEvent, QWheelEvent
from PySide6.QtWidgets import QApplication, QWidget

from app.ui.framework.samples import PathLineKind
from app.ui.framework.theme import DARK, LIGHT
from app.ui.framework.view import views
from app.ui.views.cut.camera import StandardView
from app.ui.views.cut.cell_colours import CutColourBy
from app.ui.views.cut.cut_picture import CutPaths
from app.ui.views.cut.legend import CutLegend, SectionAxis
from app.ui.views.cut.surface import ImageSurface, widgets_have_opengl
from app.ui.views.cut.view import CutView
from app.ui.views.nc.motion_shapes import MotionLineStyle
from tests.ui.cut.made_up import made_up
from tests.ui.cut.pictures import without_a_screen

LEFT, MIDDLE = Qt.MouseButton.LeftButton, Qt.MouseButton.MiddleButton


@pytest.fixture(scope="module")
def picture():
    return made_up(120)


@pytest.fixture
def view(qtbot, picture):
    without_a_screen().release()
    made = CutView()
    qtbot.addWidget(made)
    made.resize(720, 480)
    made.set_theme(LIGHT)
    made.show()
    made.show_cut(picture)
    qtbot.waitUntil(lambda: made.render_scheduler.fine, timeout=20_000)
    return made


def pixels(view):
    image = view.grab().toImage().convertToFormat(view.grab().toImage().Format.Format_RGB888)
    flat = np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), image.bytesPerLine())
    return flat[:, : 3 * image.width()].reshape(image.height(), image.width(), 3).astype(int)


def on_screen(view, place):
    x, y, _ = view.model.camera.project(np.array([place]), (view.width(), view.height()))[0]
    return QPoint(round(x), round(y))


def hover(view, at):
    nothing = Qt.MouseButton.NoButton
    QApplication.sendEvent(
        view,
        QMouseEvent(
            QEvent.Type.MouseMove,
            QPointF(at),
            view.mapToGlobal(QPointF(at)),
            nothing,
            nothing,
            Qt.KeyboardModifier.NoModifier,
        ),
    )


def drag(qtbot, view, button, by):
    begin = QPoint(300, 300)
    qtbot.mousePress(view, button, pos=begin)
    qtbot.mouseMove(view, begin + by / 2)
    qtbot.mouseMove(view, begin + by)
    qtbot.mouseRelease(view, button, pos=begin + by)


def test_without_opengl_in_widgets_a_picture_is_painted_elsewhere(view):
    assert not widgets_have_opengl()
    assert isinstance(view.render_scheduler.surface, ImageSurface)
    shown = pixels(view)
    middle = on_screen(view, (50.0, 90.0, 0.0))
    assert np.ptp(shown[middle.y(), middle.x()]) < 30
    assert shown[middle.y(), middle.x()].mean() < 220
    assert shown[20, 20].tolist() == [255, 255, 255]


def test_by_night_the_ground_is_dark(qtbot, view):
    view.set_theme(DARK)
    assert pixels(view)[20, 20].max() < 40


def test_nothing_is_made_before_there_is_a_cut_to_show(qtbot):
    empty = CutView()
    qtbot.addWidget(empty)
    empty.show()
    assert empty.render_scheduler.surface is None
    assert not empty.legend.isVisible()


def test_left_drag_turns_round_the_place_that_is_held(qtbot, view):
    before, held = view.model.camera, view.cut_input.probe(QPointF(300, 300))
    drag(qtbot, view, LEFT, QPoint(60, 20))
    assert view.model.camera.yaw != before.yaw and view.model.camera.pitch > before.pitch
    now = on_screen(view, held.place)
    assert abs(now.x() - 300) <= 1 and abs(now.y() - 300) <= 1


def test_middle_drag_shifts_and_does_not_turn(qtbot, view, picture):
    before, place = view.model.camera, (50.0, 50.0, 0.0)
    at = on_screen(view, place)
    drag(qtbot, view, MIDDLE, QPoint(40, -30))
    assert (view.model.camera.yaw, view.model.camera.pitch) == (before.yaw, before.pitch)
    assert on_screen(view, place) - at == QPoint(40, -30)


def test_wheel_zooms_at_the_mouse(qtbot, view):
    at = QPointF(250, 320)
    held, scale = view.cut_input.probe(at), view.model.camera.scale
    view.wheelEvent(
        QWheelEvent(
            at,
            view.mapToGlobal(at),
            QPoint(),
            QPoint(0, 240),
            Qt.MouseButton.NoButton,
            Qt.KeyboardModifier.NoModifier,
            Qt.ScrollPhase.NoScrollPhase,
            False,
        )
    )
    assert view.model.camera.scale == pytest.approx(scale * 1.44)
    now = on_screen(view, held.place)
    assert abs(now.x() - 250) <= 1 and abs(now.y() - 320) <= 1


@pytest.mark.parametrize(
    ("key", "standard"),
    [
        (Qt.Key.Key_1, StandardView.TOP),
        (Qt.Key.Key_2, StandardView.FRONT),
        (Qt.Key.Key_3, StandardView.RIGHT),
        (Qt.Key.Key_4, StandardView.ISOMETRIC),
    ],
)
def test_digits_are_standard_views(qtbot, view, key, standard):
    view.model.camera = view.model.camera.orbited(0.4, 0.2, np.zeros(3))
    qtbot.keyClick(view, key)
    wanted = view.model.camera.seen_from(standard).axes
    qtbot.waitUntil(lambda: np.allclose(view.model.camera.axes, wanted, atol=1e-6), timeout=5000)


def test_f_fits_and_a_fitted_view_stays_fitted_when_the_size_changes(qtbot, view):
    fitted = view.model.camera
    view.zoom_by(4.0)
    qtbot.keyClick(view, Qt.Key.Key_F)
    qtbot.waitUntil(lambda: view.model.camera.scale == pytest.approx(fitted.scale), timeout=5000)
    view.resize(1300, 900)
    assert view.model.camera.scale > 1.2 * fitted.scale
    view.zoom_by(2.0)
    scale = view.model.camera.scale
    view.resize(900, 600)
    assert view.model.camera.scale == scale


def test_probe_tells_place_depth_tool_and_line(qtbot, view, picture):
    told = []
    view.hovered.connect(told.append)
    view.stand(StandardView.TOP)
    qtbot.waitUntil(lambda: view.model.camera.pitch == pytest.approx(np.pi / 2), timeout=5000)
    place = (34.25, 50.25)
    hover(view, on_screen(view, (*place, 0.0)))
    assert view.model.hit is not None
    row, column = view.model.hit.row, view.model.hit.column
    assert (column, row) == (
        pytest.approx(place[0] / picture.pitch, abs=2),
        pytest.approx(place[1] / picture.pitch, abs=2),
    )
    move = picture.move[row, column]
    assert f"T{picture.moves.tool[move]}" in told[-1]
    assert f"line {picture.moves.line[move]}" in told[-1]
    assert f"{-picture.heights[row, column]:.3f} deep" in told[-1]
    assert view.overlay.probe is not None and view.overlay.probe.place.startswith("X 34.")
    hover(view, QPoint(5, 5))
    assert told[-1] == "" and view.overlay.probe is None


def test_click_picks_the_cell_and_a_drag_does_not(qtbot, view, picture):
    picked = []
    view.cell_picked.connect(lambda *values: picked.append(values))
    drag(qtbot, view, LEFT, QPoint(50, 0))
    assert not picked
    at = on_screen(view, (34.0, 50.0, -9.0))
    qtbot.mouseClick(view, LEFT, pos=at)
    hit = view.cut_input.probe(QPointF(at))
    assert picked == [(*hit.place, int(picture.move[hit.row, hit.column]))]


def test_legend_explains_the_colours_and_chooses_them(qtbot, view, picture):
    box = view.legend.colour.box
    assert [box.itemText(k) for k in range(box.count())] == [colour.value for colour in CutColourBy]
    plain = pixels(view)
    box.activated.emit(box.findText("Tool"))
    assert view.colour is CutColourBy.TOOL
    qtbot.waitUntil(lambda: view.legend.title.text() == "Tool", timeout=5000)
    assert view.legend.key.accessibleDescription() == "T1, T2, T3"
    assert np.any(pixels(view) != plain)
    qtbot.waitUntil(lambda: view.render_scheduler.fine, timeout=20_000)


def test_what_cuts_is_called_no_pocket_since_a_program_may_have_none(qtbot):
    parent = QWidget()
    qtbot.addWidget(parent)
    legend = CutLegend(parent)
    row = legend.rows[PathLineKind.POCKET]
    assert (row.label.text(), row.accessibleName()) == ("Cutting moves", "Show cutting moves")
    assert legend.rows[PathLineKind.CONTOUR].label.text() == "Contour"


def test_paths_can_be_hidden(qtbot, view):
    shown = pixels(view)
    view.legend.rows[PathLineKind.POCKET].setChecked(False)
    qtbot.waitUntil(lambda: view.render_scheduler.fine, timeout=20_000)
    hidden = pixels(view)
    green = (np.array(shown)[..., 1] - np.array(shown)[..., 0] > 60).sum(), (hidden[..., 1] - hidden[..., 0] > 60).sum()
    assert green[0] > 500 > green[1]


def test_many_steps_down_along_one_wall_hide_no_metal(view, picture):
    ring = np.array([[10.0, 10.0, 0.0], [50.0, 10.0, 0.0], [50.0, 40.0, 0.0], [10.0, 40.0, 0.0]])
    levels = [ring - (0.0, 0.0, 0.1 * step) for step in range(200)]
    start, end = np.concatenate(levels), np.concatenate([np.roll(level, -1, axis=0) for level in levels])
    look = np.full(len(start), MotionLineStyle.CONTOUR, np.uint8)
    wall = CutPaths(start, end, look)
    assert wall.ground_length(MotionLineStyle.CONTOUR) == pytest.approx(140.0)
    view.show_cut(None)
    view.show_cut(replace(picture, paths=wall))
    assert view.legend.rows[PathLineKind.CONTOUR].isChecked()
    aside = np.repeat(np.linspace(0.0, 9.0, 200), 4)[:, None] * (1.0, 1.0, 0.0)
    view.show_cut(None)
    view.show_cut(replace(picture, paths=CutPaths(start + aside, end + aside, look)))
    assert not view.legend.rows[PathLineKind.CONTOUR].isChecked()


def test_paths_that_would_hide_the_metal_are_left_out_until_somebody_wants_them(view, picture):
    assert view.legend.rows[PathLineKind.POCKET].isChecked()
    paths = picture.paths
    many = CutPaths(*(np.concatenate([column] * 40) for column in (paths.start, paths.end, paths.look)))
    view.show_cut(None)
    view.show_cut(replace(picture, paths=many))
    assert not view.legend.rows[PathLineKind.POCKET].isChecked() and view.legend.rows[PathLineKind.RAPID].isChecked()
    view.legend.rows[PathLineKind.POCKET].setChecked(True)
    view.show_cut(replace(picture, paths=many))
    assert view.legend.rows[PathLineKind.POCKET].isChecked()


def test_a_cut_that_came_while_the_view_was_hidden_is_painted_finely_too(qtbot, view):
    view.hide()
    view.show_cut(made_up(120))
    qtbot.waitUntil(lambda: view.render_scheduler.resting, timeout=5000)
    view.show()
    qtbot.waitUntil(lambda: view.render_scheduler.fine, timeout=20_000)


def test_a_section_opens_the_stock_and_the_probe_meets_its_face(qtbot, view):
    qtbot.mouseClick(view.legend.side.buttons[SectionAxis.Y], LEFT)
    assert view.legend.slider.isVisible()
    assert view.model.section.offset == -50.0
    hit = view.cut_input.probe(QPointF(on_screen(view, (80.0, 50.0, -15.0))))
    assert hit.place == pytest.approx((80.0, 50.0, -15.0), abs=0.3)
    qtbot.mouseClick(view.legend.side.buttons[SectionAxis.X], LEFT)
    assert view.model.camera.axes[2, 0] < 0 and view.model.section.normal == (-1.0, 0.0)
    qtbot.mouseClick(view.legend.side.buttons[SectionAxis.Y], LEFT)
    view.legend.slider.setValue(250)
    assert view.model.section.offset == -25.0
    qtbot.mouseClick(view.legend.side.buttons[SectionAxis.WHOLE], LEFT)
    assert view.model.section is None


def test_the_view_stays_when_the_same_stock_is_cut_anew(view, picture):
    view.zoom_by(2.0)
    camera = view.model.camera
    view.show_cut(made_up(100))
    assert view.model.camera == camera
    view.show_cut(None)
    assert not view.legend.isVisible()


def test_cut_curves_and_surfaces_stand_between_paths_and_nc():
    names = [view.value for view in views()]
    assert names[names.index("view_paths") + 1 :] == ["view_cut", "view_curves", "view_surfaces", "view_nc"]


def fails(scene):
    raise RuntimeError("GL_CONTEXT_LOST")


def test_a_surface_that_fails_is_replaced_and_that_is_said_once(qtbot, view):
    said = []
    view.surface_host.said.connect(said.append)
    old, before = view.render_scheduler.surface, pixels(view)
    old._scene.draw = fails
    view.render_scheduler.moved()
    qtbot.waitUntil(
        lambda: (
            view.render_scheduler.surface is not old
            and view.render_scheduler.surface is not None
            and view.render_scheduler.fine
        ),
        timeout=20_000,
    )
    assert len(said) == 1
    assert "GL_CONTEXT_LOST" in said[0]
    assert np.mean(np.abs(pixels(view) - before) > 3) < 0.001
    view.render_scheduler.surface._scene.draw_in_steps = view.render_scheduler.surface._scene.draw = fails
    view.render_scheduler.moved()
    qtbot.waitUntil(lambda: bool(view.surface_host.failure), timeout=20_000)
    assert len(said) == 1
    assert view.sentence.text() == "The cut cannot be shown. The graphics system fails (GL_CONTEXT_LOST)."
    assert not view.legend.isVisible()
