"""The programs that come with the program: each opens from the menu."""

from __future__ import annotations

import pytest

from app.core.resources import resource
from app.ui.framework.view import View
from app.ui.shell.files.open_controller import SAMPLE_PROGRAMS
from tests.ui.nc.opened import WAIT_MS, nc_of


@pytest.mark.parametrize("name", SAMPLE_PROGRAMS)
def test_a_sample_program_opens_from_the_menu(qtbot, wiring, name) -> None:
    wiring.window_.actions_[f"program_{name}"].trigger()
    path = resource("samples", f"{name}.ngc")
    qtbot.waitUntil(lambda: nc_of(wiring).shown is not None, timeout=WAIT_MS)
    assert nc_of(wiring).shown.source.path == path and wiring.display_controller.view is View.NC
