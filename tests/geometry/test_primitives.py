"""Rows of contours: computed once, and yet the caller's own."""

from __future__ import annotations

from dataclasses import replace

import pytest

from app.geometry.primitives import contour_rows
from app.model.curves import Arc, Circle, Line
from app.model.part import Contour
from app.model.stock_box import extent

HALF_DISC = Contour((Line((0.0, 0.0), (4.0, 0.0)), Arc((4.0, 0.0), (0.0, 0.0), (2.0, 0.0))))


def test_who_changes_rows_changes_nobody_elses() -> None:
    before = contour_rows(HALF_DISC)
    contour_rows(HALF_DISC)[:] = 7.0
    assert (contour_rows(HALF_DISC) == before).all()


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
