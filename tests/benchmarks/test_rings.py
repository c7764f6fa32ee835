"""All pocket rings of a part, contour tool radius 0.5 mm, pocket tool radius 1.0 mm, stepover 0.9 mm, against other
libraries.

Peers get polygons whose chords stay within 1 µm of the drawing, and offset them once a level, from the part, until
nothing is left; ours gives exact lines and arcs. Every engine starts from regions in its own form and ends with
coordinates. The least of the rounds counts, as a machine that is busy with other things only adds. What grows is shown
by an outline of ever more lines.
"""

import importlib.util

import numpy as np
import pytest
import shapely
from pytest_benchmark.fixture import BenchmarkFixture

from app.geometry.distance import DistanceField
from app.geometry.offset.offset import OffsetLevel, offset_levels
from app.geometry.primitives import Primitives, contour_rows, pack, sample
from app.model.part import Region
from app.operations.pocket.paths import pocket_distances, without_empty
from tests.benchmarks.conftest import OURS, record

pytestmark = pytest.mark.benchmark
FIRST, STEPOVER, CHORD, ARC_TOLERANCE = 1.5, 0.9, 1e-3, 1e-3

Named = tuple[str, tuple[Region, ...]]


def polygon_of(regions: tuple[Region, ...]) -> shapely.Geometry:
    """The area of all regions as chords within 1 µm of the drawing."""
    rings = ([sample(contour_rows(contour), CHORD) for contour in region.contours] for region in regions)
    return shapely.union_all([shapely.make_valid(shapely.Polygon(boundary, islands)) for boundary, *islands in rings])


def own_rings(regions: tuple[Region, ...]) -> tuple[OffsetLevel, ...]:
    primitives = pack(regions)
    return without_empty(
        offset_levels(primitives, pocket_distances(FIRST, STEPOVER, DistanceField.of(primitives.rows)))
    )


def shapely_rings(polygon: shapely.Geometry, from_part: bool) -> list[np.ndarray]:
    """Offset a polygon level by level: each from the part itself, or from the ring before it (which drifts)."""
    rings, at, level = [], polygon, FIRST
    while not (
        at := polygon.buffer(-level, quad_segs=64)
        if from_part or level == FIRST
        else at.buffer(-STEPOVER, quad_segs=64)
    ).is_empty:
        rings.append(shapely.get_coordinates(at))
        level += STEPOVER
    return rings


def clipper_rings(paths: list[np.ndarray], scale: float) -> list[list[list[list[int]]]]:
    import pyclipper

    offset = pyclipper.PyclipperOffset(arc_tolerance=ARC_TOLERANCE * scale)
    offset.AddPaths(
        [np.rint(path * scale).astype(np.int64).tolist() for path in paths],
        pyclipper.JT_ROUND,
        pyclipper.ET_CLOSEDPOLYGON,
    )
    rings, level = [], FIRST
    while found := offset.Execute(-level * scale):
        rings.append(found)
        level += STEPOVER
    return rings


def test_own_rings(benchmark: BenchmarkFixture, part: Named) -> None:
    name, regions = part
    levels = benchmark.pedantic(own_rings, (regions,), rounds=10 if name == "complex" else 40, warmup_rounds=1)
    record(benchmark, f"rings of {name}", OURS, least=True)
    area = abs(sum(ring.area for ring in levels[0].rings))
    polygon = polygon_of(regions)
    assert area == pytest.approx(polygon.buffer(-FIRST, quad_segs=64).area, rel=1e-4)


@pytest.mark.parametrize("from_part", [True, False], ids=["from part", "ring from ring"])
def test_shapely_rings(benchmark: BenchmarkFixture, part: Named, from_part: bool) -> None:
    name, regions = part
    polygon = polygon_of(regions)
    rings = benchmark.pedantic(
        shapely_rings, (polygon, from_part), rounds=(2 if from_part else 10) if name == "complex" else 40
    )
    record(benchmark, f"rings of {name}", f"shapely {'from part' if from_part else 'ring from ring'}", least=True)
    assert len(rings) > 3


@pytest.mark.skipif(importlib.util.find_spec("pyclipper") is None, reason="pyclipper is not installed (extra: bench)")
def test_clipper_rings(benchmark: BenchmarkFixture, part: Named) -> None:
    name, regions = part
    polygon = polygon_of(regions)
    parts = [
        shapely.get_coordinates(ring)
        for piece in shapely.get_parts(polygon)
        for ring in (piece.exterior, *piece.interiors)
    ]
    rings = benchmark.pedantic(clipper_rings, (parts, 1e6), rounds=1 if name == "complex" else 5)
    record(benchmark, f"rings of {name}", "pyclipper from part", least=True)
    assert len(rings) > 3


@pytest.mark.parametrize("count", [3000, 12_000])
def test_own_rings_of_a_finely_drawn_circle(benchmark: BenchmarkFixture, count: int) -> None:
    angle = np.arange(count) * 2 * np.pi / count
    ends = 50 * np.stack([np.cos(angle), np.sin(angle)], 1)
    rows = np.hstack([ends, np.roll(ends, -1, axis=0), np.zeros((count, 4))])
    primitives = Primitives(rows, np.roll(np.arange(count), 1), np.ones(count, np.int64))
    distances = pocket_distances(FIRST, STEPOVER, DistanceField.of(rows))
    levels = benchmark.pedantic(offset_levels, (primitives, distances), rounds=2)
    record(benchmark, f"rings of a circle of {count} lines", OURS, least=True)
    assert all(len(level.rings) == 1 for level in levels)
