"""Borders, peels and the circle's correction: literal peeling is the city block distance, step 307 makes it
Euclidean.
"""

from itertools import pairwise

import numpy as np
import pytest
from scipy import ndimage

from app.raster.border import borders_of, mark
from app.raster.frame import BitmapFrame
from app.raster.levels import SAFE_PX, RingSteps, offset_area, ring_index, thresholds_reached
from app.raster.peel import correct_by_circles, distance_px, frame_pixels, inner_pixels, peels
from app.raster.walls import free_pixels
from tests.part_shapes import fig2
from tests.raster.peeling import frame_distance, peeled, shrink

EIGHT = np.ones((3, 3))


def random_area(seed: int, size: int = 60) -> np.ndarray:
    rng = np.random.default_rng(seed)
    noise = rng.random((size, size)) < rng.choice([0.3, 0.5, 0.7, 0.9])
    return ndimage.binary_opening(noise) if seed % 3 == 0 else ndimage.binary_closing(noise) if seed % 3 == 1 else noise


def part(size: int) -> np.ndarray:
    return free_pixels(BitmapFrame.around((6, 6, 96, 96), size), fig2())


def squared_distance(area: np.ndarray, targets: np.ndarray) -> np.ndarray:
    """Exact squared distances from target pixels, whole numbers."""
    _, (row, col) = ndimage.distance_transform_edt(~targets, return_indices=True)
    rows, cols = np.indices(area.shape)
    return (rows - row) ** 2 + (cols - col) ** 2


@pytest.mark.parametrize("seed", range(30))
def test_every_border_is_found_once_and_holds_every_border_pixel(seed: int) -> None:
    area = random_area(seed)
    borders = borders_of(area)
    assert len(borders) == ndimage.label(area, EIGHT)[1] + ndimage.label(~np.pad(area, 1))[1] - 1, (
        "one an area, one a hole"
    )
    marked = np.zeros(area.shape, np.uint8)
    mark(marked, borders, 1)
    padded = np.pad(area, 1)
    assert np.array_equal(marked == 1, area & ~ndimage.binary_erosion(padded)[1:-1, 1:-1])
    assert np.array_equal(marked == 1, frame_pixels(area))
    assert all(border.chain.pixels()[-1].tolist() == list(border.chain.start) for border in borders)


@pytest.mark.parametrize("seed", range(12))
def test_all_levels_in_one_pass_are_the_borders_of_each(seed: int) -> None:
    index = np.random.default_rng(seed).integers(0, 8, (40, 40)).astype(np.uint16)
    index = ndimage.median_filter(index, 3) if seed % 2 else index
    together = borders_of(index)
    for level in range(1, 9):
        alone = sorted(border.chain.text() for border in borders_of(index >= level))
        assert alone == sorted(border.chain.text() for border in together if border.level == level)


@pytest.mark.parametrize("count", [1, 2, 4, 9])
def test_peeling_is_the_city_block_distance(count: int) -> None:
    for area in (part(400), random_area(2), random_area(3)):
        blocks = ndimage.distance_transform_cdt(np.pad(area, 1), "taxicab")[1:-1, 1:-1]
        assert np.array_equal(peeled(area, count), blocks > count), "0 px different"


@pytest.mark.parametrize("radius", [1.0, 4.0, 6.3, 17.5])
def test_with_the_circles_it_is_the_euclidean_threshold(radius: float) -> None:
    for area in (part(400), random_area(2), random_area(3)):
        frame = area & ~ndimage.binary_erosion(np.pad(area, 1))[1:-1, 1:-1]
        exact = area & (squared_distance(area, frame) > radius * radius) if frame.any() else area
        assert np.array_equal(shrink(area, radius), exact), "0 px different"
        assert np.array_equal(correct_by_circles(area, area, radius), exact), "the peels add nothing to the circles"


@pytest.mark.exhaustive
def test_peeling_at_1600() -> None:
    area = part(1600)
    blocks = ndimage.distance_transform_cdt(np.pad(area, 1), "taxicab")[1:-1, 1:-1]
    assert np.array_equal(peeled(area, 25), blocks > 25)
    frame = frame_pixels(area)
    assert np.array_equal(shrink(area, 25.0), area & (squared_distance(area, frame) > 625))


@pytest.mark.parametrize("wide", [1, 2])
def test_the_exception_of_step_304_keeps_a_dumbbell_whole_where_peels_alone_part_it(wide: int) -> None:
    area = np.zeros((17, 40), bool)
    area[2:15, 2:15] = area[2:15, 25:38] = True
    area[8 : 8 + wide, 15:25] = True
    plain, kept = ([left for left, _ in peels(area, 4, keep_narrow=keep)][-1] for keep in (False, True))
    assert ndimage.label(plain, np.ones((3, 3)))[1] == 2 and ndimage.label(kept, np.ones((3, 3)))[1] == 1
    assert kept[8 : 8 + wide, 15:25].all() and np.all(kept[plain])
    ((first, _),) = peels(area, 1, keep_narrow=True)
    square = np.zeros_like(area)
    square[3:14, 3:14] = True
    assert np.array_equal(first[:, :12], square[:, :12]), "all else is peeled as ever"
    corrected = [correct_by_circles(left, area, 4.0) for left in (plain, kept)]
    assert np.array_equal(*corrected), "which the circles take away again"


