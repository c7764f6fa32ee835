"""Text A's pixels on random drawings, held against shapely's distances and scipy's distance transform, labels and
borders: neither knows anything of our frames, fills, traces and peels.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely
from scipy import ndimage

from app.exhibits.stages import Variant, stages
from app.geometry.outlines import polygon_contour
from app.raster.frame import PixelCode
from app.raster.steps import StepState
from app.usecases.making.bitmap_job import BitmapJob, drawn_job
from app.usecases.pixels.options import BitmapSize
from app.usecases.pixels.way import compute_on_bitmap
from tests.usecases.test_bitmap_way import job_of

POINTS = 240
NEAR = 3.0
"""Pixels: what lies so much farther from a wall than it must is never left out; smoothing needs 1.21 of them."""


def star(random: np.random.Generator, centre: complex, size: float) -> np.ndarray:
    """A star-shaped polygon (n, 2), mm."""
    count = int(random.integers(5, 14))
    angle = np.sort(random.uniform(0, math.tau, count)) + np.linspace(0, 0.1, count)
    place = centre + size * random.uniform(0.55, 1.0, count) * np.exp(1j * angle)
    return np.column_stack([place.real, place.imag])


def drawing(seed: int) -> tuple[shapely.Polygon, list[np.ndarray]]:
    """A polygon with up to three islands, and its outlines."""
    random = np.random.default_rng(seed)
    outer = star(random, 0j, 40.0)
    whole = shapely.Polygon(outer)
    islands: list[np.ndarray] = []
    for centre in random.uniform(-22, 22, (int(random.integers(0, 4)), 2)):
        island = star(random, complex(*centre), float(random.uniform(3, 7)))
        shape = shapely.Polygon(island)
        if shape.is_valid and whole.contains(shape.buffer(2)):
            whole, islands = whole.difference(shape), [*islands, island]
    return whole, [outer, *islands]


def last(steps: list[StepState], number: int) -> np.ndarray:
    return [step for step in steps if step.number == number][-1].plane


def far_from_walls(shape: shapely.Polygon, ready: BitmapJob) -> np.ndarray:
    """How far each pixel's centre is inside the shape, mm; negative outside."""
    frame = ready.part.frame
    x = frame.x0 + (np.arange(frame.cols) + 0.5) * frame.pitch
    y = frame.y0 + (frame.rows - 0.5 - np.arange(frame.rows)) * frame.pitch
    centres = shapely.points(*np.meshgrid(x, y))
    off = shapely.distance(shape.boundary, centres)
    return np.where(shapely.contains(shape, centres), off, -off)


@pytest.mark.parametrize("seed", [0, 1, *(pytest.param(seed, marks=pytest.mark.exhaustive) for seed in range(2, 40))])
def test_areas_peels_frames_and_what_is_cleared_are_those_of_scipy(seed: int) -> None:
    shape, outlines = drawing(seed)
    assert shape.is_valid, "no outline crosses itself"
    contour, pocket = 1.0, 2.0 + seed % 3
    job = job_of([polygon_contour(points) for points in outlines], 2 * contour, 2 * pocket)
    ready = drawn_job(job, BitmapSize(POINTS))
    made = compute_on_bitmap(ready.job, ready.part)
    steps = list(stages(ready.job, ready.part, made.paths, Variant.SETTLED))
    pitch, inside = ready.part.frame.pitch, far_from_walls(shape, ready)
    area = last(steps, 130) == PixelCode.CONTOUR
    assert not (area & (inside < contour)).any(), "a pixel of the offset is nearer to a wall than the tool's radius"
    assert not (~area & (inside > contour + NEAR * pitch)).any(), "the offset leaves out what is far from walls"
    border = area & ~ndimage.binary_erosion(np.pad(area, 1))[1:-1, 1:-1]
    left = area & (ndimage.distance_transform_edt(~border) > pocket / pitch)
    assert np.array_equal(last(steps, 307) == PixelCode.CONTOUR, left), "peels and circles are the Euclidean erosion"
    assert ndimage.label(ready.part.free, np.ones((3, 3)))[1] == ready.part.label.max()
    frame = left & ~ndimage.binary_erosion(np.pad(left, 1))[1:-1, 1:-1]
    assert np.array_equal(last(steps, 144) == PixelCode.FRAME, frame)
    end = last(steps, 148)
    paths = (end == PixelCode.FRAME) | (end == PixelCode.RING)
    assert paths.any() == left.any(), "where nothing is left nothing is cleared"
    reach = ndimage.distance_transform_edt(~left) <= pocket / pitch
    swept = ndimage.distance_transform_edt(~paths) <= pocket / pitch + 1.0
    assert not (reach & ~swept).any(), "what the tool reaches stays"
