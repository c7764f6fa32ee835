"""The switches of aiming in the real window: what they switch, and that they are remembered."""

from app.core.settings import load_settings
from app.ui.shell.start import build
from app.ui.views.canvas.snap import USUAL, SnapKind


def test_kinds_are_switched_at_snap_and_remembered(qtbot, wiring):
    aiming = wiring.window_.canvas.snap_state
    assert aiming.kinds == USUAL
    wiring.snap_controller.kinds[SnapKind.NEAREST].trigger()
    wiring.snap_controller.kinds[SnapKind.TANGENT].trigger()
    assert aiming.kinds == (USUAL | {SnapKind.NEAREST}) - {SnapKind.TANGENT}
    window, again = build()
    assert again.window_.canvas.snap_state.kinds == aiming.kinds
    wiring.snap_controller.kinds[SnapKind.NEAREST].trigger()
    wiring.snap_controller.kinds[SnapKind.TANGENT].trigger()
    window.worker.finish(20.0)
    window.deleteLater()


def test_polar_rays_have_a_step_and_a_switch(qtbot, wiring):
    window, aiming = wiring.window_, wiring.window_.canvas.snap_state
    assert (aiming.polar, window.status.polar.text()) == (45.0, "Polar 45°")
    window.status.polar.click()
    assert aiming.polar is None and not window.actions_["polar"].isChecked()
    wiring.snap_controller.steps[15.0].trigger()
    assert (aiming.polar, window.status.polar.text()) == (15.0, "Polar 15°"), "who chooses a step wants rays"
    assert (load_settings().polar_step, load_settings().polar_on) == ("15", True)
    wiring.snap_controller.steps[45.0].trigger()


def test_tracking_is_switched_off(qtbot, wiring):
    wiring.snap_controller.tracking.trigger()
    assert not wiring.window_.canvas.snap_state.tracking and not load_settings().tracking
    wiring.snap_controller.tracking.trigger()
