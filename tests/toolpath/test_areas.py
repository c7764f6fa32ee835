"""Areas are put together, cut and taken from one another also where the library alone has no answer."""

from __future__ import annotations

import pytest
import shapely

from app.toolpath.coverage.areas import common, united, without

BOW = shapely.Polygon([(0, 0), (10, 10), (10, 0), (0, 10)])
"""Two triangles of 25 mm2 that meet in a point, drawn as one outline that crosses itself."""

BOX = shapely.box(2, -1, 8, 11)


def test_the_library_alone_gives_up() -> None:
    with pytest.raises(shapely.errors.GEOSException):
        shapely.intersection(BOW, BOX)


def test_areas_in_closed_form() -> None:
    assert common(BOW, BOX).area == pytest.approx(2 * 9)
    assert without(BOW, BOX).area == pytest.approx(2 * 16)
    assert united([BOW, BOX]).area == pytest.approx(6 * 12 + 2 * 16)
