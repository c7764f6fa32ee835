"""How far two paths are apart: never less than it is, and just what it is where the paths run together."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.gcode.checks.path_distance import Polyline, farthest, leash
from tests.examples import examples


def path(*points: tuple[float, ...]) -> Polyline:
    return Polyline.through(np.array([(*point, 0.0, 0.0)[:3] for point in points], float), np.arange(len(points)))


def frechet(a: np.ndarray, b: np.ndarray) -> float:
    """The discrete leash of two dense point sequences, by the book's recursion."""
    distance = np.linalg.norm(a[:, None] - b[None], axis=2)
    table = np.full((len(a) + 1, len(b) + 1), np.inf)
    table[0, 0] = 0.0
    for i in range(len(a)):
        for j in range(len(b)):
            table[i + 1, j + 1] = max(distance[i, j], min(table[i, j], table[i, j + 1], table[i + 1, j]))
    return float(table[-1, -1])


def dense(line: Polyline, count: int) -> np.ndarray:
    at = np.union1d(line.along, np.linspace(0, line.along[-1], count))
    return np.column_stack([np.interp(at, line.along, column) for column in line.points.T])


def test_going_back_over_itself_needs_a_longer_leash_though_no_place_is_apart():
    straight, there_and_back = path((0,), (10,)), path((0,), (6,), (4,), (10,))
    assert farthest(straight, there_and_back).distance == pytest.approx(0)
    assert 1.0 <= leash(straight, there_and_back) <= 2.001
    assert 1.0 <= leash(there_and_back, straight) <= 2.001


def test_the_farthest_place_is_told():
    found = farthest(path((0, 0), (10, 0)), path((0, 0), (5, 3), (10, 0)))
    assert (found.distance, found.a, found.b) == (
        pytest.approx(3.0),
        pytest.approx((5, 0, 0)),
        pytest.approx((5, 3, 0)),
    )


def test_a_path_without_length_is_as_far_as_the_other_goes():
    assert leash(path((1, 1), (1, 1)), path((1, 1), (4, 5))) == pytest.approx(5.0)


PLACES = st.lists(st.tuples(*[st.integers(-20, 20)] * 2), min_size=2, max_size=9).filter(
    lambda places: len(set(places)) > 1
)


@settings(deadline=None, max_examples=examples(80))
@given(PLACES, PLACES)
def test_a_leash_is_never_shorter_than_the_least_one(one, other):
    a, b = path(*one), path(*other)
    least = frechet(dense(a, 80), dense(b, 80)) - max(a.along[-1], b.along[-1]) / 80
    assert leash(a, b) >= least - 1e-9
    assert leash(a, b) >= farthest(a, b).distance - 1e-9


@settings(deadline=None, max_examples=examples(80))
@given(PLACES, st.integers(0, 2**32))
def test_pieces_that_are_cut_anew_and_moved_a_little_need_as_long_a_leash_as_they_are_moved(places, seed):
    rng = np.random.default_rng(seed)
    a = path(*[place for at, place in enumerate(places) if at == 0 or place != places[at - 1]])
    if len(a.points) < 2:
        return
    at = np.sort(np.concatenate([a.along, rng.uniform(0, a.along[-1], 20)]))
    moved = np.column_stack([np.interp(at, a.along, column) for column in a.points.T]) + rng.uniform(
        -1e-4, 1e-4, (len(at), 3)
    )
    b = Polyline.through(moved, np.arange(len(at)))
    assert leash(a, b) <= 2e-3
