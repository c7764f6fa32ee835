"""What is left of a carving, on paths made by hand: closed forms."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from app.core.progress import NO_PROGRESS
from app.geometry.distance import DistanceField
from app.geometry.outlines import nested, polygon_contour
from app.geometry.primitives import pack
from app.model.part import Contour
from app.verify.carved_roof import ConePath, _Carving, _discs, _Elements, prove_roof
from tests.part_shapes import circle, square

PYRAMID = ConePath(
    np.array([[0, 0, 0], [20, 0, 0], [0, 20, 0], [20, 20, 0]], float),
    np.array([[10, 10, -10.0]] * 4),
    0.0,
    1.0,
    99.0,
)
WALLS = pack(nested([square(20)]).regions)


def test_a_pyramid_is_whole() -> None:
    proof = prove_roof(PYRAMID, WALLS, 0.005)
    assert proof.left_mm == pytest.approx(0.0, abs=1e-6) and proof.above == 0
    assert proof.blunt_mm == 0 and proof.gap_mm <= 0.1


def test_a_corner_that_is_left_out_is_left() -> None:
    three = replace(PYRAMID, start=PYRAMID.start[:3], end=PYRAMID.end[:3])
    proof = prove_roof(three, WALLS, 0.005)
    assert proof.above > 100
    # the disc in the corner, held by the one at the centre: (sqrt 2 - 1) times as far away as it is smaller
    assert proof.left_mm == pytest.approx(10 * (math.sqrt(2) - 1), rel=0.01)
    assert proof.x == pytest.approx(20, abs=0.1) and proof.y == pytest.approx(20, abs=0.1)


@pytest.mark.parametrize("rate", [0.5, 1.0, 2.0])
def test_what_is_too_shallow_is_left_by_as_much(rate: float) -> None:
    path = replace(PYRAMID, rate=rate, start=PYRAMID.start / [1, 1, rate], end=PYRAMID.end / [1, 1, rate] + [0, 0, 0.1])
    proof = prove_roof(path, WALLS, 0.005)
    assert proof.left_mm == pytest.approx(0.1, rel=0.01)


def test_a_flat_tip_does_not_reach_corners() -> None:
    proof = prove_roof(
        replace(PYRAMID, tip=1.0, start=PYRAMID.start + [0, 0, 1], end=PYRAMID.end + [0, 0, 1]), WALLS, 0.005
    )
    assert proof.left_mm == pytest.approx(0.0, abs=1e-6)
    assert proof.blunt_mm == pytest.approx(8.0, abs=0.1)


def test_the_greatest_depth_is_all_that_is_asked() -> None:
    walls = pack(nested([circle(8)]).regions)
    angle = np.linspace(0, math.tau, 2001)
    ring = np.column_stack([6 * np.cos(angle), 6 * np.sin(angle), np.full(2001, -2.0)])
    path = ConePath(ring[:-1], ring[1:], 0.0, 1.0, 2.0)
    assert prove_roof(path, walls, 0.005).left_mm < 1e-4
    assert prove_roof(replace(path, greatest=3.0), walls, 0.005).left_mm == pytest.approx(2.0, abs=1e-3)


@pytest.mark.parametrize(
    ("contour", "radius"),
    [(square(20), lambda foot: np.sort(np.r_[foot, 20 - foot])[1]), (circle(4.0, 3, 2), lambda foot: 4.0)],
    ids=["square", "circle"],
)
def test_largest_discs_behind_walls_have_their_closed_forms(
    contour: Contour, radius: Callable[[NDArray[np.float64]], float]
) -> None:
    """In a square as far as the next corner; in a circle, which bends as much as the disc, the circle itself."""
    walls = pack(nested([contour]).regions)
    elements = _Elements.of(walls)
    discs = _discs(elements, DistanceField.of(walls.rows), 11.0, NO_PROGRESS)
    feet, _ = elements.feet(discs.wall, discs.share)
    assert len(feet) > 50
    assert np.allclose(discs.radius, [radius(foot) for foot in feet], atol=2e-6)


@pytest.mark.parametrize("seed", range(4))
def test_the_best_motion_is_found_among_all(seed: int) -> None:
    """Each disc against each motion at many places: none leaves less than is told, where more is left than counts."""
    made = np.random.default_rng(seed)
    start = np.column_stack([made.uniform(0, 30, (60, 2)), made.uniform(-3, 0, 60)])
    path = ConePath(start, start + made.normal(0, 2, (60, 3)) * [1, 1, 0.5], 0.2, 0.6, 9.0)
    centres, radius = made.uniform(0, 30, (300, 2)), made.uniform(0.1, 2.0, 300)
    share = np.linspace(0, 1, 501)
    places = path.start[:, None] + (path.end - path.start)[:, None] * share[None, :, None]
    apart = np.hypot(*(centres[:, None, None] - places[None, :, :, :2]).transpose(3, 0, 1, 2))
    sampled = (apart + radius[:, None, None] - path.tip + places[None, :, :, 2] * path.rate).min(axis=(1, 2))
    told = _Carving.of(path).uncarved(centres, radius, 0.5, NO_PROGRESS)
    much = sampled > 0.5
    assert much.sum() > 50 and (told[~much] <= 0.5).all()
    assert (told[much] <= sampled[much] + 1e-9).all() and (sampled[much] - told[much]).max() < 0.01
    assert told.max() == pytest.approx(sampled.max(), abs=0.01)


@pytest.mark.parametrize("shallow", [0, 1, 2])
def test_regions_that_are_alike_are_judged_each_in_its_place(shallow: int) -> None:
    """Three pyramids, two of them alike and the third a hair off, one of them too shallow by 0.1 mm."""
    corners = [(0.0, 0.0), (20.0, 0.0), (20.0, 20.0), (0.0, 20.0)]
    squares = [polygon_contour([(x + 30 * k, y + 1e-5 * (k == 2 and x > y)) for x, y in corners]) for k in range(3)]
    lift = [[30.0 * k, 0.0, 1.0 + 0.1 * (k == shallow)] for k in range(3)]
    path = ConePath(
        np.concatenate([PYRAMID.start + each for each in lift]),
        np.concatenate([PYRAMID.end + each for each in lift]),
        1.0,
        1.0,
        99.0,
    )
    proof = prove_roof(path, pack(nested(squares).regions), 0.005)
    assert proof.left_mm == pytest.approx(0.1, rel=0.01) and 30 * shallow <= proof.x <= 30 * shallow + 20
    assert proof.places / 3.5 < proof.above < proof.places / 2.8
    assert proof.blunt_mm == pytest.approx(3 * 8.0, abs=0.3)
