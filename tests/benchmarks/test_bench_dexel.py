"""Cutting three finishing programs into 1024 x 1024 cells, side by side with a plain trim: one thread, all cells of each
move's box, branches, float64. The programs are zigzags over a curved die, 100 mm square, by ball cutters."""

import math

import numba
import numpy as np
import pytest
from pytest_benchmark.fixture import BenchmarkFixture
from scipy.ndimage import gaussian_filter1d, map_coordinates

from app.dexel.cutter import Cutter
from app.dexel.trim import Course, TrimOptions, trim
from app.dexel.workpiece import BoxStock, Grid
from app.files.holders import outline_of
from app.model.motion import Floats
from app.model.stock_box import StockBox
from app.model.tool import Tool, ToolKind
from app.workflow.holder_contacts import holder_contacts
from tests.benchmarks.conftest import OURS, record
from tests.dexel.courses import course_of, polyline

pytestmark = pytest.mark.benchmark
SIZE = 100.0
PROGRAMS = {"A": (9542, 5.0, 201), "B": (35391, 3.0, 286), "C": (300000, 1.0, 667)}
"""Moves, radius, lines."""

STOCK = BoxStock(StockBox(0.0, 0.0, -25.0, SIZE, SIZE))
kept: dict[str, Course] = {}


def die(x: Floats, y: Floats) -> Floats:
    """Height of the die, mm, in about [-20, 0]."""
    hills = ((35, 40, 14, 11), (70, 65, 10, 9), (65, 28, 9, -5), (28, 75, 11, -5))
    rounds = sum(height * np.exp(-((x - cx) ** 2 + (y - cy) ** 2) / (2 * width * width)) for cx, cy, width, height in hills)
    return np.asarray(-14 + rounds + 1.2 * np.sin(x / 9.0) * np.cos(y / 11.0))


def centre_surface(radius: float, count: int = 480) -> tuple[Floats, Floats]:
    """Grid and heights of the ball's centre where it touches the die from above."""
    grid = np.linspace(-radius - 1, SIZE + radius + 1, count)
    x, y = np.meshgrid(grid, grid)
    z = die(np.clip(x, 0, SIZE), np.clip(y, 0, SIZE))
    step = grid[1] - grid[0]
    k = int(radius / step)
    padded, out = np.pad(z, k, mode="edge"), np.full_like(z, -1e9)
    for j in range(-k, k + 1):
        for i in range(-k, k + 1):
            square = (i * i + j * j) * step * step
            if square <= radius * radius:
                np.maximum(out, padded[k + j : k + j + count, k + i : k + i + count] + math.sqrt(radius * radius - square), out=out)
    return grid, out


def finishing(moves: int, radius: float, lines: int) -> Floats:
    """A zigzag along X of `moves` moves, points denser where the path bends; (moves + 1, 3) places of the tip."""
    grid, centres = centre_surface(radius)
    step = grid[1] - grid[0]
    xs = np.linspace(0, SIZE, 4001)
    rows = []
    for i, y in enumerate(np.linspace(0, SIZE, lines)):
        count = (moves + 1) // lines + (1 if i < (moves + 1) % lines else 0)
        z = map_coordinates(centres, [np.full_like(xs, (y - grid[0]) / step), (xs - grid[0]) / step], order=1)
        z = gaussian_filter1d(z, 25, mode="nearest")
        density = np.sqrt(np.abs(np.gradient(np.gradient(z, xs), xs)) + 0.005)
        along = np.concatenate([[0], np.cumsum((density[1:] + density[:-1]) / 2)])
        x = np.interp(np.linspace(0, 1, count), along / along[-1], xs)
        x = x[::-1] if i & 1 else x
        rows.append(np.stack([x, np.full_like(x, y), np.interp(x, xs, z) - radius], 1))
    return np.concatenate(rows)


def course(name: str) -> Course:
    if name not in kept:
        kept[name] = course_of(polyline(finishing(*PROGRAMS[name])))
    return kept[name]


