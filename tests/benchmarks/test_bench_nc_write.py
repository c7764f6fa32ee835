"""Writing NC and proving it: 57,000 moves, half of them arcs, and a million.

Times are multiples of what a sort of 12 million numbers takes in the same run.
"""

import math
import time

import numpy as np
import pytest
from pytest_benchmark.fixture import BenchmarkFixture

from app.gcode.checks.check import CheckReference, check
from app.gcode.posts import load_post
from app.gcode.writer.write import NcFile, write_files
from app.model.moves import Moves, Program
from tests.benchmarks.conftest import OURS, record
from tests.gcode.programs import Path, job, square

pytestmark = pytest.mark.benchmark
MOST = {57_000: 0.25, 1_000_000: 3.4}
"""How many sorts writing may take; one is about 0.9 s: 0.2 s and 3 s."""
NOTHING = (math.nan, math.nan)


def program(count: int) -> Program:
    """A chain of lines and arcs in turn that goes up and down a plate, with a little rounding everywhere."""
    inside = count - 4
    head = Path().into_work(0.0, 0.0).out_of_work().moves()
    k = np.arange(inside)
    end = np.column_stack([200 * np.abs((k * 0.00371) % 2 - 1), k * 0.0137 % 150, np.full(inside, -1.0)])
    before = np.vstack([head.end[2], end[:-1]])
    way = (end - before)[:, :2]
    bow = np.column_stack([-way[:, 1], way[:, 0]]) * (0.8 + 0.3 * np.sin(k))[:, None]
    arc = k % 2 == 1
    centre = np.where(arc[:, None], (end + before)[:, :2] / 2 + bow, math.nan)
    kind = np.where(arc, 2 + k // 2 % 2, 1)
    rows = [[*head.kind[:3], *kind, head.kind[3]], [*head.purpose[:3], *np.full(inside, 2), head.purpose[3]]]
    zeros, feed = np.zeros(count), np.concatenate([head.feed[:3], 600.0 + k // 1000 % 3, head.feed[3:]])
    last = np.append(end[-1, :2], 5.0)
    moves = Moves(
        np.vstack([head.end[:3], end, last]),
        np.vstack([np.tile(NOTHING, (3, 1)), centre, NOTHING]),
        np.array(rows[0], np.uint8),
        np.array(rows[1], np.uint8),
        zeros.astype(np.int16),
        (zeros + 1).astype(np.int16),
        (zeros + 1).astype(np.int32),
        feed,
        zeros.astype(np.int32),
    )
    return Program(moves, (square(0, 0, 200, 150),))


def sort_s() -> float:
    """Seconds of this thread that a sort of 12 million numbers takes."""
    values = np.random.default_rng(1).random(12_000_000)
    begun = time.thread_time()
    np.sort(values)
    return time.thread_time() - begun


@pytest.mark.parametrize("count", MOST)
def test_writing(benchmark: BenchmarkFixture, count: int) -> None:
    meant, post, spent = program(count), load_post("linuxcnc"), []

    def write() -> tuple[NcFile, ...]:
        begun = time.thread_time()
        files = write_files(meant, job(), post)
        spent.append(time.thread_time() - begun)
        return files

    write()  # the first one loads what is compiled
    spent.clear()
    (file,) = benchmark.pedantic(write, rounds=3)
    record(benchmark, f"writing {count} moves", OURS)
    benchmark.extra_info["sorts"] = min(spent) / sort_s()
    assert file.nc.text.count("\n") > 0.9 * count
    assert benchmark.extra_info["sorts"] < MOST[count]


def test_proving(benchmark: BenchmarkFixture) -> None:
    """Read back twice and compared: a million lines in no more than four sorts."""
    count = 1_000_000
    meant, post = program(count), load_post("linuxcnc")
    (file,) = write_files(meant, job(), post)
    data, spent = file.nc.text.encode(), []

    def prove() -> object:
        begun = time.thread_time()
        done = check(data, file, CheckReference(meant, job(), post))
        spent.append(time.thread_time() - begun)
        return done.problems

    prove()
    spent.clear()
    assert benchmark.pedantic(prove, rounds=2) == ()
    record(benchmark, f"proving {count} moves", OURS)
    benchmark.extra_info["sorts"] = min(spent) / sort_s()
    assert benchmark.extra_info["sorts"] < 4
