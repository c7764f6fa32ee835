"""Lines and arcs beside chord reduction and greedy arcs, on the same points in the same run: seconds, and blocks
out.
"""

import math
import re
from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray
from pytest_benchmark.fixture import BenchmarkFixture

from app.fitting.line_arcs.arc_fit import ArcOptions, fit_arcs
from app.geometry.arcs.arcs import lines_and_arcs
from app.model.curves import Spline
from app.usecases.smoothing.result import SmoothOptions
from app.usecases.smoothing.smooth import smooth
from tests.benchmarks.conftest import OURS, record
from tests.conftest import ROOT

pytestmark = pytest.mark.benchmark
Floats = NDArray[np.float64]
TOLERANCE = 0.05
WORD = re.compile(r"([XYZ])\s*(-?[0-9.]+)")


def chains(name: str) -> list[Floats]:
    """The chains of G1 of a plain program."""
    place, found, on = [0.0, 0.0, 0.0], [], False
    for line in (ROOT / "tests" / "data" / "nc" / name).read_text().splitlines():
        line = re.sub(r"\(.*?\)|;.*", "", line)
        for code in re.findall(r"G0*([0-3])(?![0-9.])", line):
            on, before = code == "1", on
            if on and not before:
                found.append([place])
        words = {axis: float(value) for axis, value in WORD.findall(line)}
        after = [words.get(axis, old) for axis, old in zip("XYZ", place, strict=True)]
        if on and after != place:
            found[-1].append(after)
        place = after
    return [np.array(chain) for chain in found if len(chain) > 1]


def wavy() -> list[Floats]:
    """A closed contour of 20,000 chords of 30 um."""
    t = np.linspace(0, math.tau, 20_001)
    r = 44 + 2 * np.sin(17 * t) + np.sin(61 * t)
    return [np.round(np.column_stack([r * np.cos(t), r * np.sin(t), 0 * t]), 3)]


CASES: dict[str, Callable[[], list[Floats]]] = {
    "jsdc": lambda: chains("jsdc.gcode"),
    "tux": lambda: chains("tux.ngc"),
    "pycam": lambda: chains("test_pycam.ngc"),
    "wavy": wavy,
}


def chords(points: Floats) -> int:
    """Count chords, each drawn on while all points it passes are within the tolerance of it."""
    count, i = 0, 0
    while i < len(points) - 1:
        j = i + 1
        while j < len(points) - 1 and _near_chord(points[i : j + 2]):
            j += 1
        i, count = j, count + 1
    return count


def _near_chord(points: Floats) -> bool:
    a, d = points[0], points[-1] - points[0]
    share = np.clip((points - a) @ d / max(d @ d, 1e-300), 0, 1)
    return bool(np.abs(np.linalg.norm(points - a - share[:, None] * d, axis=1)).max() <= TOLERANCE)


def arc_welder(points: Floats) -> int:
    """Count lines and arcs in the manner of ArcWelder: an arc through first, middle and last point, grown by one while
    all are near it.
    """
    count, i = 0, 0
    while i < len(points) - 1:
        j = i + 2
        while j < len(points) and _near_arc(points[i : j + 1]):
            j += 1
        j -= 1
        i, count = (j if j - i > 1 else i + 1), count + 1
    return count


