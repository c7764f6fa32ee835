"""Distance and all rings of a bitmap, as a multiple of the time that copying the arrays takes which it must touch."""

import numpy as np
import pytest
from pytest_benchmark.fixture import BenchmarkFixture

from app.raster.border import Border, borders_of
from app.raster.frame import BitmapFrame
from app.raster.levels import RingSteps, offset_area, ring_index
from app.raster.walls import Mask, free_pixels
from tests.benchmarks.conftest import OURS, record
from tests.part_shapes import fig2

pytestmark = pytest.mark.benchmark
SIZES = [1600, 8000]


def area_of(size: int) -> tuple[Mask, RingSteps]:
    """A' of the part at r1 = 0.5 mm, and rings as far apart as the findings take them: R = 1 mm, step 0.9 mm."""
    pixel = 100 / size
    return offset_area(free_pixels(BitmapFrame(size, size, pixel), fig2()), 0.5 / pixel, 1.0), RingSteps(
        1 / pixel, 0.9 / pixel
    )


def rings(area: Mask, steps: RingSteps) -> tuple[Border, ...]:
    return borders_of(ring_index(area, steps))


@pytest.mark.parametrize("size", SIZES)
def test_own_distance_and_rings(benchmark: BenchmarkFixture, size: int) -> None:
    area, steps = area_of(size)
    found = benchmark.pedantic(rings, (area, steps), rounds=5, warmup_rounds=1)
    record(benchmark, f"distance and all rings at {size} x {size}", OURS)
    assert max(border.level for border in found) >= 13
    assert len(found) > 30


@pytest.mark.parametrize("size", SIZES)
def test_copying_what_it_touches(benchmark: BenchmarkFixture, size: int) -> None:
    """The area, its inner pixels, the columns' heights and the levels in their place, each once."""
    area, _ = area_of(size)
    levels = np.ones((size, size), np.uint16)
    copies = benchmark.pedantic(
        lambda: (area.copy(), area.copy(), levels.copy(), levels.copy()), rounds=5, warmup_rounds=1
    )
    record(benchmark, f"distance and all rings at {size} x {size}", "copying the arrays")
    assert len(copies) == 4
