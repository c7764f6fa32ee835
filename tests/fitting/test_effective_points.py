"""Effective points: the ranges equal the plain definition, whatever the path; what counts as an end; bad parameters."""

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from app.core.errors import GeometryError, ParameterError
from app.fitting.point_curves.effective_points import EffectiveOptions, PointState, RangeEnds, effective_points
from tests.examples import examples

Floats = NDArray[np.float64]


def off_segment(points: Floats, a: Floats, b: Floats) -> Floats:
    chord = b - a
    size = chord @ chord
    share = np.clip((points - a) @ chord / size, 0, 1) if size > 0 else np.zeros(len(points))
    away: Floats = np.linalg.norm(points - a - share[:, None] * chord, axis=1)
    return away


def plain_ranges(points: Floats, epsilon: float) -> list[list[int]]:
    """S111-S117 word by word."""
    ranges, i, k = [], 0, 1
    while k < len(points) - 1:
        k += 1
        if (off_segment(points[i + 1 : k], points[i], points[k]) > epsilon).any():
            ranges.append([i, k - 1])
            i = k - 1
    return [*ranges, [i, k]]


def wander(seed: int, kind: str, dimensions: int) -> Floats:
    rng = np.random.default_rng(seed)
    n = int(rng.integers(2, 150))
    t = np.linspace(0, 6, n)
    noise = rng.uniform(-1, 1, (n, dimensions)) * rng.choice([0.001, 0.01, 0.05])
    line = t[:, None] * rng.normal(size=dimensions)
    if kind == "curve":
        line[:, 0], line[:, 1] = np.cos(t), np.sin(t)
    if kind == "reversal":
        line = np.abs(t - 3)[:, None] * rng.normal(size=dimensions)
    if kind == "steps":
        line = np.cumsum(rng.normal(size=(n, dimensions)) * rng.choice([1e-4, 0.02, 1.0], (n, 1)), axis=0)
    if kind == "repeats":
        line, noise = np.repeat(line, 3, axis=0), np.repeat(noise, 3, axis=0)
    points: Floats = line + noise
    return points


@pytest.mark.parametrize("kind", ["line", "curve", "reversal", "steps", "repeats"])
@given(seed=st.integers(0, 10**6), dimensions=st.sampled_from([2, 3]), epsilon=st.sampled_from([0.003, 0.0123, 0.07]))
@settings(max_examples=examples(60), deadline=None)
def test_ranges_are_those_of_the_plain_definition(kind: str, seed: int, dimensions: int, epsilon: float) -> None:
    points = wander(seed, kind, dimensions)
    found = effective_points(points, EffectiveOptions(epsilon))
    assert found.ranges.tolist() == plain_ranges(points, epsilon)
    assert sorted(set(found.ranges.ravel().tolist())) == found.passed.tolist()


def test_the_corners_of_a_polygon_are_effective() -> None:
    angles = np.linspace(0, 2 * np.pi, 9)
    corners = np.column_stack((10 * np.cos(angles), 10 * np.sin(angles)))
    path = np.concatenate([np.linspace(a, b, 5, endpoint=False) for a, b in pairwise(corners)] + [corners[-1:]])
    assert effective_points(path, EffectiveOptions(1e-6)).passed.tolist() == list(range(0, 41, 5))


def test_points_near_the_ends_of_a_range_are_effective_by_share_or_distance() -> None:
    line = np.column_stack((np.arange(11.0), np.zeros(11)))
    assert effective_points(line, EffectiveOptions(0.01)).passed.tolist() == [0, 10]
    assert effective_points(line, EffectiveOptions(0.01, RangeEnds.RATIO, 0.25)).passed.tolist() == [0, 1, 2, 8, 9, 10]
    assert effective_points(line, EffectiveOptions(0.01, RangeEnds.DISTANCE, 1.5)).passed.tolist() == [0, 1, 9, 10]
    assert effective_points(line, EffectiveOptions(0.01, RangeEnds.DISTANCE, 1.0)).passed.tolist() == [0, 10]


def test_no_range_goes_beyond_a_kept_point() -> None:
    line = np.column_stack((np.arange(11.0), np.zeros(11)))
    assert effective_points(line, EffectiveOptions(0.01), kept=[4]).ranges.tolist() == [[0, 4], [4, 10]]


