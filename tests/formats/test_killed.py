"""A process that is killed at any moment leaves a whole file, a whole backup, and a recovery file with its last
work.
"""

import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from app.drafting.document import Document
from app.drafting.history import HistoryState
from app.formats.project.project import Project, read_project, write_project
from app.formats.project.recovery import recoveries
from app.model.curves import Circle
from app.model.job import Job
from app.model.part import Part
from tests.conftest import ROOT


def drawn_in(path: Path) -> int:
    return len(read_project(path.name, path.read_bytes()).state.job.part.entities)


def killed_after(path: Path, wait_s: float) -> dict[str, int]:
    """Run the process, kill it some time after its first word, and return the last numbers that it told."""
    command = [sys.executable, "-m", "tests.formats.killed_process", str(path)]
    with subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        first = process.stdout.readline()
        time.sleep(wait_s)
        os.kill(process.pid, signal.SIGKILL)
        rest = process.stdout.read()
    assert process.returncode == -signal.SIGKILL
    words = [line.split() for line in (first + rest).splitlines() if line.count(" ") == 1]
    return {word: int(count) for word, count in words[:-1] or words}


def check(path: Path, times: int, seed: int) -> None:
    rng = random.Random(seed)
    state = HistoryState(Job(Part().with_curves([Circle((float(k), 0.0), 1.0) for k in range(500)], "0")))
    path.write_bytes(write_project(Project(state)))
    before = 500
    for _ in range(times):
        told = killed_after(path, rng.uniform(0.0, 0.12))
        saved, now = told.get("saved", before), drawn_in(path)
        assert saved <= now, "the file is older than what was told to be saved"
        assert now in (before, *range(saved, told["kept"] + 4))
        backup = path.with_name(path.name + "~")
        if backup.exists():
            assert drawn_in(backup) <= now
        (left,) = recoveries()
        assert len(left.load().state.job.part.entities) >= told["kept"], "kept work is lost"
        assert left.edited().path == path
        left.discard()
        before = now
    document = Document()
    document.load_state(read_project(path.name, path.read_bytes()).state, path)
    assert document.part.entities[-1].curve == Circle((float(before - 1), 0.0), 1.5)


@pytest.mark.exhaustive
def test_twenty_kills(tmp_path: Path) -> None:
    check(tmp_path / "plate.hito", 20, 1)


@pytest.mark.exhaustive
def test_two_hundred_kills(tmp_path: Path) -> None:
    check(tmp_path / "plate.hito", 200, 2)
