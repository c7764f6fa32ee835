"""The door that memory is asked at: sizes in words, budgets by context, refusals, portions, and what the machine
has.
"""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from app.cli.main import main, memory_given
from app.core.catalogue import catalogue
from app.core.errors import InputError
from app.core.memory import (
    MemoryRemedy,
    MemoryShortError,
    ask,
    budget_limit,
    fewer,
    half_of_machine,
    in_words,
    machine_memory,
    portion,
    read_size,
    resident,
    room,
    within,
)
from app.core.pool import pool
from tests.conftest import ROOT

FIG2 = ROOT / "resources" / "samples" / "fig2.dxf"


@pytest.mark.parametrize(
    ("text", "size"),
    [
        ("4G", 4_000_000_000),
        ("512M", 512_000_000),
        ("1.5g", 1_500_000_000),
        ("2 GB", 2_000_000_000),
        ("3000000", 3_000_000),
        ("50MiB", 50_000_000),
    ],
)
def test_sizes(text: str, size: int) -> None:
    assert read_size(text) == size


@pytest.mark.parametrize("text", ["", "G", "4X", "-4G", "1e9", "0", "999K", "2000T", "4GG", "nan"])
def test_what_is_no_size(text: str) -> None:
    with pytest.raises(InputError, match=r"size|use 1M"):
        read_size(text)


@pytest.mark.parametrize(
    ("size", "words"), [(5e5, "0 MB"), (1.25e6, "1.25 MB"), (49.96e6, "50 MB"), (123.4e6, "123 MB"), (2e9, "2 GB")]
)
def test_in_words(size: float, words: str) -> None:
    assert in_words(size) == words


def test_the_last_memory_of_the_arguments_counts() -> None:
    assert memory_given(["make", "a.dxf"]) is None
    assert memory_given(["make", "--memory", "1G", "--memory=2G"]) == 2_000_000_000
    with pytest.raises(InputError, match=r"--memory is wrong: .x. is no size; .*make --help"):
        memory_given(["make", "--memory", "x"])


def test_a_budget_is_the_context_s_own() -> None:
    usual = budget_limit()
    assert usual == half_of_machine()
    with within(50_000_000):
        assert budget_limit() == 50_000_000
        assert list(pool().map(lambda _: budget_limit(), range(4))) == [50_000_000] * 4
        with within(None):
            assert budget_limit() == usual
        assert budget_limit() == 50_000_000
    assert budget_limit() == usual
    assert pool().submit(budget_limit).result() == usual


def test_what_is_taken_is_no_longer_there() -> None:
    if not resident():
        pytest.skip("this system does not tell what a process holds")
    first = np.ones(15_000_000)  # more than what is taken for the program's own
    with within(200_000_000):
        before = room()
        held = np.ones(10_000_000)
        assert 60_000_000 < before - room() < 100_000_000
        del held
    del first


def test_what_is_too_much_is_refused_in_one_line() -> None:
    with within(50_000_000), pytest.raises(MemoryShortError) as told:
        ask(2e9, "A grid of 9 x 9 cells", MemoryRemedy("use fewer cells", "grid", fewer(9, 2e9, 2)))
    said = str(told.value)
    assert re.fullmatch(
        r"A grid of 9 x 9 cells would take 2 GB of memory, and [45]\d(\.\d)? MB may be taken; "
        r"use fewer cells \(--grid 1\), or allow more with --memory 2\.\dG\.",
        said,
    )
    assert read_size(said.rpartition(" ")[2].rstrip(".")) > 2e9
    shown = told.value.in_window()
    assert "--" not in shown and "use fewer cells, or allow more in the menu Compute, Memory of a job." in shown


def test_nobody_is_told_to_allow_what_the_machine_has_not() -> None:
    with within(50_000_000), pytest.raises(MemoryShortError, match=r"use less\.$"):
        ask(2.0 * machine_memory(), "This", MemoryRemedy("use less"))


def test_parts_fit() -> None:
    with within(100_000_000):
        count = portion(1000.0)
        assert 30_000 <= count <= 50_000
        ask(count * 1000.0, "These", MemoryRemedy("use less"))
        assert portion(1e12) == 4096 and portion(1e12, 7) == 7
        assert fewer(20_000, 400_000_000, 2) in (9_900, 10_000)  # what others take changes meanwhile
        assert fewer(20_000, 100.0) == 20_000
        ask(3_000_000, "A few cells", "nothing")
    with within(1_000_000):
        ask(3_000_000, "A few cells, whatever is left,", "nothing")


