"""Exact offset levels of bad drawings: against plain float64 distances, and against the areas that shapely finds."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import pytest
import shapely

from app.core import tolerances
from app.geometry.offset.offset import OffsetLevel, offset_levels
from app.geometry.outlines import nest
from app.geometry.primitives import contour_rows, pack, points_at, sample
from app.model.part import Contour, Region
from tests import plain_distance
from tests.rough_parts import KINDS, rough_part

CHORD, QUARTER = 1e-4, 64
SURE = 0.02
"""mm; places nearer than this to a level are not asked about: the plain answer takes arcs for chords."""
NEARER = 1e-6
"""mm; no path comes nearer to the drawing than its level by more than this."""


def polygons_of(regions: tuple[Region, ...]) -> tuple[shapely.Geometry, ...]:
    """Chords within CHORD of the regions, as they are and cut shorter.

    GEOS goes wrong either way: it first takes out corners that look small beside the lines next to them, and where all
    lines are short it can lose a part.
    """
    rings = ([sample(contour_rows(contour), CHORD) for contour in region.contours] for region in regions)
    polygons = shapely.union_all(
        [shapely.make_valid(shapely.Polygon(boundary, islands)) for boundary, *islands in rings]
    )
    return polygons, *(shapely.segmentize(polygons, max(short, polygons.length / 20_000)) for short in (0.02, 0.1, 0.5))


def points_of(level: OffsetLevel, most: int = 4000) -> np.ndarray:
    """Starts, middles and other points of all moves, or a good part of them."""
    rows = np.concatenate([ring.rows for ring in level.rings])
    points = np.concatenate([points_at(rows, np.full(len(rows), f)) for f in (0.0, 0.5, 0.13, 0.71)])
    return points[np.linspace(0, len(points) - 1, min(len(points), most)).astype(int)]


@dataclass(frozen=True)
class Places:
    """Places in and round a drawing, asked about at every level.

    Attributes:
        points: (n, 2) mm. distance: (n,) mm from the drawing. inside: (n,) whether within its areas.
    """

    points: np.ndarray
    distance: np.ndarray
    inside: np.ndarray

    @staticmethod
    def among(contours: list[Contour], rng: np.random.Generator) -> Places:
        corners = np.array([curve.start for contour in contours for curve in contour.primitives])
        points = rng.uniform(corners.min(axis=0) - 2, corners.max(axis=0) + 2, (1500, 2))
        return Places(points, plain_distance.distance(points, contours), plain_distance.inside(points, contours))


def check(seed: int) -> None:
    contours = rough_part(seed)
    regions = tuple(nest(contours))
    rng = np.random.default_rng(seed + 1)
    distances = np.cumsum(rng.uniform(0.05, 1.5, 5)) if seed % 3 else np.array([0.25, 0.5, 1.0, 2.0, 3.0])
    polygons, places = polygons_of(regions), Places.among(contours, rng)
    for level in offset_levels(pack(regions), list(distances)):
        assert not any(ring.polyline for ring in level.rings)
        for ring in level.rings:
            assert np.array_equal(ring.rows[:, 2:4], np.roll(ring.rows[:, :2], -1, axis=0))
        if level.rings:
            off = plain_distance.distance(points_of(level), contours) - level.distance
            assert off.min() >= -NEARER and off.max() <= tolerances.LEVEL
        check_area(level, polygons)
        check_places(level, places)


def check_area(level: OffsetLevel, polygons: tuple[shapely.Geometry, ...]) -> None:
    """The area that the rings enclose is the one that shapely finds, within its error."""
    ours = sum(ring.area for ring in level.rings)
    error = CHORD + level.distance * (1 - math.cos(math.pi / 4 / QUARTER)) + tolerances.RIDGE
    buffers = (polygon.buffer(-level.distance, quad_segs=QUARTER) for polygon in polygons)
    assert any(ours == pytest.approx(theirs.area, abs=error * theirs.length + 1e-4) for theirs in buffers)


def check_places(level: OffsetLevel, places: Places) -> None:
    """No ring is missing and none too many: places are enclosed if they lie inside, farther from the drawing than the
    level.
    """
    sure = np.abs(places.distance - level.distance) > SURE
    points, enclosed = places.points[sure], np.zeros(int(sure.sum()), bool)
    for ring in level.rings:
        enclosed ^= shapely.contains_xy(shapely.make_valid(shapely.Polygon(sample(ring.rows, CHORD))), points)
    assert np.array_equal(enclosed, (places.inside & (places.distance > level.distance))[sure])


@pytest.mark.parametrize("seed", range(4 * len(KINDS)))
def test_bad_drawings_keep_lines_and_arcs_that_measure_right(seed: int) -> None:
    check(seed)


@pytest.mark.exhaustive
@pytest.mark.parametrize("first", range(0, 1000, 50))
def test_a_thousand_bad_drawings(first: int) -> None:
    for seed in range(first, first + 50):
        check(seed)
