"""A job that says that it will take long: above the view, with the way to stop it, until it ends."""

from __future__ import annotations

import threading

import pytest
from PySide6.QtCore import QObject

from app.core.effort import Reckoning, announce
from app.core.progress import Progress
from app.ui.framework.worker import Worker
from app.ui.shell.announcing import Announcing

LONG = Reckoning(1234.0, "9 rings", "use a larger tool")


@pytest.fixture
def running(qtbot, workspace):
    """A job that has announced itself and waits, and what ends it."""
    owner, go, worker = QObject(), threading.Event(), Worker()
    announcing = Announcing(workspace, owner)
    workspace.activity.follow(worker)

    def work(progress: Progress) -> object:
        announce(LONG, progress)
        while not go.wait(0.01):
            progress.step(0.5)
        return None

    worker.start(work, 1)
    qtbot.waitUntil(lambda: workspace.notice.sentence == LONG.sentence())
    yield workspace, worker, go
    go.set()
    worker.finish()
    announcing.deleteLater()


def test_it_is_said_and_logged_while_the_job_runs(qtbot, running):
    workspace, worker, go = running
    assert not workspace.notice.isHidden()
    assert workspace.log.lines[-1].reply == LONG.sentence()
    with qtbot.waitSignal(worker.done):
        go.set()
    assert workspace.notice.isHidden()


def test_its_button_stops_the_job(qtbot, running):
    workspace, worker, _ = running
    with qtbot.waitSignal(worker.cancelled):
        workspace.notice.buttons[0].click()
    assert not worker.busy and workspace.notice.isHidden()


def test_another_sentence_stays_when_the_job_ends(qtbot, running):
    workspace, worker, go = running
    workspace.notice.ask("Saved.")
    with qtbot.waitSignal(worker.done):
        go.set()
    assert not workspace.notice.isHidden()
