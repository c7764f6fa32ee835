"""Splines in a tube: against scipy's smoothing spline with bisection on its sum of squares, and how the time rises with
the points.
"""

from itertools import pairwise

import numpy as np
import pytest
from numpy.typing import NDArray
from pytest_benchmark.fixture import BenchmarkFixture

from app.fitting.point_curves.bspline import SplineFit, fit_spline
from app.fitting.point_curves.proven_curve import SplineOptions, fit_splines
from app.fitting.point_curves.space_curve import curve_of_motions
from app.fitting.point_curves.tube import ToleranceTube, TubeAnswer, judge
from tests.benchmarks.conftest import OURS, record

pytestmark = pytest.mark.benchmark
Floats = NDArray[np.float64]
TOLERANCE = 0.05


def contour(count: int) -> Floats:
    """A wavy contour of some 2.4 m in space, as dense as it has points."""
    a = np.linspace(0, 60, count + 1)
    r = 40 + 5 * np.sin(3 * a / 7) + 2 * np.cos(a * 1.3)
    return np.column_stack([r * np.cos(a), r * np.sin(a), 3 * np.sin(a / 2)])


def proven(points: Floats) -> int:
    """Fit, and prove again from nothing; return the spans."""
    made = fit_splines(points, SplineOptions(ToleranceTube(TOLERANCE)))
    judgement = judge(curve_of_motions(made.motions), points, ToleranceTube(TOLERANCE))
    assert judgement.answer is TubeAnswer.INSIDE
    return sum(len(np.unique(curve.knots)) - 1 for curve in made.motions.splines.values())


def by_bisection(points: Floats) -> int:
    """The least sum of squares that keeps sampled places within the tolerance, halved twelve times; nothing is
    proven.
    """
    from scipy.interpolate import splev, splprep
    from scipy.spatial import cKDTree

    dense = np.concatenate([a + (b - a) * np.linspace(0, 1, 4, endpoint=False)[:, None] for a, b in pairwise(points)])
    tree, low, high, best = cKDTree(dense), 0.0, len(points) * TOLERANCE**2, len(points)
    for _ in range(12):
        middle = (low + high) / 2
        (knots, weights, degree), _ = splprep(points.T, s=middle, k=3)
        places = np.column_stack(splev(np.linspace(0, 1, 8 * len(points)), (knots, weights, degree)))
        if tree.query(places)[0].max() <= TOLERANCE:
            low, best = middle, min(best, len(knots) - 7)
        else:
            high = middle
    return best


@pytest.mark.parametrize("engine", [OURS, "splprep"])
def test_ten_thousand_points(benchmark: BenchmarkFixture, engine: str) -> None:
    points = contour(10_000)
    proven(points[:100])
    spans = benchmark.pedantic(
        proven if engine == OURS else by_bisection, args=(points,), rounds=3 if engine == OURS else 1
    )
    benchmark.extra_info["spans"] = spans
    record(benchmark, "splines within 0.05 mm of 10 000 points", engine, least=True)


@pytest.mark.parametrize("count", [10_000, 100_000, 1_000_000])
def test_time_rises_with_the_points(benchmark: BenchmarkFixture, count: int) -> None:
    points = contour(count)
    fit = benchmark.pedantic(fit_spline, args=(points, ToleranceTube(TOLERANCE)), rounds=1)
    assert isinstance(fit, SplineFit)
    record(benchmark, f"a spline within 0.05 mm of {count} points", OURS)
