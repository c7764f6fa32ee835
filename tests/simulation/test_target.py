"""Wanted heights: outlines on cells, grey dilation, reach, cutters that bound another; each against plain numpy."""

import math

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from app.simulation.cutter import Cutter
from app.simulation.field.judge_kernels import MOST_RINGS
from app.simulation.field.solid import SolidStock
from app.simulation.field.target import MARGIN, RIM, beside, cutter_profile, dilated, inside, solid_target
from app.simulation.field.workpiece import Grid
from app.simulation.sweeps.probe import reach_of, reachable
from tests.examples import examples
from tests.simulation.courses import CUTTERS

RNG = np.random.default_rng(4)
GRID = Grid(-1.0, 2.0, 0.1, 40, 60)


def centres(grid: Grid) -> tuple[np.ndarray, np.ndarray]:
    return np.meshgrid(grid.xs(), grid.ys())


def box(low: tuple[float, float, float], high: tuple[float, float, float]) -> np.ndarray:
    import trimesh

    mesh = trimesh.creation.box(bounds=[low, high])
    return np.array(mesh.triangles)


@given(st.integers(3, 9), st.integers(0, 10_000))
@settings(max_examples=examples(60), deadline=None)
def test_cells_are_inside_where_the_polygon_holds_their_centre(corners: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    outer, hole = rng.uniform((-2, 1), (6, 7), (corners, 2)), rng.uniform((0, 3), (3, 5), (3, 2))
    shape = shapely.symmetric_difference(
        *(shapely.make_valid(shapely.Polygon(ring), method="linework") for ring in (outer, hole))
    )
    if not shapely.is_simple(shapely.LinearRing(outer)):
        return
    expected = shapely.contains_xy(shape, *centres(GRID))
    assert np.array_equal(inside(GRID, [outer, hole]), expected)


def test_an_edge_through_the_centres_belongs_to_one_of_two_neighbours() -> None:
    y = float(GRID.ys()[10])
    below, above = np.array([[-1, 0], [5, 0], [5, y], [-1, y]]), np.array([[-1, y], [5, y], [5, 9], [-1, 9]])
    assert np.array_equal(inside(GRID, [below]) ^ inside(GRID, [above]), np.ones((40, 60), bool))


@pytest.mark.parametrize("name", CUTTERS)
def test_dilation_is_the_plain_maximum(name: str) -> None:
    heights = RNG.uniform(-3, 0, (23, 31)).astype(np.float32)
    profile = cutter_profile(CUTTERS[name], 0.5)
    expected = np.full_like(heights, -np.inf)
    reach = len(profile) // 2
    for dy in range(-reach, reach + 1):
        for dx in range(-reach, reach + 1):
            ys, xs = (slice(max(0, -d), min(size, size - d)) for d, size in ((dy, 23), (dx, 31)))
            yt, xt = (slice(max(0, d), min(size, size + d)) for d, size in ((dy, 23), (dx, 31)))
            shifted = heights[yt, xt] - profile[reach + dy, reach + dx]
            expected[ys, xs] = np.maximum(expected[ys, xs], shifted)
    assert np.array_equal(dilated(heights, profile), expected)


@pytest.mark.parametrize("name", CUTTERS)
@pytest.mark.parametrize("by", [0.01, 0.3, 0.99, 1.4, 2.5])
def test_a_wider_cutter_is_the_lowest_of_all_that_are_moved_aside_and_a_slimmer_one_is_above_the_highest(
    name: str, by: float
) -> None:
    cutter = CUTTERS[name]
    radii = np.linspace(0.0, cutter.radius + by, 4001)
    nearest, farthest = np.maximum(radii - by, 0.0), radii + by
    wide = cutter.grown(by)
    inner = radii <= wide.radius - 1e-9
    assert np.allclose(
        (wide.lift + wide.heights(radii))[inner], cutter.heights(np.minimum(nearest, cutter.radius))[inner], atol=1e-9
    )
    slim = cutter.shrunk(by)
    assert slim is not None and slim.radius == pytest.approx(cutter.radius - by)
    inner = radii <= slim.radius
    assert np.all(
        (slim.lift + slim.heights(radii))[inner] >= cutter.heights(np.minimum(farthest, cutter.radius))[inner] - 1e-9
    )
    assert cutter.shrunk(cutter.radius) is None


@pytest.mark.parametrize("name", CUTTERS)
def test_the_radius_at_a_height_is_the_profile_turned_round(name: str) -> None:
    cutter = CUTTERS[name]
    for height in np.linspace(0.0, 4.0, 41).tolist():
        radii = np.linspace(0.0, cutter.radius, 40_001)
        widest = radii[cutter.heights(radii) <= height + 1e-12].max()
        assert cutter.radius_at(height) == pytest.approx(widest, abs=1.5e-4 + 2e-6 / max(height, 1e-6) ** 0.5)
    assert cutter.radius_at(-0.1) == 0.0
    heights = np.linspace(-0.5, 4.0, 91)
    assert cutter.radii_at(heights).tolist() == [cutter.radius_at(each) for each in heights.tolist()]


def slotted(width: float) -> SolidStock:
    """A block of 60 x 40 with a slot along X, 5 deep, and a rabbet of 2 along its side at Y 40."""
    import trimesh

    parts = [((0, 0, -20), (60, 40, -5)), ((0, 0, -5), (60, 20 - width / 2, 0)), ((0, 20 + width / 2, -5), (60, 38, 0))]
    return SolidStock(np.concatenate([trimesh.creation.box(bounds=each).triangles for each in parts]))


@pytest.mark.parametrize(("width", "reached"), [(5.0, False), (5.7, False), (6.0, True), (6.1, True), (8.0, True)])
def test_a_slot_is_within_reach_from_the_width_of_the_tool_on(width: float, reached: bool) -> None:
    grid, solid = Grid.over((0, 0, 60, 40), 512), slotted(width)
    lowest = reach_of(solid, 0.0, grid.box, [Cutter(3.0, 3.0)])
    target = solid_target(solid, grid)
    left = target.deviation(np.zeros((grid.rows, grid.cols), np.float32)) > 0.01
    *heights, over_part = lowest.over(grid)
    sure, possible = (each <= target.high + np.float32(0.01) for each in heights)
    within = reachable(left, sure, possible, over_part <= 0.01, 3)
    xs, ys = centres(grid)
    # a little way in it always gets
    assert np.all(within[(np.abs(ys - 20) < width / 2 - 0.2) & (np.abs(xs - 30) < 25)] == reached)
    assert np.all(within[(ys > 38.2) & (ys < 39.9)])  # the rabbet: from beside the stock


def test_the_margin_is_as_wide_as_the_kernels_look() -> None:
    assert MARGIN == MOST_RINGS


def test_a_solid_is_wanted_as_it_is_and_its_walls_may_fall_to_either_side() -> None:
    grid = Grid(0.05, 0.05, 0.1, 100, 100)  # centres on x = 0.1, 0.2, …: on the walls
    solid = SolidStock(np.concatenate([box((0, 0, -5), (10, 10, -2)), box((2, 2, -2), (4, 4, 0))]))
    target = solid_target(solid, grid)
    xs, ys = centres(grid)
    top = (xs > 2 + 2 * RIM) & (xs < 4 - 2 * RIM) & (ys > 2 + 2 * RIM) & (ys < 4 - 2 * RIM)
    wall = ((np.abs(xs - 2) < RIM) | (np.abs(xs - 4) < RIM)) & (ys > 1.95) & (ys < 4.05)
    assert np.all(target.low[top] == 0) and np.all(target.high[top] == 0)
    assert np.all(target.low[wall] == -2) and np.all(target.high[wall] == 0)
    heights = np.full((100, 100), -1.5, np.float32)
    assert np.all(target.deviation(heights)[top] == -1.5)
    assert np.all(target.deviation(heights)[wall] == 0)
    beside = solid_target(solid, Grid(20, 20, 0.1, 3, 3))
    assert np.all(beside.deviation(np.full((3, 3), -9, np.float32)) == 0)


def test_stock_to_leave_lies_on_the_solid_along_its_normal() -> None:
    grid = Grid(0.0, 0.0, 0.05, 200, 200)
    solid = SolidStock(box((0, 0, -5), (10, 5, 0)) @ np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1]]).T)
    slope = SolidStock(
        solid.triangles
        + np.stack([np.zeros(solid.triangles.shape[:2])] * 2 + [0.75 * solid.triangles[..., 0]], axis=-1)
    )
    target = solid_target(slope, grid, leave=0.4)
    xs, ys = centres(grid)
    middle = (xs > 3) & (xs < 7) & (ys > 1) & (ys < 4)
    expected = 0.75 * xs + 0.4 * math.hypot(1.0, 0.75)
    assert np.abs(target.heights - expected)[middle].max() < 0.005


def test_a_flat_that_is_used_up_leaves_none_and_not_less_than_none() -> None:
    for flat in np.linspace(1e-4, 2e-3, 400).tolist():
        slim = Cutter(2.5 + flat, flat, 2.5).shrunk(1.7 * flat)
        assert slim is not None
        assert slim.flat == 0.0


@given(st.integers(3, 9), st.integers(0, 10_000), st.sampled_from([0.0, 1e-3, 0.02, 0.15, 0.7]))
@settings(max_examples=examples(60), deadline=None)
def test_cells_are_beside_an_outline_where_their_centre_is_as_near(corners: int, seed: int, distance: float) -> None:
    rng = np.random.default_rng(seed)
    rings = [np.round(rng.uniform((-2, 1), (6, 7), (count, 2)), 2 + seed % 3) for count in (corners, 3)]
    away = shapely.distance(
        shapely.points(*centres(GRID)), shapely.MultiLineString([[*ring, ring[0]] for ring in rings])
    )
    found = beside(GRID, rings, distance)
    assert np.all(found[away < distance - 1e-9]) and not np.any(found[away > distance + 1e-9])
