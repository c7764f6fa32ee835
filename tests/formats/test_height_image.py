"""Heights as a picture: north up, light from the north-west, cusps seen, nothing that is wrong too small to be seen."""

from __future__ import annotations

import time

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray

from app.formats.plot.height_image import (
    GOUGE,
    LEFT,
    MARGIN,
    NOTHING,
    PAPER,
    RAMP,
    SIDE,
    UNREACHABLE,
    HeightImage,
    height_image,
)

Pixels = NDArray[np.int64]


def picture(image: HeightImage) -> Pixels:
    """Read the PNG, RGB."""
    decoded = cv2.imdecode(np.frombuffer(height_image(image), np.uint8), cv2.IMREAD_COLOR)
    assert decoded is not None
    return np.asarray(decoded[..., ::-1], np.int64)


def metal(image: HeightImage) -> Pixels:
    """The part of the picture that shows the metal."""
    zoom = SIDE / max(image.heights.shape)
    times = max(1, int(zoom)) if zoom >= 1 else zoom
    rows, cols = (round(side * times) for side in image.heights.shape)
    return picture(image)[MARGIN : MARGIN + rows, MARGIN : MARGIN + cols]


def flat(rows: int, cols: int, height: float = 0.0) -> NDArray[np.float32]:
    return np.full((rows, cols), height, np.float32)


def near(pixel: NDArray[np.int64], colour: tuple[int, int, int], by: int = 30) -> bool:
    return bool(np.abs(pixel - np.array(colour)).max() <= by)


@pytest.mark.parametrize("shape", [(100, 100), (1, 1), (3, 700), (700, 3), (1024, 1024), (1500, 2300), (4096, 512)])
def test_it_is_about_as_large_whatever_the_grid(shape: tuple[int, int]) -> None:
    made = picture(HeightImage(flat(*shape), 0.1, 0.0, -10.0))
    assert SIDE / 2 < max(made.shape[0], made.shape[1] - 3 * MARGIN - 200) <= SIDE + 3 * MARGIN
    assert near(made[2, 2], PAPER, 2)


def test_north_is_up_and_depths_have_their_colours() -> None:
    heights = flat(128, 128)
    heights[96:] = -4.0  # the last rows are the northern ones
    heights[:16] = -10.0
    heights[16:48, :64] = -8.0
    shown = metal(HeightImage(heights, 0.1, 0.0, -10.0))
    assert near(shown[1000, 500], NOTHING)
    assert near(shown[800, 800], RAMP[0])
    assert near(shown[100, 500], RAMP[2], 45)
    assert near(shown[800, 100], RAMP[4], 45) or near(shown[800, 100], RAMP[3], 45)
    assert shown[100, 500].sum() > shown[800, 100].sum()


def test_light_comes_from_the_north_west() -> None:
    x = np.arange(256, dtype=np.float32) * np.float32(0.1)
    ridge = -np.abs(x - 12.8)[None, :].repeat(256, 0) - 1
    shown = metal(HeightImage(np.ascontiguousarray(ridge, np.float32), 0.1, 0.0, -20.0))
    # the western flank, and the eastern one at the same height
    assert shown[512, 300].sum() > shown[512, 723].sum() + 150
    shown = metal(HeightImage(np.ascontiguousarray(ridge.T, np.float32), 0.1, 0.0, -20.0))
    assert shown[300, 512].sum() > shown[723, 512].sum() + 150  # the northern flank


def test_cusps_of_a_ball_are_seen() -> None:
    y = np.arange(512) * 0.1
    heights = (3 - np.sqrt(9 - (np.mod(y, 0.5) - 0.25) ** 2) - 2).astype(np.float32)  # 10 um high, 0.5 mm apart
    shown = metal(HeightImage(np.ascontiguousarray(heights[:, None].repeat(512, 1)), 0.1, 0.0, -10.0))
    light = shown[200:800, 500].sum(axis=1)
    assert light.max() - light.min() > 30


@pytest.mark.parametrize("cells", [128, 1024, 3000])
def test_what_is_wrong_is_seen_however_small(cells: int) -> None:
    heights, deviation, beyond = flat(cells, cells, -2.0), flat(cells, cells), np.zeros((cells, cells), bool)
    deviation[cells // 4 + 1, cells // 4 + 1] = -0.02
    deviation[cells // 2 + 1, cells // 2 + 1] = 0.02
    deviation[3 * cells // 4 : 3 * cells // 4 + cells // 16, 3 * cells // 4 : 3 * cells // 4 + cells // 16] = 2.0
    beyond[deviation > 1] = True
    shown = metal(HeightImage(heights, 0.1, 0.0, -10.0, "p", deviation, beyond, 0.01))
    scale = shown.shape[0] / cells
    for colour, where in ((GOUGE, 1 / 4), (LEFT, 1 / 2), (UNREACHABLE, 3 / 4 + 1 / 32)):
        row, col = round((1 - where) * cells * scale), round(where * cells * scale)
        around = shown[row - 12 : row + 12, col - 4 : col + 12].reshape(-1, 3)
        ratios = around / np.array(colour)
        assert np.any(np.ptp(ratios, axis=1) < 0.05), colour
    clean = metal(HeightImage(heights, 0.1, 0.0, -10.0, "p", flat(cells, cells, 0.009), None, 0.01))
    assert np.ptp(clean.reshape(-1, 3), axis=0).max() <= 4


@pytest.mark.exhaustive
def test_it_is_quick() -> None:
    rows = np.random.default_rng(1).normal(-2, 0.01, (1024, 1024)).astype(np.float32)
    image = HeightImage(rows, 0.1, 0.0, -10.0, "p", rows + np.float32(2), rows > -2, 0.01)
    height_image(image)
    times = []
    for _ in range(3):
        begin = time.process_time()
        height_image(image)
        times.append(time.process_time() - begin)
    assert min(times) < 1.0
