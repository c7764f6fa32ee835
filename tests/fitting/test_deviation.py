"""Samples of how far a curve and its polyline are apart, beside what the judge has proven."""

import numpy as np
import pytest

from app.fitting.line_arcs.arc_fit import ArcOptions, fit_arcs
from app.fitting.point_curves.deviation import curvature, deviation
from app.fitting.point_curves.space_curve import curve_of_motions, curve_of_points
from app.fitting.point_curves.tube import ToleranceTube, TubeAnswer, judge


def half_circle(radius: float, count: int) -> np.ndarray:
    angle = np.linspace(0.0, np.pi, count)
    return np.column_stack([radius * np.cos(angle), radius * np.sin(angle), np.zeros(count)])


def test_an_arc_is_a_sagitta_from_its_chords_and_nothing_from_its_points() -> None:
    points = half_circle(20.0, 31)
    curve = curve_of_motions(fit_arcs(points, ArcOptions(0.05, 0.6, 1e4, True)).motions)
    judgement = judge(curve, points, ToleranceTube(0.05))
    assert judgement.answer is TubeAnswer.INSIDE and judgement.feet is not None
    found = deviation(curve, points, judgement.feet)
    sagitta = 20.0 * (1 - np.cos(np.pi / 60))
    assert found.off.max() == pytest.approx(sagitta, rel=0.05), "the arc that is found is nearly the circle"
    assert found.off.max() <= judgement.bound
    assert found.off.max() >= 0.99 * max(judgement.from_curve, judgement.from_points)
    length = np.linalg.norm(np.diff(points, axis=0), axis=1).sum()
    assert found.along[0] == 0.0 and found.along[-1] == pytest.approx(length)
    assert np.all(np.diff(found.along) >= 0) and found.chord[0] == 0 and found.chord[-1] == 29
    assert np.allclose(np.linalg.norm(found.place, axis=1), 20.0, atol=0.05)


def test_what_is_the_polyline_itself_is_nowhere_off() -> None:
    points = np.array([[0.0, 0, 0], [10, 0, 0], [10, 5, 1]])
    found = deviation(curve_of_points(points), points, np.array([0.0, 1.0, 2.0]))
    assert found.off.max() < 1e-12


def test_at_its_foot_a_point_is_measured_and_not_its_chord() -> None:
    points = np.array([[0.0, 0, 0], [10, 0, 0], [20, 0, 0]])
    feet = np.array([0.0, 0.9, 2.0])
    found = deviation(curve_of_points(points), points, feet)
    assert found.off.max() == pytest.approx(1.0), "the foot is 1 mm before its point, though on the chord"


def test_curvature_points_to_the_centre_and_is_nought_on_lines() -> None:
    points = half_circle(20.0, 200)
    curve = curve_of_motions(fit_arcs(points, ArcOptions(0.01, 0.6, 1e4, True)).motions)
    places, bent = curvature(curve, 4)
    assert np.allclose(np.linalg.norm(bent, axis=1), 1 / 20, rtol=1e-2)
    assert np.all(np.einsum("ij,ij->i", places, bent) < 0)
    assert np.abs(curvature(curve_of_points(points[:2]), 4)[1]).max() < 1e-12
