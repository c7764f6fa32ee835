"""Few points compared with one another and many by trees and graphs: the same answers."""

import time
from itertools import combinations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from app.geometry import near_points, triangulation
from app.geometry.near_points import (
    all_within,
    groups,
    groups_within,
    nearest,
    pairs_meeting,
    pairs_within,
    places_of_each,
)
from app.geometry.triangulation import neighbours
from tests.examples import examples

SOME = settings(max_examples=examples(60), deadline=None)
places = st.integers(1, 4).flatmap(
    lambda d: arrays(np.float64, st.tuples(st.integers(1, 30), st.just(d)), elements=st.integers(-5, 5))
)
pairs = st.integers(1, 30).flatmap(
    lambda n: st.tuples(st.just(n), st.lists(st.tuples(*[st.integers(0, n - 1)] * 2), max_size=40))
)


def both(monkeypatch: pytest.MonkeyPatch, ask):
    """The answer for few points, and that for many."""
    few = ask()
    with monkeypatch.context() as patch:
        patch.setattr(near_points, "FEW", 0)
        return few, ask()


@SOME
@given(points=places, reach=st.sampled_from([0.0, 1.0, 1.5, 3.0]))
def test_pairs(points, reach: float) -> None:
    with pytest.MonkeyPatch.context() as monkeypatch:
        few, many = both(monkeypatch, lambda: pairs_within(points, reach))
    assert few.tolist() == many.tolist()
    assert few.tolist() == [
        [j, k] for j, k in combinations(range(len(points)), 2) if np.linalg.norm(points[j] - points[k]) <= reach
    ]


@SOME
@given(points=places, reach=st.sampled_from([0.0, 1.0, 2.5]), shift=st.integers(-2, 2))
def test_all_within(points, reach: float, shift: int) -> None:
    with pytest.MonkeyPatch.context() as monkeypatch:
        few, many = both(monkeypatch, lambda: all_within(points, points[::2] + shift, reach))
    assert [each.tolist() for each in few] == [each.tolist() for each in many]


@SOME
@given(
    points=arrays(np.float64, st.tuples(st.integers(1, 30), st.just(2)), elements=st.integers(-5, 5)),
    shift=st.sampled_from([0.0, 0.3, 9.0]),
    count=st.integers(1, 9),
)
def test_nearest(points, shift: float, count: int) -> None:
    """Equal points and equal distances, too."""
    count = min(count, len(points))
    with pytest.MonkeyPatch.context() as monkeypatch:
        few, many = both(monkeypatch, lambda: nearest(points, points + shift, count))
    assert few[0].tolist() == many[0].tolist()
    clear = few[0][:, -1] > 0  # else so many points lie there that any of them will do
    assert few[1][clear].tolist() == many[1][clear].tolist()
    assert all(len(set(row)) == count for row in many[1].tolist())


@SOME
@given(
    corners=arrays(np.float64, st.tuples(st.integers(0, 30), st.just(4)), elements=st.integers(-5, 5)),
    owners=st.lists(st.integers(0, 9), min_size=30, max_size=30),
    few_owners=st.booleans(),
)
def test_pairs_of_boxes_that_meet(corners, owners: list[int], few_owners: bool) -> None:
    """Owners of many boxes, too: whole nodes of the tree are theirs."""
    boxes = np.hstack([np.minimum(corners[:, :2], corners[:, 2:]), np.maximum(corners[:, :2], corners[:, 2:])])
    owner = np.array(owners[: len(boxes)], np.int64) // (5 if few_owners else 1)
    with pytest.MonkeyPatch.context() as monkeypatch:
        few, many = both(monkeypatch, lambda: pairs_meeting(boxes, owner))
    assert few.tolist() == many.tolist()
    meeting = {
        tuple(sorted((int(owner[j]), int(owner[k]))))
        for j, k in combinations(range(len(boxes)), 2)
        if (boxes[j, :2] <= boxes[k, 2:]).all() and (boxes[k, :2] <= boxes[j, 2:]).all() and owner[j] != owner[k]
    }
    assert few.tolist() == [list(pair) for pair in sorted(meeting)]


