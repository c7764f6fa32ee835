"""What `surface` leaves within reach of its own tools: flats, slopes, walls, corners, domes and waves, in closed form
and by an oracle.
"""

import json
import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from app.cli.main import main
from app.simulation.cutter import Cutter
from app.usecases.scene_program.ridges import ridges
from tests.surfaces.closing_oracle import Surface, Window, cut, reach
from tests.surfaces.solids import pocketed_block
from tests.usecases.test_scene_findings import DOME, MESH, told

RADIUS = 3.0
"""Of the ball that `told` cuts with, mm."""


def flat_ridge(spacing: float) -> float:
    return RADIUS - math.sqrt(RADIUS**2 - spacing**2 / 4)


def left(report: dict[str, Any]) -> list[dict[str, Any]]:
    return [finding for finding in report["findings"] if finding["kind"] == "left_reachable"]


@pytest.mark.parametrize(("spacing", "degrees"), [(0.2, 0), (1.0, 0), (2.0, 30), (1.0, 60), (0.3, 75)])
def test_ridges_of_a_ball_in_closed_form(spacing: float, degrees: float) -> None:
    """Along a slope passes are 1 / cos farther apart, and their circles meet where they meet on a flat."""
    slope = math.tan(math.radians(degrees))
    found = float(ridges(Cutter(RADIUS, 0.0, RADIUS), spacing, np.array([slope]))[0])
    assert found == pytest.approx(flat_ridge(spacing / math.cos(math.radians(degrees))), abs=0.003)


def test_ridges_of_a_flat_mill_are_steps() -> None:
    """None on a flat while passes overlap; on a slope a step of pitch times slope, square to it; none farther apart
    than the mill is.
    """
    mill = Cutter(RADIUS, RADIUS, 0.0)
    found = ridges(mill, 0.2, np.array([0.0, 1.0]))
    assert found.tolist() == pytest.approx([0.0, 0.2 / math.sqrt(2.0)], abs=0.01)
    assert ridges(mill, 7.0, np.zeros(1))[0] == 0.0


@pytest.mark.parametrize(("degrees", "pitch"), [(0, 1.0), (0, 2.0), (30, 1.0), (45, 1.0), (60, 0.5)])
def test_ridges_on_planes_are_told_as_ridges_and_are_not_left(tmp_path: Path, degrees: int, pitch: float) -> None:
    """The surface goes on beside the stock: at its lower edge the ball would have to go lower than passes do there."""
    rise = 26 * math.tan(math.radians(degrees))
    shape = f'{{ kind = "plane", corner = [0, -3, {-rise}], along = [30, 0, 0], across = [0, 26, {rise}] }}'
    _, report = told(tmp_path, shape=shape, pitch=pitch, stock=f"box = [0, 0, {-rise - 5}, 30, 20, 0.5]")
    assert left(report) == [] and report["left"]["reachable_mm2"] == 0.0
    asked = flat_ridge(pitch / math.cos(math.radians(degrees)))
    assert report["left"]["ridge"]["max_mm"] == pytest.approx(asked, abs=0.02 + 0.1 * asked)
    assert report["left"]["ridge"]["level_mm"] == pytest.approx(flat_ridge(pitch), abs=0.002)


def test_a_wall_between_two_planes_is_left_with_its_height_and_the_remedy(tmp_path: Path) -> None:
    """The pocket's wall is at y = 7, its middle passes at 12 and 16, and the ball may come to 10: 2 mm stay.

    At y = 9 the last pass over the block leaves 0, and the ball at 10 would come to sqrt(8) below its middle, -1.
    """
    status, report = told(tmp_path, pocketed_block(), pitch=4)
    (finding,) = left(report)
    assert status == 1 and finding["counts"] and finding["amount"] == report["left"]["reachable_mm2"]
    assert report["left"]["worst_mm"] == pytest.approx(1 + math.sqrt(8), abs=0.2) and finding["y"] == pytest.approx(
        9, abs=0.2
    )
    assert "angle_deg = 90" in finding["text"]
    # along the wall, from where metal is higher than the ridges of 4 mm to the foot of its ball
    bounds = (
        1.2 * 20,
        3.0 * 20,
    )
    assert bounds[0] < report["left"]["reachable_mm2"] < bounds[1]


