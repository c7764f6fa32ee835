"""Runs between rings: nothing is left at any stepover, in closed form and against two independent measures."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from app.core import tolerances
from app.geometry.distance import DistanceField
from app.geometry.offset.offset import OffsetLevel, offset_levels
from app.geometry.outlines import nest, polygon_contour
from app.geometry.overlay.overlay import without_crossings
from app.geometry.primitives import Primitives, Rows, lengths, pack, points_at, sample, within_half_turn
from app.model.part import Contour
from app.operations.pocket.paths import pocket_distances, without_empty
from app.toolpath.build import Stroke
from app.toolpath.coverage.areas import region_shapes
from app.toolpath.coverage.uncut_kernels import widest
from app.toolpath.linking import runs_kernels
from app.toolpath.linking.bridge import RingField
from app.toolpath.linking.link import LinkOptions, link
from app.toolpath.linking.runs import NOTHING, GapFilling, between, fill, gaps_of
from tests import plain_distance
from tests.examples import examples
from tests.part_shapes import circle, fig2, random_part, square
from tests.toolpath.uncut_squares import uncut


def rings(
    primitives: Primitives, first: float, stepover: float, radius: float
) -> tuple[tuple[OffsetLevel, ...], tuple[OffsetLevel, ...]]:
    """(levels, levels between them)."""
    distances = pocket_distances(first, stepover, DistanceField.of(primitives.rows))
    halves = between(distances, stepover, radius)
    each = sorted({*distances, *halves})
    found = dict(zip(each, offset_levels(primitives, each, frame=True), strict=True))
    levels = without_empty(tuple(found[distance] for distance in distances))
    return levels, tuple(found[distance] for distance in halves)[: len(levels)]


def filled(
    contours: list[Contour], first: float, stepover: float, radius: float
) -> tuple[tuple[OffsetLevel, ...], GapFilling, DistanceField]:
    primitives = pack(nest(without_crossings(contours).contours))
    field = DistanceField.of(primitives.rows)
    levels, halves = rings(primitives, first, stepover, radius)
    return levels, fill(levels, halves, field, radius) if halves and levels else NOTHING, field


def left_by_squares(
    levels: tuple[OffsetLevel, ...], strokes: tuple[Stroke, ...], field: DistanceField, radius: float
) -> float:
    """Area whose squares' centres are farther than 2 um beyond what the strokes sweep, mm2."""
    left = uncut(field, levels[0], radius, [(stroke.rows, radius) for stroke in strokes]).thicker(2e-6)
    return float((4 * left.halves**2).sum())


def left_by_polygons(contours: list[Contour], first: float, strokes: tuple[Stroke, ...], radius: float) -> float:
    """Area of the opening without the strokes' swath, by the library's polygons, chords within a micrometre, mm2."""
    regions = region_shapes(nest(without_crossings(contours).contours), 1e-4)
    reach = shapely.union_all(
        shapely.buffer(shapely.buffer(regions, -first - 2e-3, quad_segs=64), radius, quad_segs=64)
    )
    parts = [
        shapely.buffer(shapely.LineString(points), radius, quad_segs=64)
        for stroke in strokes
        for points in runs_of(stroke.rows)
    ]
    left = shapely.difference(reach, shapely.union_all(parts))
    return float(shapely.buffer(left, -2e-3).area)


def runs_of(rows: Rows) -> list[np.ndarray]:
    """Points along each row by itself: the library loses parts of paths that cross themselves."""
    return [np.concatenate([sample(row[None], 1e-5), row[None, 2:4]]) for row in rows]


@pytest.mark.parametrize(("stepover", "first"), [(1.2, 1.5), (1.7, 1.0), (2.0, 5.0)])
def test_runs_lie_between_two_rings_and_near_enough_to_the_inner_one(stepover: float, first: float) -> None:
    distances = tuple(first + k * stepover for k in range(9))
    for level, half in zip(distances, between(distances, stepover, 1.0), strict=True):
        rise = level + stepover - half
        assert level < half <= level + 1.0 + 1e-12
        assert rise <= 1.0 and rise * (level + stepover) >= 1.0 - 1e-12
    assert between(distances, 1.0, 1.0) == ()