def test_a_line_of_one_pixel_is_never_peeled_by_the_exception() -> None:
    area = np.zeros((7, 12), bool)
    area[3, 1:11] = True
    assert not peeled(area, 1).any() and not list(peels(area, 3, keep_narrow=True))


def test_peeling_ends_where_kept_ends_alone_are_left() -> None:
    area = np.zeros((9, 14), bool)
    area[2:7, 2:12] = True
    area[4, 0:14] = True
    turns = [left for left, _ in peels(area, 500, keep_narrow=True)]
    assert 1 < len(turns) < 9
    assert turns[-1].any()
    assert all(np.count_nonzero(b) < np.count_nonzero(a) for a, b in pairwise([area, *turns]))
    assert not list(peels(turns[-1], 3, keep_narrow=True))


@pytest.mark.exhaustive
def test_an_offset_keeps_its_distance_from_every_outside_pixel() -> None:
    free = part(400)
    distance = np.sqrt(squared_distance(free, ~free))
    assert np.array_equal(offset_area(free, 8.0, 1.0), distance >= 8 + 1 + SAFE_PX - 1e-6)
    assert offset_area(free, 0.0, 1.0) is free
    assert np.allclose(distance_px(free)[free], distance[free], atol=1e-4)


@pytest.mark.parametrize("seed", range(20))
def test_thresholds_are_reached_exactly(seed: int) -> None:
    free = random_area(seed, 50 + seed)
    square = squared_distance(np.pad(free, 1), ~np.pad(free, 1))[1:-1, 1:-1]
    thresholds = [1, 2, 3, 5, 9, 10, 26]
    expected = sum((square >= each).astype(int) for each in thresholds)
    assert np.array_equal(thresholds_reached(free, thresholds), expected)
    assert not thresholds_reached(np.zeros((3, 4), bool), [1]).any()
    assert np.array_equal(
        thresholds_reached(np.ones((5, 9), bool), [1, 4, 9, 16]),
        np.minimum.reduce(
            np.meshgrid(
                np.minimum(np.arange(1, 10), np.arange(9, 0, -1)), np.minimum(np.arange(1, 6), np.arange(5, 0, -1))
            )
        ),
    )


def test_large_pictures_are_measured_in_bands_alike() -> None:
    area = part(1600)
    square = squared_distance(area, ~area)
    assert np.array_equal(thresholds_reached(area, [400, 2500]), (square >= 400) + 1 * (square >= 2500))


@pytest.mark.parametrize(
    ("rows", "cols", "free"), [(97, 700, 0.999), (33, 300, 0.99), (64, 129, 0.5), (1, 200, 0.99), (200, 1, 0.99)]
)
def test_long_runs_and_thin_pictures_are_measured_alike(rows: int, cols: int, free: float) -> None:
    area = np.random.default_rng(rows).random((rows, cols)) < free
    padded = np.pad(area, 1)
    inner = ndimage.binary_erosion(padded)[1:-1, 1:-1]
    assert np.array_equal(inner_pixels(area), inner)
    thresholds = [1, 2, 30, 31, 32, 400]
    square = squared_distance(padded, ~padded)[1:-1, 1:-1]
    assert np.array_equal(
        thresholds_reached(area, thresholds), sum((square >= each).astype(int) for each in thresholds)
    )


def test_noise_of_many_borders_is_traced_whole() -> None:
    noise = np.random.default_rng(1).random((300, 300)) < 0.7
    borders = borders_of(noise)
    assert len(borders) == ndimage.label(noise, EIGHT)[1] + ndimage.label(~np.pad(noise, 1))[1] - 1
    marked = np.zeros(noise.shape, np.uint8)
    mark(marked, borders, 1)
    assert np.array_equal(marked == 1, frame_pixels(noise))


def test_paths_are_levels_of_one_field() -> None:
    area = offset_area(part(400), 4.0, 1.0)
    field = frame_distance(area)
    index = ring_index(area, RingSteps(8.0, 5.0, 2.0))
    assert np.array_equal(index >= 1, shrink(area, 8.0))
    exact = np.sqrt(np.maximum(np.rint(field.astype(float) ** 2), 0))
    for k in (2, 3, 4):
        assert np.array_equal(index >= k, area & (exact > 8) & (exact >= 8 + 5 * (k - 1) - 2))
    assert np.array_equal(ring_index(area, RingSteps(0.0, 5.0)) >= 1, area)