def test_passes_along_the_walls_leave_nothing_and_corners_are_out_of_reach(tmp_path: Path) -> None:
    """Passes at 10.01 and 19.99 come to both walls; what is left in corners and at the foot of walls no ball of its
    size cuts.
    """
    status, report = told(tmp_path, pocketed_block(), pitch=1.996, passes="through = [0, 10.01]")
    assert (status, left(report)) == (0, []) and report["left"]["places"] == 0


def test_a_pass_that_is_left_out_is_found(tmp_path: Path) -> None:
    """Two strips of passes with a gap of 8 mm between: metal of the stock's height stays there."""
    shape = '{ kind = "plane", corner = [0, 0, 0], along = [40, 0, 0], across = [0, 30, 0] }'
    given = "[{ rectangle = [0, 0, 40, 8] }, { rectangle = [0, 22, 40, 30] }]"
    _, whole = told(tmp_path, shape=shape, pitch=1, stock="box = [0, 0, -5, 40, 30, 2]")
    status, report = told(
        tmp_path, shape=shape, pitch=1, stock="box = [0, 0, -5, 40, 30, 2]", passes=f"boundary = {given}"
    )
    assert left(whole) == [] and (status, left(report)) == (0, [])  # a boundary says what is not asked for
    status, report = told(tmp_path, shape=shape, pitch=7, stock="box = [0, 0, -5, 40, 30, 2]")
    (finding,) = left(report)
    assert status == 1 and report["left"]["worst_mm"] == pytest.approx(2, abs=1e-6) and finding["x"] is not None


def test_stock_to_leave_is_not_left(tmp_path: Path) -> None:
    status, report = told(tmp_path, pocketed_block(), pitch=1.797, passes="stock_to_leave = 0.5\nthrough = [0, 10.51]")
    assert (status, left(report)) == (0, [])
    shape = '{ kind = "plane", corner = [0, -2, 0], along = [30, 0, 0], across = [0, 24, 18] }'
    status, report = told(
        tmp_path, shape=shape, pitch=1, stock="box = [0, 0, -5, 30, 20, 18.5]", passes="stock_to_leave = 0.5"
    )
    assert left(report) == [] and status == 0


