"""Exact distance and even-odd counting against plain numpy."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.geometry.distance import DistanceField
from app.geometry.primitives import (
    boxes,
    contour_rows,
    lengths,
    points_at,
    sample,
    signed_area,
    sweeps,
    within_half_turn,
)
from tests import plain_distance
from tests.examples import examples
from tests.part_shapes import bulged, circle, random_part


@settings(max_examples=examples(30), deadline=None)
@given(st.integers(0, 10**6))
def test_nearest_equals_plain_distance(seed: int) -> None:
    contours, _ = random_part(seed)
    field = DistanceField.of(np.concatenate([contour_rows(c) for c in contours]))
    points = np.random.default_rng(seed).uniform(-35, 45, (500, 2))
    assert np.allclose(field.nearest(points)[0], plain_distance.distance(points, contours), atol=1e-9)


@settings(max_examples=examples(30), deadline=None)
@given(st.integers(0, 10**6))
def test_inside_equals_plain_even_odd(seed: int) -> None:
    contours, _ = random_part(seed)
    field = DistanceField.of(np.concatenate([contour_rows(c) for c in contours]))
    points = np.random.default_rng(seed).uniform(-35, 45, (500, 2))
    points = points[plain_distance.distance(points, contours) > 0.02]
    assert np.array_equal(field.inside(points), plain_distance.inside(points, contours))


def test_a_ray_through_vertices_and_tops_of_arcs_counts_once() -> None:
    field = DistanceField.of(contour_rows(circle(5)))
    assert field.inside(np.array([[0.0, 0.0], [-6.0, 0.0], [6.0, 0.0], [6.0, 5.0], [6.0, -5.0]])).tolist() == [
        True,
        *[False] * 4,
    ]


def test_a_ray_at_the_height_of_an_arc_that_begins_at_its_top_by_a_rounding_counts_it() -> None:
    # the foot of a letter: the circle's lowest place is a rounding above the end that both arcs share
    y = -503.3194909578027
    foot = [117.56552603719315, -503.2826111969591, 117.20294708640321, y, 117.20294708640323, -501.518725317278]
    next_to_it = [
        117.20294708640321,
        y,
        116.83676803790294,
        -503.28298108383683,
        117.20294708640321,
        -501.4649232512131,
    ]
    arcs = [[*foot, 1.8007656405247279, -1.0], [*next_to_it, 1.8545677065895916, -1.0]]
    closing = [116.83676803790294, -503.28298108383683, 117.56552603719315, -503.2826111969591, 0.0, 0.0, 0.0, 0.0]
    points = np.array([[300.0, y], [100.0, y], [117.2, y + 0.02], [117.2, y - 0.02]])
    field = DistanceField.of(np.array([*arcs, closing]))
    assert y - foot[5] < -arcs[0][6]  # else it is another case
    assert field.inside(points).tolist() == [False, False, True, False]
    level = np.column_stack([np.linspace(100.0, 300.0, 41), np.full(41, y)])
    assert not field.inside(level[np.abs(level[:, 0] - 117.2) > 1]).any()  # many on one line are asked together


def test_a_limit_cuts_the_search_short() -> None:
    field = DistanceField.of(contour_rows(circle(5)))
    distance, row = field.nearest(np.array([[0.0, 0.0], [4.0, 0.0]]), limit=2.0)
    assert distance.tolist() == pytest.approx([2.0, 1.0]) and row[0] == -1


def test_where_some_distance_is_enough_only_farther_ones_are_the_least() -> None:
    field = DistanceField.of(np.concatenate([contour_rows(c) for c in random_part(7)[0]]))
    points = np.random.default_rng(7).uniform(-35, 45, (5000, 2))
    exact, rows = field.nearest(points)
    for enough in (0.5, 3.0):
        found, some = field.nearest(points, enough=enough)
        far = exact > enough
        assert np.array_equal(found[far], exact[far]) and np.array_equal(some[far], rows[far])
        assert np.all((exact[~far] <= found[~far]) & (found[~far] <= enough))


def test_the_farthest_point_is_as_far_as_the_farthest_of_all_distances() -> None:
    field = DistanceField.of(np.concatenate([contour_rows(c) for c in random_part(7)[0]]))
    for count in (1, 300, 5000):
        points = np.random.default_rng(count).uniform(-35, 45, (count, 2))
        assert field.farthest(points) == field.nearest(points)[0].max()
    assert field.farthest(np.zeros((0, 2))) == 0.0


def test_area_and_length_in_closed_form() -> None:
    assert signed_area(contour_rows(circle(12))) == pytest.approx(np.pi * 144)
    assert float(lengths(contour_rows(circle(12))).sum()) == pytest.approx(24 * np.pi)
    half = contour_rows(bulged([(0, 0, 0), (10, 0, 1.0)]))  # half a disc of radius 5
    assert abs(signed_area(half)) == pytest.approx(np.pi * 12.5)


def test_boxes_hold_their_rows_tightly() -> None:
    rows = np.concatenate([contour_rows(c) for c in random_part(4)[0]])
    box = boxes(rows)
    along = np.stack([points_at(rows, np.full(len(rows), f)) for f in np.linspace(0, 1, 201)])
    assert np.all(along.min(0) >= box[:, :2] - 1e-9) and np.all(along.max(0) <= box[:, 2:] + 1e-9)
    assert np.abs(along.min(0) - box[:, :2]).max() < 0.01


def test_sampled_chords_stay_within_tolerance() -> None:
    points = sample(contour_rows(circle(10)), 0.01)
    middle = (points + np.roll(points, -1, axis=0)) / 2
    assert np.allclose(np.hypot(*points.T), 10) and np.hypot(*middle.T).min() >= 10 - 0.01


def test_full_turns_cut_up_keep_their_length_and_ends() -> None:
    turn = np.array([[5.0, 0, 5, 0, 0, 0, 5, 1], [0, 0, 3, 4, 0, 0, 0, 0], [0, 2, 2, 0, 0, 0, 2, 1]])
    cut = within_half_turn(turn)
    assert len(cut) == 3 + 1 + 2 and np.abs(sweeps(cut)).max() < np.pi
    assert float(lengths(cut).sum()) == pytest.approx(10 * np.pi + 5 + 3 * np.pi)
    assert DistanceField.of(cut).nearest(np.array([[0.0, -5.5]]))[0] == pytest.approx(0.5)


def test_many_points_on_two_cores_measure_as_few_do() -> None:
    field = DistanceField.of(np.concatenate([contour_rows(c) for c in random_part(4)[0]]))
    points = np.random.default_rng(0).uniform(-30, 30, (25_001, 2))
    distance, row = field.nearest(points, 9.0)
    for part in np.array_split(np.arange(len(points)), 7):
        few = field.nearest(points[part], 9.0)
        assert np.array_equal(distance[part], few[0]) and np.array_equal(row[part], few[1])


@settings(max_examples=examples(30), deadline=None)
@given(st.integers(0, 10**6))
def test_inside_is_the_same_for_many_points_on_a_line(seed: int) -> None:
    contours, _ = random_part(seed)
    field = DistanceField.of(np.concatenate([contour_rows(c) for c in contours]))
    ends = field.rows[:4, 1]  # lines through vertices too
    x, y = np.meshgrid(np.linspace(-35, 45, 60), np.append(np.linspace(-35, 45, 20), ends))
    points = np.column_stack([x.ravel(), y.ravel()])
    one_by_one = np.array([field.inside(point[None])[0] for point in points])
    assert np.array_equal(field.inside(points), one_by_one)
    assert one_by_one.any() and not one_by_one.all()