def test_the_corners_of_a_square_get_spurs_of_the_length_that_theory_says() -> None:
    """At s = 2R the ring's corner is sqrt(2) R from the uncut tip, so a spur goes (sqrt(2) - 1) R there, and back."""
    levels, filling, _ = filled([square(40)], 1.0, 2.0, 1.0)
    corners = [trip for trip in filling.detours if trip.length < 1.5]
    assert len(corners) == 4 * (len(levels) - 2)  # the innermost ones are too near to one another to be told apart
    needed = 2 * (math.sqrt(2) - 1)
    assert all(needed <= trip.length <= needed + 0.1 for trip in corners)


def test_a_round_pocket_needs_no_runs_but_in_its_middle() -> None:
    levels, filling, _ = filled([circle(20)], 1.0, 1.8, 1.0)
    middle = 20 - levels[-1].distance
    assert len(filling.detours) + sum(len(half.rings) for half in filling.halves) == (1 if middle > 1 else 0)


def test_parallel_rings_as_far_apart_as_the_tool_is_wide_leave_nothing_between() -> None:
    primitives = pack(nest([square(40)]))
    levels, halves = rings(primitives, 1.0, 2.0, 1.0)
    gaps = gaps_of(halves[2], RingField.of(levels[3].rings, 0), 1.0)
    assert len(gaps) == 4
    assert all(float(lengths(gap.rows).sum()) == pytest.approx(2.0, abs=0.01) for gap in gaps)


def test_a_corridor_without_a_ring_is_run_along_on_the_way_round() -> None:
    """Two rooms and a corridor between them in which no second ring fits: what rings leave there is long."""
    right = [(20, 0), (20, 7), (45, 7), (45, 0), (65, 0)]
    bone = [polygon_contour([(0, 0), *right, (65, 20), (45, 20), (45, 12.2), (20, 12.2), (20, 20), (0, 20)])]
    levels, filling, field = filled(bone, 1.0, 1.9, 1.0)
    strokes = link(levels, field, LinkOptions(), filling)
    assert len(strokes) == 1
    assert left_by_squares(levels, strokes, field, 1.0) == 0
    assert filling.length < 2.5 * 25 + 0.05 * sum(ring.length for level in levels for ring in level.rings)


@pytest.mark.parametrize("share", [1.01, 1.2, 1.4, 1.7, 1.9, 2.0])
def test_fig2_is_covered_at_any_stepover(share: float) -> None:
    levels, filling, field = filled(fig2(), 3.0, 2 * share, 2.0)
    strokes = link(levels, field, LinkOptions(), filling)
    assert len(strokes) == 2
    assert left_by_squares(levels, strokes, field, 2.0) == 0
    assert left_by_polygons(fig2(), 3.0, strokes, 2.0) == 0


def test_a_tip_between_two_corners_of_inner_rings_is_not_forgotten() -> None:
    """Uncut places end where the swaths round two corners meet, too, and not only on the level along which runs go."""
    levels, filling, field = filled(fig2(), 3.0, 4.8, 3.0)
    assert left_by_polygons(fig2(), 3.0, link(levels, field, LinkOptions(), filling), 3.0) == 0


@settings(max_examples=examples(8), deadline=None)
@given(st.integers(0, 10**6), st.floats(1.0, 2.0), st.booleans())
def test_random_parts_are_covered_in_one_stroke_an_area_and_no_wall_is_touched(
    seed: int, share: float, outside_in: bool
) -> None:
    check_random_part(seed, share, outside_in)


@pytest.mark.exhaustive
@settings(max_examples=examples(300), deadline=None)
@given(st.integers(0, 10**6), st.floats(1.0, 2.0), st.booleans())
def test_many_random_parts_are_covered(seed: int, share: float, outside_in: bool) -> None:
    check_random_part(seed, share, outside_in)


