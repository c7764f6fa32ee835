"""The real window, killed while it draws: the next start has all but the last seconds."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest

from app.drafting.document import Document
from app.formats.project.files import Stamp, save_project, stamp_of
from app.formats.project.project import Project
from app.formats.project.recovery import recoveries
from tests.conftest import ROOT

PROMISED_S = 30.0
WAITS_S = (11.0, 19.0, 26.0)
"""After its first word, when a window is killed."""


@dataclass(frozen=True)
class DrawingWindow:
    """A window that draws into a file.

    Attributes:
        first: line that it told.
        began: when that was, s of the monotonic clock.
    """

    path: Path
    stamp: Stamp | None
    config: Path
    process: subprocess.Popen[str]
    first: str
    began: float


@pytest.fixture(scope="module")
def windows(tmp_path_factory: pytest.TempPathFactory) -> Iterator[dict[float, DrawingWindow]]:
    """One for each wait, all drawing at once: nearly all of the time is waiting."""
    begun = {wait_s: begin(tmp_path_factory.mktemp("killed")) for wait_s in WAITS_S}
    yield begun
    for each in begun.values():
        each.process.kill()
        each.process.wait()


def begin(folder: Path) -> DrawingWindow:
    path, config = folder / "plate.hito", folder / "config"
    config.mkdir()
    document = Document()
    document.run("rect 0,0 60,40")
    stamp = save_project(path, Project(document.state))
    command = [sys.executable, "-m", "tests.ui.drawing_window", str(path)]
    own = os.environ | {"QT_QPA_PLATFORM": "offscreen", "HITOFUDE_CONFIG": str(config)}
    process = subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE, text=True, env=own)
    assert process.stdout is not None
    return DrawingWindow(path, stamp, config, process, process.stdout.readline(), time.monotonic())


@pytest.mark.exhaustive
@pytest.mark.parametrize("wait_s", WAITS_S)
def test_a_killed_window_loses_less_than_was_promised(
    windows: dict[float, DrawingWindow], wait_s: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    window = windows[wait_s]
    time.sleep(max(0.0, window.began + wait_s - time.monotonic()))
    killed = time.monotonic()
    os.kill(window.process.pid, signal.SIGKILL)
    rest, _ = window.process.communicate()
    told = [line.split() for line in (window.first + rest).splitlines()[:-1]]
    assert stamp_of(window.path) == window.stamp
    monkeypatch.setenv("HITOFUDE_CONFIG", str(window.config))
    (left,) = recoveries()
    kept = len(left.load().state.job.part.entities)
    lost = [killed - float(when) for count, when in told if int(count) > kept]
    assert max(lost, default=0.0) < PROMISED_S
    assert max(lost, default=0.0) < 15.0, "a change waits 8 s, and is written at once then"
    assert left.edited().path == window.path and left.edited().stamp == window.stamp
    left.discard()
