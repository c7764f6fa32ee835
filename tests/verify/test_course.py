"""Which motions may cut in a box."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from app.model.motion import MotionKind
from app.model.stock_box import StockBox
from app.simulation.cutter import Cutter
from app.simulation.field.workpiece import BoxStock
from app.simulation.sweeps.course import Course
from app.verify.course import FineStock, straight


@pytest.mark.parametrize("count", [0, 1, 3, 700])
def test_motions_near_a_box_are_those_whose_cutter_comes_into_its_shadow(count: int) -> None:
    chance = np.random.default_rng(count)
    start = chance.uniform(0, 100, (count, 3))
    end = start + chance.uniform(-8, 8, (count, 3))
    rapid = chance.random(count) < 0.3
    motions = replace(straight(start, end), kind=np.where(rapid, MotionKind.RAPID, MotionKind.LINE).astype(np.uint8))
    tool = chance.integers(1, 3, count).astype(np.int32)
    left_out = tuple(range(0, count, 7))
    radius = np.array([0.0, 1.0, 3.0])
    stock = BoxStock(StockBox(0, 0, -10, 100, 100, 0))
    cutters = {number: Cutter(radius[number], radius[number]) for number in (1, 2)}
    metal = FineStock(stock, (Course(motions, tool, left_out),), cutters)
    cuts = ~rapid & ~np.isin(np.arange(count), left_out)
    for x, y in chance.uniform(0, 100, (20, 2)):
        low = np.minimum(start, end)[:, :2] - radius[tool][:, None]
        high = np.maximum(start, end)[:, :2] + radius[tool][:, None]
        meets = np.all((low <= [x + 5, y + 9]) & (high >= [x, y]), axis=1)
        np.testing.assert_array_equal(metal.near(0, (x, y, x + 5, y + 9)), np.flatnonzero(meets & cuts))
