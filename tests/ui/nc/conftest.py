"""A small program in the window, and the sample computed, for the tests of the NC view."""

import pytest

from tests.ui.nc.opened import SMALL, WAIT_MS, nc_of, open_file


@pytest.fixture
def small(qtbot, wiring, tmp_path):
    path = tmp_path / "small.ngc"
    path.write_text(SMALL)
    return open_file(qtbot, wiring, path)


@pytest.fixture
def computed(qtbot, opened_sample):
    """The sample part, computed, and its program read."""
    qtbot.waitUntil(lambda: nc_of(opened_sample).shown is not None, timeout=WAIT_MS)
    return opened_sample
