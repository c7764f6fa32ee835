"""What polygons take to be within reach, asked once more by exact distances: passages a few micrometres too narrow."""

import numpy as np
import pytest

from app.geometry.outlines import polygon_contour
from app.model.curves import Point
from app.model.job import Job
from app.model.operation import CutParameters, PocketOperation
from app.model.part import Entity, Part, Region
from app.model.tool import Tool
from app.operations.compute import compute
from app.toolpath.coverage.areas import CutterInArea, Fields, reached
from app.toolpath.coverage.coverage import measure


def slot(width: float) -> tuple[Region, ...]:
    return (Region(1, polygon_contour([(0, 0), (30, 0), (30, width), (0, width)])),)


SLOTS = [(6.0, True), (5.9999995, True), (5.99902, True), (5.9985, False), (5.997, False), (5.5, False), (6.01, True)]


@pytest.mark.parametrize(("width", "fits"), SLOTS)
def test_a_slot_is_reached_only_where_the_cutter_fits(width: float, fits: bool) -> None:
    cutter = CutterInArea(slot(width), 3.0, 3.0)
    assert reached(np.array([[15.0, width / 2]]), [cutter], Fields(), 1.0) is fits


@pytest.mark.parametrize(("width", "counts"), [(6.0, False), (6.0015, False), (6.0021, True)])
def test_a_sliver_counts_where_a_cutter_with_a_micrometre_to_spare_reaches_it(width: float, counts: bool) -> None:
    cutter = CutterInArea(slot(width), 3.0, 3.0)
    assert reached(np.array([[15.0, width / 2]]), [cutter], Fields(), 0.05) is counts


def test_a_corner_is_out_of_reach_and_what_lies_beside_it_is_not() -> None:
    cutter, fields = CutterInArea(slot(20.0), 3.0, 3.0), Fields()
    assert not reached(np.array([[0.5, 0.5]]), [cutter], fields, 1.0)
    assert reached(np.array([[0.5, 0.5], [1.0, 1.0]]), [cutter], fields, 1.0)
    assert not reached(np.array([[-1.0, 10.0]]), [cutter], fields, 1.0)


def test_points_asked_together_are_reached_where_one_of_them_is() -> None:
    """Far from one another, in any order: in corners of two slots, one of which is wide enough."""
    for width, fits in ((5.9, False), (6.1, True)):
        regions = (*slot(5.5), Region(2, polygon_contour([(100, 90), (130, 90), (130, 90 + width), (100, 90 + width)])))
        points = np.array([[15.0, 2.75], [115.0, 90.0], [2.0, 2.0]])
        for some in (points, points[::-1]):
            assert reached(some, [CutterInArea(regions, 3.0, 3.0)], Fields(), 1.0) is fits


def two_rooms(width: float) -> list[Point]:
    """Two rooms with a passage between them."""
    low, high = 10 - width / 2, 10 + width / 2
    return [
        (0, 0),
        (20, 0),
        (20, low),
        (40, low),
        (40, 0),
        (60, 0),
        (60, 20),
        (40, 20),
        (40, high),
        (20, high),
        (20, 20),
        (0, 20),
    ]


@pytest.mark.parametrize("width", [5.9985, 5.997, 5.992])
def test_a_passage_too_narrow_by_micrometres_is_not_said_to_be_left_within_reach(width: float) -> None:
    lines = polygon_contour(two_rooms(width)).primitives
    part = Part().with_entities(tuple(Entity(k, line) for k, line in enumerate(lines, 1)))
    job = Job(part, (Tool(1, 6.0),), (PocketOperation(CutParameters(1)),))
    found = measure(compute(job), job)
    assert found.reachable_left_mm2 == 0
    assert found.unreachable_mm2 > 100  # the passage
