"""Heights at single points, against the float64 reference and the engine's cells."""

import numpy as np
import pytest

from app.model.motion import Motions
from app.model.stock_box import StockBox
from app.simulation.field.workpiece import BoxStock, Grid
from app.simulation.sweeps.course import Course, TrimOptions
from app.simulation.sweeps.probe import PathProbe
from app.simulation.sweeps.trim import trim
from tests.simulation.courses import CUTTERS, arc, joined, polyline
from tests.simulation.reference import line, swept


def asked(motions: Motions, name: str, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """What motions of one tool leave at points, and which of them."""
    return PathProbe.of([Course(motions, np.ones(len(motions), np.int32))], {1: CUTTERS[name]}).lowest(points)


@pytest.mark.parametrize("name", CUTTERS)
def test_a_straight_way_is_the_reference(name: str) -> None:
    rng = np.random.default_rng(3)
    for start, end in rng.uniform((-4, -4, -3), (4, 4, 0), (12, 2, 3)):
        points = rng.uniform(-8, 8, (60, 2))
        expected = swept(CUTTERS[name], line(start, end), points)
        got = asked(polyline(np.array([start, end])), name, points)[0]
        rim = np.isfinite(expected) != np.isfinite(got)
        assert np.count_nonzero(rim) <= 1
        both = np.isfinite(expected) & np.isfinite(got)
        assert np.abs(got[both] - expected[both]).max(initial=0.0) < 2e-5


def test_upright_ways_and_standing_still() -> None:
    points, end = np.array([[0.0, 0.0], [2.9, 0.0], [3.1, 0.0]]), [0.0, 0.0, -2.0]
    for begin in ([0.0, 0.0, 0.0], end):
        assert asked(polyline(np.array([begin, end])), "flat", points)[0] == pytest.approx([-2.0, -2.0, np.inf])


@pytest.mark.parametrize("name", CUTTERS)
def test_the_cells_of_the_engine_are_met(name: str) -> None:
    rng = np.random.default_rng(5)
    motions = joined([polyline(rng.uniform((-9, -9, -3), (9, 9, -0.5), (30, 3))), arc((5, 0, -2), (-5, 0, -1), (0, 0, -2))])
    course, grid = Course(motions, np.ones(len(motions), np.int32)), Grid.over((-10, -10, 10, 10), 60)
    cut = trim(BoxStock(StockBox(-10, -10, -20, 10, 10, 0)).over(grid), course, {1: CUTTERS[name]}, TrimOptions())
    points = np.column_stack([each.ravel() for each in np.meshgrid(grid.xs(), grid.ys())])
    heights, rows = PathProbe.of([course], {1: CUTTERS[name]}).lowest(points)
    heights = np.minimum(heights, 0.0).reshape(cut.heights.shape)
    assert np.count_nonzero(np.abs(heights - cut.heights) > 2e-4) <= 3
    assert np.all((rows >= 0).reshape(cut.heights.shape)[cut.heights < -1e-3])
