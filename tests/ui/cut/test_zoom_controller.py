"""Zooming in cuts what is seen again with finer cells, on the real engine."""

import numpy as np
import pytest
from PySide6.QtCore import QPointF

from app.ui.framework.theme import LIGHT
from app.ui.views.cut.camera import StandardView
from app.ui.views.cut.cell_colours import CutColourBy
from app.ui.views.cut.view import CutView
from app.ui.views.cut.zoom_controller import ZoomController, ZoomTarget
from tests.ui.cut.pictures import without_a_screen
from tests.ui.cut.real_cut import detailed_heights, real_shown

WAIT_MS = 20_000


@pytest.fixture(scope="module")
def shown():
    return real_shown(colour=CutColourBy.DEPTH)


@pytest.fixture
def zooming(qtbot, shown):
    without_a_screen().release()
    view = CutView()
    qtbot.addWidget(view)
    view.resize(800, 560)
    view.set_theme(LIGHT)
    view.set_colour(CutColourBy.DEPTH)
    view.show()
    made = ZoomController(view.model, view.render_scheduler, view)
    made.failed.connect(pytest.fail)
    made.found.connect(view.show_detail)
    made.follow(ZoomTarget(shown.cut))
    with qtbot.waitSignal(made.looked, timeout=WAIT_MS):
        view.show_cut(shown.picture)
    view.look_now(view._fitted_camera(view.model.camera.seen_from(StandardView.TOP)))
    yield made
    made.worker.finish(10.0)


def zoom(qtbot, zooming, factor, place=(30.0, 17.0, 0.0)):
    view = zooming.parent()
    at = view.model.camera.project(np.array([place]), (view.width(), view.height()))[0]
    with qtbot.waitSignal(zooming.looked, timeout=WAIT_MS):
        view.zoom_by(factor, QPointF(at[0], at[1]))


def test_at_rest_the_part_that_is_seen_has_cells_of_its_own(qtbot, zooming, shown):
    view = zooming.parent()
    assert view.model.detail is None
    zoom(qtbot, zooming, 8.0)
    detail = view.model.detail
    assert max(detail.heights.shape) == 256
    assert detail.pitch < shown.picture.pitch / 4
    window = (*detail.low[:2], *detail.high[:2])
    same = detailed_heights(window)
    assert same.shape == detail.heights.shape
    assert np.abs(same - detail.heights).max() <= 1e-5
    assert view.cut_input.probe(QPointF(400, 280)).picture is detail
    assert CutColourBy.DEPTH in detail.values
    assert view.overlay._pitch == f"cells {1000 * detail.pitch:.0f} µm"


@pytest.mark.exhaustive
def test_farther_in_the_cells_end_at_a_micrometre(qtbot, zooming):
    for factor in (30.0, 30.0):
        zoom(qtbot, zooming, factor)
    assert zooming.parent().model.detail.pitch == pytest.approx(1e-3, rel=0.02)


def test_zooming_out_shows_the_whole_at_once_and_lets_the_part_go(qtbot, zooming, shown):
    view = zooming.parent()
    zoom(qtbot, zooming, 8.0)
    assert view.model.detail is not None and view.model.picture is shown.picture
    view.zoom_by(1 / 8)
    assert view.render_scheduler.due and view.model.picture is shown.picture
    qtbot.waitUntil(lambda: view.model.detail is None, timeout=WAIT_MS)
    assert view.overlay._pitch == f"cells {1000 * shown.picture.pitch:.0f} µm"


@pytest.mark.exhaustive
def test_a_movement_leaves_the_look_that_is_on_its_way(qtbot, zooming):
    view = zooming.parent()
    view.zoom_by(8.0)
    qtbot.waitUntil(lambda: zooming.worker.busy, timeout=WAIT_MS)
    view.look_now(view.model.camera.panned(3.0, 0.0))
    assert not zooming.worker.busy
    assert view.model.detail is None
    with qtbot.waitSignal(zooming.looked, timeout=WAIT_MS):
        pass
    assert view.model.detail is not None


@pytest.mark.exhaustive
def test_other_colours_reach_the_part_too(qtbot, zooming):
    view = zooming.parent()
    zoom(qtbot, zooming, 8.0)
    view.set_colour(CutColourBy.TOOL)
    qtbot.waitUntil(lambda: view.legend.title.text() == "Tool", timeout=WAIT_MS)
    assert CutColourBy.TOOL in view.model.detail.values
    qtbot.waitUntil(lambda: view.render_scheduler.fine, timeout=WAIT_MS)


def test_deviation_of_the_part_is_that_of_its_own_cells(qtbot, zooming, shown):
    view = zooming.parent()
    zoom(qtbot, zooming, 12.0, (33.0, 15.0, 0.0))
    deviation = view.model.detail.deviation
    assert deviation is not None and deviation.shape == view.model.detail.heights.shape
    assert float(deviation.min()) == pytest.approx(float(shown.picture.deviation.min()), abs=1e-4)


def test_a_profile_within_the_part_is_that_of_its_cells(qtbot, zooming, shown):
    view = zooming.parent()
    zoom(qtbot, zooming, 8.0)
    view.show_line(((29.0, 15.0, -2.0), (30.5, 15.2, -2.0)))
    fine = len(view.profile.drawn.heights)
    view.show_line(((2.0, 15.0, 0.0), (30.5, 15.2, -2.0)))
    assert fine > 3 * 1.5 / shown.picture.pitch
    assert len(view.profile.drawn.heights) < 1.3 * 28.5 / shown.picture.pitch
