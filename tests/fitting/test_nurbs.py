"""Chords of a rational B-spline stay within their tolerance, everywhere and not only at samples' places."""

import itertools
import time
import tracemalloc

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.geometry.arcs.nurbs import flattened, flattened_all
from app.model.motion import Nurbs
from tests.examples import examples
from tests.nurbs_oracle import nurbs_points


@st.composite
def drawn_curves(draw: st.DrawFn) -> Nurbs:
    rng = np.random.default_rng(draw(st.integers(0, 10**6)))
    degree = draw(st.integers(1, 7))
    count = draw(st.integers(degree + 1, 14))
    inner = np.sort(rng.choice([0.2, 0.5, 0.50001, 0.9, *rng.random(12)], count - degree - 1, replace=False))
    knots = np.concatenate([np.zeros(degree + 1), inner, np.ones(degree + 1)])
    return Nurbs(rng.normal(0, 30, (count, 3)), 10 ** rng.uniform(-0.7, 0.7, count), knots, degree)


def distances(points: np.ndarray, chords: np.ndarray) -> np.ndarray:
    """Distance of points (n, 3) from a polyline (m, 3)."""
    start, along = chords[:-1], np.diff(chords, axis=0)
    square = np.maximum((along**2).sum(axis=1), 1e-300)
    share = np.clip(((points[:, None] - start) * along).sum(axis=2) / square, 0, 1)
    return np.linalg.norm(points[:, None] - start - share[..., None] * along, axis=2).min(axis=1)


@settings(max_examples=examples(60), deadline=None)
@given(drawn_curves(), st.sampled_from([1.0, 0.1, 0.01]))
def test_no_point_is_farther_than_the_tolerance(curve: Nurbs, tolerance: float) -> None:
    chords = flattened(curve, tolerance)
    edges = np.unique(curve.knots)
    samples = nurbs_points(curve, np.concatenate([np.linspace(a, b, 300) for a, b in itertools.pairwise(edges)]))
    assert distances(samples, chords).max() <= tolerance * (1 + 1e-9)
    assert (
        np.array_equal(chords[[0, -1]], curve.points[[0, -1]])
        or np.abs(chords[[0, -1]] - curve.points[[0, -1]]).max() < 1e-9
    )
    assert distances(chords, samples).max() < 5.0


def test_chords_are_not_many_more_than_needed() -> None:
    half = np.sqrt(0.5)
    quarter = Nurbs(
        np.array([[10.0, 0, 0], [10, 10, 0], [0, 10, 0]]), np.array([1, half, 1]), np.array([0, 0, 0, 1.0, 1, 1]), 2
    )
    chords = flattened(quarter, 0.001)
    needed = (np.pi / 2) / (2 * np.arccos(1 - 0.001 / 10))
    assert needed < len(chords) - 1 < 3 * needed
    assert np.hypot(chords[:, 0], chords[:, 1]) == pytest.approx(10.0, abs=1e-12)


@pytest.mark.parametrize(
    "points", [np.zeros((4, 3)), np.array([[0.0, 0, 0], [9, 0, 0], [-9, 0, 0], [1, 0, 0]]), np.eye(4, 3) * 1e9]
)
def test_curves_that_stand_still_turn_back_or_are_huge(points: np.ndarray) -> None:
    curve = Nurbs(points, np.array([1e-6, 1e6, 1e-6, 1e6]), np.array([0.0, 0, 0, 0, 1, 1, 1, 1]), 3)
    begun = time.perf_counter()
    chords = flattened(curve, 1e-4)
    assert time.perf_counter() - begun < 2.0
    assert np.isfinite(chords).all()
    assert distances(nurbs_points(curve, np.linspace(0, 1, 500)), chords).max() <= max(1e-4, 2e-9 * np.ptp(points))


@settings(max_examples=examples(20), deadline=None)
@given(st.lists(drawn_curves(), max_size=6))
def test_many_at_once_are_as_each_by_itself(curves: list[Nurbs]) -> None:
    for curve, chords in zip(curves, flattened_all(curves, 0.1), strict=True):
        assert np.array_equal(chords, flattened(curve, 0.1))


def test_a_curve_of_very_many_pieces_takes_memory_in_proportion() -> None:
    count, degree = 4000, 19
    points = np.column_stack([np.arange(count) * 1.0, np.sin(np.arange(count) * 2.0) * 40, np.zeros(count)])
    knots = np.concatenate([np.zeros(degree + 1), np.arange(1, count - degree), np.full(degree + 1, count - degree)])
    curve = Nurbs(points, np.ones(count), knots, degree)
    tracemalloc.start()
    chords = flattened(curve, 0.001)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert len(chords) > count - degree
    assert peak < 60e6
