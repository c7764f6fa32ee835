"""Surfaces of heights: what compiled sums make of places is what dense matrices of scipy's B-splines make of them."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.interpolate import BSpline

from app.fitting.point_surfaces.height_spline import Box, HeightSpline, rough_heights
from app.model.motion import Floats

_BOX = Box(-2.0, 7.0, 1.0, 5.0)


def basis(at: Floats, knots: Floats) -> Floats:
    dense: Floats = BSpline.design_matrix(np.clip(at, knots[3], knots[-4]), knots, 3).toarray()
    return dense


def scattered(count: int) -> Floats:
    u, v = np.random.default_rng(3).uniform((_BOX.u0, _BOX.v0), (_BOX.u1, _BOX.v1), (count, 2)).T
    return np.column_stack([u, v, np.sin(u) * np.cos(v / 2)])


def test_heights_are_those_of_b_splines_up_to_the_rim_and_level_beyond_it() -> None:
    knots_u, knots_v = np.arange(-3.0, 9.0), np.arange(-3.0, 8.0) / 2 + 1
    control = np.random.default_rng(1).normal(size=(8, 7))
    places = np.random.default_rng(2).uniform((-1, 0), (6, 4), (500, 2))
    places[:3] = (0.0, 1.0), (5.0, 3.0), (2.0, 1.5)
    wanted = np.einsum("ka,kb,ab->k", basis(places[:, 0], knots_u), basis(places[:, 1], knots_v), control)
    assert HeightSpline(knots_u, knots_v, control).heights(places) == pytest.approx(wanted, abs=1e-12)


def test_a_surface_is_the_one_of_least_squares_and_of_least_third_differences() -> None:
    places = scattered(600)
    made = rough_heights(places, _BOX)
    m, n = made.control.shape
    assert m != n
    matrix = np.einsum("ka,kb->kab", basis(places[:, 0], made.knots_u), basis(places[:, 1], made.knots_v))
    flat = matrix.reshape(len(places), -1)
    thirds = [np.diff(np.eye(count), n=3, axis=0) for count in (m, n)]
    bent = np.kron(thirds[0].T @ thirds[0], np.eye(n)) + np.kron(np.eye(m), thirds[1].T @ thirds[1])
    whole = flat.T @ flat + 1e-5 * len(places) / (m * n) * bent
    wanted = np.linalg.solve(whole, flat.T @ places[:, 2]).reshape(m, n)
    assert made.control == pytest.approx(wanted, abs=1e-9)
