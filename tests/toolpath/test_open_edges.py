"""Areas that go on past the stock's edges: against unions of polygons."""

from __future__ import annotations

import numpy as np
import pytest
import shapely

from app.geometry.even_odd import even_odd
from app.geometry.outlines import nested, polygon_contour
from app.geometry.primitives import contour_rows, sample
from app.model.part import Contour, Region
from app.toolpath.machining_areas import BoxSides, opened
from tests.examples import examples
from tests.part_shapes import circle

STOCK, PAST = BoxSides(0.0, 0.0, 100.0, 60.0), 7.0


def regions_of(*contours: Contour) -> tuple[Region, ...]:
    return nested(contours).regions


def shape_of(contours: tuple[Contour, ...]) -> shapely.Geometry:
    made = shapely.Polygon()
    for contour in contours:
        made = made.symmetric_difference(shapely.Polygon(sample(contour_rows(contour), 1e-6)))
    return made


def test_an_area_that_touches_no_edge_stays_as_it_is() -> None:
    regions = regions_of(circle(10, 50, 30))
    past = opened(regions, STOCK, PAST)
    assert past.strips == () and past.contours == regions[0].contours and not past.findings


def test_all_of_the_stock_goes_on_all_round() -> None:
    past = opened(regions_of(polygon_contour([(0, 0), (100, 0), (100, 60), (0, 60)])), STOCK, PAST)
    assert even_odd(past.contours).area == pytest.approx(114 * 74) and len(past.contours) == 1
    assert even_odd(past.strips).area == pytest.approx(114 * 74 - 6000)


def test_a_wall_a_thousandth_inside_the_edge_is_a_wall() -> None:
    regions = regions_of(polygon_contour([(20, 1e-3), (50, 1e-3), (50, 30), (20, 30)]))
    assert not opened(regions, STOCK, PAST).strips


@pytest.mark.parametrize("seed", range(examples(60)))
def test_what_comes_of_it_is_area_and_strips_together(seed: int) -> None:
    """Polygons with a side on an edge, some with an island, and with a bay from a corner of the side."""
    rng = np.random.default_rng(seed)
    low = float(rng.uniform(10, 60))
    high = low + float(rng.uniform(5, 30))
    inner = np.column_stack([rng.uniform(5, 95, 4), rng.uniform(8, 55, 4)]).tolist()
    polygon = shapely.MultiPoint([(low, 0.0), (high, 0.0), *inner]).convex_hull
    if rng.integers(2):
        polygon = polygon.difference(shapely.Polygon([(low - 30, 2.0), (low + 3, 4.0), (low - 30, 6.0)]))
        polygon = max(shapely.get_parts(polygon).tolist(), key=lambda part: part.area)
    contours = [polygon_contour(shapely.get_coordinates(shapely.orient_polygons(polygon).exterior)[:-1].tolist())]
    middle = polygon.representative_point()
    if (room := middle.distance(polygon.exterior)) > 1:
        contours.append(circle(room / 2, middle.x, middle.y))
    regions = regions_of(*contours)
    past = opened(regions, STOCK, PAST)
    assert not past.findings
    drawn, strips = shape_of(tuple(c for region in regions for c in region.contours)), shape_of(past.strips)
    assert strips.area == pytest.approx((high - low + 2 * PAST) * PAST)
    off = shape_of(past.contours).symmetric_difference(drawn.union(strips))
    assert off.area < 1e-4
