"""Least-squares splines: few spans, proven in their tube, smooth inside, corners kept."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.interpolate import BSpline

from app.fitting.point_curves.bspline import SplineFit, fit_spline
from app.fitting.point_curves.proven_curve import SplineOptions, fit_splines
from app.fitting.point_curves.smoothness import joints_of
from app.fitting.point_curves.space_curve import curve_of_motions, curve_of_nurbs
from app.fitting.point_curves.tube import ToleranceTube, TubeAnswer, judge
from app.model.motion import MotionKind, Nurbs
from tests.fitting.test_tube import off_chords

Floats = NDArray[np.float64]


def circle(count: int, radius: float = 50.0) -> Floats:
    angle = np.linspace(0, 2 * np.pi, count + 1)
    return np.column_stack([radius * np.cos(angle), radius * np.sin(angle), 0 * angle])


def wave(count: int) -> Floats:
    a = np.linspace(0, 20, count + 1)
    r = 40 + 5 * np.sin(3 * a / 7) + 2 * np.cos(a * 1.3)
    return np.column_stack([r * np.cos(a), r * np.sin(a), 3 * np.sin(a / 2)])


def fitted(points: Floats, tube: ToleranceTube, degree: int = 3) -> SplineFit:
    fit = fit_spline(points, tube, degree)
    assert isinstance(fit, SplineFit), f"it asks for corners at {fit}"
    return fit


def test_ten_thousand_chords_of_a_circle_are_at_most_ten_spans() -> None:
    points = circle(10_000)
    fit = fitted(points, ToleranceTube(0.05))
    curve = curve_of_nurbs(fit.curve)
    assert len(curve) <= 10
    judgement = judge(curve, points, ToleranceTube(0.05))
    assert judgement.answer is TubeAnswer.INSIDE
    radii = np.linalg.norm(curve.at(np.linspace(0, len(curve), 1_000_001))[:, :2], axis=1)
    assert np.abs(radii - 50).max() <= judgement.bound


@pytest.mark.parametrize("degree", [3, 5])
@pytest.mark.parametrize("tube", [ToleranceTube(0.05), ToleranceTube(0.004), ToleranceTube(0.01, 0.05)])
def test_a_million_samples_find_nothing_outside_of_what_is_stated(degree: int, tube: ToleranceTube) -> None:
    points = wave(3000)
    fit = fitted(points, tube, degree)
    curve = curve_of_nurbs(fit.curve)
    judgement = judge(curve, points, tube, fit.feet)
    assert judgement.answer is TubeAnswer.INSIDE and judgement.bound <= tube.widest
    feet = judgement.feet
    assert feet is not None
    for k in range(len(points) - 1):  # in order: each stretch beside its own chord
        places = curve.at(np.linspace(feet[k], feet[k + 1], 333))
        assert off_chords(places, points[k : k + 2]).max() <= judgement.bound + 1e-9
    assert len(curve) < len(points) / 25


@pytest.mark.parametrize("degree", [3, 5])
def test_inside_it_is_smooth_and_its_ends_are_the_points(degree: int) -> None:
    points = wave(2000)
    curve = fitted(points, ToleranceTube(0.01), degree).curve
    assert np.array_equal(curve.points[[0, -1]], points[[0, -1]])
    inner = curve.knots[degree + 1 : -degree - 1]
    assert len(np.unique(inner)) == len(inner), "a knot that comes twice breaks the smoothness"
    spline = BSpline(curve.knots, curve.points, degree)
    for order in range(degree):
        slope = spline.derivative(order)
        jump = np.abs(slope(inner - 1e-9) - slope(inner + 1e-9)).max()
        assert jump <= 1e-4 * max(1.0, np.abs(slope(inner)).max())


def test_noise_below_the_tolerance_costs_few_spans() -> None:
    rng = np.random.default_rng(1)
    clean = wave(5000)
    plain = len(curve_of_nurbs(fitted(clean, ToleranceTube(0.05)).curve))
    noisy = len(curve_of_nurbs(fitted(clean + rng.uniform(-0.005, 0.005, clean.shape), ToleranceTube(0.05)).curve))
    assert noisy <= 2 * plain


def test_corners_are_kept_exactly_and_crumbs_make_none() -> None:
    leg = np.linspace(0, 10, 200)[:, None]
    up = np.hstack([leg, 0.3 * np.sin(leg), 0 * leg])
    path = np.vstack(
        [up, up[-1] + np.array([0, 1e-4, 0]), up[-1] + np.hstack([0.3 * np.sin(leg[1:]), leg[1:], 0 * leg[1:]])]
    )
    made = fit_splines(path, SplineOptions(ToleranceTube(0.02)))
    corner = np.abs(made.motions.end - up[-1]).max(axis=1)
    assert corner.min() <= 2e-4
    assert len(made.motions) <= 4
    assert judge(curve_of_motions(made.motions), path, ToleranceTube(0.02)).answer is TubeAnswer.INSIDE


def test_chords_stand_where_a_spline_would_take_more_blocks() -> None:
    rng = np.random.default_rng(3)
    points = np.cumsum(rng.normal(0, 1, (60, 3)), axis=0)
    made = fit_splines(points, SplineOptions(ToleranceTube(1e-3), corner=np.pi))
    assert judge(curve_of_motions(made.motions), points, ToleranceTube(1e-3)).answer is TubeAnswer.INSIDE
    blocks = sum(len(curve.points) for curve in made.motions.splines.values()) + int(
        np.sum(made.motions.kind == MotionKind.LINE)
    )
    assert blocks <= len(points) - 1


def test_adversaries_end_and_are_proven() -> None:
    angle = np.linspace(0, 4 * np.pi, 1500)
    cases = {
        "eight": np.column_stack([10 * np.sin(angle), 5 * np.sin(2 * angle), 0 * angle]),
        "helix": np.column_stack([10 * np.cos(angle), 10 * np.sin(angle), angle]),
        "quantised": np.round(circle(2000, 10.0), 2),
        "noisy line": np.column_stack(
            [np.linspace(0, 100, 3000), np.random.default_rng(0).uniform(-0.004, 0.004, 3000), np.zeros(3000)]
        ),
        "reversal": np.array([[0, 0, 0], [10, 0, 0], [0, 0, 0], [10, 0.0, 0]]),
        "zigzag": np.column_stack([np.arange(500) * 0.002, (np.arange(500) % 2) * 0.001, np.zeros(500)]),
        "ten um": np.column_stack([np.arange(4000) * 0.01, np.sin(np.arange(4000) * 0.001), np.zeros(4000)]),
    }
    for name, points in cases.items():
        kept = np.concatenate([[True], np.any(np.diff(points, axis=0) != 0, axis=1)])
        points = np.ascontiguousarray(points[kept])
        made = fit_splines(points, SplineOptions(ToleranceTube(0.01)))
        assert judge(curve_of_motions(made.motions), points, ToleranceTube(0.01)).answer is TubeAnswer.INSIDE, name
        assert len(made.motions) <= len(points) - 1, name


@pytest.mark.parametrize("tolerance", [0.01, 0.05])
def test_a_dense_wave_is_one_spline_of_few_spans(tolerance: float) -> None:
    """In narrow places samples' places draw away from one another; the curve between them must not be left without
    hold.
    """
    t = np.linspace(0, 2 * np.pi, 100_001)
    r = 60 + 4 * np.sin(9 * t) + 0.8 * np.sin(31 * t)
    points = np.round(np.column_stack([r * np.cos(t), r * np.sin(t), 0 * t]), 4)
    curve = fitted(points, ToleranceTube(tolerance)).curve
    assert len(curve.points) <= {0.01: 200, 0.05: 150}[tolerance]


def derivatives(curve: Nurbs, at: float) -> list[np.ndarray]:
    """Place, unit tangent and curvature vector, by scipy."""
    spline = BSpline(curve.knots, curve.points, curve.degree)
    place, first, second = (spline(at, nu) for nu in range(3))
    speed = np.linalg.norm(first)
    return [place, first / speed, (second - first * (first @ second) / speed**2) / speed**2]


@pytest.mark.parametrize("degree", [3, 5])
@pytest.mark.parametrize("insist", [False, True])
def test_a_long_run_is_fitted_in_pieces_that_join_with_one_direction_and_one_curvature(
    degree: int, insist: bool
) -> None:
    turn = np.linspace(0.0, 9.0, 1501)
    points = np.column_stack([40 * np.cos(turn), 25 * np.sin(turn), 3 * np.sin(2 * turn)])
    options = SplineOptions(ToleranceTube(0.01), degree, insist=insist)
    whole, made = fit_splines(points, options), fit_splines(points, replace(options, longest=400))
    assert len(whole.motions) == 1 and len(made.motions) == 4 and made.last.tolist() == [375, 750, 1125, 1500]
    curves = [made.motions.splines[k] for k in range(4)]
    for before, behind in pairwise(curves):
        ends = derivatives(before, before.knots[-1]), derivatives(behind, behind.knots[0])
        for one, other, within in zip(*ends, (1e-12, 1e-9, 1e-7), strict=True):
            assert np.linalg.norm(one - other) < within
    assert all(joint.bend < 1e-6 and joint.curvature_step < 1e-6 for joint in joints_of(curve_of_motions(made.motions)))
    assert judge(curve_of_motions(made.motions), points, options.tube).answer is TubeAnswer.INSIDE
    assert sum(len(each.points) for each in curves) < 2 * len(whole.motions.splines[0].points)
