"""The real window, killed while it draws: the next start has all but the last seconds."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from app.drafting.document import Document
from app.formats.project.files import save_project, stamp_of
from app.formats.project.project import Project
from app.formats.project.recovery import recoveries
from tests.conftest import ROOT

PROMISED_S = 30.0


@pytest.mark.exhaustive
@pytest.mark.parametrize("wait_s", [11.0, 19.0, 26.0])
def test_a_killed_window_loses_less_than_was_promised(tmp_path: Path, wait_s: float) -> None:
    path = tmp_path / "plate.hito"
    document = Document()
    document.run("rect 0,0 60,40")
    stamp = save_project(path, Project(document.state))
    command = [sys.executable, "-m", "tests.ui.drawing_window", str(path)]
    own = os.environ | {"QT_QPA_PLATFORM": "offscreen"}
    with subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE, text=True, env=own) as process:
        assert process.stdout is not None
        first = process.stdout.readline()
        time.sleep(wait_s)
        killed = time.monotonic()
        os.kill(process.pid, signal.SIGKILL)
        told = [line.split() for line in (first + process.stdout.read()).splitlines()[:-1]]
    assert stamp_of(path) == stamp
    (left,) = recoveries()
    kept = len(left.load().state.job.part.entities)
    lost = [killed - float(when) for count, when in told if int(count) > kept]
    assert max(lost, default=0.0) < PROMISED_S
    assert max(lost, default=0.0) < 15.0, "a change waits 8 s, and is written at once then"
    assert left.edited().path == path and left.edited().stamp == stamp
    left.discard()
