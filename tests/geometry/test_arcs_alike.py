"""Splines that are alike: the arcs of the first, moved, are as near to each as is told."""

from __future__ import annotations

import math

import numpy as np
import pytest

from app.geometry.arcs.alike import arcs_of_all
from app.geometry.arcs.arcs import LinesAndArcs, lines_and_arcs
from app.geometry.arcs.bezier import pieces_of
from app.geometry.distance import DistanceField
from app.geometry.primitives import contour_rows
from app.model.curves import Arc, Circle, Spline
from app.model.part import Contour

WAVE = [(0.0, 0.0), (3.0, 5.0), (6.0, -4.0), (9.0, 1.0)]


def spline(points: list[tuple[float, float]], dx: float = 0.0, dy: float = 0.0) -> Spline:
    degree = len(points) - 1
    return Spline(degree, tuple((x + dx, y + dy) for x, y in points), (0.0,) * (degree + 1) + (1.0,) * (degree + 1))


@pytest.mark.parametrize("away", [(17.3, -8.1), (9123.4, 77.7)])
def test_moved_arcs_join_keep_the_ends_and_hold_their_bound(away: tuple[float, float]) -> None:
    curve = spline(WAVE, *away)
    first, made = arcs_of_all([spline(WAVE), curve])
    assert isinstance(first, LinesAndArcs) and isinstance(made, LinesAndArcs)
    assert len(made.primitives) == len(first.primitives) > 3
    assert made.primitives[0].start == curve.start and made.primitives[-1].end == curve.end
    for one, other in zip(made.primitives, made.primitives[1:], strict=False):
        assert one.end == other.start
    for each in made.primitives:
        if isinstance(each, Arc):
            assert math.dist(each.centre, each.end) == pytest.approx(math.dist(each.centre, each.start), abs=1e-8)
    points, _ = pieces_of(curve).at(np.linspace(0, 1, 2001))
    off = DistanceField.of(contour_rows(Contour(made.primitives, False))).nearest(points)[0]
    assert off.max() <= made.deviation <= first.deviation + 1e-8


def test_what_is_a_little_different_gets_arcs_of_its_own() -> None:
    other = spline([*WAVE[:3], (9.0, 1.00001)])
    assert arcs_of_all([spline(WAVE), other])[1] == lines_and_arcs(other)


def test_what_is_made_does_not_depend_on_how_many_cores_work_on_it() -> None:
    curves = [spline([*WAVE[:3], (9.0, 1.0 + k % 70 / 100)], 20.0 * k) for k in range(150)]
    assert arcs_of_all(curves)[:70] == [lines_and_arcs(curve) for curve in curves[:70]]
    assert arcs_of_all(curves)[70:80] == arcs_of_all(curves[:80])[70:]


def test_a_round_spline_is_a_circle_in_each_place() -> None:
    s = math.sqrt(0.5)
    points = ((1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (-1.0, 1.0), (-1.0, 0.0), (-1.0, -1.0), (0.0, -1.0), (1.0, -1.0))
    knots = (0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 3.0, 3.0, 4.0, 4.0, 4.0)
    places = (0.0, 5.0)
    round_ones = [
        Spline(2, tuple((x + dx, y) for x, y in (*points, points[0])), knots, (1.0, s) * 4 + (1.0,)) for dx in places
    ]
    for dx, made in zip(places, arcs_of_all(round_ones), strict=True):
        assert isinstance(made, LinesAndArcs)
        (circle,) = made.primitives
        assert (
            isinstance(circle, Circle)
            and circle.centre == pytest.approx((dx, 0.0))
            and circle.radius == pytest.approx(1)
        )
