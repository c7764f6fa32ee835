"""A small program in the window, and the sample computed, for the tests of the NC view."""

import pytest

from app.ui.framework.computation import ComputationState
from tests.ui.nc.opened import SMALL, WAIT_MS, nc_of, open_file


@pytest.fixture
def small(qtbot, wiring, tmp_path):
    path = tmp_path / "small.ngc"
    path.write_text(SMALL)
    return open_file(qtbot, wiring, path)


@pytest.fixture
def computed(qtbot, wiring):
    """The sample part, computed, and its program read."""
    wiring.files.open_sample()
    qtbot.waitUntil(
        lambda: wiring.computation.state is ComputationState.CURRENT and nc_of(wiring).shown is not None,
        timeout=WAIT_MS,
    )
    return wiring