@pytest.mark.parametrize(
    ("line", "file"),
    [
        ("0::/jobs/one", "jobs/memory.max"),
        ("0::/jobs/one", "jobs/one/memory.max"),
        ("4:cpu,memory:/jobs/one", "memory/memory.limit_in_bytes"),
        ("4:memory:/jobs/one", "memory/jobs/one/memory.limit_in_bytes"),
    ],
)
def test_limits_of_groups_of_processes_are_kept(tmp_path: Path, line: str, file: str) -> None:
    (tmp_path / "proc" / "self").mkdir(parents=True)
    (tmp_path / "proc" / "self" / "cgroup").write_text(f"2:cpu:/\n{line}\n")
    limit = tmp_path / "groups" / file
    limit.parent.mkdir(parents=True)
    limit.write_text("123000000\n")
    assert machine_memory(tmp_path / "proc", tmp_path / "groups") == 123_000_000
    limit.write_text("max\n")
    assert machine_memory(tmp_path / "proc", tmp_path / "groups") == machine_memory(tmp_path, tmp_path) > 123_000_000


def test_memory_that_runs_out_unasked_is_told_with_its_stage(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def greedy(*args: object, **_: object) -> None:
        args[-1].step(0.3, "Link rings")  # type: ignore[attr-defined]
        np.empty(1 << 36)  # more than anybody has

    monkeypatch.setattr("app.usecases.making.make.make", greedy)
    if not sys.platform.startswith("linux"):
        pytest.skip("only Linux bounds the data of a process")
    assert main(["make", str(FIG2), "-o", str(tmp_path / "a.ngc"), "--memory=50M"]) == 2
    said = capsys.readouterr().err
    assert said.startswith(
        "hitofude: the memory that the job may take, 50 MB, ran out, at: Link rings; allow more with --memory"
    )
    assert said.count("\n") == 1 and not list(tmp_path.iterdir())


DEAF = """
import sys, time, threading
import numpy as np
import app.usecases.making.make
from app.cli.main import main

def deaf(*args, **_):
    args[-1].step(0.3, "Link rings")
    print("deaf", flush=True)
    a = np.random.default_rng(0).random((6000, 6000))
    np.linalg.svd(a)  # minutes in a library that hears nothing

app.usecases.making.make.make = deaf
sys.exit(main(sys.argv[1:]))
"""


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_stage_that_hears_no_signal_is_ended(tmp_path: Path, number: signal.Signals) -> None:
    command = [sys.executable, "-c", DEAF, "make", str(FIG2), "-o", str(tmp_path / "a.ngc")]
    running = subprocess.Popen(
        command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=os.environ
    )
    assert running.stdout is not None
    assert running.stdout.readline() == "deaf\n"
    time.sleep(0.3)
    running.send_signal(number)
    begun = time.monotonic()
    _, said = running.communicate(timeout=60)
    assert time.monotonic() - begun < 2.0 + 2.0  # the machine may be busy
    assert (running.returncode, said) == (128 + number, "hitofude: cancelled; no file was written\n")
    assert not list(tmp_path.iterdir())


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="the call is that of Linux's library")
def test_what_many_small_things_left_free_is_given_back() -> None:
    """In a process of its own: blocks that lie between kept ones, as the allocator cannot give back by itself."""
    code = """
import app.core.memory as memory
memory._MUCH = 0
blocks = [bytearray(4000) for _ in range(60_000)]
kept = blocks[::100]
del blocks
held = memory.resident()
memory.give_back()
print(held - memory.resident())
"""
    told = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert int(told.stdout) > 100_000_000


@pytest.mark.parametrize(
    ("what", "remedy"),
    [
        ("A program of 9,000 lines", "cut it in parts of at most 70 lines"),
        ("A bitmap of 90 x 80 px", "use at most 7 px along a side, or pixels of 0.5 mm or more"),
        ("A bitmap of 90 x 80 px", "make the picture smaller, at most 7 px along its longer side"),
        ("9.png, a picture of 90 x 80 px,", "make it smaller, at most 7 px along its longer side"),
        ("Passes on 9,000 planes", "set them 0.5 mm apart or more (pitch = 0.5 in the scene)"),
        ("A pocket of 9,000 rings, 0.1 mm from one to the next,", "use a larger tool or stepover"),
        ("Clearing what is left with a tool of 0.1 mm", "use one of 0.5 mm or more, or a smaller one before it"),
        ("A grid of 90 x 80 cells", "use at most 7 cells along its longer side"),
    ],
)
def test_a_window_in_japanese_says_it_in_japanese(what: str, remedy: str) -> None:
    with within(50_000_000), pytest.raises(MemoryShortError) as told:
        ask(2e9, what, MemoryRemedy(remedy, "grid", 7))
    shown = catalogue("ja").look_up(told.value.in_window())
    assert shown is not None and "計算、ジョブのメモリ" in shown
    assert not re.search("[A-Za-z]{4,}", shown.replace("pitch", ""))
