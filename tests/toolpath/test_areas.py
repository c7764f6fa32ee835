"""Areas are put together, cut and taken from one another also where the library alone has no answer."""

from __future__ import annotations

import numpy as np
import pytest
import shapely

from app.toolpath.coverage.areas import common, opened, unions, united, without

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


def test_many_areas_on_all_cores_keep_their_order() -> None:
    """As many as are shared out; of every third one nothing is left."""
    wide = np.where(np.arange(100) % 3 == 0, 0.5, 2.0 + np.arange(100))
    boxes = np.asarray(shapely.box(0.0, 0.0, wide, 3.0), dtype=object)
    assert shapely.area(opened(boxes, 0.5)) == pytest.approx(3.0 * wide[wide > 1])
    covered = unions([np.asarray(shapely.box([0.0, 1.0], 0.0, [2.0, each], 3.0), dtype=object) for each in wide + 3])
    assert shapely.area(covered) == pytest.approx(3.0 * (wide + 3))
