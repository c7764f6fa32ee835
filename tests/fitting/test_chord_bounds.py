"""Chords beside surfaces of heights: what is proven of them holds on every place, and is what closed forms say."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

from app.fitting.point_surfaces.chord_bounds import chord_bounds
from app.fitting.point_surfaces.height_spline import Box, HeightSpline, HoldingPoints, fit_heights
from app.model.motion import Floats

Height = Callable[[Floats, Floats], Floats]
ALONG = np.linspace(0.0, 1.0, 401)


def quadratic(spans: tuple[int, int], uu: float, uv: float, vv: float) -> HeightSpline:
    """The surface uu u^2 + uv u v + vv v^2 + u over 0 to 10 by 0 to 6, by the blossoms of its powers."""
    knots = [np.linspace(0, far, n + 1) for far, n in zip((10.0, 6.0), spans, strict=True)]
    full = [
        np.concatenate([k[0] + (k[1] - k[0]) * np.arange(-3, 0), k, k[-1] + (k[1] - k[0]) * np.arange(1, 4)])
        for k in knots
    ]
    a, b = (np.stack([k[i : len(k) - 4 + i] for i in (1, 2, 3)]) for k in full)
    one, two = (each.mean(axis=0) for each in (a, b))
    squares = [(e[0] * e[1] + e[0] * e[2] + e[1] * e[2]) / 3 for e in (a, b)]
    control = uu * squares[0][:, None] + uv * np.outer(one, two) + vv * squares[1][None, :] + one[:, None]
    return HeightSpline(full[0], full[1], control)


def farthest(spline: HeightSpline, starts: Floats, ends: Floats) -> Floats:
    """How far the surface is from chords, by 401 places along each."""
    found = []
    for start, end in zip(starts, ends, strict=True):
        heights = spline.heights(start + ALONG[:, None] * (end - start))
        found.append(np.abs(heights - (heights[0] + ALONG * (heights[-1] - heights[0]))).max())
    return np.array(found)


def chords(count: int, length: float, seed: int = 1) -> tuple[Floats, Floats]:
    random = np.random.default_rng(seed)
    middles, turn = random.uniform([1.5, 1.5], [8.5, 4.5], (count, 2)), random.uniform(0, math.tau, count)
    ways = length / 2 * np.column_stack([np.cos(turn), np.sin(turn)])
    return middles - ways, middles + ways


def test_of_a_paraboloid_the_bound_is_what_its_chords_are_off() -> None:
    starts, ends = chords(60, 2.0)
    spline, ways = quadratic((5, 4), 0.03, -0.02, 0.05), ends - starts
    true = np.abs(0.03 * ways[:, 0] ** 2 - 0.02 * ways[:, 0] * ways[:, 1] + 0.05 * ways[:, 1] ** 2) / 4
    assert np.allclose(farthest(spline, starts, ends), true, rtol=1e-9)
    across_patches = chord_bounds(spline, starts, ends)
    assert np.allclose(across_patches, true, rtol=1e-9)


def test_chords_over_a_plane_are_off_by_nothing() -> None:
    assert chord_bounds(quadratic((7, 3), 0.0, 0.0, 0.0), *chords(40, 2.5)).max() < 1e-13
    assert not len(chord_bounds(quadratic((2, 2), 0.1, 0.0, 0.0), np.zeros((0, 2)), np.zeros((0, 2))))


SHAPES: dict[str, Height] = {
    "sphere": lambda x, y: np.sqrt(30.0**2 - (x - 4) ** 2 - (y - 3) ** 2),
    "cylinder": lambda x, y: np.sqrt(20.0**2 - (0.8 * (x - 4) + 0.6 * (y - 3)) ** 2),
    "cone": lambda x, y: -0.5 * np.hypot(x + 9, y + 5),
}


@pytest.mark.parametrize("name", SHAPES)
def test_what_is_proven_holds_and_comes_near_to_the_closed_form(name: str) -> None:
    height = SHAPES[name]
    x, y = (each.ravel() for each in np.meshgrid(np.linspace(0, 10, 40), np.linspace(0, 6, 25)))
    places = np.column_stack([x, y, height(x, y)])
    spline = fit_heights(places, np.ones(len(places)), HoldingPoints(places[:1]), Box(0.0, 10.0, 0.0, 6.0)).spline
    starts, ends = chords(80, 0.6, 3)
    bounds, found = chord_bounds(spline, starts, ends), farthest(spline, starts, ends)
    assert np.all(bounds >= found)
    true = np.array([_sag(height, start, end) for start, end in zip(starts, ends, strict=True)])
    assert np.abs(found - true).max() < 1e-4 * true.max() + 1e-6  # the surface is the shape
    assert bounds.max() < 1.15 * true.max()


def _sag(height: Height, start: Floats, end: Floats) -> float:
    """How far a chord is below the shape itself, along Z."""
    x, y = (start + ALONG[:, None] * (end - start)).T
    z = height(x, y)
    return float(np.abs(z - (z[0] + ALONG * (z[-1] - z[0]))).max())


def test_no_chord_over_any_number_of_patches_is_farther_off_than_proven() -> None:
    random = np.random.default_rng(11)
    for _ in range(12):
        plain = quadratic((int(random.integers(2, 12)), int(random.integers(2, 9))), 0.0, 0.0, 0.0)
        spline = HeightSpline(plain.knots_u, plain.knots_v, random.normal(0, 1, plain.control.shape))
        starts, ends = random.uniform([0, 0], [10, 6], (2, 60, 2))
        bounds, found = chord_bounds(spline, starts, ends), farthest(spline, starts, ends)
        assert np.all(bounds >= found * (1 - 1e-12))
