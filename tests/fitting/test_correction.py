"""Corrected points: the text's own example, correction curves against scipy's, and how near the true shape they
come.
"""

import math
from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from app.core.errors import ParameterError
from app.fitting.point_curves import correction_kernels
from app.fitting.point_curves.correction import (
    CorrectionCurve,
    CorrectionMove,
    CorrectionOptions,
    CorrectionScope,
    corrected,
)
from app.fitting.point_curves.effective_points import EffectiveOptions, PointState, effective_points

Floats = NDArray[np.float64]
RADIUS = 25.0
E, V = PointState.EFFECTIVE, PointState.INVALID


def on_polygon(corners: Floats, each: int) -> Floats:
    """Points of a polygon's sides: its corners and so many on each side between."""
    sides = [a + np.linspace(0, 1, each + 1, endpoint=False)[:, None] * (b - a) for a, b in pairwise(corners)]
    return np.concatenate([*sides, corners[-1:]])


def circle(sides: int, rise: float = 0.0) -> Floats:
    """Corners on a circle, a helix if it rises; unevenly spaced."""
    turn = np.linspace(0, 2 * math.pi, sides + 1) + 0.02 * np.sin(np.arange(sides + 1))
    return np.column_stack((RADIUS * np.cos(turn), RADIUS * np.sin(turn), rise * turn))


def off_circle(points: Floats) -> float:
    return float(np.abs(np.hypot(points[:, 0], points[:, 1]) - RADIUS).max())


def test_the_example_of_the_text() -> None:
    """P(i-3), two before it and three after it, pick P(i-6), P(i-4), P(i-3), P(i), P(i+1) and P(i+3)."""
    effective = np.array([-9, -6, -4, -3, 0, 1, 3, 6]) + 9
    points = np.zeros((20, 3))
    points[:, 0] = np.arange(20)
    at, value, chosen = np.empty(6), np.empty((6, 3)), np.empty(6, np.int64)
    count = correction_kernels.choose(points, effective, np.zeros(8, np.bool_), 3, 2, 3, at, value, chosen)
    assert (effective[chosen[:count]] - 9).tolist() == [-6, -4, -3, 0, 1, 3]
    assert at.tolist() == [0, 2, 3, 6, 7, 9]


@pytest.mark.parametrize("count", [4, 5, 9])
def test_the_spline_is_that_of_scipy(count: int) -> None:
    rng = np.random.default_rng(count)
    at, value, slope = np.cumsum(rng.uniform(0.1, 2, count)), rng.normal(size=(count, 3)), np.empty((count, 3))
    correction_kernels.spline_slopes(at, value, slope)
    assert slope == pytest.approx(CubicSpline(at, value)(at, 1), abs=1e-11)


@pytest.mark.parametrize("count", [2, 3, 4, 6, 11])
def test_the_least_squares_cubic_is_that_of_numpy(count: int) -> None:
    rng = np.random.default_rng(count)
    at, value, slope = np.cumsum(rng.uniform(0.1, 2, count)), rng.normal(size=(count, 3)), np.empty((count, 3))
    whole = [np.polynomial.Polynomial.fit(at, row, min(3, count - 1)) for row in value.T]
    correction_kernels.least_squares(at, value, slope)
    assert value == pytest.approx(np.column_stack([fit(at) for fit in whole]), abs=1e-9)
    assert slope == pytest.approx(np.column_stack([fit.deriv()(at) for fit in whole]), abs=1e-8)


@pytest.mark.parametrize("rise", [0.0, 3.0])
@pytest.mark.parametrize("move", list(CorrectionMove))
def test_points_of_a_polygon_come_back_to_its_circle(move: CorrectionMove, rise: float) -> None:
    """Sides of 3.9 mm lie 77 um off the circle; corrected, their points are within a tenth of a micrometre of it, but
    at the ends.
    """
    points = on_polygon(circle(40, rise), 6)
    state = effective_points(points, EffectiveOptions(1e-6)).state
    assert off_circle(points) > 0.07
    assert off_circle(points[state == E]) < 1e-12
    after = corrected(points, state, CorrectionOptions(move=move))
    assert after.passed.tolist() == list(range(len(points)))
    assert off_circle(after.places[20:-20]) < 1e-4
    assert off_circle(after.places) < 1e-3
    assert after.moved == pytest.approx(np.linalg.norm(after.places - points, axis=1), abs=1e-15)
    if move == CorrectionMove.PERPENDICULAR:
        chords = np.diff(points[state == E], axis=0)[
            np.searchsorted(np.flatnonzero(state == E), np.flatnonzero(state == V)) - 1
        ]
        assert np.abs(np.einsum("ij,ij->i", (after.places - points)[state == V], chords)).max() < 1e-9


