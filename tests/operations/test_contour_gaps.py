"""What a cutter does not touch of the walls: corners are none of a finding, slots, necks and gaps are, with place and
width.
"""

from __future__ import annotations

import math

import pytest

from app.geometry.offset.offset import offset_levels
from app.geometry.outlines import polygon_contour
from app.model.job import Job
from app.model.part import Contour
from app.operations.contour.gaps import WallGap, gaps
from app.operations.contour.narrow_places import NarrowPlace, narrow_places
from tests.operations.contour_jobs import contour_job, outside, sheet_of
from tests.part_shapes import bulged, circle, fig2, square


def found(job: Job) -> tuple[list[WallGap], list[NarrowPlace]]:
    sheet, distance = sheet_of(job), job.tools[0].radius
    gone = gaps(offset_levels(sheet.primitives, [distance], frame=True)[0], sheet)
    return gone, narrow_places(gone, sheet, distance)


def keyhole(width: float) -> Contour:
    half = width / 2
    return polygon_contour(
        [(0, 0), (20, 0), (20, 10 - half), (30, 10 - half), (30, 10 + half), (20, 10 + half), (20, 20), (0, 20)]
    )


def test_the_corners_of_a_square_are_gaps_of_twice_the_radius_and_nothing_else() -> None:
    gone, places = found(contour_job([square(30)]))
    assert [round(gap.length, 6) for gap in gone] == [3, 3, 3, 3] and all(gap.is_corner for gap in gone) and not places
    assert {gap.corner for gap in gone} == {(1.5, 1.5), (28.5, 1.5), (28.5, 28.5), (1.5, 28.5)}
    assert [gap.turn for gap in gone] == pytest.approx([math.pi / 2] * 4)


def test_nothing_is_missed_round_convex_parts() -> None:
    assert found(contour_job([square(30), circle(9, 60, 0)], outside())) == ([], [])


def test_corners_between_arcs_and_lines_are_no_finding() -> None:
    gone, places = found(contour_job(fig2()))
    assert not places and all(gap.is_corner for gap in gone) and len(gone) == 11


@pytest.mark.parametrize(("width", "diameter"), [(2.0, 3.0), (1.0, 3.0), (2.9, 3.0), (5.0, 6.0)])
def test_a_slot_too_narrow_is_found_with_its_width(width: float, diameter: float) -> None:
    _, (place,) = found(contour_job([keyhole(width)], diameter=diameter))
    assert place.width == pytest.approx(width, abs=1e-4) and place.y == pytest.approx(10) and 20 < place.x < 30
    assert place.gap.length == pytest.approx(20 + width)


def test_a_slot_wide_enough_is_no_finding() -> None:
    for width in (3.0, 3.01, 5.0):
        assert found(contour_job([keyhole(width)]))[1] == []


@pytest.mark.parametrize("gap", [0.5, 2.0, 2.99])
def test_the_gap_between_neighbours_is_one_place(gap: float) -> None:
    _, (place,) = found(contour_job([square(10), square(10, 10 + gap)], outside()))
    assert place.width == pytest.approx(gap, abs=1e-4) and (place.x, place.y) == pytest.approx(
        (10 + gap / 2, 5), abs=1e-3
    )
    assert found(contour_job([square(10), square(10, 13.0)], outside()))[1] == []


def test_the_gap_between_two_round_parts_is_where_they_are_nearest() -> None:
    _, (place,) = found(contour_job([circle(10), circle(10, 21)], outside()))
    assert (place.x, place.y) == pytest.approx((10.5, 0), abs=0.01) and place.width == pytest.approx(1, abs=1e-3)


def test_notches_and_slots_in_an_outline_are_found_from_outside() -> None:
    notched = polygon_contour([(0, 0), (40, 0), (40, 20), (21, 20), (21, 12), (19, 12), (19, 20), (0, 20)])
    _, (place,) = found(contour_job([notched], outside()))
    assert place.width == pytest.approx(2, abs=1e-4) and place.x == pytest.approx(20)
    vee = polygon_contour([(0, 0), (40, 0), (40, 20), (21, 20), (20, 17), (19, 20), (0, 20)])
    assert len(found(contour_job([vee], outside()))[1]) == 1
    shallow = polygon_contour([(0, 0), (40, 0), (40, 20), (25, 20), (20, 18), (15, 20), (0, 20)])
    assert found(contour_job([shallow], outside()))[1] == []


def test_rounded_and_chamfered_corners_are_corners() -> None:
    rounded = bulged([(1, 0, 0), (20, 0, 0), (20, 20, 0), (0, 20, 0), (0, 1, math.tan(math.pi / 8))])
    chamfered = polygon_contour([(1, 0), (20, 0), (20, 20), (0, 20), (0, 1)])
    for contour in (rounded, chamfered):
        assert found(contour_job([contour]))[1] == []


def test_beside_a_clamp_the_clamp_is_to_blame() -> None:
    _, places = found(contour_job([square(40)], clamps=[square(10, 15, -5)]))
    assert not [place for place in places if not place.clamped]
    _, (near,) = found(contour_job([square(40)], outside(), clamps=[square(10, 15, -12)]))
    assert near.clamped and near.width == pytest.approx(2, abs=1e-3)
