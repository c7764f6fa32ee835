"""What each stage of a job took, and how far it is on a pipe."""

from __future__ import annotations

import json
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

from app.cli import files as cli_files
from app.cli.main import main
from app.cli.signals import StopFlag
from app.cli.timings import StageTimes
from app.core.progress import Progress

pytestmark = pytest.mark.usefixtures("lines_by_the_clock")
FIG2 = Path(__file__).parents[2] / "resources" / "samples" / "fig2.dxf"


def test_time_goes_to_the_stage_that_was_told_last() -> None:
    clock = iter([0.0, 1.0, 3.0, 6.0, 10.0, 15.0])
    told: list[tuple[float, str]] = []
    times = StageTimes(lambda: next(clock))
    progress = times.watch(Progress(lambda fraction, text: told.append((fraction, text))))
    progress.part(0.5, 1.0).step(0.0, "Reading part.dxf")
    progress.step(0.6)
    progress.step(0.7, "Offset 3.000 mm")
    progress.step(0.8, "Offset 6.000 mm")
    progress.step(0.9, "Reading other.dxf")
    assert times.seconds() == {"Start": 1.0, "Reading …": 2.0 + 5.0, "Offset … mm": 3.0 + 4.0}
    assert told[0] == (0.5, "Reading part.dxf") and len(told) == 5


def test_stopping_goes_through() -> None:
    stopped = threading.Event()
    assert StageTimes().watch(Progress(None, stopped)).cancelled is stopped


def test_make_tells_its_stages(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    report = tmp_path / "r.json"
    assert main(["make", str(FIG2), "-o", str(tmp_path / "a.ngc"), "--report", str(report), "--timings"]) == 0
    spent = json.loads(report.read_text())["timings_s"]
    assert {
        "Reading …",
        "Chain contours",
        "Link rings",
        "Writing NC",
        "Measuring what is left",
        "Looking between the cells",
    } <= set(spent)
    assert all(seconds >= 0 for seconds in spent.values())
    lines = [line for line in capsys.readouterr().out.splitlines() if " s  " in line]
    assert len(lines) == len(spent) + 1 and lines[-1].endswith("all")


def test_without_the_option_a_report_is_the_same_each_time(tmp_path: Path) -> None:
    report = tmp_path / "r.json"
    assert main(["make", str(FIG2), "-o", str(tmp_path / "a.ngc"), "--report", str(report), "--quiet"]) == 0
    assert "timings_s" not in json.loads(report.read_text())


def test_a_pipe_gets_a_line_now_and_then(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    clock = [100.0]
    monkeypatch.setattr("app.cli.files.time.monotonic", lambda: clock[0])
    progress = cli_files.shown_progress(quiet=False, stopped=StopFlag())
    for second, fraction in ((101.0, 0.1), (104.9, 0.2), (105.1, 0.3), (109.0, 0.4), (110.2, 0.5)):
        clock[0] = second
        progress.step(fraction, "Link rings")
    assert capsys.readouterr().err == "hitofude: 30% Link rings\nhitofude: 50% Link rings\n"


def test_a_pipe_hears_of_a_stage_that_tells_nothing(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    clock, stopped = [100.0], StopFlag()
    monkeypatch.setattr("app.cli.files.time.monotonic", lambda: clock[0])
    progress = cli_files.shown_progress(quiet=False, stopped=stopped)
    assert stopped.tick is not None
    progress.step(0.3, "Link rings")
    for clock[0] in (104.0, 106.0, 107.0, 112.0):
        stopped.tick()
    progress.step(1.0)
    clock[0] = 120.0
    stopped.tick()
    assert capsys.readouterr().err == "hitofude: 30% Link rings\n" * 2
    assert stopped.stage == "Link rings"


def test_a_pipe_hears_nothing_while_the_command_waits(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    clock, stopped = [100.0], StopFlag()
    monkeypatch.setattr("app.cli.files.time.monotonic", lambda: clock[0])
    progress = cli_files.shown_progress(quiet=False, stopped=stopped)
    assert stopped.tick is not None
    progress.step(0.3, "Link rings")
    for clock[0] in (104.0, 106.0, 109.0):
        stopped.waited = clock[0]
        stopped.tick()
    progress.step(0.3, "Link rings")
    assert capsys.readouterr().err == ""
    clock[0] = 114.1
    stopped.tick()
    assert capsys.readouterr().err == "hitofude: 30% Link rings\n"


def test_a_short_job_says_nothing_of_it_on_a_pipe(tmp_path: Path) -> None:
    begun = time.monotonic()
    done = subprocess.run(
        [sys.executable, "-P", "-m", "app", "make", str(FIG2), "-o", str(tmp_path / "a.ngc")],
        check=False,
        capture_output=True,
        text=True,
        cwd=FIG2.parents[2],
    )
    seconds = time.monotonic() - begun
    assert done.stderr.count("%") <= seconds / 5, "a job is short on a machine that does nothing else"
