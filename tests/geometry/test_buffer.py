"""Parallels by GEOS are where dense sampling has them, also beside edges far shorter than the distance."""

from __future__ import annotations

import numpy as np
import pytest
import shapely

from app.geometry.buffer import buffered

DISTANCE = 3.0
CHORDS = 200
SAG = DISTANCE * (1 - np.cos(np.pi / 4 / CHORDS))


def farthest_off(shape: shapely.Geometry, grown: object) -> float:
    """Return by how much the outline of `grown` lies farther from the shape than the distance, mm."""
    assert isinstance(grown, shapely.Geometry)
    points = shapely.points(shapely.get_coordinates(shapely.segmentize(shapely.boundary(grown), 0.02)))
    apart = shapely.distance(shape, points)
    assert apart.min() > (1 - 1.1e-3) * DISTANCE - 2 * SAG
    return float(apart.max() - DISTANCE)


def random_line(rng: np.random.Generator) -> shapely.LineString:
    """Return a few edges of 0.0003 to 10 mm with turns of 0.001 to 1.6 rad."""
    count = int(rng.integers(3, 9))
    length = 10 ** rng.uniform(-3.5, 1, count)
    angle = np.cumsum(rng.uniform(-1, 1, count) * 10 ** rng.uniform(-3, 0.2, count))
    steps = np.column_stack([length * np.cos(angle), length * np.sin(angle)])
    return shapely.LineString(np.cumsum(np.vstack([[0.0, 0.0], steps]), axis=0))


def test_the_parallel_of_a_long_edge_beside_a_short_one_is_parallel() -> None:
    line = shapely.LineString([(71, 60), (71, 48.58), (71.025, 48.574), (74, 47.2)])
    assert farthest_off(line, shapely.buffer(line, DISTANCE, quad_segs=CHORDS)) > 0.004  # what GEOS alone does
    assert farthest_off(line, buffered(line, DISTANCE, CHORDS)) < 1e-4


@pytest.mark.parametrize("first", range(4))
def test_a_ring_is_the_same_wherever_it_begins(first: int) -> None:
    corners = np.array([(71.0, 60.0), (71, 48.58), (71.025, 48.574), (90, 40)])
    ring = shapely.Polygon(np.roll(corners, first, axis=0))
    inner = buffered(ring, -0.5, CHORDS)
    exact = shapely.difference(ring, shapely.union_all([shapely.buffer(e, 0.5, quad_segs=CHORDS) for e in edges(ring)]))
    assert isinstance(inner, shapely.Geometry)
    assert shapely.hausdorff_distance(shapely.segmentize(inner, 0.01), shapely.segmentize(exact, 0.01)) < 2e-4


def edges(ring: shapely.Polygon) -> list[shapely.LineString]:
    points = shapely.get_coordinates(ring.exterior)
    return [shapely.LineString(points[k : k + 2]) for k in range(len(points) - 1)]


def test_random_lines_against_dense_sampling() -> None:
    rng = np.random.default_rng(5)
    lines = np.array([random_line(rng) for _ in range(300)], dtype=object)
    grown = buffered(lines, DISTANCE, CHORDS)
    assert isinstance(grown, np.ndarray) and grown.shape == lines.shape
    assert max(farthest_off(line, each) for line, each in zip(lines, grown, strict=True)) < 5e-4 * DISTANCE


def test_shapes_of_all_kinds_keep_their_kind_and_number() -> None:
    square = shapely.box(0, 0, 10, 10)
    short = shapely.Polygon([(0, 0), (10, 0), (10, 10), (5, 10), (5, 10.01), (0, 10)], [[(2, 2), (2, 2.01), (4, 4)]])
    shapes = np.array([square, short, shapely.MultiPolygon([square, shapely.box(20, 0, 21, 1)])], dtype=object)
    for distance in (0.4, -0.4):
        found = buffered(shapes, distance, CHORDS)
        assert isinstance(found, np.ndarray)
        plain = shapely.buffer(shapes, distance, quad_segs=CHORDS)
        assert shapely.area(found) == pytest.approx(shapely.area(plain), abs=0.01)
    assert buffered(shapely.Polygon(), 1.0, 8).is_empty  # type: ignore[union-attr]


def test_empty_shapes_stay_empty_among_others() -> None:
    steep = shapely.Polygon([(71, 60), (71, 48.58), (71.025, 48.574), (90, 40)])
    shapes = np.array([shapely.Polygon(), steep, shapely.MultiPolygon([steep, shapely.box(0, 0, 9, 9)])], dtype=object)
    found = buffered(shapes, -0.5, CHORDS)
    assert isinstance(found, np.ndarray)
    assert shapely.is_empty(found).tolist() == [True, False, False]


def test_a_hole_that_geos_leaves_in_a_tight_turn_is_none() -> None:
    rng = np.random.default_rng(5)
    line = [random_line(rng) for _ in range(66)][65]
    alone = shapely.buffer(line, DISTANCE, quad_segs=CHORDS)
    assert len(alone.interiors) == 1 and shapely.distance(line, alone.interiors[0]) < 1.9
    grown = buffered(line, DISTANCE, CHORDS)
    assert isinstance(grown, shapely.Polygon) and not grown.interiors
    square = shapely.box(-50, -50, 50, 50).difference(shapely.buffer(line, 1e-3))
    inner = buffered(square, -DISTANCE, CHORDS)
    assert isinstance(inner, shapely.Geometry) and inner.disjoint(shapely.buffer(line, 2.99))
