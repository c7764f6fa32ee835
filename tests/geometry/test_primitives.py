"""Rows of contours: computed once, and yet the caller's own."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from app.geometry.primitives import (
    contour_rows,
    fraction_on,
    lengths,
    path_length,
    point_on,
    points_at,
    rows_of_each,
    sweep_of,
    sweeps,
)
from app.model.curves import Arc, Circle, Line
from app.model.part import Contour
from app.model.stock_box import extent
from app.toolpath.linking.bridge import fractions_at

HALF_DISC = Contour((Line((0.0, 0.0), (4.0, 0.0)), Arc((4.0, 0.0), (0.0, 0.0), (2.0, 0.0))))


def test_who_changes_rows_changes_nobody_elses() -> None:
    before = contour_rows(HALF_DISC)
    contour_rows(HALF_DISC)[:] = 7.0
    assert (contour_rows(HALF_DISC) == before).all()


def test_rows_of_many_contours_are_those_of_each() -> None:
    shapes = [HALF_DISC, Contour((Circle((1.0, 1.0), 3.0),)), Contour(()), replace(HALF_DISC, layer="b"), HALF_DISC]
    found = rows_of_each([replace(each) for each in shapes])
    for rows, shape in zip(found, shapes, strict=True):
        np.testing.assert_array_equal(rows, contour_rows(replace(shape)))


def test_a_contour_made_from_another_has_rows_and_an_extent_of_its_own() -> None:
    assert len(contour_rows(HALF_DISC)) == 3
    assert extent([HALF_DISC]) == pytest.approx((0.0, 0.0, 4.0, 2.0))
    other = replace(HALF_DISC, primitives=(Circle((1.0, 1.0), 3.0),))
    assert contour_rows(other)[:, 6] == pytest.approx(3.0)
    assert extent([HALF_DISC, other]) == pytest.approx((-2.0, -2.0, 4.0, 4.0))


@pytest.mark.parametrize(
    ("start", "end", "ccw", "top"),
    [
        ((1.0, 3.0), (3.0, 1.0), False, 3.0),
        ((1.0, 3.0), (3.0, 1.0), True, 10**0.5),
        ((3.0, 1.0), (1.0, 3.0), True, 3.0),
        ((3.0, 1.0), (1.0, 3.0), False, 10**0.5),
    ],
)
def test_an_arc_within_a_quadrant_reaches_no_farther_than_its_ends_and_the_rest_of_its_circle_does(
    start: tuple[float, float], end: tuple[float, float], ccw: bool, top: float
) -> None:
    box = extent([Contour((Arc(start, end, (0.0, 0.0), ccw),), closed=False)])
    assert box is not None and box[3] == pytest.approx(top)


@pytest.mark.parametrize("seed", range(20))
def test_one_row_measures_as_many_do(seed: int) -> None:
    rng = np.random.default_rng(seed)
    ends, turn = rng.uniform(-9, 9, (12, 4)), rng.choice([-1.0, 0.0, 1.0], 12)
    middle, across = (ends[:, :2] + ends[:, 2:]) / 2, (ends[:, 2:] - ends[:, :2]) @ np.array([[0.0, 1.0], [-1.0, 0.0]])
    centre = np.where(turn[:, None] == 0, 0.0, middle + across * rng.uniform(-2, 2, (12, 1)))
    radius = np.where(turn == 0, 0.0, np.hypot(*(ends[:, :2] - centre).T))
    rows = np.column_stack([ends, centre, radius, turn])
    parts, places = rng.uniform(0, 1, 12), rng.uniform(-9, 9, (12, 2))
    parts[0] = 0.0
    each = rows.tolist()
    assert [sweep_of(row) for row in each] == pytest.approx(sweeps(rows))
    assert np.array([point_on(row, part) for row, part in zip(each, parts.tolist(), strict=True)]) == pytest.approx(
        points_at(rows, parts)
    )
    assert [fraction_on(row, (x, y)) for row, (x, y) in zip(each, places.tolist(), strict=True)] == pytest.approx(
        fractions_at(rows, places)
    )
    assert path_length(rows[:5]) == pytest.approx(lengths(rows[:5]).sum()) and path_length(rows[:0]) == 0
    assert path_length(rows) == pytest.approx(lengths(rows).sum())
