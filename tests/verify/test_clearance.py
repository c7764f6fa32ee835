"""Closed-form distances against dense sampling, for random lines and arcs."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from app.verify.verdict import curve_distance
from tests.examples import examples

numbers = st.floats(-10, 10).map(lambda value: round(value, 3))
points = st.tuples(numbers, numbers)
lines = st.tuples(points, points).map(lambda ends: (*ends[0], *ends[1], 0.0, 0.0, 0.0, 0.0))


@st.composite
def arcs(draw: st.DrawFn) -> tuple[float, ...]:
    (cx, cy), radius = draw(points), draw(st.floats(0.1, 8))
    first, sweep = draw(st.floats(-3.1, 3.1)), draw(st.floats(0.05, 6.2)) * draw(st.sampled_from([1, -1]))
    ends = [(cx + radius * math.cos(a), cy + radius * math.sin(a)) for a in (first, first + sweep)]
    return (*ends[0], *ends[1], cx, cy, radius, math.copysign(1.0, sweep))


@st.composite
def circles(draw: st.DrawFn) -> tuple[float, ...]:
    (cx, cy), radius = draw(points), draw(st.floats(0.1, 8))
    return (cx + radius, cy, cx + radius, cy, cx, cy, radius, draw(st.sampled_from([1.0, -1.0])))


curves = st.one_of(lines, arcs(), circles())


def along(row: tuple[float, ...], count: int = 900) -> np.ndarray:
    """Points of a curve, by its definition."""
    x0, y0, x1, y1, cx, cy, radius, turn = row
    t = np.linspace(0, 1, count)
    if turn == 0:
        return np.stack([x0 + t * (x1 - x0), y0 + t * (y1 - y0)], axis=1)
    first, last = math.atan2(y0 - cy, x0 - cx), math.atan2(y1 - cy, x1 - cx)
    sweep = (turn * (last - first)) % math.tau if (x0, y0) != (x1, y1) else math.tau
    angle = first + turn * sweep * t
    return np.stack([cx + radius * np.cos(angle), cy + radius * np.sin(angle)], axis=1)


def spacing(points: np.ndarray) -> float:
    return float(np.max(np.hypot(*np.diff(points, axis=0).T)))


@settings(max_examples=examples(150), deadline=None)
@given(curves, curves)
def test_distance_is_that_of_dense_points(first: tuple[float, ...], second: tuple[float, ...]) -> None:
    assume(first[:2] != first[2:4] or first[7] != 0)
    a, b = along(first), along(second)
    dense = min(float(np.min(np.hypot(*(a[k : k + 100, None] - b).reshape(-1, 2).T))) for k in range(0, len(a), 100))
    distance, place = curve_distance(np.array([first]), np.array([second]))
    assert distance[0] <= dense + 1e-9
    assert distance[0] >= dense - (spacing(a) + spacing(b)) / 2 - 1e-9
    assert np.min(np.hypot(*(a - place[0]).T)) <= spacing(a)


@pytest.mark.parametrize(
    ("first", "second", "expected"),
    [
        ((0, 0, 10, 0, 0, 0, 0, 0), (5, -5, 5, 5, 0, 0, 0, 0), 0.0),
        ((0, 0, 10, 0, 0, 0, 0, 0), (0, 2, 10, 2, 0, 0, 0, 0), 2.0),
        ((0, 0, 10, 0, 0, 0, 0, 0), (2, 5, 8, 5, 5, 5, 3, 1), 2.0),
        ((0, 0, 10, 0, 0, 0, 0, 0), (2, 5, 8, 5, 5, 5, 3, -1), 5.0),
        ((-1, 0, 1, 0, 0, 0, 1, 1), (9, 0, 11, 0, 10, 0, 1, 1), 8.0),
        ((3, 0, 3, 0, 0, 0, 3, 1), (5, 0, 5, 0, 0, 0, 5, -1), 2.0),
        ((4, 4, 4, 4, 0, 0, 0, 0), (0, 0, 10, 0, 0, 0, 0, 0), 4.0),
    ],
)
def test_known_distances(first: tuple[float, ...], second: tuple[float, ...], expected: float) -> None:
    distance, _ = curve_distance(np.array([first], float), np.array([second], float))
    assert distance[0] == pytest.approx(expected, abs=1e-12)
