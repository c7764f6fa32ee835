"""Reading programs, side by side with LinuxCNC's own interpreter: 200,000 G1 lines, a real program, and one with words of every kind.

`rs274` prints what it reads; it is let print into nothing.
"""

import subprocess
import tracemalloc
from pathlib import Path

import pytest
from pytest_benchmark.fixture import BenchmarkFixture

from app.gcode.interpreter.reader import read_program
from tests.benchmarks.conftest import OURS, record
from tests.conftest import ROOT
from tests.gcode.rs274_oracle import RS274, needs_rs274, own_home

pytestmark = pytest.mark.benchmark
LINES = 200_000


def lines() -> bytes:
    """The program of the requirement: 200,000 G1 lines."""
    return b"G21 G90 F1000\n" + b"".join(b"G1 X%.4f Y%.4f\n" % (k * 0.01 % 200, k * 0.02 % 150) for k in range(LINES)) + b"M2\n"


def real() -> bytes:
    """PyCAM's 33,444 lines, six times; only the last M2 ends it."""
    text = (ROOT / "tests" / "data" / "nc" / "test_pycam.ngc").read_bytes()
    return text.replace(b"\nM2", b"\nM1") * 5 + text


def mixed() -> bytes:
    """Arcs, and every fifth line one that is not plain: a speed, a plane, an expression."""
    part = b"G1 X1 Y%d F500\nG2 X3 I1\nG3 X1 Y%d R1\nS%d M3\nG0 Z[1+1] X0\n"
    return b"G21 G90\n" + b"".join(part % (k % 9, k % 9, k % 999) for k in range(LINES // 20)) + b"M2\n"


PROGRAMS = {"200,000 lines": lines, "PyCAM, six times": real, "50,000 mixed lines": mixed}


@pytest.mark.parametrize("name", PROGRAMS)
def test_ours(benchmark: BenchmarkFixture, name: str) -> None:
    data = PROGRAMS[name]()
    program = benchmark.pedantic(read_program, (data,), rounds=5, warmup_rounds=1)
    assert program.error is None and len(program.motions) > 30_000
    record(benchmark, name, OURS)


@pytest.mark.parametrize("name", PROGRAMS)
def test_rs274(benchmark: BenchmarkFixture, name: str, tmp_path: Path) -> None:
    needs_rs274()
    (tmp_path / "in.ngc").write_bytes(PROGRAMS[name]())
    (tmp_path / "tool.tbl").write_text("".join(f"T{n} P{n} Z0 D0.1\n" for n in (1, 2, 3)))
    command = [RS274, "-g", "-t", "tool.tbl", "-v", "scratch.var", "in.ngc", "/dev/null"]

    def run() -> int:
        return subprocess.run(command, cwd=tmp_path, env=own_home(str(tmp_path)), capture_output=True, stdin=subprocess.DEVNULL).returncode

    assert benchmark.pedantic(run, rounds=3) == 0
    record(benchmark, name, "rs274")


def test_memory_is_in_proportion() -> None:
    """The motions take 94 bytes each; reading takes as much again at its peak, and the text."""
    data = lines()
    tracemalloc.start()
    program = read_program(data)
    now, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert len(program.motions) == LINES
    assert now < 1.1 * 94 * LINES and peak < 2.5 * 94 * LINES + len(data), (now / LINES, peak / LINES)
