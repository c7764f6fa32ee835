"""The witness: areas of drawn curves against closed forms, whatever lies on whatever."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely

from app.geometry.even_odd import even_odd
from app.geometry.outlines import reversed_contour
from app.geometry.primitives import contour_rows, sample
from app.model.curves import Arc, Line, Point
from app.model.part import Contour
from tests.geometry.meeting_shapes import Pose, box, disc, rounded, slot
from tests.part_shapes import random_part


def lens(r: float, s: float, gap: float) -> float:
    """What two circles share."""
    if gap >= r + s:
        return 0.0
    if gap <= abs(r - s):
        return math.pi * min(r, s) ** 2
    a, b = (math.acos(max(-1.0, min(1.0, (gap**2 + p**2 - q**2) / (2 * gap * p)))) for p, q in ((r, s), (s, r)))
    return r * r * (a - math.sin(2 * a) / 2) + s * s * (b - math.sin(2 * b) / 2)


ONE = [
    (box(1, 2, 4, 9), 21.0),
    (slot(0, 0, 30, 6), 144 + 9 * math.pi),
    (rounded(0, 0, 20, 12, 3), 204 + 9 * math.pi),
    (disc(3, 4, 5), 25 * math.pi),
]


@pytest.mark.parametrize(("shape", "area"), ONE)
@pytest.mark.parametrize("turned", [False, True])
def test_one_shape(shape: Contour, area: float, turned: bool) -> None:
    assert even_odd([reversed_contour(shape) if turned else shape]).area == pytest.approx(area, abs=1e-11)


@pytest.mark.parametrize("first", [(0.0, 10.0), (0.0, -10.0), (10.0, 0.0)])
@pytest.mark.parametrize("ccw", [True, False])
def test_an_arc_of_three_quarters_that_begins_at_the_top_or_the_bottom(first: Point, ccw: bool) -> None:
    """A corner of a keyhole: three quarters of a disc of radius 10, and a square of 10 in the fourth."""
    x, y = first
    last = (y, -x) if ccw else (-y, x)
    corner = (first[0] + last[0], first[1] + last[1])
    keyhole = Contour((Arc(first, last, (0, 0), ccw), Line(last, corner), Line(corner, first)))
    assert even_odd([keyhole]).area == pytest.approx(75 * math.pi + 100)


@pytest.mark.parametrize("gap", [0.0, 1e-9, 0.3, 7.0, 11.0, 13 - 1e-9, 13.0, 13 + 1e-9, 20.0])
@pytest.mark.parametrize("pose", [Pose(), Pose(0.7, 3000, -2000)])
def test_two_circles(gap: float, pose: Pose) -> None:
    pair = [pose.of(disc(0, 0, 10)), pose.of(disc(gap, 0, 3))]
    expected = 109 * math.pi - 2 * lens(10, 3, gap)
    found = even_odd(pair)
    assert found.area == pytest.approx(expected, abs=1e-9)
    assert found.length == pytest.approx(26 * math.pi)
    assert found.loose == 0


@pytest.mark.parametrize("e", [0.0, 1e-13, -1e-9, 1e-6])
def test_what_is_drawn_twice_is_nothing_and_three_times_is_there(e: float) -> None:
    assert even_odd([box(0, 0, 10, 10), box(e, e, 10 + e, 10 + e)]).area == pytest.approx(
        4 * 10 * abs(e) - 2 * e * e, abs=1e-12
    )
    assert even_odd([disc(0, 0, 10)] * 3).area == pytest.approx(100 * math.pi)


def test_what_outlines_hold_is_left_out_however_often() -> None:
    outlines = [box(5, -1, 15, 4), box(6, -2, 12, 3), disc(100, 0, 2)]
    assert even_odd([box(0, 0, 20, 10), disc(10, 8, 1)], outlines).area == pytest.approx(200 - math.pi - 40)
    assert even_odd([disc(0, 0, 2)], [disc(0, 0, 3)]).area == 0


def test_nothing_drawn() -> None:
    assert even_odd([]).area == 0


def test_a_gap_is_told_as_a_height() -> None:
    torn = Contour((Line((0, 0), (10, 0)), Line((10, 0), (10, 9.5)), Line((10, 10), (0, 10)), Line((0, 10), (0, 0))))
    assert even_odd([torn]).loose == pytest.approx(0.5)


def test_flat_arcs_keep_their_segment() -> None:
    radius, half = 1e6, 5.0
    centre = (0.0, -math.sqrt(radius**2 - half**2))
    bow = Contour((Arc((half, 0), (-half, 0), centre), Line((-half, 0), (half, 0))))
    assert even_odd([Pose(1.0).of(bow)]).area == pytest.approx(2 / 3 * 2 * half * half**2 / (2 * radius), rel=1e-4)


@pytest.mark.parametrize("seed", range(20))
def test_random_parts_agree_with_polygons(seed: int) -> None:
    contours, _ = random_part(seed)
    area = shapely.Polygon()
    for contour in contours:
        area = shapely.symmetric_difference(
            area, shapely.make_valid(shapely.Polygon(sample(contour_rows(contour), 1e-6)))
        )
    assert even_odd(contours).area == pytest.approx(float(area.area), abs=1e-3)


def test_it_does_not_matter_where_and_how_it_is_turned() -> None:
    rng = np.random.default_rng(3)
    shapes = [disc(*rng.uniform(0, 30, 2), rng.uniform(1, 9)) for _ in range(12)] + [
        box(3, 4, 20, 22),
        slot(0, 9, 40, 5),
    ]
    first = even_odd(shapes).area
    for angle in rng.uniform(0, math.tau, 8):
        assert even_odd([Pose(float(angle), 500, -900).of(shape) for shape in shapes]).area == pytest.approx(
            first, abs=1e-8
        )
