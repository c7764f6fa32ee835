"""A process that is killed at any moment leaves a whole file, a whole backup, and a recovery file with its last
work.
"""

import contextlib
import multiprocessing
import os
import random
import signal
import time
from multiprocessing.context import ForkServerContext
from pathlib import Path

import pytest

from app.drafting.document import Document
from app.drafting.history import HistoryState
from app.formats.project.project import Project, read_project, write_project
from app.formats.project.recovery import recoveries
from app.model.curves import Circle
from app.model.job import Job
from app.model.part import Part
from tests.formats.killed_process import draw_without_end


def drawn_in(path: Path) -> int:
    return len(read_project(path.name, path.read_bytes()).state.job.part.entities)


@pytest.fixture(scope="module")
def processes() -> ForkServerContext:
    """Makes processes that have imported what they need: each is forked from a server that has."""
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload([draw_without_end.__module__])
    return context


def killed_after(processes: ForkServerContext, path: Path, wait_s: float) -> dict[str, int]:
    """Run the process, kill it some time after its first word, and return the last numbers that it told."""
    ours, its = processes.Pipe(duplex=False)
    process = processes.Process(target=draw_without_end, args=(path, os.environ["HITOFUDE_CONFIG"], its))
    process.start()
    its.close()
    told = [ours.recv()]
    time.sleep(wait_s)
    process.kill()
    process.join()
    with ours, contextlib.suppress(EOFError, OSError):  # the last word may be cut
        while True:
            told.append(ours.recv())
    assert process.exitcode == -signal.SIGKILL
    return dict(told)


def check(processes: ForkServerContext, path: Path, times: int, seed: int) -> None:
    rng = random.Random(seed)
    state = HistoryState(Job(Part().with_curves([Circle((float(k), 0.0), 1.0) for k in range(500)], "0")))
    path.write_bytes(write_project(Project(state)))
    before = 500
    for _ in range(times):
        told = killed_after(processes, path, rng.uniform(0.0, 0.12))
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
def test_twenty_kills(processes: ForkServerContext, tmp_path: Path) -> None:
    check(processes, tmp_path / "plate.hito", 20, 1)


@pytest.mark.exhaustive
def test_two_hundred_kills(processes: ForkServerContext, tmp_path: Path) -> None:
    check(processes, tmp_path / "plate.hito", 200, 2)
