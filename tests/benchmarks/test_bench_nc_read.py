"""Reading programs, side by side with LinuxCNC's own interpreter: 200,000 G1 lines, a real program, and two with words
of every kind.

`rs274` prints what it reads; it is let print into nothing.
"""

import os
import subprocess
import time
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
TOOLS = "".join(f"T{n} P{n} Z0 D0.1\n" for n in (1, 2, 3))


def lines() -> bytes:
    """The program of the requirement: 200,000 G1 lines."""
    return (
        b"G21 G90 F1000\n"
        + b"".join(b"G1 X%.4f Y%.4f\n" % (k * 0.01 % 200, k * 0.02 % 150) for k in range(LINES))
        + b"M2\n"
    )


def real() -> bytes:
    """PyCAM's 33,444 lines, six times; only the last M2 ends it."""
    text = (ROOT / "tests" / "data" / "nc" / "test_pycam.ngc").read_bytes()
    return text.replace(b"\nM2", b"\nM1") * 5 + text


def mixed() -> bytes:
    """Arcs, and every fifth line one that is not plain: a speed, a plane, an expression."""
    part = b"G1 X1 Y%d F500\nG2 X3 I1\nG3 X1 Y%d R1\nS%d M3\nG0 Z[1+1] X0\n"
    return b"G21 G90\n" + b"".join(part % (k % 9, k % 9, k % 999) for k in range(LINES // 20)) + b"M2\n"


ANY = """N{n} G1 X{a:.3f} Y{a:.3f} F500
g2 x{b:.3f} y{a:.3f} i1 j0 (half a circle)
; number {n}
#1={n}
G1 X[#1*2+0.5] Y#1
S{n} M3
G17 G90 G94
G81 X{a:.2f} Y1 Z-2 R1 F100
X{b:.2f}
G80
g1 z 1 x {a:.3f}
M8
G0 X1 Y1 Z5
G18 G2 X1 Z5 I0 K1
G17
G4 P0.1
g1 x[sin[#1]] y[#1 * cos[30]] (computed)
"""


def any_kind() -> bytes:
    """Numbered lines, lower case, arcs, comments, parameters, expressions, modes, canned cycles, dwells."""
    parts = (ANY.format(n=k % 2_000, a=k % 50_000 / 1_000, b=k % 50_000 / 1_000 + 2) for k in range(LINES // 68))
    return ("G21 G90 F100\n" + "".join(parts) + "M2\n").encode()


PROGRAMS = {
    "200,000 lines": lines,
    "PyCAM, six times": real,
    "50,000 mixed lines": mixed,
    "50,000 lines of any kind": any_kind,
}


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
    (tmp_path / "tool.tbl").write_text(TOOLS)
    command = [RS274, "-g", "-t", "tool.tbl", "-v", "scratch.var", "in.ngc", "/dev/null"]

    def run() -> int:
        return subprocess.run(
            command, cwd=tmp_path, env=own_home(str(tmp_path)), capture_output=True, stdin=subprocess.DEVNULL
        ).returncode

    assert benchmark.pedantic(run, rounds=3) == 0
    record(benchmark, name, "rs274")


@pytest.mark.parametrize("name", PROGRAMS)
def test_no_slower_than_rs274(name: str, tmp_path: Path) -> None:
    """CPU seconds of both in the same run, the least of three; rs274's own start-up, a few ms, counts with it."""
    needs_rs274()
    data = PROGRAMS[name]()
    (tmp_path / "in.ngc").write_bytes(data)
    (tmp_path / "tool.tbl").write_text(TOOLS)
    command = [RS274, "-g", "-t", "tool.tbl", "-v", "scratch.var", "in.ngc", "/dev/null"]
    read_program(data[:1_000])
    ours, theirs = [], []
    for _ in range(3):
        begun, before = time.process_time(), os.times()
        read_program(data)
        ours.append(time.process_time() - begun)
        subprocess.run(
            command,
            cwd=tmp_path,
            env=own_home(str(tmp_path)),
            capture_output=True,
            stdin=subprocess.DEVNULL,
            check=True,
        )
        after = os.times()
        theirs.append(after.children_user + after.children_system - before.children_user - before.children_system)
    assert min(ours) <= min(theirs), f"{name}: {min(ours):.3f} s, rs274 {min(theirs):.3f} s"


def test_memory_is_in_proportion() -> None:
    """The motions take 94 bytes each; reading takes as much again at its peak, and the text."""
    data = lines()
    tracemalloc.start()
    program = read_program(data)
    now, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert len(program.motions) == LINES
    assert now < 1.1 * 94 * LINES and peak < 2.5 * 94 * LINES + len(data), (now / LINES, peak / LINES)
