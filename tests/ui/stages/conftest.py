"""A window at the Stages view."""

import pytest

from app.ui.framework.view import View
from tests.ui.conftest import WAIT_MS


@pytest.fixture
def staged(qtbot, wiring):
    """A triangle with a hole, its stages computed on a small bitmap and shown."""
    wiring.run("line 0,0 30,0 0,24 0,0")
    wiring.run("circle 9,8 3")
    wiring.run("line 40,0 52,0 52,12 40,12 40,0")
    wiring.display_controller.show_view(View.STAGES)
    show_stages(qtbot, wiring)
    return wiring


def show_stages(qtbot, wiring):
    """Wait until the stages are there."""
    qtbot.waitUntil(
        lambda: not wiring.stages_controller.worker.busy and wiring.window_.views.stages.film is not None,
        timeout=WAIT_MS,
    )
