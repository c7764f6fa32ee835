"""The window, as the tests of all its parts drive it; and what a controller needs without one."""

from collections.abc import Iterator

import pytest
from PySide6.QtCore import QCoreApplication, QEvent

from app.core.settings import Settings
from app.drafting.document import Document
from app.ui.framework import computation
from app.ui.framework.activity import Activity
from app.ui.framework.computation import Computation, ComputationState
from app.ui.framework.log import Log
from app.ui.framework.log_view import LogView
from app.ui.framework.notice import Notice
from app.ui.framework.preferences import Preferences
from app.ui.framework.worker import Worker
from app.ui.framework.workspace import Workspace
from app.ui.views.language import command_runner
from tests.ui.one_window import OneWindow

WAIT_MS = 20_000


@pytest.hookimpl(wrapper=True)
def pytest_runtest_teardown() -> Iterator[None]:
    """Let go of a test's widgets: outside of an event loop Qt keeps what is to be deleted later for ever, and each
    change of style dresses them all.
    """
    try:
        return (yield)
    finally:
        QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)


@pytest.fixture
def workspace(qtbot):
    """What the controllers of views share, with an empty document and no window."""
    document, worker, activity = Document(), Worker(), Activity()
    log, notice = LogView(), Notice()
    for widget in (log, notice):
        qtbot.addWidget(widget)
    activity.follow(worker)
    computing = Computation(document, worker, lambda made: None)
    yield Workspace(document, computing, activity, Preferences(Settings()), Log(document, log), notice)
    activity.cancel()
    activity.ended.emit()


@pytest.fixture(scope="session")
def run_window(qapp):
    """The window that a run's tests share as long as none leaves anything behind."""
    shared = OneWindow()
    yield shared
    shared.close()


@pytest.fixture(scope="module")
def one_window(run_window):
    """The shared window, hidden while other modules have theirs."""
    yield run_window
    run_window.hide()


@pytest.fixture
def wiring(qtbot, one_window, monkeypatch):
    """A window as it is when the program starts; a short line is carried out at once however busy the machine is."""
    monkeypatch.setattr(command_runner, "AT_ONCE_S", 10.0)
    yield one_window.lend(qtbot)
    one_window.take_back()


class MadeOnce:
    """Programs that were made before, by the jobs that they were made of; nobody changes them."""

    def __init__(self) -> None:
        self._make, self._kept = computation._make, list[tuple[object, object]]()

    def __call__(self, job, pixels, drawing_findings, progress):
        """Return the program of a job and what is proven of it, as the window has it made."""
        asked = (job, pixels, drawing_findings)
        for known, made in self._kept:
            if known == asked:
                progress.step(1.0, "Done")
                return made
        made = self._make(job, pixels, drawing_findings, progress)
        self._kept.append((asked, made))
        return made


@pytest.fixture(scope="session")
def made_once():
    return MadeOnce()


@pytest.fixture
def opened_sample(qtbot, wiring, made_once, monkeypatch):
    """The sample part, opened and computed, once a run."""
    with monkeypatch.context() as meanwhile:
        meanwhile.setattr(computation, "_make", made_once)
        wiring.files.open_sample()
        qtbot.waitUntil(lambda: wiring.computation.state is ComputationState.CURRENT, timeout=WAIT_MS)
    return wiring


@pytest.fixture
def computed(opened_sample):
    """The sample part, opened and computed."""
    return opened_sample
