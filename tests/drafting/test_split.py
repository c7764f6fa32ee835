"""Pieces of curves: together they are the curve."""

import math
from itertools import pairwise

import numpy as np
import pytest

from app.drafting.commands.split import split
from app.drafting.curves.intersections import intersection_points, nearest_point
from app.drafting.curves.shapes import curve_length
from app.geometry.sample import sample
from app.model.curves import Arc, Circle, Curve, Ellipse, Line, Spline

SPLINE = Spline(3, ((0, 0), (10, 20), (20, -20), (30, 10), (40, 0)), (0, 0, 0, 0, 0.4, 1, 1, 1, 1))
RATIONAL = Spline(2, ((5, 0), (5, 5), (0, 5)), (0, 0, 0, 1, 1, 1), (1, math.sqrt(0.5), 1))
CURVES: list[Curve] = [
    Line((0, 0), (30, 10)),
    Arc((20, 0), (0, 20), (0, 0)),
    Arc((0, 20), (20, 0), (0, 0), ccw=False),
    Arc((20, 0), (0, -20), (0, 0)),
    Ellipse((0, 0), (30, 5), 0.5, 0.2, 4.0),
    Ellipse((0, 0), (30, 5), 0.5, 0.2, 4.0, ccw=False),
    SPLINE,
    RATIONAL,
]


def points_on(curve: Curve, *shares: float) -> list[tuple[float, float]]:
    points = sample(curve)
    return [tuple(map(float, points[round(share * (len(points) - 1))])) for share in shares]  # type: ignore[misc]


@pytest.mark.parametrize("curve", CURVES, ids=lambda c: type(c).__name__)
def test_pieces_join_and_have_the_whole_length(curve: Curve) -> None:
    points = [(15.0, 5.0), (6.0, 2.0)] if isinstance(curve, Line) else points_on(curve, 0.7, 0.3)
    pieces = split(curve, [points[0], curve.start, points[1], points[1], curve.end])
    assert len(pieces) == 3
    assert all(math.dist(a.end, b.start) < 1e-9 for a, b in pairwise(pieces))
    assert math.dist(pieces[0].start, curve.start) < 1e-9 and math.dist(pieces[-1].end, curve.end) < 1e-9
    assert math.dist(pieces[0].end, points[1]) < 1e-6 and math.dist(pieces[1].end, points[0]) < 1e-6
    assert sum(map(curve_length, pieces)) == pytest.approx(curve_length(curve), rel=3e-3)  # of samples
    far = max(
        math.dist(nearest_point(curve, (float(x), float(y))), (x, y)) for piece in pieces for x, y in sample(piece)[::5]
    )
    assert far < 1e-7


@pytest.mark.parametrize("whole", [Circle((0, 0), 10), Circle((0, 0), 10, ccw=False), Ellipse((0, 0), (10, 0), 0.5)])
def test_what_is_closed_needs_two_points(whole: Curve) -> None:
    assert split(whole, [(10, 0)]) == (whole,)
    pieces = split(whole, [(10, 0), (-10, 0), (10, 0)])
    assert len(pieces) == 2
    assert all(math.dist(a.end, b.start) < 1e-9 for a, b in zip(pieces, (pieces[1], pieces[0]), strict=True))
    ccw = getattr(whole, "ccw", True)
    high = next(p for p in pieces if sample(p)[len(sample(p)) // 2][1] > 0)
    assert (high.start[0] > 0) is ccw


def test_points_on_either_side_of_where_angles_begin_again_are_one() -> None:
    """A circle's angles go round from pi to -pi; two points a nanometre apart there cut it once with a third one, not
    into a hair.
    """
    pieces = split(Circle((0, 0), 10), [(-10.0, 3e-8), (-10.0, -3e-8), (10.0, 0.0)])
    assert [curve_length(piece) for piece in pieces] == pytest.approx([10 * math.pi] * 2)
    assert len(split(Circle((0, 0), 10), [(-10.0, 3e-8), (-10.0, -3e-8)])) == 1


@pytest.mark.parametrize(
    ("a", "b", "count"),
    [
        (Line((0, 0), (10, 0)), Line((5, -5), (5, 5)), 1),
        (Line((0, 0), (4, 0)), Line((5, -5), (5, 5)), 0),
        (Line((-20, 3), (20, 3)), Circle((0, 0), 5), 2),
        (Line((-20, 5), (20, 5)), Circle((0, 0), 5), 1),
        (Circle((0, 0), 5), Circle((6, 0), 4), 2),
        (Circle((0, 0), 5), Circle((9, 0), 4), 1),
        (Circle((0, 0), 5), Circle((1, 0), 1), 0),
        (Arc((5, 0), (0, 5), (0, 0)), Line((0, 0), (-9, -9)), 0),
        (Arc((5, 0), (0, 5), (0, 0)), Line((0, 0), (9, 9)), 1),
        (SPLINE, Line((0, 0.5), (40, 0.5)), 4),
        (Ellipse((0, 0), (10, 0), 0.5), Circle((0, 0), 7), 4),
        (SPLINE, Ellipse((20, 0), (15, 0), 0.3), 2),
        (RATIONAL, Line((0, 0), (9, 9)), 1),
        (Line((0, 0), (9, 0)), Line((0, 0), (9, 0)), 0),
    ],
)
def test_places_where_curves_meet_lie_on_both(a: Curve, b: Curve, count: int) -> None:
    for one, other in ((a, b), (b, a)):
        found = intersection_points(one, other)
        assert len(found) == count
        assert all(math.dist(nearest_point(curve, p), p) < 1e-7 for curve in (a, b) for p in found)


def test_the_rational_arc_is_met_where_the_arc_is() -> None:
    arc = Arc((5, 0), (0, 5), (0, 0))
    line = Line((0, 1), (9, 4))
    assert np.array(intersection_points(RATIONAL, line)) == pytest.approx(
        np.array(intersection_points(arc, line)), abs=1e-9
    )


def test_lines_extended_meet_beyond_their_ends() -> None:
    assert intersection_points(Line((0, 0), (1, 0)), Line((5, 1), (5, 2)), extended=True) == [(5, 0)]
