"""Ground that is cut: against shapely's discs, and closed forms."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from app.geometry.primitives import contour_rows
from app.model.tool import Tool
from app.model.tool_kind import ToolKind
from app.toolpath.rest_material import ClearedGround, flat_radius
from tests.examples import examples
from tests.part_shapes import circle

TOOL = Tool(1, 6.0)


def line(a: tuple[float, float], b: tuple[float, float]) -> np.ndarray:
    return np.array([[*a, *b, 0, 0, 0, 0]], np.float64)


def at(*heights: float) -> np.ndarray:
    return np.array(heights)


@settings(max_examples=examples(40), deadline=None)
@given(st.integers(0, 10**6))
def test_a_way_is_clear_where_discs_of_the_path_cover_it(seed: int) -> None:
    rng = np.random.default_rng(seed)
    cleared, shapes = ClearedGround(), []
    for _ in range(int(rng.integers(1, 200))):
        a = rng.uniform(0, 25, 2)
        b = a + rng.uniform(-8, 8, 2)
        cleared.add(TOOL, line(tuple(a), tuple(b)), at(-2.0))
        shapes.append(shapely.LineString([a, b]).buffer(3, quad_segs=64))
    cut = shapely.union_all(shapes)
    for _ in range(20):
        a = rng.uniform(0, 25, 2)
        b = a + rng.uniform(-6, 6, 2) * rng.integers(0, 2)
        way = shapely.LineString([a, b]) if np.any(a != b) else shapely.Point(a)
        if cleared.is_clear(TOOL, tuple(a), tuple(b), -2.0):
            assert way.buffer(2.96).difference(cut).area < 1e-2  # but for a skin of 0.03 mm
        else:
            assert way.buffer(3.002).difference(cut).area > 0


@settings(max_examples=examples(20), deadline=None)
@given(st.integers(0, 10**6))
def test_places_asked_one_after_the_other_are_as_clear_as_each_alone(seed: int) -> None:
    """What one place shows not to be cut rules out others, but none that is clear."""
    rng = np.random.default_rng(seed)
    cleared = ClearedGround()
    for a in rng.uniform(0, 20, (int(rng.integers(1, 40)), 2)):
        cleared.add(TOOL, line(tuple(a), tuple(a + rng.uniform(-8, 8, 2))), at(-2.0))
    places = [tuple(place) for place in rng.uniform(0, 20, (60, 2)).tolist()]
    alone = [k for k, place in enumerate(places) if cleared.is_clear(TOOL, place, place, -2.0)]
    assert list(cleared.clear_places(TOOL, places, -2.0)) == alone


def test_the_first_clear_place_behind_an_edge_is_the_one_that_is_a_radius_away() -> None:
    cleared = ClearedGround()
    for y in range(11):
        cleared.add(TOOL, line((0, y), (40, y)), at(-2.0))
    places = [(20.0, -6.0 + 0.05 * k) for k in range(240)]  # cut from y = -3 on
    first = next(cleared.clear_places(TOOL, places, -2.0))
    assert places[first][1] == pytest.approx(0.0, abs=0.051)


def test_a_floor_that_was_asked_for_is_deeper_when_more_is_cut() -> None:
    cleared = ClearedGround()
    for z in (-1.0, -2.0, -2.0, -3.0):
        assert cleared.floor(TOOL, (10, 0)) > z or z == -2.0
        cleared.add(TOOL, line((0, 0), (20, 0)), at(z))
        assert cleared.floor(TOOL, (10, 0)) == pytest.approx(z)


def test_depths_of_many_passes_are_kept_apart() -> None:
    cleared = ClearedGround()
    for k in range(1, 400):
        cleared.add(TOOL, line((10.0 * k, 0), (10.0 * k, 5)), at(-0.01 * k))
    for k in (1, 50, 399):
        assert cleared.floor(TOOL, (10.0 * k, 2)) == pytest.approx(-0.01 * k)
    assert cleared.floor(TOOL, (5.0, 50.0)) == 0.0


def test_the_deepest_cut_that_holds_the_whole_cutter_counts() -> None:
    cleared = ClearedGround()
    cleared.add(TOOL, line((0, 0), (20, 0)), at(-1.0))
    cleared.add(TOOL, line((0, 0), (10, 0)), at(-2.0))
    assert cleared.floor(TOOL, (5, 0)) == -2.0 and cleared.floor(TOOL, (12, 0)) == -1.0
    assert cleared.is_clear(TOOL, (2, 0), (9, 0), -2.0) and not cleared.is_clear(TOOL, (2, 0), (12, 0), -2.0)
    assert cleared.is_clear(Tool(2, 2.0), (2, 1.9), (9, -1.9), -2.0) and not cleared.is_clear(
        Tool(2, 2.0), (2, 2.2), (9, 2.2), -2.0
    )


def test_two_slots_side_by_side_clear_what_neither_clears_alone() -> None:
    cleared = ClearedGround()
    for y in (0.0, 5.0):
        cleared.add(TOOL, line((0, y), (20, y)), at(-1.0))
    assert cleared.is_clear(TOOL, (5, 2.5), (15, 2.5), -1.0)
    assert not cleared.is_clear(TOOL, (5, 2.5), (25, 2.5), -1.0)


def test_what_stays_inside_a_ring_is_not_clear() -> None:
    cleared = ClearedGround()
    ring = contour_rows(circle(3.2))
    cleared.add(TOOL, ring, np.full(len(ring), -1.0))
    assert cleared.floor(TOOL, (0, 0)) == 0.0  # a post of 0.2 mm stands in the middle
    small = contour_rows(circle(2.9))
    cleared.add(TOOL, small, np.full(len(small), -1.0))
    assert cleared.floor(TOOL, (0, 0)) == -1.0


def test_a_tab_is_not_clear_below_its_top() -> None:
    cleared = ClearedGround()
    cleared.add(
        TOOL,
        np.concatenate([line((0, 0), (10, 0)), line((10, 0), (14, 0)), line((14, 0), (30, 0))]),
        at(-5.0, -3.5, -5.0),
    )
    assert not cleared.is_clear(TOOL, (5, 0), (20, 0), -5.0) and cleared.is_clear(TOOL, (5, 0), (20, 0), -3.5)


def test_a_ball_clears_only_where_it_was() -> None:
    ball = Tool(3, 6.0, ToolKind.BALL)
    cleared = ClearedGround()
    cleared.add(ball, line((0, 0), (20, 0)), at(-1.0))
    assert cleared.floor(ball, (5, 0)) == -1.0 and cleared.floor(ball, (5, 0.1)) == 0.0
    assert cleared.floor(Tool(2, 1.0), (5, 0)) == 0.0 and not cleared.is_clear(ball, (5, 0), (10, 0), -1.0)
    assert [flat_radius(tool) for tool in (TOOL, ball, Tool(4, 6.0, ToolKind.BULL, corner_radius=1.0))] == [
        3.0,
        0.0,
        2.0,
    ]


def test_nothing_above_the_stock_is_kept() -> None:
    cleared = ClearedGround()
    cleared.add(TOOL, line((0, 0), (20, 0)), at(0.5))
    assert cleared.floor(TOOL, (5, 0)) == 0.0 and cleared.nearest((5, 0), -0.1) == (np.inf, None)
