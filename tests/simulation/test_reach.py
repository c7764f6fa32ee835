"""Which cells that are left count as within reach."""

import math

import numpy as np
import pytest
import trimesh

from app.simulation.cutter import Cutter
from app.simulation.field.solid import SolidStock
from app.simulation.field.target import solid_target
from app.simulation.field.workpiece import Grid
from app.simulation.sweeps.probe import reach_of, reachable

TOLERANCE = 0.02
BALL = Cutter(2.0, fillet=2.0)


def test_a_narrow_place_counts_where_a_tool_comes_near_enough_and_nowhere_else() -> None:
    left, sure, possible, near = (np.zeros((12, 20), np.bool_) for _ in range(4))
    left[2:10, 2:9] = possible[2:10, 2:9] = True  # wide
    left[5, 9:13] = possible[5, 9:13] = True  # a rim of one cell beside it
    left[3:9, 16] = possible[3:9, 16] = True  # as narrow, and alone
    assert reachable(left, sure, possible, near, 3).sum() == 8 * 7
    near[5, 9:15] = near[4, 16] = True
    found = reachable(left, sure, possible, near, 3)
    assert found[2:10, 2:9].all() and found[5, 9:13].all() and found[4, 16]
    assert found.sum() == 8 * 7 + 4 + 1, "near alone is not possible"
    sure[6, 16] = True
    assert reachable(left, sure, possible, near, 3)[6, 16]


def ramp(degrees: float) -> SolidStock:
    """A floor at Z 0 from X -10 to 0 and a slope up from there to Z 6, 12 wide."""
    up = 6 / math.tan(math.radians(degrees))
    floor = np.array([(x, y, z) for y in (-6.0, 6.0) for x, z in ((-10, -4), (10, -4), (-10, 0), (10, 0))])
    hill = np.array([(x, y, z) for y in (-6.0, 6.0) for x, z in ((0, 0), (up, 6), (10, 6), (10, 0))])
    return SolidStock(np.concatenate([trimesh.convex.convex_hull(each).triangles for each in (floor, hill)]))


def closing(x: np.ndarray, degrees: float, radius: float) -> np.ndarray:
    """How far over floor and slope a ball stays, by the circle that touches both: 64 bit, no cells."""
    angle = math.radians(degrees)
    foot = radius * math.tan(angle / 2)
    under = np.where(x < 0, 0.0, x * math.tan(angle))
    inside = (x > -foot) & (x < foot * math.cos(angle))
    return np.where(inside, radius - np.sqrt(np.maximum(radius**2 - (x + foot) ** 2, 0.0)) - under, 0.0)


@pytest.mark.parametrize("degrees", [30.0, 60.0, 80.0, 85.0])
def test_the_foot_of_a_slope_is_out_of_reach_as_the_closing_says_and_the_slope_is_not(degrees: float) -> None:
    grid, solid = Grid.over((-10, -6, 10, 6), 150), ramp(degrees)
    lowest = reach_of(solid, 0.0, grid.box, [BALL])
    target = solid_target(solid, grid)
    left = np.zeros((grid.rows, grid.cols), np.bool_)
    left[:, ::2] = True  # nowhere wide: wide places count as soon as they are possible
    *heights, over_part = lowest.over(grid)
    sure, possible = (each <= target.high + np.float32(TOLERANCE) for each in heights)
    found = reachable(left, sure, possible, over_part <= TOLERANCE, 3)[grid.rows // 2]
    x = grid.xs()
    both = [closing(x + side * grid.pitch, degrees, 2.0) <= TOLERANCE for side in (-1.0, -0.5, 0.0, 0.5, 1.0)]
    seen = (x < 6 / math.tan(math.radians(degrees)) - 2 * grid.pitch) | (x > 3)
    assert found[seen & left[0] & np.logical_and.reduce(both)].all(), "the slope is within reach up to its foot"
    assert not found[seen & ~np.logical_or.reduce(both)].any(), "the foot is not, but for a cell"
