"""Dog-bones: how far they go, where there are none, and that no third wall is cut."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.geometry.outlines import polygon_contour
from app.model.contour_operation import ContourOperation
from app.model.finding import FindingKind
from app.model.moves import Program, Purpose
from app.model.operation import CutParameters
from app.model.part import Contour
from app.operations.compute import compute
from tests import plain_distance
from tests.examples import examples
from tests.operations.contour_jobs import about, contour_job, outside, rows_of
from tests.part_shapes import bulged, square

BONES = ContourOperation(CutParameters(2), dog_bones=True)


def made(contours: list[Contour], diameter: float = 3.0, leave: float = 0.0, **kwargs: object) -> Program:
    return compute(
        contour_job(
            contours, ContourOperation(CutParameters(2, stock_to_leave=leave), dog_bones=True), diameter, **kwargs
        )
    )  # type: ignore[arg-type]


def test_in_right_angles_the_rim_touches_the_corner() -> None:
    program = made([square(20)])
    assert len(program.dog_bones) == 4
    for bone in program.dog_bones:
        corner = np.round(np.array([bone.x0, bone.y0]) / 20) * 20
        assert math.dist((bone.x1, bone.y1), corner) == pytest.approx(1.5, abs=1e-9)
        assert math.dist((bone.x0, bone.y0), (bone.x1, bone.y1)) == pytest.approx(1.5 * (math.sqrt(2) - 1), abs=1e-9)
        assert bone.diameter == 3
    ways = rows_of(program.moves, Purpose.DOG_BONE)
    assert (
        len(ways) == 8
        and ways[::2, :2] == pytest.approx(ways[1::2, 2:4])
        and ways[::2, 2:4] == pytest.approx(ways[1::2, :2])
    )


@settings(max_examples=examples(12), deadline=None)
@given(st.floats(math.radians(25), math.radians(125)), st.floats(1, 4), st.floats(0, 0.5))
def test_at_any_angle_the_way_is_as_long_as_the_bisector_says(angle: float, diameter: float, leave: float) -> None:
    tip = polygon_contour([(0, 0), (60, 0), (60 * math.cos(angle), 60 * math.sin(angle))])
    program = made([tip], diameter, leave)
    need = diameter / 2 + leave
    near = [bone for bone in program.dog_bones if math.hypot(bone.x0, bone.y0) < 30]
    (bone,) = near
    assert math.dist((bone.x0, bone.y0), (bone.x1, bone.y1)) == pytest.approx(
        need / math.sin(angle / 2) - need, abs=1e-6
    )
    assert math.hypot(bone.x1, bone.y1) == pytest.approx(need, abs=1e-6)
    assert math.atan2(bone.y1, bone.x1) == pytest.approx(angle / 2, abs=1e-6)


def test_in_small_arcs_the_rim_touches_the_middle_of_the_arc() -> None:
    rounded = bulged([(1, 0, 0), (20, 0, 0), (20, 20, 0), (0, 20, 0), (0, 1, math.tan(math.pi / 8))])
    program = made([rounded])
    (bone,) = [each for each in program.dog_bones if each.x0 + each.y0 < 5]
    middle = 1 - math.sqrt(0.5)
    assert math.dist((bone.x1, bone.y1), (middle, middle)) == pytest.approx(1.5, abs=1e-9) and bone.x1 == pytest.approx(
        bone.y1
    )
    wide = bulged([(2, 0, 0), (20, 0, 0), (20, 20, 0), (0, 20, 0), (0, 2, math.tan(math.pi / 8))])
    assert len(made([wide]).dog_bones) == 3  # the cutter goes round in an arc of 2 mm by itself


def test_outside_they_are_in_the_corners_of_the_part() -> None:
    ell = polygon_contour([(0, 0), (40, 0), (40, 15), (15, 15), (15, 40), (0, 40)])
    program = compute(contour_job([ell], outside(dog_bones=True)))
    (bone,) = program.dog_bones
    assert (bone.x0, bone.y0) == pytest.approx((16.5, 16.5)) and math.dist(
        (bone.x1, bone.y1), (15, 15)
    ) == pytest.approx(1.5)


def test_there_is_none_where_a_clamp_makes_the_corner() -> None:
    program = made([square(40)], clamps=[square(10, -5, -5), circle_like(36, 20)])
    assert sorted((round(bone.x0), round(bone.y0)) for bone in program.dog_bones) == [(2, 38), (38, 2), (38, 38)]


def circle_like(x: float, y: float) -> Contour:
    return polygon_contour([(x, y), (x + 8, y), (x + 8, y + 5), (x, y + 5)])


def test_a_third_wall_is_not_cut() -> None:
    corner = [(0.0, 0.0), (30.0, 0.0), (30.0, 30.0), (0.0, 30.0)]
    behind = polygon_contour([(-10, -10), (-0.35, -10), (-0.35, 12), (-10, 12)])
    far = polygon_contour([(-20, -10), (-4, -10), (-4, 12), (-20, 12)])
    assert len(made([polygon_contour(corner), far], 6.0).dog_bones) == 8
    program = made([polygon_contour(corner), behind], 6.0)
    places = {(round(bone.x0), round(bone.y0)) for bone in program.dog_bones}
    assert (3, 3) not in places and (27, 27) in places
    assert about(program, "no dog-bone")


def test_dog_bones_are_the_only_cuts_nearer_than_the_cutter_is_wide() -> None:
    contours = [polygon_contour([(0, 0), (50, 0), (50, 20), (25, 8), (0, 20)]), square(10, 70, 0)]
    program = made(contours)
    moves = program.moves
    others = np.isin(moves.purpose, (Purpose.CONTOUR, Purpose.LEAD))
    assert plain_distance.distance(moves.end[others, :2], contours).min() >= 1.5 - 1e-6
    bones = rows_of(moves, Purpose.DOG_BONE)
    assert plain_distance.distance(bones[::2, 2:4], contours).min() < 1.4
    assert not any(finding.kind is FindingKind.TOLERANCE for finding in program.findings)


def test_a_finish_width_has_its_own() -> None:
    program = compute(contour_job([square(20)], ContourOperation(CutParameters(2), dog_bones=True, finish_width=0.4)))
    lengths = sorted(round(math.dist((b.x0, b.y0), (b.x1, b.y1)), 6) for b in program.dog_bones)
    share = math.sqrt(2) - 1
    assert lengths == [round(1.5 * share, 6)] * 4 + [round(1.9 * share, 6)] * 4
