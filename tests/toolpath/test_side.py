"""Paths along walls: on the right side, climbing, open beside clamps, and what lies inside first."""

from __future__ import annotations

import math
from functools import reduce

import numpy as np
import pytest
import shapely

from app.geometry.offset.offset import offset_levels
from app.geometry.primitives import contour_rows, points_at, sample, signed_area
from app.model.contour_operation import ContourOperation
from app.model.job import Job
from app.model.operation import CutParameters, Direction, Side
from app.model.part import Contour
from app.toolpath.leads.contour_path import ContourPath, headings_at, left_of
from app.toolpath.machining_areas import ranks, wall_paths
from tests import plain_distance
from tests.operations.contour_jobs import contour_job, outside, polygon, sheet_of
from tests.part_shapes import circle, fig2, random_part, square


def paths_of(job: Job, distance: float, direction: Direction = Direction.CLIMB) -> tuple[ContourPath, ...]:
    sheet = sheet_of(job)
    return wall_paths(offset_levels(sheet.primitives, [distance], frame=True)[0], sheet, direction)


def test_round_a_square_the_path_is_its_offset_with_round_corners() -> None:
    (path,) = paths_of(contour_job([square(20)], outside()), 1.5)
    assert path.closed and path.length == pytest.approx(80 + 2 * math.pi * 1.5, abs=1e-9)
    assert abs(signed_area(path.rows)) == pytest.approx(400 + 4 * 20 * 1.5 + math.pi * 1.5**2, abs=1e-9)


@pytest.mark.parametrize("direction", list(Direction))
@pytest.mark.parametrize("side", [Side.INSIDE, Side.OUTSIDE])
def test_climb_milling_has_the_metal_that_stays_on_the_right(side: Side, direction: Direction) -> None:
    contours = [square(40), circle(8, 20, 20)]
    plate = shapely.difference(polygon(contours[0]), polygon(contours[1]))
    for path in paths_of(contour_job(contours, ContourOperation(CutParameters(2), side)), 1.5, direction):
        middle = points_at(path.rows, np.full(len(path.rows), 0.5))
        aside = left_of(headings_at(path.rows, np.full(len(path.rows), 0.5))) * (
            1 if direction is Direction.CLIMB else -1
        )
        touched, free = (shapely.contains_xy(plate, *(middle + far * aside).T) for far in (-1.55, 0.5))
        assert touched.all() if side is Side.OUTSIDE else not touched.any()
        assert not free.any() if side is Side.OUTSIDE else free.all()


@pytest.mark.parametrize("seed", range(12))
def test_outside_paths_keep_exactly_their_distance_and_leave_nothing_out(seed: int) -> None:
    contours, crossing = random_part(seed)
    if crossing:
        contours = contours[:1] if seed % 5 == 3 else [square(30), circle(4, 15, 15)]
    job = contour_job(contours, outside(), 1.0)
    paths = paths_of(job, 0.5)
    points = np.concatenate([sample(path.rows, 1e-3) for path in paths])
    assert np.abs(plain_distance.distance(points, contours) - 0.5).max() < 1e-3
    solid = reduce(shapely.symmetric_difference, [shapely.make_valid(polygon(contour)) for contour in contours])
    assert not shapely.contains_xy(solid, *points.T).any()
    wanted = shapely.buffer(solid, 0.5, quad_segs=64).boundary
    run = shapely.union_all([shapely.LinearRing(sample(path.rows, 1e-3)) for path in paths if len(path.rows) > 2])
    assert wanted.length - shapely.intersection(wanted, run.buffer(5e-3)).length < 0.05


def test_no_path_follows_a_clamp_or_the_frame() -> None:
    clamp = square(10, 30, 20)
    job = contour_job([square(60)], outside(), clamps=[square(6, 70, 70), circle(3, -30, 30)])
    (path,) = paths_of(job, 1.5)
    assert path.closed and path.length == pytest.approx(240 + 3 * math.pi, abs=1e-9)
    (inner,) = paths_of(contour_job([square(60)], clamps=[clamp]), 1.5)
    assert inner.closed and inner.length == pytest.approx(4 * 57, abs=1e-9)


def test_a_wall_that_a_clamp_lies_over_is_followed_up_to_it() -> None:
    job = contour_job([square(60)], clamps=[square(20, -10, 20)])
    (path,) = paths_of(job, 1.5)
    assert not path.closed and path.length == pytest.approx(3 * 57 + 2 * (20 - 3), abs=1e-6)
    assert {tuple(np.round(p, 6)) for p in (path.rows[0, :2], path.rows[-1, 2:4])} == {(1.5, 18.5), (1.5, 41.5)}


def test_ranks_count_the_loops_round_each() -> None:
    loops: list[Contour] = [square(100), square(50, 10, 10), circle(5, 30, 30), square(10, 75, 75)]
    assert ranks([contour_rows(loop) for loop in loops]) == [0, 1, 2, 1]
    assert ranks([]) == []


def test_the_outline_of_a_part_comes_after_its_holes() -> None:
    paths = paths_of(contour_job(fig2(), outside()), 1.5)
    outermost = min(path.rank for path in paths)
    assert sorted((path.rank - outermost, path.area < 0) for path in paths) == [(0, True), (0, True), (1, False)]
