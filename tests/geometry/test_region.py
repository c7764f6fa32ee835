"""Even-odd nesting."""

from __future__ import annotations

from app.geometry.outlines import nest, reversed_contour
from app.geometry.primitives import contour_rows, signed_area
from app.model.part import Contour
from tests.part_shapes import circle, fig2, square


def test_fig2_is_a_region_with_an_island_and_one_without() -> None:
    first, second = nest(fig2())
    assert (len(first.islands), len(second.islands)) == (1, 0)
    assert (first.number, second.number) == (1, 2)


def test_boundaries_turn_left_and_islands_right_whatever_was_drawn() -> None:
    for flip in (False, True):
        outer, hole = square(40), circle(5, 20, 20)
        (region,) = nest([reversed_contour(hole) if flip else hole, outer if flip else reversed_contour(outer)])
        assert signed_area(contour_rows(region.boundary)) > 0
        assert signed_area(contour_rows(region.islands[0])) < 0


def test_an_area_inside_an_island_is_a_region_of_its_own() -> None:
    outer, inner = nest([square(60), square(40, 10, 10), square(20, 20, 20)])
    assert len(outer.islands) == 1 and inner.islands == ()


def test_the_island_belongs_to_the_smallest_area_round_it() -> None:
    regions = nest([square(100), square(80, 10, 10), square(60, 20, 20), circle(5, 50, 50)])
    assert [len(r.islands) for r in regions] == [1, 1]


def test_open_contours_bound_nothing() -> None:
    opened = Contour(square().primitives[:3], closed=False)
    assert nest([opened]) == ()


def test_islands_that_touch_the_boundary_are_islands() -> None:
    (region,) = nest([square(40), square(10, 0, 15)])
    assert len(region.islands) == 1
