"""Cutters over meshes: closed forms, and never below nor above what dense sampling finds."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import cKDTree

from app.model.tool import Tool
from app.model.tool_kind import ToolKind
from app.surfaces.cutter_contact.drop_cutter import NONE, drop
from app.surfaces.patches.facets import SurfaceFacets
from tests.examples import examples

TOOLS = {
    "ball": Tool(1, 6.0, ToolKind.BALL),
    "flat": Tool(1, 6.0, ToolKind.FLAT),
    "bull": Tool(1, 6.0, ToolKind.BULL, corner_radius=1.0),
    "v": Tool(1, 6.0, ToolKind.V, tip_angle=math.radians(90), tip_diameter=0.5),
    "sharp": Tool(1, 6.0, ToolKind.V, tip_angle=math.radians(60)),
    "drill": Tool(1, 6.0, ToolKind.DRILL, tip_angle=math.radians(118)),
    "taper": Tool(1, 6.0, ToolKind.TAPER, tip_angle=math.radians(30), tip_diameter=2.0),
}


def rise(tool: Tool, r: np.ndarray) -> np.ndarray:
    """A cutter's lower side over its tip, told kind by kind."""
    radius, half, tip = tool.diameter / 2, tool.tip_angle / 2, tool.tip_diameter / 2
    if tool.kind is ToolKind.BALL:
        up = radius - np.sqrt(np.maximum(radius**2 - r**2, 0))
    elif tool.kind is ToolKind.BULL:
        out = np.maximum(r - (radius - tool.corner_radius), 0)
        up = tool.corner_radius - np.sqrt(np.maximum(tool.corner_radius**2 - out**2, 0))
    elif tool.kind is ToolKind.TAPER:
        end = tip * math.cos(half)
        up = np.where(
            r <= end,
            tip - np.sqrt(np.maximum(tip**2 - r**2, 0)),
            tip - tip * math.sin(half) + (r - end) / math.tan(half),
        )
    elif tool.kind is ToolKind.FLAT:
        up = 0 * r
    else:
        up = np.maximum(r - tip, 0) / math.tan(half)
    return np.where(r <= radius, up, np.inf)


def mesh_of(triangles: np.ndarray) -> SurfaceFacets:
    return SurfaceFacets.of_mesh(triangles)


def plane(slope: float, size: float = 100.0) -> SurfaceFacets:
    """A square that rises along X."""
    a, b, c, d = ([x, y, slope * x] for x, y in ((-size, -size), (size, -size), (size, size), (-size, size)))
    return mesh_of(np.array([[a, b, c], [a, c, d]]))


@pytest.mark.parametrize(("degrees", "tip"), [(30, 0.0), (50, 0.0959), (60, 0.3660), (75, 1.3660)])
def test_a_cone_on_a_tilted_plane(degrees: float, tip: float) -> None:
    cone = Tool(1, 1.0, ToolKind.V, tip_angle=math.radians(90))
    found = drop(plane(math.tan(math.radians(degrees))), cone, np.array([[0.0, 0.3]]))
    assert found.height[0] == pytest.approx(tip, abs=5e-5)
    assert found.height[0] == pytest.approx(max(0.5 * (math.tan(math.radians(degrees)) - 1), 0), abs=1e-12)


@pytest.mark.parametrize("degrees", [0.0, 10.0, 30.0, 60.0, 80.0])
@pytest.mark.parametrize("name", TOOLS)
def test_on_a_tilted_plane_the_height_is_that_of_the_closed_form(name: str, degrees: float) -> None:
    tool, slope = TOOLS[name], math.tan(math.radians(degrees))
    r = np.linspace(0, tool.diameter / 2, 2_000_001)
    meant = float((slope * r - rise(tool, r)).max())
    found = drop(plane(slope), tool, np.array([[1.0, 2.0], [-3.0, 0.5]])).height - slope * np.array([1.0, -3.0])
    assert found == pytest.approx(meant, abs=2e-6 * (1 + slope))


def sampled(triangles: np.ndarray, count: int) -> np.ndarray:
    """Places all over triangles, their edges and corners among them."""
    i, j = np.meshgrid(np.arange(count + 1), np.arange(count + 1), indexing="ij")
    s, u = (each[i + j <= count] / count for each in (i, j))
    a, b, c = triangles[:, 0, None], triangles[:, 1, None], triangles[:, 2, None]
    return np.asarray(a + s[None, :, None] * (b - a) + u[None, :, None] * (c - a)).reshape(-1, 3)


