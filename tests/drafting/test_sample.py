"""Points along curves and boxes round them."""

import math

import numpy as np
import pytest
from scipy.interpolate import BSpline

from app.geometry.sample import bounds, bounds_of_all, sample, spline_points, union
from app.model.curves import Arc, Circle, Curve, Ellipse, Line, Spline

CURVES: list[Curve] = [
    Line((1, 2), (5, -3)),
    Arc((10, 0), (0, 10), (0, 0)),
    Arc((10, 0), (0, 10), (0, 0), ccw=False),
    Circle((3, 4), 2.5),
    Ellipse((1, 1), (6, 2), 0.4),
    Ellipse((0, 0), (5, 0), 0.5, 0.3, 2.0, ccw=False),
    Spline(3, ((0, 0), (1, 5), (4, 5), (6, 0), (9, 3)), (0, 0, 0, 0, 0.5, 1, 1, 1, 1)),
]


@pytest.mark.parametrize("curve", CURVES, ids=lambda c: type(c).__name__)
def test_samples_run_from_start_to_end(curve: Curve) -> None:
    points = sample(curve)
    assert tuple(points[0]) == pytest.approx(curve.start)
    assert tuple(points[-1]) == pytest.approx(curve.end)


@pytest.mark.parametrize("curve", CURVES, ids=lambda c: type(c).__name__)
def test_bounds_hold_the_samples_and_no_more(curve: Curve) -> None:
    points, box = sample(curve), bounds(curve)
    found = (*points.min(axis=0), *points.max(axis=0))
    size = max(box[2] - box[0], box[3] - box[1])
    assert found == pytest.approx(box, abs=2e-3 * size)
    assert all(found[k] >= box[k] - 1e-9 for k in (0, 1)) and all(found[k] <= box[k] + 1e-9 for k in (2, 3))


def test_an_arc_reaches_to_the_quadrants_it_passes() -> None:
    assert bounds(Arc((10, 0), (0, 10), (0, 0), ccw=False)) == pytest.approx((-10, -10, 10, 10))
    half = math.sqrt(0.5)
    assert bounds(Arc((half, half), (-half, half), (0, 0))) == pytest.approx((-half, half, half, 1))


def test_splines_equal_scipys() -> None:
    spline = CURVES[-1]
    assert isinstance(spline, Spline)
    t = np.linspace(0, 1, 33)
    expected = BSpline(np.array(spline.knots), np.array(spline.control_points, float), 3)(t)
    assert np.abs(spline_points(spline, t) - expected).max() < 1e-12


def test_a_weighted_spline_can_be_a_circle() -> None:
    h = math.sqrt(0.5)
    quarter = Spline(2, ((1, 0), (1, 1), (0, 1)), (0, 0, 0, 1, 1, 1), (1, h, 1))
    assert np.abs(np.hypot(*sample(quarter).T) - 1).max() < 1e-12


def test_the_box_of_many_curves_is_the_union_of_theirs() -> None:
    """Splines of which some bulge out of all others, and a rational one whose hull a weight below zero leaves."""
    rng = np.random.default_rng(4)
    knots = (0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0)
    for count in (1, 2, 30):
        places = rng.uniform(0, 50, (count, 1, 2)) + rng.normal(0, 6, (count, 4, 2))
        splines = [Spline(3, tuple((float(x), float(y)) for x, y in each), knots) for each in places]
        curves = [Line((20.0, 20.0), (30.0, 25.0)), *splines]
        assert bounds_of_all(curves) == pytest.approx(union([bounds(curve) for curve in curves]), abs=1e-12)
    outward = Spline(2, ((0.0, 0.0), (1.0, 1.0), (2.0, 0.0)), (0.0, 0.0, 0.0, 1.0, 1.0, 1.0), (1.0, -0.5, 1.0))
    frame = [Line((-1.0, -0.5), (3.0, -0.5)), Line((-1.0, 1.0), (3.0, 1.0))]
    assert bounds_of_all([*frame, outward]) == union([bounds(curve) for curve in (*frame, outward)])
    assert bounds_of_all([]) is None
