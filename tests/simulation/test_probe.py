"""Heights at single points, against the float64 reference and the engine's cells."""

import numpy as np
import pytest

from app.model.motion import Motions
from app.model.stock_box import StockBox
from app.simulation.field.workpiece import BoxStock, Grid
from app.simulation.sweeps.course import Course, TrimOptions
from app.simulation.sweeps.pieces import helix_chord
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
    motions = joined(
        [polyline(rng.uniform((-9, -9, -3), (9, 9, -0.5), (30, 3))), arc((5, 0, -2), (-5, 0, -1), (0, 0, -2))]
    )
    course, grid = Course(motions, np.ones(len(motions), np.int32)), Grid.over((-10, -10, 10, 10), 60)
    cut = trim(BoxStock(StockBox(-10, -10, -20, 10, 10, 0)).over(grid), course, {1: CUTTERS[name]}, TrimOptions())
    points = np.column_stack([each.ravel() for each in np.meshgrid(grid.xs(), grid.ys())])
    heights, rows = PathProbe.of([course], {1: CUTTERS[name]}).lowest(points)
    heights = np.minimum(heights, 0.0).reshape(cut.heights.shape)
    slope = CUTTERS[name].slope if np.isfinite(CUTTERS[name].slope) else 0.0
    off = 2e-4 + (1.0 + slope) * helix_chord(grid.pitch)  # the engine's helices are as fine as its cells
    assert np.count_nonzero(np.abs(heights - cut.heights) > off) <= 3
    assert np.all((rows >= 0).reshape(cut.heights.shape)[cut.heights < -1e-3])


@pytest.mark.parametrize("name", CUTTERS)
def test_a_level_arc_is_the_reference(name: str) -> None:
    points = np.random.default_rng(7).uniform(-9, 9, (150, 2))
    got = asked(arc((5, 0, -2), (-3, 4, -2), (0, 0, -2), ccw=False), name, points)[0]

    def way(t: np.ndarray) -> np.ndarray:
        angle = -np.asarray(t) * (2 * np.pi - np.arctan2(4, -3))
        return np.stack([5 * np.cos(angle), 5 * np.sin(angle), np.full(angle.shape, -2.0)], axis=-1)

    expected = swept(CUTTERS[name], way, points)
    assert np.count_nonzero(np.isfinite(expected) != np.isfinite(got)) <= 1
    both = np.isfinite(expected) & np.isfinite(got)
    assert np.abs(got[both] - expected[both]).max() < 2e-5


def test_of_motions_that_are_as_low_the_first_is_told() -> None:
    back_and_forth = polyline([(-5, 0, -1), (5, 0, -1), (-5, 0, -1), (5, 0, -1), (5, 0, 2)])
    assert asked(back_and_forth, "flat", np.array([[0.0, 1.0], [0.0, 4.0]]))[1].tolist() == [0, -1]


def test_a_point_is_met_by_few_of_many_pieces_and_by_the_lowest() -> None:
    """Passes beside one another in both directions: each point against all motions, one by one."""
    rng = np.random.default_rng(11)
    xs = np.linspace(-9, 9, 40)
    motions = polyline(
        [(x, y, float(rng.uniform(-2, 0))) for k, x in enumerate(xs) for y in ((-9, 9) if k % 2 else (9, -9))]
    )
    points = rng.uniform(-9, 9, (40, 2))
    heights, rows = asked(motions, "bull", points)
    single = np.array(
        [swept(CUTTERS["bull"], line(a, b), points) for a, b in zip(motions.start, motions.end, strict=True)]
    )
    assert heights == pytest.approx(single.min(axis=0), abs=2e-5)
    assert single[rows, np.arange(len(points))] == pytest.approx(single.min(axis=0), abs=2e-5)
