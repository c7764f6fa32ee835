"""Smoothing 100,000 traced pixels into lines and arcs, against a plain numpy greedy that makes lines alone."""

import numpy as np
import pytest
from pytest_benchmark.fixture import BenchmarkFixture

from app.fitting.corner_smoothing.smooth import CornerSmoothingOptions, smooth
from app.raster.frame import BitmapFrame
from tests.benchmarks.conftest import OURS, record
from tests.fitting.paths import traces, wavy

pytestmark = pytest.mark.benchmark
TASK = "smoothing of 100 000 pixels"
TOLERANCE = 0.75


@pytest.fixture(scope="module")
def path() -> np.ndarray:
    """The trace, in pixels, of a part of 100 mm on 8000 x 8000."""
    trace: np.ndarray = traces(BitmapFrame(8000, 8000, 100 / 8000), [wavy()])[0] / (100 / 8000)
    assert len(trace) == pytest.approx(100_000, rel=0.1)
    return trace


def greedy_lines(points: np.ndarray, tolerance: float) -> int:
    """The longest line through each end's next points, by doubling and halving, each fitted by numpy."""

    def holds(a: int, steps: int) -> bool:
        run = points[a : a + steps + 1]
        away = run - run.mean(axis=0)
        _, _, axes = np.linalg.svd(away, full_matrices=False)
        return float(np.abs(away @ axes[-1]).max()) <= tolerance

    at, count = 0, 0
    while at < len(points) - 1:
        good, steps = 1, 2
        while at + steps < len(points) and holds(at, steps):
            good, steps = steps, 2 * steps
        bad = min(steps, len(points) - at)
        while bad - good > 1:
            middle = (good + bad) // 2
            good, bad = (middle, bad) if holds(at, middle) else (good, middle)
        at += good
        count += 1
    return count


def test_own_smoothing(benchmark: BenchmarkFixture, path: np.ndarray) -> None:
    smoothed = benchmark(smooth, path, CornerSmoothingOptions(TOLERANCE))
    record(benchmark, TASK, OURS)
    assert smoothed.exact
    assert smoothed.deviation <= 4 * TOLERANCE


def test_plain_greedy(benchmark: BenchmarkFixture, path: np.ndarray) -> None:
    count = benchmark.pedantic(greedy_lines, (path, TOLERANCE), rounds=1)
    record(benchmark, TASK, "plain numpy greedy")
    assert count > 100
