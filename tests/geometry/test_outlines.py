"""Many contours measured at once: as each alone, in closed form."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely

from app.geometry.outlines import Outlines, nested, polygons
from app.model.curves import Circle
from app.model.part import Contour
from tests.part_shapes import square


def contours() -> list[Contour]:
    return [Contour((Circle((30.0, 1e6), 5.0),)), square(10), Contour((Circle((0.0, 0.0), 0.0005, False),))]


def test_areas_lengths_and_boxes_are_those_of_each() -> None:
    outlines = Outlines.of(contours())
    assert outlines.areas == pytest.approx([25 * math.pi, 100.0, -2.5e-7 * math.pi], rel=1e-9)
    assert outlines.lengths == pytest.approx([10 * math.pi, 40.0, 0.001 * math.pi])
    assert outlines.boxes[0] == pytest.approx([25.0, 1e6 - 5, 35.0, 1e6 + 5])
    assert outlines.owner.tolist() == [0] * 3 + [1] * 4 + [2] * 3
    assert outlines.following.tolist() == [1, 2, 0, 4, 5, 6, 3, 8, 9, 7]
    assert outlines.following[outlines.previous].tolist() == list(range(10))


def test_nothing_has_no_rows_and_no_areas() -> None:
    none = Outlines.of([])
    assert len(none) == len(none.areas) == len(none.boxes) == len(polygons(none, np.zeros(0, np.int64), 0.1)[1]) == 0


def test_each_is_asked_for_its_own_point() -> None:
    points = np.array([[30.0, 1e6 + 4.9], [30.0, 1e6], [0.0, 0.0006]])
    assert Outlines.of(contours()).enclose(points).tolist() == [True, False, False]


def test_polygons_have_holes_and_what_is_too_small_for_a_chord_is_left_out() -> None:
    circles = [Circle((0.0, 0.0), 10.0), Circle((0.0, 0.0), 4.0, False), Circle((50.0, 0.0), 2.0)]
    outlines = Outlines.of([Contour((circle,)) for circle in circles])
    number, shapes = polygons(outlines, np.array([0, 0, 2]), 1e-4)
    assert number.tolist() == [0, 2]
    assert shapely.area(shapes) == pytest.approx([84 * math.pi, 4 * math.pi], rel=1e-4)
    assert polygons(outlines, np.array([0, 0, 2]), np.array([1e-4, 1e-4, 1e-4]))[1][0].equals(shapes[0])


def test_ten_thousand_discs_in_a_plate_are_its_islands_at_once() -> None:
    places = [(3.0 * i, 3.0 * j) for i in range(100) for j in range(100)]
    plate = [Contour((Circle((150.0, 150.0), 300.0),)), *(Contour((Circle(place, 1.0),)) for place in places)]
    (region,) = nested(plate).regions
    assert len(region.islands) == len(places)