def _near_arc(points: Floats) -> bool:
    if np.ptp(points[:, 2]) > 0:
        return False
    (ax, ay), (bx, by), (cx, cy) = points[0, :2], points[len(points) // 2, :2], points[-1, :2]
    double = 2 * (ax * (by - cy) + bx * (cy - ay) + cx * (ay - by))
    if abs(double) < 1e-9:
        return False
    a, b, c = ax * ax + ay * ay, bx * bx + by * by, cx * cx + cy * cy
    x = (a * (by - cy) + b * (cy - ay) + c * (ay - by)) / double
    y = (a * (cx - bx) + b * (ax - cx) + c * (bx - ax)) / double
    radius = math.hypot(ax - x, ay - y)
    middles = np.concatenate([points, (points[1:] + points[:-1]) / 2])
    return bool(np.abs(np.hypot(middles[:, 0] - x, middles[:, 1] - y) - radius).max() <= TOLERANCE) and radius < 1e5


def ours(points: Floats) -> int:
    return len(fit_arcs(points, ArcOptions(TOLERANCE)).motions)


def bent(points: Floats) -> int:
    """Ours, where neighbours may bend by 15 degrees."""
    return len(fit_arcs(points, ArcOptions(TOLERANCE, bend=math.radians(15.0))).motions)


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("way", [ours, bent, chords, arc_welder])
def test_blocks(benchmark: BenchmarkFixture, case: str, way: Callable[[Floats], int]) -> None:
    given = CASES[case]()
    engine = OURS if way is ours else way.__name__
    total = benchmark.pedantic(lambda: sum(way(points) for points in given), rounds=1)
    benchmark.extra_info["blocks"] = total
    record(benchmark, f"lines and arcs, {case}", engine)


@pytest.mark.parametrize("case", CASES)
def test_no_more_blocks_than_the_best_of_the_others(case: str) -> None:
    given = CASES[case]()
    count, *others = (sum(way(points) for points in given) for way in (ours, chords, arc_welder))
    assert count <= min(others)


def test_the_sort_that_times_are_told_in(benchmark: BenchmarkFixture) -> None:
    """12 million doubles: what ArcWelder's recorded 0.063 s for jsdc and 0.16 s stand beside on other machines."""
    values = np.random.default_rng(1).random(12_000_000)
    benchmark.pedantic(lambda: np.sort(values), rounds=1)
    record(benchmark, "lines and arcs, jsdc", "a sort of 12 million numbers")


def program(name: str) -> bytes:
    if name == "jsdc":
        return (ROOT / "tests" / "data" / "nc" / "jsdc.gcode").read_bytes()
    t = np.linspace(0, math.tau, int(name) + 1)
    r = len(t) / 20_000 * (40 + 6 * np.sin(5 * t) + 1.5 * np.sin(23 * t))
    moves = "".join(
        f"X{x:.4f} Y{y:.4f}\n" for x, y in zip((r * np.cos(t)).tolist(), (r * np.sin(t)).tolist(), strict=True)
    )
    return f"G21 G90 G94\nG0 X{r[0]:.4f} Y0 Z0\nG1 F1000\n{moves}G0 Z5\nM2\n".encode()


@pytest.mark.parametrize("name", ["jsdc", "10000", "100000", "1000000"])
def test_a_whole_program(benchmark: BenchmarkFixture, name: str) -> None:
    """Reading, fitting, writing, reading again, proving: time is to grow with the lines."""
    data = program(name)
    done = benchmark.pedantic(
        lambda: smooth("x.ngc", data, SmoothOptions(TOLERANCE)), rounds=1, warmup_rounds=int(name == "jsdc")
    )
    benchmark.extra_info["blocks"] = sum(piece.blocks[1] for piece in done.pieces)
    record(benchmark, f"a program smoothed, {name}", OURS)


@pytest.mark.parametrize("count", [500, 2_000, 8_000])
def test_splines_of_a_drawing(benchmark: BenchmarkFixture, count: int) -> None:
    """Of 10 control points each, some 30 mm long."""
    rng, t = np.random.default_rng(3), np.linspace(0, 30, 10)
    knots = (0.0,) * 4 + tuple(range(1, 7)) + (7.0,) * 4
    curves = [
        Spline(3, tuple(zip(t.tolist(), np.cumsum(rng.normal(0, 1.0, 10)).tolist(), strict=True)), knots)
        for _ in range(count)
    ]
    lines_and_arcs(curves[0])
    benchmark.pedantic(lambda: [lines_and_arcs(curve) for curve in curves], rounds=1)
    record(benchmark, f"{count} splines to lines and arcs", OURS)
