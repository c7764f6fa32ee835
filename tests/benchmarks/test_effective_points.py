"""Effective points and corrected points of a path of 100,000 points on a polygon, against the plain definition in
numpy.
"""

import math
from itertools import pairwise

import numpy as np
import pytest
from pytest_benchmark.fixture import BenchmarkFixture

from app.fitting.point_curves.correction import CorrectionOptions, corrected
from app.fitting.point_curves.effective_points import EffectiveOptions, effective_points
from tests.benchmarks.conftest import OURS, record

pytestmark = pytest.mark.benchmark
TASK = "effective points of 100 000"
OPTIONS = EffectiveOptions(1e-9)


@pytest.fixture(scope="module")
def path() -> np.ndarray:
    """Turns of a helix as 5000 sides of 20 steps each."""
    turn = np.linspace(0, 50 * 2 * math.pi, 5001)
    corners = np.column_stack((25 * np.cos(turn), 25 * np.sin(turn), 0.1 * turn))
    share = np.linspace(0, 1, 21)[:-1, None]
    return np.concatenate([*(a + share * (b - a) for a, b in pairwise(corners)), corners[-1:]])


def plain(points: np.ndarray, epsilon: float) -> int:
    """How many ranges S111-S117 find, each longer segment tried against all points between."""
    count, i, k = 1, 0, 1
    while k < len(points) - 1:
        k += 1
        chord, between = points[k] - points[i], points[i + 1 : k] - points[i]
        share = np.clip(between @ chord / (chord @ chord), 0, 1)
        if ((between - share[:, None] * chord) ** 2).sum(axis=1).max() > epsilon**2:
            count, i = count + 1, k - 1
    return count


def test_own_ranges(benchmark: BenchmarkFixture, path: np.ndarray) -> None:
    found = benchmark(effective_points, path, OPTIONS)
    record(benchmark, TASK, OURS)
    assert len(found.ranges) == 5000


def test_plain_ranges(benchmark: BenchmarkFixture, path: np.ndarray) -> None:
    count = benchmark.pedantic(plain, (path, OPTIONS.epsilon), rounds=1)
    record(benchmark, TASK, "plain numpy")
    assert count == 5000


def test_own_correction(benchmark: BenchmarkFixture, path: np.ndarray) -> None:
    state = effective_points(path, OPTIONS).state
    after = benchmark(corrected, path, state, CorrectionOptions())
    record(benchmark, "correction of 100 000 points", OURS)
    off = np.abs(np.hypot(after.places[:, 0], after.places[:, 1]) - 25)
    assert off.max() < 0.1 * np.abs(np.hypot(path[:, 0], path[:, 1]) - 25).max()
