"""Every kind of cutter over scenes that are hard on it: what is written is proven, and dense sampling finds no deeper
cut.
"""

import math

import numpy as np
import pytest
import shapely
from scipy.spatial import cKDTree

from app.formats.scene.toml import read_scene, sources_of
from app.model.tool import Tool
from app.model.tool_kind import ToolKind
from app.surfaces.patches.patch import patches_of
from app.usecases.scene.compute import ComputedScene, compute
from app.usecases.scene_program.nc import write_scene_nc
from tests.surfaces.surface_places import no_data
from tests.surfaces.test_drop_cutter import rise

GOUGE = 1e-4
CUTTERS = {
    "ball": 'kind = "ball"',
    "flat": 'kind = "flat"',
    "bull": 'kind = "bull"\ncorner_radius = 1.0',
    "v": 'kind = "v"\ntip_angle = 90',
    "taper": 'kind = "taper"\ntip_angle = 30\ntip_diameter = 2',
}
SCENES = {
    "a spire and a saddle": """
[[surface]]
name = "saddle"
shape = { kind = "bilinear", corners = [[0, 0, -7], [30, 0, 4], [30, 30, -5], [0, 30, -3]] }
[[surface]]
name = "spire"
shape = { kind = "cone", start = [14, 16, -6], end = [14, 16, 7], start_radius = 7, end_radius = 0 }
""",
    "a wavy sheet with a hole": """
[[surface]]
name = "sheet"
trims = [{ circle = [16, 13, 7], keep = "outside" }]
[surface.shape]
kind = "bspline"
points = [[[0, 0, -3], [1, 8, -2], [0, 15, -4], [0, 24, 3], [0, 31, 5]],
    [[8, -1, 4], [8, 8, 1], [9, 17, -1], [8, 24, 2], [8, 32, 6]],
    [[16, 1, -3], [17, 7, -1], [15, 15, 5], [15, 24, -3], [15, 31, 2]],
    [[25, 0, -5], [24, 9, 0], [25, 16, 0], [24, 25, 7], [24, 30, 1]],
    [[32, 0, 3], [31, 8, 2], [33, 15, 1], [33, 25, -4], [33, 31, 3]]]
[[surface]]
name = "ring"
shape = { kind = "torus", centre = [15, 14, -2], major = 9, minor = 2.4 }
""",
}


def samples(computed: ComputedScene) -> np.ndarray:
    """Return places (n, 3) all over what is left of the surfaces."""
    found = []
    for number, built in enumerate(computed.built):
        patches = patches_of([built.splines])
        u, v = (grid.ravel() for grid in np.meshgrid(*[np.linspace(0, 1, int(250 / math.sqrt(len(patches))))] * 2))
        places = np.concatenate([patches.points(np.full(len(u), patch), u, v) for patch in range(len(patches))])
        area = computed.facets.areas.get(number)
        found.append(places if area is None else places[shapely.intersects_xy(area, *places[:, :2].T)])
    return np.concatenate(found)


def pared(tool: Tool, r: np.ndarray) -> np.ndarray:
    """Return a cutter's lower side over its tip, GOUGE within it, square to it."""
    if tool.kind is ToolKind.BALL:
        return tool.radius - np.sqrt((tool.radius - GOUGE) ** 2 - r**2)
    if tool.kind is ToolKind.BULL:
        out = np.maximum(r - (tool.radius - tool.corner_radius), 0.0)
        deep = tool.corner_radius - GOUGE
        return np.where(out < deep, tool.corner_radius - np.sqrt(np.maximum(deep**2 - out**2, 0.0)), np.inf)
    return rise(tool, r) + (GOUGE if tool.kind is ToolKind.FLAT else GOUGE / math.sin(tool.tip_angle / 2))


@pytest.mark.parametrize("scene", SCENES)
@pytest.mark.parametrize("cutter", CUTTERS)
def test_what_is_written_is_proven_and_nowhere_too_deep(cutter: str, scene: str) -> None:
    text = (
        f"[[tool]]\nnumber = 1\ndiameter = 6\n{CUTTERS[cutter]}\n{SCENES[scene]}\n[[passes]]\ntool = 1\npitch = "
        "4.7\nangle_deg = 26.7\n"
    )
    computed = compute(read_scene("hard.toml", text.encode()), sources_of(no_data))
    written = write_scene_nc(computed)
    assert not len(written.unproven)
    (family,) = computed.families
    assert sum(len(run.points) for run in family.path.runs) < 12_000
    tool, surface, ends = family.tool, samples(computed), computed.moves.moves.end
    share, rows = np.random.default_rng(1).random((1500, 1)), np.random.default_rng(2).integers(1, len(ends), 1500)
    tips = ends[rows - 1] + share * (ends[rows] - ends[rows - 1])
    for tip, near in zip(tips, cKDTree(surface[:, :2]).query_ball_point(tips[:, :2], tool.radius - GOUGE), strict=True):
        places = surface[near]
        assert (places[:, 2] <= tip[2] + pared(tool, np.hypot(*(places[:, :2] - tip[:2]).T)) + 1e-9).all()