def check_random_part(seed: int, share: float, outside_in: bool) -> None:
    contours, _ = random_part(seed)
    rng = np.random.default_rng(seed)
    radius = float(rng.uniform(0.4, 2.0))
    first = radius + float(rng.choice([0.0, 0.5]))
    levels, filling, field = filled(contours, first, share * radius, radius)
    if not levels:
        return
    strokes = link(levels, field, LinkOptions(outside_in=outside_in), filling)
    assert len(strokes) == sum(ring.area > 0 for ring in levels[0].rings)
    assert left_by_squares(levels, strokes, field, radius) == 0
    assert left_by_polygons(contours, first, strokes, radius) <= 1e-9
    for stroke in strokes:
        assert np.array_equal(stroke.rows[1:, :2], stroke.rows[:-1, 2:4])
        rows = within_half_turn(stroke.rows)
        for fraction in (0.0, 0.3, 0.6, 0.85):
            points = points_at(rows, np.full(len(rows), fraction))
            assert plain_distance.distance(points, contours).min() >= first - tolerances.LEVEL
            assert plain_distance.inside(points, contours).all()


def test_squares_between_rings_are_those_that_each_would_be_by_itself() -> None:
    """Quartered, lists of rows handed on: the same squares as where all rows are asked for each."""
    radius, smallest = 1.0, 1 / 32
    primitives = pack(nest(fig2()))
    levels, halves = rings(primitives, 1.0, 2.0, radius)
    k = next(k for k, half in enumerate(halves[: len(levels) - 1]) if half.rings and levels[k + 1].rings)
    walls, inner = DistanceField.of(primitives.rows), RingField.of(levels[k + 1].rings, 0).field
    gaps = DistanceField.of(
        np.concatenate(
            [gap.rows for gap in gaps_of(halves[k], RingField(inner, *2 * (np.zeros(0, np.int64),)), radius)]
        )
    )
    low, high = gaps.boxes[:, :2].min(axis=0) - 1, gaps.boxes[:, 2:].max(axis=0) + 1
    axes = (np.arange(a, b, 0.5) for a, b in zip(low, high, strict=True))
    first = np.stack(np.meshgrid(*axes), -1).reshape(-1, 2)
    squares = np.column_stack([first, np.full(len(first), 0.25)])
    radii = np.full(len(inner.rows), radius)
    trees = [part for field in (walls, gaps, inner) for part in (field.rows, field.order, field.nodes)]
    found, count = runs_kernels.squares_beyond(
        *trees, radii, widest(radii, inner.order, len(inner.nodes)), np.array([halves[k].distance, smallest]), squares
    )
    expected: list[tuple[float, ...]] = []
    while len(squares):
        half = squares[:, 2]
        far = half * math.sqrt(2.0)
        cut, inside = inner.nearest(squares[:, :2])[0] - radius, walls.nearest(squares[:, :2])[0] - halves[k].distance
        near = gaps.nearest(squares[:, :2])[0] < np.maximum(inside, 0.0) + 2 * far
        open_ = (cut > -far) & (inside + far >= 0) & near
        done = open_ & ((half <= smallest) | ((half <= 4 * smallest) & (cut >= far) & (inside >= far)))
        expected += map(tuple, squares[done].tolist())
        more = np.repeat(squares[open_ & ~done], 4, axis=0)
        turn = np.arange(len(more)) % 4
        shift = np.column_stack([turn % 2 - 0.5, turn // 2 - 0.5])
        squares = np.column_stack([more[:, :2] + more[:, 2:] * shift, more[:, 2] / 2])
    assert count > 100 and sorted(map(tuple, found[:count, :3].tolist())) == sorted(expected)


@pytest.mark.parametrize("seed", range(5))
def test_outermost_corners_of_squares_have_the_hull_of_all(seed: int) -> None:
    """Squares of three sizes on one lattice, in groups that overlap; one group has none."""
    rng = np.random.default_rng(seed)
    half = 0.37 * 0.5 ** rng.integers(1, 4, 400)
    squares = np.column_stack([2 * half[:, None] * (rng.integers(-9, 9, (400, 2)) + 0.5), half, np.zeros(400)])
    group = rng.choice([0, 1, 3], 400)
    corners, owner = runs_kernels.outermost(squares, group, 4)
    assert len(corners) < 400
    for k in range(4):
        mine = squares[group == k]
        all_of_them = (mine[:, None, :2] + mine[:, 2, None, None] * [[-1, -1], [-1, 1], [1, -1], [1, 1]]).reshape(-1, 2)
        hulls = [shapely.MultiPoint(each).convex_hull for each in (all_of_them, corners[owner == k])]
        assert hulls[0].equals_exact(hulls[1], 1e-12, normalize=True)
        assert hulls[0].is_empty == (k == 2)
