"""How much of a circle convex shapes leave bare, and how far round a place they leave nothing bare."""

from __future__ import annotations

import math

import numpy as np
import pytest

from app.toolpath.engagement.rim_kernels import bound_along, clear_radius
from tests.operations.engaged import sweep


def discs(*each: tuple[float, float, float]) -> np.ndarray:
    return np.array([[*disc, 0.0, 0.0, math.inf, 0.0, 0.0, math.inf] for disc in each])


def half(turn: float) -> list[float]:
    """Half of a disc of radius 5 about (0, 0), on one side of a line through its centre."""
    return [0.0, 0.0, 5.0, math.cos(turn), math.sin(turn), 0.0, 0.0, 0.0, math.inf]


def test_one_disc_is_clear_as_far_as_to_its_border() -> None:
    assert clear_radius(discs((0, 0, 5)), (1.0, 2.0, 9.0)) == pytest.approx(5 - math.hypot(1, 2), abs=1e-8)
    assert clear_radius(discs((0, 0, 5)), (6.0, 0.0, 9.0)) == 0.0
    assert clear_radius(discs((0, 0, 5)), (0.0, 0.0, 2.0)) == 2.0


def test_a_disc_that_touches_a_circle_from_within_does_not_cover_it() -> None:
    x, r = 0.05233384, 3.0
    assert clear_radius(discs((0, 0, r)), (x, 0.0, r + x)) == pytest.approx(r - x, abs=1e-8)


def test_two_halves_are_a_whole() -> None:
    shapes = np.array([half(0.3), half(0.3 + math.pi)])
    assert clear_radius(shapes, (0.0, 0.0, 9.0)) == pytest.approx(5.0, abs=1e-8)
    assert clear_radius(shapes[:1], (0.0, 0.0, 9.0)) == 0.0


@pytest.mark.parametrize("seed", range(20))
def test_what_is_clear_round_a_place_is_so_at_many_points(seed: int) -> None:
    rng = np.random.default_rng(seed)
    shapes = discs(*rng.uniform((-2, -2, 1), (2, 2, 4), (6, 3)))
    shapes = shapes[np.hypot(shapes[:, 0], shapes[:, 1]) < shapes[:, 2]]
    found = clear_radius(shapes, (0.0, 0.0, 9.0))
    angle = np.linspace(0, math.tau, 5000)
    ring = np.column_stack([np.cos(angle), np.sin(angle)])

    def bare(radius: float) -> bool:
        away = np.hypot(*(radius * ring[:, None] - shapes[None, :, :2]).transpose(2, 0, 1))
        return bool((away > shapes[:, 2]).all(axis=1).any())

    if found:
        assert not bare(found - 1e-6) and bare(found + 1e-3)


@pytest.mark.parametrize("seed", range(20))
def test_a_bound_is_never_less_than_what_is_seen_and_closes_in_on_it(seed: int) -> None:
    rng = np.random.default_rng(seed)
    shapes, r = discs(*rng.uniform((-4, -4, 2), (4, 4, 5), (5, 3))), 2.0
    start, turn = rng.uniform(-2, 2, 2), rng.uniform(1, 3)
    centre = start - [turn, 0]
    angle = rng.uniform(0.5, 2.5)
    end = centre + turn * np.array([math.cos(angle), math.sin(angle)])
    row = np.array([*start, *end, *centre, turn, 1.0])
    size = turn * sweep(row)
    places = angle * (np.arange(200) + 0.5) / 200
    rim = places[:, None] + (np.arange(720) + 0.5) / 720 * math.pi
    points = (centre + turn * np.column_stack([np.cos(places), np.sin(places)]))[:, None] + r * np.stack(
        [np.cos(rim), np.sin(rim)], -1
    )
    away = np.hypot(*(points[:, :, None] - shapes[:, :2]).transpose(3, 0, 1, 2))
    seen = (away > shapes[:, 2]).all(axis=2).sum(axis=1).max() * math.pi / 720
    bound, _ = bound_along(shapes, row, r, (sweep(row), size), (0.0, 0.2, 1e-3, math.inf))
    assert seen - 0.02 <= bound <= seen + 0.3
    loose, _ = bound_along(shapes, row, r, (sweep(row), size), (math.pi + 1, 0.2, 1e-3, math.inf))
    assert loose >= bound