def dome(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    square = 144.0 - x**2 - y**2
    return np.where(square >= 0, np.sqrt(np.maximum(square, 0.0)), -50.0)


def wave(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    return np.where((x >= 0) & (x <= 40) & (y >= 0) & (y <= 20), 4 * np.sin(2 * np.pi * y / 20) - 6, -50.0)


def cone(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    far = np.hypot(x, y)
    return np.where(far <= 12, 12 - far, -50.0)


def pyramid(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    far = np.maximum(np.abs(x), np.abs(y))
    return np.where(far <= 12, 1.5 * (12 - far), -50.0)


def lying(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    return np.where((np.abs(y) <= 8) & (x >= 0) & (x <= 30), np.sqrt(np.maximum(64 - y**2, 0.0)), -50.0)


def meshed(surface: Surface, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Return triangles (n, 3, 3) between places of a surface."""
    px, py = np.meshgrid(x, y)
    grid = np.stack([px, py, surface(px, py)], axis=-1)
    a, b, c, d = (part.reshape(-1, 3) for part in (grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1]))
    return np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])


def faces(*base: tuple[float, float], top: float) -> np.ndarray:
    """Return the faces (n, 3, 3) of a pyramid over (0, 0)."""
    return np.array([[(*a, 0.0), (*b, 0.0), (0.0, 0.0, top)] for a, b in zip(base, base[1:] + base[:1], strict=True)])


Scene = tuple[Surface, str | Callable[[], np.ndarray], tuple[float, ...], str]
SCENES: dict[str, Scene] = {
    "dome": (dome, DOME, (-12, -12, 0, 12, 12, 12), ""),
    "dome without its foot": (dome, DOME, (-12, -12, 0, 12, 12, 12), "overrun = 0"),
    "wave": (wave, lambda: meshed(wave, np.array([0.0, 40.0]), np.linspace(0, 20, 401)), (0, 0, -15, 40, 20, 0), ""),
    "cone": (
        cone,
        '{ kind = "cone", start = [0, 0, 0], end = [0, 0, 12], start_radius = 12, end_radius = 0 }',
        (-12, -12, 0, 12, 12, 12),
        "",
    ),
    "pyramid": (
        pyramid,
        lambda: faces((-12, -12), (12, -12), (12, 12), (-12, 12), top=18),
        (-12, -12, 0, 12, 12, 18),
        "",
    ),
    "lying cylinder": (
        lying,
        '{ kind = "cylinder", start = [0, 0, 0], end = [30, 0, 0], radius = 8 }',
        (0, -8, 0, 30, 8, 8),
        "",
    ),
}
PITCH = 0.15
"""Of the oracle, mm."""


@dataclass(frozen=True)
class Measured:
    """By the oracle: how high metal stands over reach, how high reach is over the part, and how much a mm square to
    reach is upright.
    """

    report: dict[str, Any]
    over: np.ndarray
    lifted: np.ndarray
    upright: np.ndarray

    def area(self, which: np.ndarray) -> float:
        return float(np.count_nonzero(which)) * PITCH**2


def measured(folder: Path, name: str, pitch: float) -> Measured:
    """Return what the oracle says of a scene's program, beside the report."""
    surface, made, box, passes = SCENES[name]
    given = {"shape": made} if isinstance(made, str) else {"shape": MESH}
    triangles = None if isinstance(made, str) else made()
    _, report = told(folder, triangles, pitch=pitch, stock=f"box = {list(box)}", passes=passes, **given)
    window = Window(box[0], box[1], box[3], box[4], PITCH)
    heights = cut((folder / "s.ngc").read_bytes(), RADIUS, window, box[5])
    low, x, y = reach(surface, RADIUS, window, box[2]), *window.places()
    slope = np.hypot(*np.gradient(low, PITCH))
    on = surface(x, y) > -49
    return Measured(
        report, *(np.where(on, each, 0.0) for each in (heights - low, low - surface(x, y))), np.hypot(1.0, slope)
    )


@pytest.mark.exhaustive
@pytest.mark.parametrize("pitch", [1.0, 3.0])
@pytest.mark.parametrize("name", SCENES)
def test_what_is_left_agrees_with_an_independent_closing(tmp_path: Path, name: str, pitch: float) -> None:
    """The area lies between that of what stands clearly too high and that of what stands over the ridges of a flat at
    all.

    Clearly: by more than twice those ridges, or a tenth of the radius, and half as much again. Both count cells; 4 mm2
    of rims are free.
    """
    of = measured(tmp_path, name, pitch)
    square = of.over / of.upright
    clear = 1.5 * max(2 * flat_ridge(pitch), 0.1 * RADIUS)
    least, most = (of.area(square > height) for height in (clear, 0.8 * flat_ridge(pitch)))
    found = of.report["left"]["reachable_mm2"]
    assert 0.6 * least - 4 <= found <= 1.1 * most + 2
    if found:
        assert of.report["left"]["worst_mm"] == pytest.approx(of.over.max(), abs=0.1)


@pytest.mark.exhaustive
@pytest.mark.parametrize("name", SCENES)
def test_what_cut_says_is_within_reach_agrees_with_an_independent_closing(tmp_path: Path, name: str) -> None:
    """What stands over the part, within reach or not, and higher than 0.01 and the chords, is left; where reach is over
    it, that is why.

    Between 0.005 and 0.045 mm, square to the part, either is right: cells, chords, and the rim of each ridge.
    """
    of = measured(tmp_path, name, 1.0)
    report = tmp_path / "cut.json"
    main(
        [
            "cut",
            str(tmp_path / "s.ngc"),
            "--against",
            str(tmp_path / "s.toml"),
            "--report",
            str(report),
            "--grid",
            "256",
            "--quiet",
        ]
    )
    said = json.loads(report.read_text())["left"]
    standing = (of.over + of.lifted) / of.upright
    beyond = of.area((of.lifted > 0.01) & (standing > 0.005))
    least, most = (of.area(standing > height) for height in (0.045, 0.005))
    assert said["unreachable_mm2"] <= 1.1 * beyond + 4
    assert 0.9 * (least - beyond) - 4 <= said["reachable_mm2"] <= 1.1 * most + 4


def valley(bottom: float) -> np.ndarray:
    """Triangles of two planes of 60 degrees, wider than a stock of 20 mm, that meet at y = bottom, at height -20."""

    def height(_: np.ndarray, y: np.ndarray) -> np.ndarray:
        return math.sqrt(3.0) * np.abs(y - bottom) - 20

    return meshed(height, np.array([-8.0, 28.0]), np.array([-8.0, bottom, 28.0]))


@pytest.mark.parametrize("leave", [0.0, 0.5])
@pytest.mark.parametrize(("degrees", "missed"), [(3, 0.084), (90, 0.0)])
def test_what_passes_nearly_along_a_valley_miss_of_its_bottom_is_left(
    tmp_path: Path, degrees: int, missed: float, leave: float
) -> None:
    """Ridges of 0.002 mm are asked for: on sides of 60 degrees passes lie 0.1095 mm apart.

    The ball touches both sides at one place across, its centre 2 R over the bottom. A pass d beside it stands
    d tan 60 higher, and leaves that much of the bottom. Passes at 3 degrees cross the bottom every 2.1 mm: between two
    crossings they are d = 0.0547 mm off, where the ball on its way down the valley takes a little of the 0.095 mm.
    Passes across miss nothing. Stock to leave lifts all of it by twice as much, and changes nothing else.
    """
    _, report = told(
        tmp_path,
        valley(10.03),
        apart="scallop",
        pitch=0.002,
        stock="box = [0, 0, -22, 20, 20, -2]",
        passes=f"angle_deg = {degrees}\nstock_to_leave = {leave}",
    )
    found = report["left"]
    assert bool(left(report)) == bool(missed)
    assert found["worst_mm"] == pytest.approx(missed, abs=0.025)
    # all of the foot, 5.2 mm wide, but round the places where passes cross: 50 mm2 by the closed form
    assert (20.0 if missed else 0.0) <= found["reachable_mm2"] <= 58.0 * bool(missed)


def test_cut_tells_metal_in_a_valley_that_stands_over_what_the_tool_leaves_at_best(tmp_path: Path) -> None:
    """Where the ball does not get down to the sides, within 2.6 mm of the bottom, it is still to cut as low as it can.

    Passes 3 mm apart at 3 degrees cross the bottom every 57 mm, so here once; 1.2 mm beside it they leave
    1.2 tan 60 = 2.1 mm of it.
    """
    passes, stock = "angle_deg = 3", "box = [0, 0, -22, 20, 20, -2]"
    told(tmp_path, valley(10.03), pitch=3, stock=stock, passes=passes)
    report = tmp_path / "cut.json"
    given = [str(tmp_path / "s.ngc"), "--against", str(tmp_path / "s.toml"), "--report", str(report)]
    main(["cut", *given, "--grid", "200", "--window", "0,9,20,11", "--quiet"])
    found = json.loads(report.read_text())
    assert found["left"]["reachable_mm2"] + found["left"]["unreachable_mm2"] == pytest.approx(40.0)
    assert 30.0 < found["left"]["reachable_mm2"] < 38.0
    assert found["worst"][0]["kind"] == "left" and found["worst"][0]["depth_mm"] == pytest.approx(2.1, abs=0.2)
