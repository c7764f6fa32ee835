"""Exact offset levels: closed forms, and random parts against plain float64 distances."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.core import tolerances
from app.core.errors import Cancelled
from app.core.progress import Progress
from app.geometry.offset import offset
from app.geometry.offset.offset import OffsetLevel, offset_levels
from app.geometry.outlines import nest, polygon_contour
from app.geometry.overlay.overlay import without_crossings
from app.geometry.primitives import lengths, pack, points_at
from app.model.part import Contour
from tests import plain_distance
from tests.examples import examples
from tests.part_shapes import bulged, circle, fig2, random_part, square


def levels_of(contours: list[Contour], distances: list[float]) -> tuple[OffsetLevel, ...]:
    return offset_levels(pack(nest(contours)), distances)


def points_of(level: OffsetLevel, per_row: int = 5) -> np.ndarray:
    rows = np.concatenate([ring.rows for ring in level.rings])
    return np.concatenate([points_at(rows, np.full(len(rows), f)) for f in np.linspace(0, 1, per_row)])


def area_of(level: OffsetLevel) -> float:
    return sum(ring.area for ring in level.rings)


def test_square_shrinks_to_a_square_of_four_lines() -> None:
    (level,) = levels_of([square(20)], [3])
    (ring,) = level.rings
    assert len(ring.rows) == 4 and np.all(ring.rows[:, 7] == 0)
    assert ring.area == pytest.approx(14 * 14, abs=1e-9)


def test_circle_shrinks_to_arcs_about_the_same_centre() -> None:
    (level,) = levels_of([circle(12, 84, 84)], [1.5])
    (ring,) = level.rings
    assert np.all(ring.rows[:, 7] == 1)
    assert np.allclose(ring.rows[:, 4:7], [84, 84, 10.5], atol=1e-9)


def test_island_grows_by_arcs_about_its_corners() -> None:
    (level,) = levels_of([square(40), square(10, 15, 15)], [2])
    assert area_of(level) == pytest.approx(36 * 36 - (10 * 10 + 4 * 10 * 2 + math.pi * 4), abs=1e-9)
    island = min(level.rings, key=lambda ring: ring.area)
    assert island.area < 0 and (island.rows[:, 7] == -1).sum() == 4


def test_reflex_corner_becomes_an_arc_of_the_level() -> None:
    corner = polygon_contour([(0, 0), (30, 0), (30, 10), (10, 10), (10, 30), (0, 30)])
    (level,) = levels_of([corner], [2])
    arcs = level.rings[0].rows[level.rings[0].rows[:, 7] != 0]
    assert len(arcs) == 1 and arcs[0, 4:] == pytest.approx([10, 10, 2, -1])


def test_nothing_is_left_beyond_the_deepest_point() -> None:
    near, far = levels_of([square(20)], [9.9, 10.1])
    assert len(near.rings) == 1 and far.rings == ()


def test_slot_exactly_as_wide_as_the_tool_gives_no_ring_on_the_ridge() -> None:
    slot = polygon_contour([(0, 0), (30, 0), (30, 4), (0, 4)])
    assert levels_of([slot], [2.0])[0].rings == ()


def test_neck_narrower_than_the_tool_parts_the_region() -> None:
    bone = polygon_contour(
        [(0, 0), (20, 0), (20, 9), (30, 9), (30, 0), (50, 0), (50, 20), (30, 20), (30, 11), (20, 11), (20, 20), (0, 20)]
    )
    wide, narrow = levels_of([bone], [0.9, 1.1])
    assert len(wide.rings) == 1 and len(narrow.rings) == 2


def test_rings_of_fig2_measure_right_and_close_exactly() -> None:
    contours = fig2()
    for level in levels_of(contours, [0.5, 1.5, 2.4, 3.3, 6.0, 11.4, 15.0]):
        measured = plain_distance.distance(points_of(level, 9), contours)
        assert np.abs(measured - level.distance).max() < 1e-6
        for ring in level.rings:
            assert not ring.polyline
            assert np.array_equal(ring.rows[:, 2:4], np.roll(ring.rows[:, :2], -1, axis=0))


def test_levels_do_not_depend_on_the_ones_before() -> None:
    alone = [levels_of(fig2(), [d])[0] for d in (4.2, 8.7)]
    together = levels_of(fig2(), [0.6, 1.5, 2.4, 4.2, 5.1, 8.7])
    for level in alone:
        same = next(other for other in together if other.distance == level.distance)
        assert area_of(same) == pytest.approx(area_of(level), abs=1e-7)


def check_random(seed: int) -> None:
    contours, crossing = random_part(seed)
    contours = list(without_crossings(contours).contours) if crossing else contours
    distances = (
        [0.5, 1.0, 1.5, 2.0, 3.0, 4.0] if seed % 2 else list(np.cumsum(np.random.default_rng(seed).uniform(0.1, 2, 6)))
    )
    cells = sheared_grid(contours)
    field = np.where(plain_distance.inside(cells, contours), plain_distance.distance(cells, contours), -1)
    cell = abs(np.linalg.det(np.stack([cells[1] - cells[0], cells[GRID] - cells[0]])))
    for level in levels_of(contours, distances):
        assert not any(ring.polyline for ring in level.rings)
        counted = float((field > level.distance).sum()) * cell
        perimeter = sum(float(lengths(ring.rows).sum()) for ring in level.rings)
        assert area_of(level) == pytest.approx(
            counted, abs=0.1 * perimeter * math.sqrt(cell) + 4 * cell + 4e-3 * perimeter
        )
        if level.rings:
            assert np.abs(plain_distance.distance(points_of(level), contours) - level.distance).max() <= 2e-6


GRID = 160


def sheared_grid(contours: list[Contour]) -> np.ndarray:
    """Points of a turned grid that covers the part: no wall is parallel to it, so counting errors average out."""
    reach = max(max(map(abs, p)) for c in contours for k in c.primitives for p in (k.start, k.end)) + 4
    axis = np.linspace(-1.6 * reach, 1.6 * reach, GRID)
    x, y = np.meshgrid(axis, axis)
    return np.stack([x * math.cos(0.37) - y * math.sin(0.37), x * math.sin(0.37) + y * math.cos(0.37)], -1).reshape(
        -1, 2
    )


@settings(max_examples=examples(40), deadline=None)
@given(st.integers(0, 10**6))
def test_random_parts_against_plain_distances(seed: int) -> None:
    check_random(seed)


@pytest.mark.exhaustive
@pytest.mark.parametrize("seed", range(1000))
def test_many_random_parts(seed: int) -> None:
    check_random(seed)


def test_a_level_that_cannot_be_closed_becomes_a_polyline_that_measures_right(monkeypatch: pytest.MonkeyPatch) -> None:
    exact = levels_of(fig2(), [1.5])[0]
    monkeypatch.setattr(offset, "_ATTEMPTS", ())  # the exact way is never tried
    (level,) = levels_of(fig2(), [1.5])
    assert all(ring.polyline for ring in level.rings)
    assert area_of(level) == pytest.approx(area_of(exact), abs=0.01)
    measured = plain_distance.distance(points_of(level), fig2())
    assert measured.min() >= 1.5 - tolerances.LEVEL and measured.max() <= 1.5 + tolerances.LEVEL


def test_cancel_stops_between_levels() -> None:
    seen = []

    def listen(fraction: float, text: str) -> None:
        seen.append(fraction)
        if len(seen) == 3:
            raise Cancelled

    with pytest.raises(Cancelled):
        offset_levels(pack(nest(fig2())), [1, 2, 3, 4, 5], Progress(listen))
    assert len(seen) == 3


def test_cusps_that_point_out_of_the_area_get_no_arc_and_those_that_point_in_do() -> None:
    star = bulged(
        [
            (10, 0, -math.sqrt(2) + 1),
            (0, 10, -math.sqrt(2) + 1),
            (-10, 0, -math.sqrt(2) + 1),
            (0, -10, -math.sqrt(2) + 1),
        ]
    )
    (level,) = levels_of([star], [1.0])
    assert [ring.polyline for ring in level.rings] == [False]
    corner = 10 - math.sqrt(11**2 - 10**2)  # where the grown quarter circles meet
    half = math.asin(corner / math.sqrt(2) / 11)
    assert area_of(level) == pytest.approx(2 * corner**2 - 4 * 11**2 * (half - math.sin(2 * half) / 2), abs=1e-9)
    assert set(level.rings[0].rows[:, 7]) == {-1.0}
    outer = square(60, -30, -30)
    (level,) = levels_of([outer, star], [1.0])
    assert not any(ring.polyline for ring in level.rings)
    assert np.abs(plain_distance.distance(points_of(level), [outer, star]) - 1.0).max() < 1e-6


@pytest.mark.parametrize("island", [circle(10, 50, 20), circle(6, 6, 20), square(10, 0, 5)])
def test_islands_that_touch_the_wall_keep_lines_and_arcs(island: Contour) -> None:
    wall = polygon_contour([(0, 0), (60, 0), (60, 40), (0, 40)])
    contours = list(without_crossings([wall, island]).contours)
    for level in levels_of(contours, [1.0, 4.0, 7.0]):
        assert level.rings and not any(ring.polyline for ring in level.rings)
        assert len(level.rings[0].rows) < 20