def test_few_and_equal_points() -> None:
    assert effective_points(np.zeros((2, 3)), EffectiveOptions(0.1)).passed.tolist() == [0, 1]
    assert effective_points(np.zeros((9, 3)), EffectiveOptions(0.1)).ranges.tolist() == [[0, 8]]
    there_and_back = np.array([[0.0, 0], [5, 0], [0, 0]])
    assert effective_points(there_and_back, EffectiveOptions(0.1)).passed.tolist() == [0, 1, 2]
    assert effective_points(there_and_back, EffectiveOptions(0.1)).state.tolist() == [PointState.EFFECTIVE] * 3


def test_a_straight_cloud_of_many_points_is_one_range() -> None:
    rng = np.random.default_rng(3)
    many = np.column_stack((np.linspace(0, 1000, 100_000), rng.uniform(-0.004, 0.004, (100_000, 2))))
    assert len(effective_points(many, EffectiveOptions(0.02)).ranges) == 1


def wave(count: int, inner: int) -> Floats:
    """Facets of a wave that turn by less and less up to where it bends the other way, with points within each."""
    x = np.linspace(-1, 1, count + 1) + 0.013
    ends = np.column_stack((50 * x, 12 * np.sin(2.2 * x)))
    share = np.arange(inner + 1) / (inner + 1)
    between = ends[:-1, None] + (ends[1:] - ends[:-1])[:, None] * share[None, :, None]
    return np.vstack((between.reshape(-1, 2), ends[-1:])).round(4)


@pytest.mark.parametrize("count", range(8, 30))
def test_ranges_end_at_the_facets_where_these_turn_by_little(count: int) -> None:
    """By the text's own definition a range goes on into the next facet, or over it."""
    points, step = wave(count, 4), 100 / count
    epsilon = max(12 * 2.2**2 * step**2 / 50**2 / 80, 2e-4)
    at_bends = effective_points(points, EffectiveOptions(epsilon), at_bends=True)
    assert at_bends.passed.tolist() == list(range(0, 5 * count + 1, 5))


def test_what_rounding_moves_by_chance_ends_no_range() -> None:
    """Of 1,200 points on 244 facets one lies a last decimal off, and the rest of its facet is straight on both sides:
    a range that ended there would lead the curve by a place 0.0018 mm off the circle.
    """
    random, turn = np.random.default_rng(28), 0.4 + 1.7 * math.pi * np.linspace(0, 1, 245)
    ends = 33.3 * np.column_stack((np.cos(turn), np.sin(turn)))
    points, at = [ends[:1]], [0]
    for a, b in pairwise(ends):
        count = int(random.integers(2, 7)) + 1
        points.append(a + (b - a) * np.arange(1, count + 1)[:, None] / count)
        at.append(at[-1] + count)
    path = np.vstack(points).round(4)
    assert effective_points(path, EffectiveOptions(2e-4), at_bends=True).passed.tolist() != at
    assert effective_points(path, EffectiveOptions(2e-4), at_bends=True, settled=True).passed.tolist() == at


@pytest.mark.parametrize("noise", [0.2, 0.5])
def test_points_that_bend_nowhere_or_all_along_end_no_range_within(noise: float) -> None:
    rng = np.random.default_rng(5)
    turn = np.linspace(0, 2, 400)
    line = np.column_stack((np.linspace(0, 90, 400), np.zeros(400))) + rng.uniform(-noise, noise, (400, 2)) * 1e-3
    arc = 40 * np.column_stack((np.cos(turn), np.sin(turn)))
    for points in (line, arc):
        plain, at_bends = (effective_points(points, EffectiveOptions(0.004), at_bends=flag) for flag in (False, True))
        assert at_bends.ranges.tolist() == plain.ranges.tolist()


@pytest.mark.parametrize(
    "bad",
    [(0.0,), (math.nan,), (0.1, RangeEnds.RATIO, 0.6), (0.1, RangeEnds.RATIO, -0.1), (0.1, RangeEnds.DISTANCE, -1.0)],
)
def test_bad_parameters_are_named(bad: tuple[float, ...]) -> None:
    with pytest.raises(ParameterError, match="must be"):
        EffectiveOptions(*bad)  # type: ignore[arg-type]


@pytest.mark.parametrize("bad", [np.zeros((1, 3)), np.zeros((4, 4)), np.array([[0.0, 0], [np.nan, 1]])])
def test_a_path_that_is_none_is_refused(bad: Floats) -> None:
    with pytest.raises(GeometryError, match="expected"):
        effective_points(bad, EffectiveOptions(0.1))
