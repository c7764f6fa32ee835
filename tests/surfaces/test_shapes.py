"""Analytic surfaces lie on their equations, all over, and are whole."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.model.scene_shapes import (
    BicubicShape,
    BilinearShape,
    BsplineShape,
    ConeShape,
    CylinderShape,
    PlaneShape,
    SphereShape,
    TorusShape,
)
from tests.examples import examples
from tests.surfaces.surface_places import anywhere, built, places, spline_of

CLOSE = 1e-12


@pytest.mark.parametrize("size", [0.01, 1.0, 500.0])
def test_a_sphere(size: float) -> None:
    found = anywhere(spline_of(SphereShape((1.0, -2.0, 3.0), size))) - (1.0, -2.0, 3.0)
    assert np.abs(np.linalg.norm(found, axis=1) - size).max() <= CLOSE * max(size, 4.0)
    assert np.ptp(found, axis=0) == pytest.approx([2 * size] * 3, rel=0.02)


@pytest.mark.parametrize("axis", [(0.0, 0.0, 1.0), (1.0, 2.0, -0.5), (0.0, 3.0, 0.0)])
def test_a_torus(axis: tuple[float, float, float]) -> None:
    found = anywhere(spline_of(TorusShape((5.0, 6.0, 7.0), 10.0, 3.0, axis))) - (5.0, 6.0, 7.0)
    up = np.array(axis) / np.linalg.norm(axis)
    high = found @ up
    out = np.linalg.norm(found - high[:, None] * up, axis=1)
    assert np.abs(np.hypot(out - 10, high) - 3).max() <= CLOSE * 13


def test_a_lying_half_cylinder_is_the_upper_one() -> None:
    found = anywhere(spline_of(CylinderShape((0.0, 0.0, 2.0), (10.0, 0.0, 2.0), 4.0, (-90.0, 90.0))))
    assert np.abs(np.hypot(found[:, 1], found[:, 2] - 2) - 4).max() <= CLOSE * 10
    assert found[:, 2].min() >= 2 - CLOSE * 10
    assert np.ptp(found[:, 0]) == 10


def test_turns_of_an_upright_cylinder_count_from_x() -> None:
    found = anywhere(spline_of(CylinderShape((0.0, 0.0, 0.0), (0.0, 0.0, 9.0), 4.0, (0.0, 90.0))))
    assert found[:, :2].min() >= -CLOSE * 10
    assert np.abs(np.hypot(found[:, 0], found[:, 1]) - 4).max() <= CLOSE * 10


@pytest.mark.parametrize(("low", "high"), [(5.0, 0.0), (0.0, 5.0), (5.0, 2.0)])
def test_a_cone_with_or_without_a_tip(low: float, high: float) -> None:
    found = anywhere(spline_of(ConeShape((0.0, 0.0, 0.0), (0.0, 0.0, 8.0), low, high)))
    assert np.abs(np.hypot(found[:, 0], found[:, 1]) - (low + (high - low) * found[:, 2] / 8)).max() <= CLOSE * 10


def test_a_parallelogram() -> None:
    found = anywhere(spline_of(PlaneShape((1.0, 2.0, 3.0), (10.0, 0.0, 1.0), (0.0, 5.0, -1.0))))
    share = (found[:, 0] - 1) / 10, (found[:, 1] - 2) / 5
    assert found[:, 2] == pytest.approx(3 + share[0] - share[1], abs=CLOSE * 10)


def test_a_bilinear_surface_has_its_corners_in_order_round_it() -> None:
    corners = ((0.0, 0.0, 0.0), (4.0, 0.0, 1.0), (4.0, 4.0, 0.0), (0.0, 4.0, 1.0))
    surface = spline_of(BilinearShape(corners))
    u, v = np.array([0.0, 1.0, 1.0, 0.0, 0.25]), np.array([0.0, 0.0, 1.0, 1.0, 0.5])
    assert places(surface, u, v) == pytest.approx(np.array([*corners, (1.0, 2.0, 0.5)]))


def test_a_bicubic_patch_goes_through_its_corners_only() -> None:
    rows = tuple(tuple((float(i), float(j), float(i * j * (3 - i))) for j in range(4)) for i in range(4))
    found = places(spline_of(BicubicShape(rows)), np.array([0.0, 1.0, 0.5]), np.array([1.0, 1.0, 0.5]))
    assert found[:2] == pytest.approx(np.array([rows[0][3], rows[3][3]]))
    assert found[2] == pytest.approx([1.5, 1.5, (2 * 3 + 2 * 3) / 8 * 1.5])


def test_weights_and_knots_of_a_bspline_count() -> None:
    """A quarter of a cylinder, as a B-spline that is given whole."""
    rows = tuple(tuple((x, y, z) for z in (0.0, 5.0)) for x, y in ((1.0, 0.0), (1.0, 1.0), (0.0, 1.0)))
    root = 0.5**0.5
    shape = BsplineShape(
        rows, 2, 1, knots_u=(3.0, 3.0, 3.0, 7.0, 7.0, 7.0), weights=((1.0, 1.0), (root, root), (1.0, 1.0))
    )
    surface = spline_of(shape)
    found = places(surface, 3 + 4 * np.linspace(0, 1, 50), np.linspace(0, 1, 50))
    assert np.abs(np.hypot(found[:, 0], found[:, 1]) - 1).max() <= CLOSE


def test_a_bspline_without_knots_and_weights_is_even() -> None:
    rows = tuple(tuple((float(i), float(j), 0.0) for j in range(4)) for i in range(6))
    surface = spline_of(BsplineShape(rows, 2, 3))
    assert surface.knots_u.tolist() == [0, 0, 0, 0.25, 0.5, 0.75, 1, 1, 1]
    assert (surface.weights == 1).all()


turns = st.tuples(*[st.floats(-360, 360)] * 3)
moves = st.tuples(*[st.floats(-1000, 1000)] * 3)


@settings(max_examples=examples(40), deadline=None)
@given(turns, moves)
def test_placing_keeps_lengths(turn: tuple[float, float, float], move: tuple[float, float, float]) -> None:
    shape = TorusShape((5.0, 0.0, 0.0), 10.0, 3.0)
    before, after = spline_of(shape).points.reshape(-1, 3), built(shape, turn, move).splines[0].points.reshape(-1, 3)
    middle = before.mean(axis=0)
    assert np.linalg.norm(after - after.mean(axis=0), axis=1) == pytest.approx(
        np.linalg.norm(before - middle, axis=1), abs=1e-9
    )


@given(turns)
def test_turns_follow_each_other_about_x_then_y_then_z(turn: tuple[float, float, float]) -> None:
    def one(axis: int, angle: float, place: np.ndarray) -> np.ndarray:
        turn = [0.0, 0.0, 0.0]
        turn[axis] = angle
        x, y, z = place
        along, across = (x, y, z)[(axis + 1) % 3], (x, y, z)[(axis + 2) % 3]
        c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
        made = place.copy()
        made[(axis + 1) % 3], made[(axis + 2) % 3] = c * along - s * across, s * along + c * across
        return made

    corner = np.array([1.0, 2.0, 3.0])
    wanted = one(2, turn[2], one(1, turn[1], one(0, turn[0], corner)))
    plane = PlaneShape((1.0, 2.0, 3.0), (10.0, 0.0, 1.0), (0.0, 5.0, -1.0))
    assert built(plane, turn).splines[0].points[0, 0] == pytest.approx(wanted, abs=1e-12 * 10)


def test_quarter_turns_are_exact() -> None:
    plane = PlaneShape((1.0, 2.0, 3.0), (10.0, 0.0, 1.0), (0.0, 5.0, -1.0))
    assert built(plane, (90.0, 0.0, 0.0)).splines[0].points[0, 0].tolist() == [1, -3, 2]
    assert built(plane, (0.0, 0.0, -90.0)).splines[0].points[0, 0].tolist() == [2, -1, 3]
