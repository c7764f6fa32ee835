"""What of polygons lies in boxes is what the library finds for one box after the other."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from app.toolpath.coverage import proven
from app.toolpath.coverage.proven import cut_out
from tests.examples import examples


def _plate(rng: np.random.Generator) -> shapely.Polygon:
    """A plate with holes, some of which reach beyond its rim."""
    holes = shapely.buffer(shapely.points(rng.uniform(-10, 10, (12, 2))), rng.uniform(0.3, 3.0, 12))
    return shapely.difference(shapely.box(-10, -10, 10, 10), shapely.union_all(holes))


@pytest.mark.parametrize("few_points", [4, 1000], ids=["halved", "whole"])
@given(st.integers(0, 10**6))
@settings(max_examples=examples(20), deadline=None)
def test_each_box_holds_what_lies_in_it(few_points: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    plate, other = _plate(rng), shapely.affinity.translate(_plate(rng), 21.0)
    shapes = shapely.get_parts(shapely.get_parts([plate, other]))
    low = rng.uniform((-12, -12), (32, 12), (15, 2))
    boxes = np.asarray(shapely.box(*low.T, *(low + rng.uniform(0.1, 9.0, (15, 2))).T), dtype=object)
    before, proven._FEW_POINTS = proven._FEW_POINTS, few_points
    try:
        box, pieces = cut_out(shapes, boxes)
    finally:
        proven._FEW_POINTS = before
    assert not np.any(shapely.is_empty(pieces))
    for k, each in enumerate(boxes):
        expected = shapely.intersection(shapely.union_all(shapes), each)
        found = shapely.union_all(pieces[box == k])
        assert shapely.area(shapely.symmetric_difference(expected, found)) < 1e-9


def test_boxes_beside_everything_hold_nothing() -> None:
    box, pieces = cut_out(np.array([shapely.box(0, 0, 1, 1)], dtype=object), np.array([shapely.box(2, 2, 3, 3)]))
    assert not len(box) and not len(pieces)
