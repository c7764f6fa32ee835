"""The window, as the tests of all its parts drive it."""

import pytest

from app.ui.computation import State
from app.ui.start import build

WAIT_MS = 20_000


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
    made.language.control.text = ""
    window.scene.document.setModified(False)
    window.close()
    window.deleteLater()


@pytest.fixture
def computed(qtbot, wiring):
    """The sample part, opened and computed."""
    wiring.files.open_sample()
    qtbot.waitUntil(lambda: wiring.computation.state is State.CURRENT, timeout=WAIT_MS)
    return wiring
