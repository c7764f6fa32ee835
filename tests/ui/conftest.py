"""The window, as the tests of all its parts drive it."""

import pytest

from app.ui.framework.computation import State
from tests.ui.one_window import OneWindow

WAIT_MS = 20_000


@pytest.fixture(scope="module")
def one_window(qapp):
    """The window that a module's tests share as long as none leaves anything behind."""
    shared = OneWindow()
    yield shared
    shared.close()


@pytest.fixture
def wiring(qtbot, one_window):
    """A window as it is when the program starts."""
    yield one_window.lend(qtbot)
    one_window.take_back()


@pytest.fixture
def computed(qtbot, wiring):
    """The sample part, opened and computed."""
    wiring.files.open_sample()
    qtbot.waitUntil(lambda: wiring.computation.state is State.CURRENT, timeout=WAIT_MS)
    return wiring
