"""Parts whose process dies, hangs or raises: each ends as what it is, and no other is harmed."""

from __future__ import annotations

import os
import signal
import time
from concurrent.futures import BrokenExecutor, ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import pytest

from app.core.errors import Cancelled
from app.core.progress import NO_PROGRESS, Progress
from app.usecases.batch.lanes import ExecutorLane, Lane, ProcessLane
from app.usecases.batch.run import BatchRun
from app.usecases.batch.task import BatchKind, BatchResult, BatchRow, BatchTask, BatchVerdict
from app.usecases.batch.work import work
from app.usecases.examine import ExamineOptions

PROGRAM = b"G21 G90 G94\nT1 M6\nS9000 M3\nG0 X0 Y0 Z5\nG1 Z-1 F100\nG1 X30 F300\nG0 Z5\nM30\n"
TASK = BatchTask("part", PROGRAM, BatchKind.CHECK, ExamineOptions(), "part.ngc")


def trouble(task: BatchTask, progress: Progress = NO_PROGRESS) -> BatchResult:
    """Do what the part's name says."""
    if task.name == "dies":
        os._exit(3)
    if task.name == "hangs":
        time.sleep(600)
    marker = Path(task.output)
    if task.name == "dies once" and not marker.exists():
        marker.touch()
        os._exit(3)
    return work(task, progress)


def run(names: list[str], lanes: list[Lane], limit_s: float = 60.0, output: str = "x.ngc") -> dict[str, BatchRow]:
    tasks = [replace(TASK, name=name, output=output) for name in names]
    rows: dict[str, BatchRow] = {}
    BatchRun(tasks, lanes, lambda place, result: rows.update({names[place]: result.row}), limit_s).run()
    return rows


def test_each_part_has_its_own_fate(tmp_path: Path) -> None:
    names = ["good", "dies", "dies once", "good too"]
    rows = run(names, [ProcessLane(trouble), ProcessLane(trouble)], output=str(tmp_path / "marker"))
    assert {name: row.verdict for name, row in rows.items()} == {
        "good": BatchVerdict.CLEAN,
        "dies": BatchVerdict.KILLED,
        "dies once": BatchVerdict.CLEAN,
        "good too": BatchVerdict.CLEAN,
    }
    assert "killed 4 times" in rows["dies"].findings[0]


@pytest.mark.exhaustive
def test_a_part_that_hangs_is_ended_and_the_next_is_done() -> None:
    began = time.monotonic()
    # the good one has a process to start within the limit, with whatever else goes on beside
    rows = run(["hangs", "good"], [ProcessLane(trouble)], limit_s=10.0)
    assert (rows["hangs"].verdict, rows["good"].verdict) == (BatchVerdict.OVERDUE, BatchVerdict.CLEAN)
    assert time.monotonic() - began < 60


@pytest.mark.exhaustive
def test_a_process_that_dies_between_two_parts_harms_none() -> None:
    lane = ProcessLane()
    try:
        assert lane.submit(TASK).result(60).row.verdict is BatchVerdict.CLEAN
        os.kill(lane.pid, signal.SIGKILL)
        executor = lane._executor
        assert executor is not None
        with pytest.raises(BrokenExecutor):
            for _ in range(1000):
                executor.submit(os.getpid).result(60)
        assert lane.submit(TASK).result(60).row.verdict is BatchVerdict.CLEAN
    finally:
        lane.close()


def test_any_executor_does() -> None:
    with ThreadPoolExecutor(2) as executor:
        rows = run(["a", "b", "c"], [ExecutorLane(executor), ExecutorLane(executor)])
    assert [row.verdict for row in rows.values()] == [BatchVerdict.CLEAN] * 3
    assert {row.picture for row in rows.values()} == {rows["a"].picture} and "<svg" in rows["a"].picture


def test_all_and_each_say_how_far_they_are() -> None:
    told: list[str] = []
    BatchRun([replace(TASK, name="hangs")], [ProcessLane(trouble)], lambda *_: None, 0.5).run(
        Progress(lambda fraction, text: told.append(f"{fraction:.2f} {text}"))
    )
    assert told[0] == "0.00 0 of 1 done; hangs 0%" and told[-1] == "1.00 1 of 1 done"


def test_a_cancelled_batch_leaves_no_process() -> None:
    lane = ProcessLane(trouble)
    seen: list[int] = []

    def told(fraction: float, text: str) -> None:
        if lane.pid:
            seen.append(lane.pid)
            raise Cancelled

    with pytest.raises(Cancelled):
        BatchRun([replace(TASK, name="hangs")], [lane], lambda *_: None).run(Progress(told))
    with pytest.raises(ProcessLookupError):
        os.kill(seen[0], 0)


def test_work_makes_a_verdict_of_every_failure() -> None:
    broken = replace(TASK, options="no options")  # type: ignore[arg-type]  # a fault of the program itself
    assert work(broken).row.verdict is BatchVerdict.FAILED
    assert "should not have happened" in work(broken).row.findings[0]