@settings(max_examples=examples(25), deadline=None)
@given(seed=st.integers(0, 10**6), name=st.sampled_from(sorted(TOOLS)), flat=st.booleans())
def test_random_triangles_against_dense_sampling(seed: int, name: str, flat: bool) -> None:
    rng = np.random.default_rng(seed)
    triangles = rng.uniform(-4, 4, (rng.integers(1, 7), 3, 3))
    if flat:
        triangles[:, :, :2] = np.round(triangles[:, :, :2])  # upright facets and edges among them
    places = rng.uniform(-4, 4, (5, 2))
    found, tool = drop(mesh_of(triangles), TOOLS[name], places), TOOLS[name]
    points = sampled(triangles, 300)
    for k, place in enumerate(places):
        r = np.hypot(*(points[:, :2] - place).T)
        lower = float((points[:, 2] - rise(tool, r)).max())
        if lower == -np.inf:
            continue
        assert found.height[k] >= lower - 1e-9, "it never touches more than the surface"
        step = 12.0 / 300
        own = sampled(triangles[[found.facet[k]]], 1500)
        reached = float((own[:, 2] - rise(tool, np.hypot(*(own[:, :2] - place).T))).max())
        assert found.height[k] <= reached + 40 * step / 5 * (1 if name != "flat" else 5), "and comes down to it"


@pytest.mark.parametrize("name", TOOLS)
def test_a_terrain_is_never_cut_into(name: str) -> None:
    """Two thousand facets with their edges and corners, some thousand places."""
    rng = np.random.default_rng(2)
    side = np.linspace(0, 60, 31)
    x, y = np.meshgrid(side, side, indexing="ij")
    grid = np.stack([x, y, 6 * np.sin(x / 6) * np.cos(y / 5) + rng.normal(0, 0.3, x.shape)], axis=-1)
    a, b, c, d = grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]
    triangles = np.concatenate([np.stack([a, b, c], 2).reshape(-1, 3, 3), np.stack([a, c, d], 2).reshape(-1, 3, 3)])
    places, tool = rng.uniform(5, 55, (1500, 2)), TOOLS[name]
    found, points = drop(mesh_of(triangles), tool, places).height, sampled(triangles, 24)
    tree = cKDTree(points[:, :2])
    for place, height in zip(places, found, strict=True):
        near = points[tree.query_ball_point(place, tool.diameter / 2)]
        lower = float((near[:, 2] - rise(tool, np.hypot(*(near[:, :2] - place).T))).max())
        assert lower - 1e-9 <= height <= lower + 0.2


def test_out_of_reach_there_is_nothing() -> None:
    found = drop(plane(0.0, 1.0), TOOLS["ball"], np.array([[0.0, 0.0], [4.5, 0.0]]))
    assert found.height.tolist() == [0.0, -math.inf]
    assert found.facet[1] == NONE


def test_a_spike_narrower_than_any_sampling_is_touched() -> None:
    spike = mesh_of(np.array([[[0, 0, 0], [1e-6, 0, 0], [0, 1e-6, 5.0]]]))
    assert drop(spike, TOOLS["flat"], np.array([[2.0, 0.0]])).height[0] == pytest.approx(5.0)
    assert drop(spike, TOOLS["ball"], np.array([[0.0, 0.0]])).height[0] == pytest.approx(5.0, abs=1e-5)


def test_an_edge_that_touches_where_the_corner_becomes_the_cone_is_found() -> None:
    # Newton's steps went to and fro between both sides of that bend, and the cutter was 0.16 mm too low
    off, low, high, slope = 0.8196536552145496, -1.8576334543054327, 2.1683723442533354, 1.3198124335151489
    start, end = (low, off, slope * low), (high, off, slope * high)
    upright = mesh_of(np.array([[start, end, (low, off, slope * low - 5.0)]]))
    along = np.linspace(low, high, 1_000_001)
    true = float((slope * along - rise(TOOLS["taper"], np.hypot(along, off))).max())
    found = drop(upright, TOOLS["taper"], np.zeros((1, 2)))
    assert found.height[0] == pytest.approx(true, abs=1e-9)


@pytest.mark.parametrize("name", TOOLS)
def test_the_order_of_triangles_and_one_far_below_change_nothing(name: str) -> None:
    rng = np.random.default_rng(5)
    triangles = rng.uniform(-20, 20, (400, 3, 3)) * [1, 1, 0.1]
    places = rng.uniform(-20, 20, (200, 2))
    one = drop(mesh_of(triangles), TOOLS[name], places)
    order = rng.permutation(400)
    other = drop(mesh_of(triangles[order]), TOOLS[name], places)
    below = drop(mesh_of(np.concatenate([triangles, triangles - [0, 0, 100]])), TOOLS[name], places)
    assert np.array_equal(one.height, other.height) and np.array_equal(one.height, below.height)
    touched = one.facet >= 0
    assert np.mean(one.facet[touched] == order[other.facet[touched]]) > 0.99
