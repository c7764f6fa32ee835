"""The bitmap fill against OpenCV's polygon fill on the same contours, which gets them as points and knows no codes."""

import cv2
import numpy as np
import pytest
from pytest_benchmark.fixture import BenchmarkFixture

from app.geometry.primitives import contour_rows, sample
from app.model.part import Region
from app.raster.fill import fill
from app.raster.frame import BitmapFrame
from tests.benchmarks.conftest import OURS, record

pytestmark = pytest.mark.benchmark
SIZES = [400, 1600, 4000]
SUB_PIXEL_BITS = 8

Named = tuple[str, tuple[Region, ...]]


def frame_of(regions: tuple[Region, ...], size: int) -> tuple[BitmapFrame, np.ndarray]:
    rows = np.concatenate([contour_rows(contour) for region in regions for contour in region.contours])
    points = rows[:, :2]
    return BitmapFrame.around((*points.min(axis=0), *points.max(axis=0)), size), rows


@pytest.mark.parametrize("size", SIZES)
def test_own_fill(benchmark: BenchmarkFixture, part: Named, size: int) -> None:
    name, regions = part
    frame, rows = frame_of(regions, size)
    codes = benchmark(fill, frame, rows)
    record(benchmark, f"fill of {name} at {size} x {size}", OURS)
    assert codes.filled.mean() > 0.1


@pytest.mark.parametrize("size", SIZES)
def test_opencv_fill(benchmark: BenchmarkFixture, part: Named, size: int) -> None:
    name, regions = part
    frame, _ = frame_of(regions, size)
    contours = [sample(contour_rows(contour), frame.pitch / 10) for region in regions for contour in region.contours]
    corners = [np.rint((frame.to_px(points) - 0.5) * (1 << SUB_PIXEL_BITS)).astype(np.int32) for points in contours]

    def filled() -> np.ndarray:
        return cv2.fillPoly(np.zeros((size, size), np.uint8), corners, 1, shift=SUB_PIXEL_BITS)

    mask = benchmark(filled)
    record(benchmark, f"fill of {name} at {size} x {size}", "cv2.fillPoly")
    assert np.mean((mask != 0) != fill(frame, [c for region in regions for c in region.contours]).filled) < 0.02