def test_the_nearest_of_many_points_on_one_another_are_soon_found() -> None:
    points = np.repeat([[1.0, 2.0], [3.0, 4.0]], 40_000, axis=0)
    begun = time.process_time()
    away, which = nearest(points, points, 3)
    assert time.process_time() - begun < 2.0  # 80,000 times 40,000 distances would take five or more
    assert away.max() == 0
    assert (which // 40_000 == np.arange(80_000)[:, None] // 40_000).all()


@SOME
@given(given_pairs=pairs)
def test_groups_are_numbered_by_their_first(given_pairs) -> None:
    count, joined = given_pairs
    together = np.array(joined, np.int64).reshape(-1, 2)
    with pytest.MonkeyPatch.context() as monkeypatch:
        few, many = both(monkeypatch, lambda: groups(count, together))
    assert few.tolist() == many.tolist()
    assert all(few[a] == few[b] for a, b in joined)
    assert list(dict.fromkeys(few.tolist())) == list(range(few.max() + 1))


@SOME
@given(
    points=st.integers(1, 60).flatmap(
        lambda n: arrays(np.float64, st.tuples(st.just(n), st.just(2)), elements=st.integers(-9, 9))
    ),
    owners=st.integers(1, 20),
    reach=st.sampled_from([0.5, 1.0, 1.5, 3.0, 40.0]),
)
def test_things_are_grouped_by_points_of_theirs_that_are_near(points, owners: int, reach: float) -> None:
    owner = np.arange(len(points)) * 7 % owners
    expected = groups(owners, owner[pairs_within(points, reach)])
    with pytest.MonkeyPatch.context() as monkeypatch:
        for found in both(monkeypatch, lambda: groups_within(points, owner, owners, reach)):
            assert found.tolist() == expected.tolist()


@pytest.mark.parametrize("apart", [1e-6, 9e-7, 1.1e-6])
@pytest.mark.parametrize("size", [1.0, 1e3, 1e6])
def test_points_as_near_as_the_reach_are_one_however_wide_the_drawing(
    monkeypatch: pytest.MonkeyPatch, size: float, apart: float
) -> None:
    """Where cells as wide as the reach could not be numbered, or their edges not be told, there is no grid."""
    random = np.random.default_rng(7)
    points = np.repeat(random.uniform(0, size, (40, 2)), 2, axis=0)
    points[1::2, 0] += apart
    points[0], points[-1] = (0.0, 0.0), (size, size)
    expected = groups(80, pairs_within(points, 1e-6))
    monkeypatch.setattr(near_points, "FEW", 0)
    assert groups_within(points, np.arange(80), 80, 1e-6).tolist() == expected.tolist()


@SOME
@given(values=st.lists(st.integers(0, 6), max_size=30))
def test_places_of_each_number(values: list[int]) -> None:
    numbers = np.array([1, 3, 4, 9])
    found = places_of_each(np.array(values, np.int64), numbers)
    assert [each.tolist() for each in found] == [
        [k for k, value in enumerate(values) if value == number] for number in numbers
    ]


@pytest.mark.parametrize("offset", [0.0, 3000.0])
def test_a_triangulation_is_the_same_whoever_makes_it(monkeypatch: pytest.MonkeyPatch, offset: float) -> None:
    points = np.random.default_rng(3).uniform(0, 50, (300, 2)) + offset
    few = neighbours(points)
    monkeypatch.setattr(triangulation, "FEW", 0)
    assert few.tolist() == neighbours(points).tolist()


@pytest.mark.parametrize("points", [[], [[0, 0]], [[0, 0], [1, 1]], [[0, 0], [1, 1], [2, 2]], [[1, 2], [1, 2], [1, 2]]])
def test_what_has_no_triangle_has_no_neighbours(monkeypatch: pytest.MonkeyPatch, points) -> None:
    for _ in range(2):
        assert neighbours(np.array(points, np.float64).reshape(-1, 2)).shape == (0, 2)
        monkeypatch.setattr(triangulation, "FEW", -1)


def test_the_shortest_tree_of_a_grid_is_among_its_neighbours() -> None:
    """Of four points on a circle either diagonal may be taken, but never a side be left out."""
    axis = np.arange(12.0)
    points = np.stack(np.meshgrid(axis, axis), -1).reshape(-1, 2)
    edges = {tuple(edge) for edge in neighbours(points).tolist()}
    sides = {(j, k) for j, k in combinations(range(len(points)), 2) if np.hypot(*(points[j] - points[k])) == 1}
    assert sides <= edges and len(edges) == len(sides) + 11 * 11


def test_a_point_that_is_there_twice_is_one_of_the_two() -> None:
    edges = neighbours(np.array([[0.0, 0.0], [4.0, 0.0], [0.0, 3.0], [4.0, 0.0]]))
    assert len(edges) == 3 and set(edges.ravel().tolist()) in ({0, 1, 2}, {0, 2, 3})
