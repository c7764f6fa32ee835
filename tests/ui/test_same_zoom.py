"""What is looked at closely in one view of the plane is looked at closely in the next one."""

from dataclasses import replace

import pytest

from app.model.job import OriginXY
from app.ui.framework.computation import ComputationState
from app.ui.framework.view import View
from app.ui.views.canvas.viewport import Viewport
from tests.ui.conftest import WAIT_MS

PLACE, SCALE = (60.0, 35.0), 23.0


def look_at(viewport: Viewport, place: tuple[float, float]) -> None:
    viewport.set_view(replace(viewport.view, scale=SCALE).centred(place, viewport.area))


def looked_at(viewport: Viewport) -> tuple[float, float, float]:
    return (*viewport.view.to_world(viewport.area.center()), viewport.view.scale)


def show_nc(qtbot, wiring) -> Viewport:
    wiring.display_controller.show_view(View.NC)
    path = wiring.window_.views.nc.path
    qtbot.waitUntil(lambda: path.picture is not None and not wiring.nc.reading.worker.busy, timeout=WAIT_MS)
    return path


def test_a_place_is_followed_into_the_program_and_back(qtbot, computed):
    canvas, showing = computed.window_.canvas, computed.display_controller
    showing.show_view(View.PATHS)
    look_at(canvas, PLACE)
    path = show_nc(qtbot, computed)
    assert looked_at(path) == pytest.approx((*PLACE, SCALE))
    showing.show_view(View.CURVES)
    curves = computed.window_.views.curves.path
    qtbot.waitUntil(lambda: curves.picture is not None, timeout=WAIT_MS)
    assert looked_at(curves) == pytest.approx((*PLACE, SCALE))
    showing.show_view(View.NC)
    look_at(path, (20.0, 30.0))
    showing.show_view(View.CUT)
    showing.show_view(View.DRAW)
    assert looked_at(canvas) == pytest.approx((20.0, 30.0, SCALE))
    canvas.fit_to((0.0, 0.0, 100.0, 100.0))
    showing.show_view(View.NC)
    assert not path.moved, "all is seen there, too"


def test_zero_of_the_program_may_be_elsewhere_and_another_program_is_not_followed(qtbot, computed, tmp_path):
    document = computed.document
    document.change_job("Origin", replace(document.job, origin_xy=OriginXY.CENTRE))
    computed.computation.start()
    qtbot.waitUntil(lambda: computed.computation.state is ComputationState.CURRENT, timeout=WAIT_MS)
    showing, canvas = computed.display_controller, computed.window_.canvas
    showing.show_view(View.PATHS)
    look_at(canvas, PLACE)
    path = show_nc(qtbot, computed)
    stock = showing.stock()
    middle = ((stock.x0 + stock.x1) / 2, (stock.y0 + stock.y1) / 2)
    assert looked_at(path) == pytest.approx((PLACE[0] - middle[0], PLACE[1] - middle[1], SCALE))
    program = tmp_path / "other.ngc"
    program.write_text("G21 G90\nG0 X0 Y0 Z5\nG1 Z-1 F100\nX25\nM2\n")
    computed.files.open_file(program)
    qtbot.waitUntil(lambda: computed.nc.foreign and computed.nc.shown is not None, timeout=WAIT_MS)
    look_at(path, (900.0, 900.0))
    showing.show_view(View.PATHS)
    assert looked_at(canvas) == pytest.approx((*PLACE, SCALE), abs=3.0), "but for other widths of what stands beside"


def test_what_was_looked_at_elsewhere_is_followed_once(qtbot, computed):
    """A program that was made anew while all of it was seen jumped back to where *Paths* had been looked at."""
    showing, document = computed.display_controller, computed.document
    showing.show_view(View.PATHS)
    look_at(computed.window_.canvas, PLACE)
    path = show_nc(qtbot, computed)
    path.fit_now()
    document.change_job("Origin", replace(document.job, origin_xy=OriginXY.CENTRE))
    computed.computation.start()
    qtbot.waitUntil(lambda: computed.computation.state is ComputationState.CURRENT, timeout=WAIT_MS)
    show_nc(qtbot, computed)
    assert not path.moved


def test_a_motion_that_is_picked_elsewhere_is_in_sight(qtbot, computed):
    showing = computed.display_controller
    showing.show_view(View.PATHS)
    look_at(computed.window_.canvas, PLACE)
    path = show_nc(qtbot, computed)
    motions = computed.nc.shown.program.motions
    far = int(abs(motions.end[:, :2] - PLACE).sum(axis=1).argmax())
    computed.nc.pick_motion(0, far)
    x, y = motions.end[far, :2].tolist()
    qtbot.waitUntil(lambda: path.area.contains(path.view.to_screen((x, y))), timeout=WAIT_MS)
