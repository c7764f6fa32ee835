"""A window, a small program in it, and the sample computed, for the tests of the NC view."""

import pytest

from app.ui.computation import State
from app.ui.start import build
from tests.ui.nc.opened import SMALL, WAIT_MS, nc_of, open_file


@pytest.fixture
def wiring(qtbot):
    window, made = build()
    window.resize(1280, 800)
    with qtbot.waitActive(window):
        window.show()
        window.activateWindow()
    yield made
    window.worker.finish(20.0)
    made.document.load(made.document.job)
    window.close()
    window.deleteLater()


@pytest.fixture
def small(qtbot, wiring, tmp_path):
    path = tmp_path / "small.ngc"
    path.write_text(SMALL)
    return open_file(qtbot, wiring, path)


@pytest.fixture
def computed(qtbot, wiring):
    """The sample part, computed, and its program read."""
    wiring.files.open_sample()
    qtbot.waitUntil(lambda: wiring.computation.state is State.CURRENT and nc_of(wiring).shown is not None, timeout=WAIT_MS)
    return wiring
