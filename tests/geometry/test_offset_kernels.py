"""What the exact offset rests on: distances between rows, the bound that rules rows out, the proof of a path."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.geometry.distance import DistanceField
from app.geometry.kernels import DEPTH
from app.geometry.offset import (
    clearance_kernels as offset_clearance_kernels,
)
from app.geometry.offset import (
    offset_kernels,
)
from app.geometry.offset import (
    tree_kernels as offset_tree_kernels,
)
from app.geometry.offset import (
    trim_kernels as offset_trim_kernels,
)
from app.geometry.offset.offset import offset_levels
from app.geometry.primitives import Primitives, Rows, contour_rows, points_at
from tests.examples import examples
from tests.part_shapes import random_star, square

SEEDS = st.integers(0, 10**6)


def random_rows(rng: np.random.Generator) -> Rows:
    return np.concatenate(
        [contour_rows(random_star(rng, (0, 0), (2, 9), 0.6)), contour_rows(random_star(rng, (3, 2), (1, 5), 0.9))]
    )


def tree_of(field: DistanceField) -> tuple[np.ndarray, ...]:
    return offset_tree_kernels.build_runs(field.rows, field.boxes)


def dense(rows: Rows, count: int = 400) -> np.ndarray:
    """Points (n, count, 2) along each row."""
    return np.stack([points_at(rows, np.full(len(rows), f)) for f in np.linspace(0, 1, count)], axis=1)


@settings(max_examples=examples(25), deadline=None)
@given(SEEDS)
def test_distance_between_rows_is_that_of_their_nearest_points(seed: int) -> None:
    rows = random_rows(np.random.default_rng(seed))
    points = dense(rows)
    step = np.hypot(*np.diff(points, axis=1).T).max(axis=0)
    for i in range(0, len(rows), 3):
        for j in range(len(rows)):
            exact = offset_clearance_kernels.rows_distance(rows, i, rows, j)
            sampled = DistanceField.of(rows[[j]]).nearest(points[i])[0].min()
            assert sampled - step[i] <= exact <= sampled + 1e-9
            assert exact == pytest.approx(offset_clearance_kernels.rows_distance(rows, j, rows, i), abs=1e-9)


@settings(max_examples=examples(25), deadline=None)
@given(SEEDS, st.floats(0.05, 3))
def test_every_row_that_comes_nearer_to_a_piece_is_a_candidate(seed: int, level: float) -> None:
    rng = np.random.default_rng(seed)
    rows = random_rows(rng)
    field = DistanceField.of(rows)
    tree = tree_of(field)
    angles, shape, probe = np.empty((2 * len(rows), 2)), np.empty(6), np.empty(10)
    offset_kernels.element_angles(rows, np.arange(-1, len(rows) - 1), angles)
    near, stack = np.empty(len(rows), np.int64), np.empty(DEPTH, np.int64)
    for e in range(2 * len(rows)):
        if not offset_kernels.element(rows, angles, e, level, shape):
            continue
        u0, u1 = np.sort(rng.uniform(0, 1, 2)) if e % 3 else (0.0, 1.0)
        offset_trim_kernels.probe_piece(shape, u0, u1, probe)
        probe[9] = level - 1e-9
        points = np.array([offset_kernels.place(shape, u) for u in np.linspace(u0, u1, 101)])
        distance = np.stack([DistanceField.of(rows[[j]]).nearest(points)[0] for j in range(len(rows))])
        found = offset_trim_kernels.candidates(rows, field.boxes, *tree, e, probe, near, stack, -1)
        if found < 0:
            row, only_middle = divmod(-1 - found, 2)
            assert (distance[row, 50] if only_middle else distance[row].max()) < level
        else:
            assert set(np.flatnonzero(distance.min(axis=1) < level - 1e-8)) - {e} <= set(near[:found])


@pytest.mark.parametrize(("moved", "right"), [(0.0, True), (-1e-7, True), (-1e-6, False), (1e-6, False), (-0.5, False)])
def test_a_path_is_refused_where_it_comes_nearer_or_goes_farther_than_it_may(moved: float, right: bool) -> None:
    field = DistanceField.of(contour_rows(square(20)))
    path = contour_rows(square(18, 1, 1))
    path[0, 3] = path[1, 1] = path[0, 3] + moved  # one end of the first line, so that it slants
    answer = offset_clearance_kernels.measures_right(
        path, np.arange(4), field.rows, field.boxes, *tree_of(field), 1.0, 8e-7
    )
    assert answer == right


def test_a_path_is_refused_for_a_place_that_is_neither_joint_nor_middle() -> None:
    wall = np.concatenate([contour_rows(square(20)), contour_rows(square(0.2, 5, 1.7))])
    field, path = DistanceField.of(wall), contour_rows(square(18, 1, 1))
    ends_and_middles = np.concatenate([points_at(path, np.full(4, f)) for f in (0.0, 0.5)])
    assert field.nearest(ends_and_middles)[0] == pytest.approx(1.0)
    assert not offset_clearance_kernels.measures_right(
        path, np.arange(4), field.rows, field.boxes, *tree_of(field), 1.0, 8e-7
    )


def test_thousands_of_short_lines_cost_little_more_each_than_hundreds() -> None:
    """Rows looked at, not seconds: a piece has the two rows beside it to be cut with, however fine the outline is."""
    for count in (200, 4000):
        angle = np.arange(count) * 2 * np.pi / count
        ends = 50 * np.stack([np.cos(angle), np.sin(angle)], 1)
        rows = np.hstack([ends, np.roll(ends, -1, axis=0), np.zeros((count, 4))])
        field, angles = DistanceField.of(rows), np.empty((2 * count, 2))
        tree = tree_of(field)
        offset_kernels.element_angles(rows, np.roll(np.arange(count), 1), angles)
        shape, probe, near, stack = np.empty(6), np.empty(10), np.empty(count, np.int64), np.empty(DEPTH, np.int64)
        offset_kernels.element(rows, angles, 7, 30.0, shape)
        offset_trim_kernels.probe_piece(shape, 0.3, 0.7, probe)
        probe[9] = 30.0 - 1e-11
        assert offset_trim_kernels.candidates(rows, field.boxes, *tree, 7, probe, near, stack, -1) <= 4


def test_rings_of_a_finely_drawn_circle_are_all_there() -> None:
    angle = np.arange(3000) * 2 * np.pi / 3000
    ends = 50 * np.stack([np.cos(angle), np.sin(angle)], 1)
    rows = np.hstack([ends, np.roll(ends, -1, axis=0), np.zeros((3000, 4))])
    circle = Primitives(rows, np.roll(np.arange(3000), 1), np.ones(3000, np.int64))
    inner = 50 * np.cos(np.pi / 3000)
    for level in offset_levels(circle, [0.5, 20.0, 45.0, 49.9]):
        (ring,) = level.rings
        assert len(ring.rows) == 3000 and not ring.polyline
        assert ring.area == pytest.approx(3000 * (inner - level.distance) ** 2 * np.tan(np.pi / 3000), rel=1e-9)
