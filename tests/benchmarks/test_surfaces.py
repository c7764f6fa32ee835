"""Cutters over meshes against OpenCAMLib (bucket size 10, all threads), and paths over ten B-spline surfaces.

Both drop a ball of 3 % of the part's width at 90,000 places of meshes of 2 thousand, 8 thousand and 75 thousand
triangles; the heights have to agree. The peer is an extra (`pip install -e '.[bench]'`).
"""

import math

import numpy as np
import pytest
from pytest_benchmark.fixture import BenchmarkFixture

from app.formats.scene.toml import read_scene, sources_of
from app.model.tool import Tool
from app.model.tool_kind import ToolKind
from app.surfaces.cutter_contact.drop_cutter import drop
from app.surfaces.cutter_contact.scene_facets import scene_facets
from app.surfaces.passes.path import Follower, FollowOptions, cutter_path
from app.surfaces.patches.build import build
from app.surfaces.patches.facets import SurfaceFacets
from app.surfaces.sections.planes import even_planes
from tests.benchmarks.conftest import OURS, record
from tests.conftest import ROOT
from tests.surfaces.surface_places import no_data

pytestmark = pytest.mark.benchmark
SIDE, WIDTH = 300, 100.0
CELLS = {"2k": 32, "8k": 64, "75k": 194}
TOOL = Tool(1, 3.0, ToolKind.BALL)

heights: dict[str, np.ndarray] = {}
"""Of our own, by mesh."""


def terrain(cells: int) -> np.ndarray:
    """Return a bumpy mesh (n, 3, 3) of 2 cells² triangles."""
    at = np.linspace(0, WIDTH, cells + 1)
    x, y = np.meshgrid(at, at)
    z = 6 * np.sin(x / 9) * np.cos(y / 7) + 2 * np.sin(x / 2.3 + y / 3.1)
    grid = np.stack([x, y, z], axis=-1)
    a, b, c, d = (part.reshape(-1, 3) for part in (grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1]))
    return np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])


def places() -> np.ndarray:
    at = np.linspace(2, WIDTH - 2, SIDE)
    return np.column_stack([part.ravel() for part in np.meshgrid(at, at)])


@pytest.mark.parametrize("size", CELLS)
def test_own_drop(benchmark: BenchmarkFixture, size: str) -> None:
    mesh, where = terrain(CELLS[size]), places()

    def work() -> np.ndarray:
        return drop(SurfaceFacets.of_mesh(mesh), TOOL, where).height

    heights[size] = benchmark.pedantic(work, rounds=5, warmup_rounds=1)
    record(benchmark, f"ball over {size} triangles, 90,000 places", OURS)


@pytest.mark.parametrize("size", CELLS)
def test_opencamlib(benchmark: BenchmarkFixture, size: str) -> None:
    ocl = pytest.importorskip("opencamlib", reason="the peer is not installed; pip install -e '.[bench]'")
    surface = ocl.STLSurf()
    for a, b, c in terrain(CELLS[size]).tolist():
        surface.addTriangle(ocl.Triangle(ocl.Point(*a), ocl.Point(*b), ocl.Point(*c)))
    where = places()

    def work() -> np.ndarray:
        batch = ocl.BatchDropCutter()
        batch.setSTL(surface)
        batch.setCutter(ocl.BallCutter(TOOL.diameter, 50.0))
        batch.setBucketSize(10)
        for x, y in where.tolist():
            batch.appendPoint(ocl.CLPoint(x, y, -100.0))
        batch.run()
        return np.array([point.z for point in batch.getCLPoints()])

    found = benchmark.pedantic(work, rounds=1)
    if size in heights:
        assert np.abs(found - heights[size]).max() <= 1e-6
    record(benchmark, f"ball over {size} triangles, 90,000 places", "opencamlib")


def test_path_over_ten_surfaces(benchmark: BenchmarkFixture) -> None:
    path = ROOT / "resources" / "samples" / "die.toml"
    scene = read_scene(path.name, path.read_bytes())
    facets = scene_facets(build(scene, sources_of(no_data))).facets
    planes = even_planes((0.0, 0.0), 0.0, 1.07, facets.triangles[:, :, :2].reshape(-1, 2))
    follower = Follower(facets, scene.tools[-1], FollowOptions(0.0, 0.005, 1e-4))
    made = benchmark.pedantic(cutter_path, (follower, planes), rounds=3, warmup_rounds=1)
    count = sum(len(run.points) for run in made.runs)
    benchmark.extra_info.update(points=count)
    assert 80_000 < count < 120_000 and not math.isnan(made.runs[0].points.sum())
    record(benchmark, f"proven path of {count} points over ten B-spline surfaces", OURS)