@numba.njit("void(float64[:, ::1], float64[:, ::1], float64[:, ::1], float64, float64)", cache=True)
def plain_trim(heights: Floats, start: Floats, end: Floats, radius: float, pitch: float) -> None:
    """Lower heights over [0, n pitch]² under a ball: what anybody would write first."""
    rows, cols = heights.shape
    for k in range(len(start)):
        x0, y0, z0 = start[k]
        x1, y1, z1 = end[k]
        dx, dy, dz = x1 - x0, y1 - y0, z1 - z0
        length2 = dx * dx + dy * dy
        length = math.sqrt(length2)
        slope = dz / length if length > 0 else 0.0
        lean = slope / math.sqrt(1 + slope * slope)
        first_row, last_row = max(0, int((min(y0, y1) - radius) / pitch)), min(rows - 1, int((max(y0, y1) + radius) / pitch))
        first_col, last_col = max(0, int((min(x0, x1) - radius) / pitch)), min(cols - 1, int((max(x0, x1) + radius) / pitch))
        for row in range(first_row, last_row + 1):
            y = (row + 0.5) * pitch - y0
            for col in range(first_col, last_col + 1):
                x = (col + 0.5) * pitch - x0
                along = (x * dx + y * dy) / length if length > 0 else 0.0
                square = x * x + y * y - along * along
                if square >= radius * radius:
                    continue
                reach = math.sqrt(radius * radius - square)
                at = along - reach * lean
                if at < 0:
                    at = 0.0
                elif at > length:
                    at = length
                under = reach * reach - (along - at) * (along - at)
                if under < 0:
                    continue
                z = z0 + slope * at + radius - math.sqrt(under)
                if z < heights[row, col]:
                    heights[row, col] = z


def cut(name: str, cells: int = 1024, traced: bool = False, box: tuple[float, float, float, float] = (0.0, 0.0, SIZE, SIZE)) -> Floats:
    radius = PROGRAMS[name][1]
    done = trim(STOCK.over(Grid.over(box, cells)), course(name), {1: Cutter(radius, 0.0, radius)}, TrimOptions(trace=traced))
    return done.heights.astype(float)


def plain(name: str, cells: int = 1024) -> Floats:
    heights = np.zeros((cells, cells))
    motions = course(name).motions
    plain_trim(heights, motions.start.copy(), motions.end.copy(), PROGRAMS[name][1], SIZE / cells)
    return heights


@pytest.mark.parametrize("name", PROGRAMS)
def test_ours(benchmark: BenchmarkFixture, name: str) -> None:
    piece, radius, way = STOCK.over(Grid.over((0.0, 0.0, SIZE, SIZE), 1024)), PROGRAMS[name][1], course(name)
    done = benchmark.pedantic(trim, (piece, way, {1: Cutter(radius, 0.0, radius)}), rounds=15, warmup_rounds=1)
    apart = np.abs(done.heights - plain(name))
    assert np.mean(apart > 1e-5) < 1e-5
    record(benchmark, f"cut {name}", OURS)


@pytest.mark.parametrize("name", PROGRAMS)
def test_a_holder_that_touches_nothing(benchmark: BenchmarkFixture, name: str) -> None:
    """And how far the tool must stick out, beside the cut alone."""
    piece, radius, way = STOCK.over(Grid.over((0.0, 0.0, SIZE, SIZE), 1024)), PROGRAMS[name][1], course(name)
    tool = Tool(1, 2 * radius, ToolKind.BALL, flute_length=50, shank_diameter=2 * radius, stick_out=60, holder=outline_of("Shrink fit 6"))
    looked = benchmark.pedantic(holder_contacts, (way, piece, {1: Cutter(radius, 0.0, radius)}, {1: tool}), rounds=5, warmup_rounds=1)
    assert looked.contacts == () and 10 < looked.least[1] < 25
    record(benchmark, f"cut {name}", "holder")


@pytest.mark.parametrize("name", PROGRAMS)
def test_plain(benchmark: BenchmarkFixture, name: str) -> None:
    benchmark.pedantic(plain, (name,), rounds=3, warmup_rounds=1)
    record(benchmark, f"cut {name}", "plain")


@pytest.mark.parametrize("name", PROGRAMS)
def test_ours_with_volume_and_cutting_move(benchmark: BenchmarkFixture, name: str) -> None:
    benchmark.pedantic(cut, (name, 1024, True), rounds=3, warmup_rounds=1)
    record(benchmark, f"cut {name}", "ours, traced")


@pytest.mark.parametrize("name", PROGRAMS)
def test_a_window_of_ten_millimetres(benchmark: BenchmarkFixture, name: str) -> None:
    benchmark.pedantic(cut, (name, 1024, False, (42.0, 47.0, 52.0, 57.0)), rounds=7, warmup_rounds=1)
    record(benchmark, f"window {name}", OURS)


def test_sixteen_million_cells(benchmark: BenchmarkFixture) -> None:
    benchmark.pedantic(cut, ("B", 4096), rounds=3, warmup_rounds=1)
    record(benchmark, "cut B, 4096 x 4096", OURS)
