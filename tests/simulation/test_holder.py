"""What of a tool does not cut, and how deep that goes into metal that stays as it is."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.core.errors import ParameterError
from app.model.motion import Floats
from app.model.tool import HolderPoint, Tool
from app.model.tool_kind import ToolKind
from app.simulation.bodies.bodies import Body, BodyPaths, HeightPyramid, HolderPart, bodies_of, holder_of, shape_rows
from app.simulation.cutter import Cutter
from app.simulation.field.workpiece import Grid, Workpiece


def held(*outline: HolderPoint) -> Tool:
    return Tool(1, 6.0, stick_out=20.0, holder=outline)


def test_a_tool_of_which_nothing_is_known_has_no_bodies() -> None:
    assert bodies_of(Tool(1, 6.0)) == ()
    assert bodies_of(Tool(1, 6.0, shank_diameter=6.0)) == ()
    assert bodies_of(Tool(1, 6.0, ToolKind.THREAD_MILL, flute_length=10.0)) == ()
    assert bodies_of(Tool(1, 6.0, stick_out=20.0)) == ()
    assert bodies_of(Tool(1, 6.0, holder=((0.0, 10.0), (30.0, 10.0)))) == ()


def test_a_shank_begins_where_the_flutes_end() -> None:
    (shank,) = bodies_of(Tool(1, 6.0, flute_length=10.0, shank_diameter=8.0))
    assert shank == Body(HolderPart.SHANK, Cutter(4.0, 4.0, lift=10.0))
    (untold,) = bodies_of(Tool(1, 6.0, flute_length=10.0))
    assert untold == Body(HolderPart.SHANK, Cutter(3.0, 3.0, lift=10.0))


def test_a_holder_stands_at_the_stick_out() -> None:
    assert bodies_of(held((0.0, 10.0), (30.0, 10.0))) == (Body(HolderPart.HOLDER, Cutter(10.0, 10.0, lift=20.0)),)


def test_frustums_that_widen_are_bodies_and_those_that_do_not_are_in_their_lower_disc() -> None:
    cone = Cutter(12.0, 8.0, slope=1.25, lift=0.0)
    assert [body.shape for body in holder_of(held((0.0, 8.0), (5.0, 12.0), (20.0, 6.0), (30.0, 12.0)))] == [cone]


def test_a_step_is_a_disc_and_what_is_wider_above_a_waist_goes_on_from_there() -> None:
    step = holder_of(held((0.0, 8.0), (10.0, 8.0), (10.0, 15.0), (20.0, 15.0)))
    assert [body.shape for body in step] == [Cutter(8.0, 8.0), Cutter(15.0, 15.0, lift=10.0)]
    waist = holder_of(held((0.0, 8.0), (10.0, 4.0), (20.0, 14.0)))
    assert [body.shape for body in waist] == [Cutter(8.0, 8.0), Cutter(14.0, 4.0, slope=1.0, lift=10.0)]


OUTLINES = st.lists(st.tuples(st.floats(0, 20), st.floats(0, 20)), min_size=1, max_size=6).map(
    lambda points: tuple(
        (height - min(h for h, _ in points), radius) for height, radius in sorted(points, key=lambda point: point[0])
    )
)


@given(OUTLINES.filter(lambda outline: len(outline) > 1), st.floats(0, 20))
def test_bodies_are_as_low_as_the_outline_at_every_radius(outline: tuple[HolderPoint, ...], radius: float) -> None:
    """The lowest point of the outline, turned round the axis and filled, over a radius."""
    lowest = math.inf
    for (low, inner), (high, outer) in pairwise(outline):
        if radius <= inner:
            lowest = min(lowest, low)
        elif radius <= outer:
            lowest = min(lowest, low + (high - low) * (radius - inner) / (outer - inner))
    bodies = [body.shape for body in holder_of(Tool(1, 6.0, stick_out=1.0, holder=outline))]
    found = min((float(shape.heights(np.array([radius]))[0]) + shape.lift for shape in bodies), default=math.inf)
    assert found == pytest.approx(lowest, abs=1e-6)


def test_rounded_bodies_are_refused() -> None:
    with pytest.raises(ParameterError, match="discs and frustums"):
        shape_rows([Cutter(5.0, 0.0, 5.0)], 0.0)


def swept(grid: Grid, shape: Floats, way: Floats) -> Floats:
    """(rows, cols) lowest height of a body over each cell on its way, by dense sampling."""
    x, y = np.meshgrid(grid.xs(), grid.ys())
    low = np.full(x.shape, np.inf)
    radius, flat, slope, lift = shape
    for t in np.linspace(0.0, 1.0, 1501):
        px, py, pz = way[:3] + (way[3:] - way[:3]) * t
        aside = np.hypot(x - px, y - py)
        low = np.minimum(low, np.where(aside <= radius, pz + lift + slope * np.maximum(aside - flat, 0.0), np.inf))
    return low


@pytest.mark.parametrize("seed", range(40))
def test_the_pyramid_finds_the_deepest_place(seed: int) -> None:
    rng = np.random.default_rng(seed)
    grid = Grid(-3.0, 2.0, 0.7, int(rng.integers(1, 40)), int(rng.integers(1, 60)))
    heights = (rng.normal(0, 0.3, (grid.rows, grid.cols)).cumsum(0).cumsum(1)).clip(-20, 20).astype(np.float32)
    radius = rng.uniform(0.5, 12.0)
    flat = radius * rng.choice([0.0, 0.5, 1.0])
    shape = np.array([radius, flat, 0.0 if flat == radius else rng.uniform(0.2, 3.0), 1.5])
    start = np.array([*rng.uniform(-8, 40, 2), rng.uniform(-15, 5)])
    move = rng.normal(0, 8, 3) * [(1, 1, 0), (1, 1, 1), (0, 0, 1), (0, 0, 0)][seed % 4]
    way = np.concatenate([start, start + move])
    true = heights - swept(grid, shape, way)
    pyramid = HeightPyramid.of(Workpiece(grid, heights, -50.0))
    led = BodyPaths(way[None], shape[None], np.zeros(1, np.int64), np.zeros(1, np.int64), np.zeros(1))
    (depth,), (cell,) = pyramid.deeper(led, np.full(1, -1000.0))
    if not np.isfinite(true.max()):
        assert cell == -1
        return
    assert depth == pytest.approx(true.max(), abs=0.02)
    assert true.ravel()[cell] == pytest.approx(true.max(), abs=0.02)
    least = np.full(1, -1000.0)
    assert pyramid.deepest(led, least)[0][0] == depth == least[0]
    assert pyramid.deeper(led, np.full(1, depth))[1][0] == -1, "nothing is deeper than the deepest"


def test_where_there_is_no_metal_nothing_is_met() -> None:
    pyramid = HeightPyramid.of(Workpiece(Grid(0.0, 0.0, 1.0, 4, 4), np.full((4, 4), -5.0, np.float32), -5.0))
    led = BodyPaths(
        np.array([[2.0, 2, -9, 2, 2, -9]]),
        np.array([[3.0, 3, 0, 0]]),
        np.zeros(1, np.int64),
        np.zeros(1, np.int64),
        np.zeros(1),
    )
    assert pyramid.deeper(led, np.zeros(1))[1][0] == -1
