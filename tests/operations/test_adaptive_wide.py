"""Wide places of adaptive clearing: ways along the metal's edge, what they clear, and that they are worth it."""

from __future__ import annotations

import math

import numpy as np
import pytest

from app.geometry.primitives import Rows
from app.operations.adaptive.front import MetalFront
from app.operations.adaptive.limit import DigitGrid, EngagementLimit
from app.operations.adaptive.plan import ConnectedPath
from app.operations.adaptive.pursuit import Heading, biarc
from app.operations.adaptive.wide import WayWorth
from app.toolpath.engagement.swath_shapes import swath_shapes
from tests.operations.engaged import at, reached, sweep
from tests.operations.test_adaptive import ANGLE, LIMIT, R, greatest, path_of, planned, rectangle

FASTER = 4.0


def quarter(x: float, y: float, radius: float, side: float) -> list[float]:
    """A quarter of a circle about the origin of it, from its right."""
    return [x + radius, y, x, y + side * radius, x, y, radius, side]


ROWS = {
    "line": [0.0, 0.0, 7.0, 2.0, 0.0, 0.0, 0.0, 0.0],
    "left": quarter(1.0, 2.0, 8.0, 1.0),
    "right": quarter(1.0, 2.0, 8.0, -1.0),
    "tight": quarter(0.0, 0.0, 0.4, 1.0),
}


@pytest.mark.parametrize("name", ROWS)
def test_shapes_of_a_swath_lie_in_what_the_cutter_sweeps_and_reach_its_border(name: str) -> None:
    row = np.array(ROWS[name])
    shapes = swath_shapes(row[None], R)
    x, y = np.random.default_rng(0).uniform(-12, 14, (2, 20000))
    held = np.zeros(len(x), np.bool_)
    for cx, cy, reach, nx, ny, h, mx, my, k in shapes:
        held |= (np.hypot(x - cx, y - cy) <= reach) & (nx * x + ny * y <= h) & (mx * x + my * y <= k)
    assert not (held & ~reached(x, y, row[None], R + 1e-6)).any()
    # what is left out lies on the inner side alone: half of the swath is there at the least
    assert held.sum() > 0.5 * reached(x, y, row[None], R).sum()


def half_plane_front() -> MetalFront:
    """Ground that long ways along x have cleared, up to y = R; metal stands above."""
    front = MetalFront(LIMIT)
    front.sweep(np.array([[-40.0, y, 40.0, y, 0.0, 0.0, 0.0, 0.0] for y in (-8.0, -4.0, 0.0)]))
    return front


@pytest.mark.parametrize("depth", [0.2, 1.0, 2.5])
def test_metal_is_met_up_to_the_angle_of_the_closed_form(depth: float) -> None:
    angle = math.acos(1 - depth / R)
    # to the left of x: metal is on the right
    assert half_plane_front().met((0.0, depth), math.pi) == pytest.approx(angle, abs=1e-9)
    assert half_plane_front().met((0.0, -0.1), math.pi) is None


def test_a_row_along_metal_has_the_bound_of_the_closed_form_and_air_is_air() -> None:
    row = np.array([10.0, 1.0, -10.0, 1.0, 0.0, 0.0, 0.0, 0.0])
    angle = math.acos(1 - 1.0 / R)
    assert half_plane_front().bound(row, angle + 1e-3) <= angle + 1e-3
    assert half_plane_front().bound(row, angle - 1e-3) > angle - 1e-3
    assert not half_plane_front().is_air(row)
    assert half_plane_front().is_air(np.array([10.0, 0.0, -10.0, -0.0, 0.0, 0.0, 0.0, 0.0]))


def test_a_disc_is_clear_where_shapes_together_hold_it_and_forgotten_ones_hold_nothing() -> None:
    front = half_plane_front()
    count = len(front.table)
    front.sweep(np.array([[-40.0, 4.0, 40.0, 4.0, 0.0, 0.0, 0.0, 0.0]]))
    assert front.covers((0.0, 2.0, 4.99)) and not front.covers((0.0, 2.0, 5.01))
    front.forget(count)
    assert not front.covers((0.0, 2.0, 4.99)) and front.covers((0.0, 0.0, 2.99))


def test_the_most_of_an_arc_that_leaves_metal_is_at_its_beginning() -> None:
    most, where = half_plane_front().most((0.0, 1.0 - 2.0), 2.0, math.pi)
    assert most == pytest.approx(math.acos(1 - 1.0 / R), abs=1e-9) and where == math.pi


@pytest.mark.parametrize("seed", range(5))
def test_two_arcs_go_from_pose_to_pose_and_touch(seed: int) -> None:
    x, y, ahead = np.random.default_rng(seed).uniform((1, -1, -1), (3, 1, 1)).tolist()
    first, second = (np.array(row) for row in biarc(Heading(0.0, 0.0, 0.0), Heading(x, y, ahead)))
    assert first[:2].tolist() == [0.0, 0.0] and second[2:4].tolist() == [x, y]
    assert np.abs(first[2:4] - second[:2]).max() < 1e-12
    turns = [
        float(at(row, np.array([share]))[1][0]) for row, share in ((first, 0), (first, 1), (second, 0), (second, 1))
    ]
    wrapped = [(a - b + math.pi) % math.tau - math.pi for a, b in ((turns[0], 0.0), (turns[1], turns[2]))]
    assert np.abs(wrapped).max() < 1e-6 and math.cos(turns[3] - ahead) > 1 - 1e-9
    assert max(sweep(row) for row in (first, second) if row[7] != 0) < math.pi


def test_ways_that_cost_more_than_discs_are_left() -> None:
    row: Rows = np.array([0.0, 0.0, 50.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    worth = WayWorth(100.0, FASTER)
    assert worth.lost([row], [False], 0.4) and not worth.lost([row], [False], 0.7)
    assert not worth.lost([row], [True], 0.1)


@pytest.fixture(scope="module")
def small() -> ConnectedPath:
    (part,) = planned([rectangle(26, 12)])
    return part


def test_a_wide_place_takes_less_time_than_discs(small: ConnectedPath) -> None:
    """Coarse digits have discs alone; so fine ones of the same kind tell what these take."""
    (discs,) = planned([rectangle(26, 12)], EngagementLimit(R, ANGLE, 1.0, DigitGrid(1e-6)))
    assert small.effort(FASTER) < 0.93 * discs.effort(FASTER)


@pytest.mark.exhaustive
def test_a_wide_place_keeps_the_limit_and_goes_fast_over_clear_ground_alone(small: ConnectedPath) -> None:
    rows, clear = path_of(small)
    assert not small.unproven and not small.stops
    assert greatest(rows, step=1.0)[1] < ANGLE
    assert clear.any()