def test_final_curves_of_both_embodiments_keep_to_the_circle() -> None:
    """The spline through all points swings with the polygon's sides; those of S12 are a hundredfold nearer."""

    def off_along(places: Floats) -> float:
        at = np.concatenate(([0.0], np.cumsum(np.linalg.norm(np.diff(places, axis=0), axis=1))))
        return off_circle(CubicSpline(at, places)(np.linspace(0, at[-1], 100_001)))

    points = on_polygon(circle(40), 6)
    found = effective_points(points, EffectiveOptions(1e-6))
    second = corrected(points, found.state, CorrectionOptions(0.3))
    assert off_along(points) > 0.09
    assert off_along(points[found.passed]) < 1e-3
    assert off_along(second.places[second.passed]) < 1e-3


def test_effective_points_move_by_least_squares_alone() -> None:
    """Corners that lie off a circle by noise: the curve through them keeps them, the one near them brings them
    nearer.
    """
    corners = circle(240)
    corners[1:-1, :2] *= 1 + 4e-4 * np.random.default_rng(1).normal(size=(239, 1))
    points = on_polygon(corners, 4)
    state = effective_points(points, EffectiveOptions(1e-9)).state
    options = {"before": 6, "after": 7}
    through = corrected(points, state, CorrectionOptions(**options, curve=CorrectionCurve.THROUGH))  # type: ignore[arg-type]
    near = corrected(points, state, CorrectionOptions(**options, curve=CorrectionCurve.NEAR))  # type: ignore[arg-type]
    assert through.moved[state == E].max() < 1e-9
    assert near.moved[state == E].max() > 1e-3
    assert near.moved[[0, -1]].tolist() == [0, 0]

    def spread(places: Floats) -> float:
        return float(np.std(np.hypot(*places[:, :2].T)))

    assert spread(near.places[state == E]) < 0.7 * spread(through.places[state == E])


def test_which_points_are_corrected() -> None:
    points = on_polygon(circle(40)[:, :2], 9)
    state = effective_points(points, EffectiveOptions(1e-6)).state
    by_share = corrected(points, state, CorrectionOptions(0.25))
    assert np.bincount(by_share.state).tolist() == [40 * 5, 41, 40 * 4]
    every = corrected(points, state, CorrectionOptions(1.0, CorrectionScope.DISTANCE))
    by_move = corrected(points, state, CorrectionOptions(0.05, CorrectionScope.DISTANCE))
    assert by_move.places.shape == points.shape
    assert (by_move.state == V).tolist() == (every.moved > 0.05).tolist()
    assert 0 < (by_move.state == V).sum() < (state == V).sum()
    assert (by_move.places[by_move.state == V] == points[by_move.state == V]).all()
    assert by_move.moved[by_move.state == V].max() == 0


@pytest.mark.parametrize(("curve", "off"), [(CorrectionCurve.THROUGH, 1e-3), (CorrectionCurve.NEAR, 4e-3)])
def test_a_kept_corner_stays_and_bends_nothing(curve: CorrectionCurve, off: float) -> None:
    """A quarter circle and the straight side after it: the corner between them is kept, the side stays straight."""
    arc = circle(40)[:11]
    side = arc[-1] + np.linspace(0, 30, 11)[1:, None] * [0.0, 1, 0]
    points, corner = on_polygon(np.concatenate([arc, side]), 4), 50
    state = effective_points(points, EffectiveOptions(1e-6), kept=[corner]).state
    kept = corrected(points, state, CorrectionOptions(curve=curve), kept=[corner])
    assert kept.moved[corner] == 0
    assert kept.moved[corner:].max() < 1e-9
    assert off_circle(kept.places[: corner + 1]) < off
    assert off_circle(corrected(points, state, CorrectionOptions(curve=curve)).places[: corner + 1]) > 0.01


def test_equal_and_few_points() -> None:
    points = np.repeat(circle(12), 2, axis=0)
    after = corrected(points, np.full(len(points), E, np.uint8), CorrectionOptions())
    assert np.isfinite(after.places).all()
    assert after.moved.max() < 1e-9
    pair = corrected(
        np.array([[0.0, 0], [1, 0]]), np.array([E, E], np.uint8), CorrectionOptions(curve=CorrectionCurve.NEAR)
    )
    assert pair.moved.tolist() == [0, 0]


@pytest.mark.parametrize(
    "make",
    [
        lambda: CorrectionOptions(before=-1),
        lambda: CorrectionOptions(after=0),
        lambda: CorrectionOptions(after=51),
        lambda: CorrectionOptions(1.1),
        lambda: CorrectionOptions(-1.0, CorrectionScope.DISTANCE),
        lambda: CorrectionOptions(math.nan),
        lambda: corrected(circle(5), np.array([E, E, E, E, E, V], np.uint8), CorrectionOptions()),
    ],
)
def test_bad_parameters_are_named(make: Callable[[], object]) -> None:
    with pytest.raises(ParameterError, match="must be"):
        make()
