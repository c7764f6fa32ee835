"""Crossing contours become touching ones of the same even-odd area."""

from __future__ import annotations

import math

import numpy as np
import pytest

from app.geometry.chaining.chain import crossings
from app.geometry.distance import DistanceField
from app.geometry.offset.offset import offset_levels
from app.geometry.outlines import nest, polygon_contour, reversed_contour
from app.geometry.overlay.overlay import without_crossings
from app.geometry.primitives import contour_rows, pack, signed_area
from tests import plain_distance
from tests.part_shapes import circle, random_part, square


def test_two_circles_become_two_moons() -> None:
    moons = without_crossings([circle(10), circle(10, 8, 0)]).contours
    lens = 2 * 100 * math.acos(8 / 20) - 8 / 2 * math.sqrt(400 - 64)
    assert sorted(signed_area(contour_rows(m)) for m in moons) == pytest.approx([100 * math.pi - lens] * 2)
    assert len(nest(moons)) == 2


def test_a_bow_tie_becomes_two_triangles() -> None:
    parts = without_crossings([polygon_contour([(0, 0), (40, 30), (40, 0), (0, 30)])]).contours
    assert [signed_area(contour_rows(p)) for p in parts] == pytest.approx([300, 300])
    assert all(len(p.primitives) == 3 for p in parts)


def test_contours_that_do_not_cross_stay_as_they_are() -> None:
    outer, hole = without_crossings([square(40), circle(5, 20, 20)]).contours
    assert signed_area(contour_rows(outer)) == pytest.approx(1600)
    assert signed_area(contour_rows(hole)) == pytest.approx(25 * math.pi)


def test_a_square_over_the_edge_of_another_is_taken_out_of_it() -> None:
    parts = without_crossings([square(20), square(10, 15, 5)]).contours
    assert sum(signed_area(contour_rows(p)) for p in parts) == pytest.approx(400 - 50 + 50)


@pytest.mark.parametrize("seed", [k for k in range(60) if k % 5 >= 3])
def test_random_parts_keep_their_even_odd_area_point_by_point(seed: int) -> None:
    contours, _ = random_part(seed)
    parts = without_crossings(contours).contours
    assert not [f for f in crossings(parts) if f.counts]
    points = np.random.default_rng(seed).uniform(-35, 35, (4000, 2))
    clear = plain_distance.distance(points, contours) > 0.02
    rows = np.concatenate([contour_rows(p) for p in parts])
    assert np.array_equal(DistanceField.of(rows).inside(points[clear]), plain_distance.inside(points[clear], contours))
    for part in parts:
        ends = [c.end for c in part.primitives]
        assert [c.start for c in part.primitives] == ends[-1:] + ends[:-1]


@pytest.mark.parametrize("turned", [False, True])
def test_an_edge_that_two_areas_share_stays_a_wall_of_both(turned: bool) -> None:
    left, right = square(20), square(20, 20, 0)
    parts = without_crossings([left, reversed_contour(right) if turned else right]).contours
    assert [signed_area(contour_rows(p)) for p in parts] == pytest.approx([400, 400])
    (level,) = offset_levels(pack(nest(parts)), [3.0])
    assert [ring.area for ring in level.rings] == pytest.approx([14 * 14] * 2)


def test_an_island_along_the_wall_becomes_a_notch() -> None:
    parts = without_crossings([square(40), square(10, 0, 15)]).contours
    assert [abs(signed_area(contour_rows(p))) for p in parts] == pytest.approx([1500])
