"""Hand-made faults in a good program are found, placed and sized; a bound that is said to hold does."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from app.core.resources import resource
from app.gcode.interpreter.options import ReadOptions
from app.gcode.interpreter.reader import read_program
from app.model.finding import FindingKind
from app.model.motion_path import anchored
from app.model.stock_box import StockBox
from app.model.tool import Tool
from app.model.tool_kind import ToolKind
from app.simulation.field.solid import SolidStock
from app.simulation.field.workpiece import BoxStock
from app.usecases.cutting.cut import CutOptions, CutProgram, CutSetup, cut
from app.usecases.job.options import MakeOptions
from app.usecases.making.make import MakeResult, make
from app.verify.judgement import SpotKind
from app.verify.parts import SolidPart
from tests.simulation.test_target import box

AS_USUAL = CutOptions()
ISLAND = "X24.0000\nG2 X22.6584 Y20.6708"
"""The island's lower side, cut along Y 18.5 towards -X; the wall is at Y 20."""


@cache
def made() -> MakeResult:
    return make("fig2.dxf", resource("samples", "fig2.dxf").read_bytes(), MakeOptions())


def again(old: str = "", new: str = "", options: CutOptions = AS_USUAL) -> CutProgram:
    """The sample's program with some words changed, cut once more and judged anew."""
    result, text = made().cut, made().nc.text
    assert result is not None and old in text
    return cut(replace(result.setup, programs=(program(text.replace(old, new, 1)),)), options)


def program(text: str):  # type: ignore[no-untyped-def]  # what the reader gives
    read = read_program(text.encode(), ReadOptions())
    assert read.error is None
    return replace(read, motions=anchored(read.motions))


def line_of(text: str, words: str) -> int:
    return text[: text.index(words)].count("\n") + 1


def kinds(result: CutProgram) -> set[FindingKind]:
    return {finding.kind for finding in result.findings if finding.counts}


def test_the_program_as_it_is() -> None:
    result = again()
    assert kinds(result) == set() and result.judgement is not None and result.judgement.clean
    assert result.judgement.gouge.max_mm < 0.001
    assert result.judgement.unreachable_mm2 == pytest.approx(made().coverage.unreachable_mm2, abs=0.01)
    spots = [spot for spot in result.judgement.spots if spot.kind is SpotKind.UNREACHABLE]
    assert len(spots) == len(made().coverage.places) and max(spot.depth_mm for spot in spots) == 2.0
    assert sum(band.area_mm2 for band in result.judgement.bands) == pytest.approx(made().coverage.area_mm2, rel=2e-3)


@pytest.mark.parametrize("cells", [256, 1024])
def test_a_gouge_of_a_twentieth(cells: int) -> None:
    result = again(ISLAND, "X40.0000 Y18.5500\nX30.0000\nX24.0000 Y18.5\nG2 X22.6584 Y20.6708", CutOptions(cells))
    judgement = result.judgement
    assert judgement is not None and kinds(result) == {FindingKind.GOUGE}
    assert judgement.gouge.max_mm == pytest.approx(0.05, abs=1e-4)
    assert judgement.gouge.x is not None and 30 <= judgement.gouge.x <= 40 and judgement.gouge.y == pytest.approx(18.55)
    text = made().nc.text
    finding = next(finding for finding in result.findings if finding.kind is FindingKind.GOUGE)
    assert "0.0500 mm" in finding.text and finding.line is not None
    assert line_of(text, ISLAND) <= finding.line <= line_of(text, ISLAND) + 1


def test_a_cut_below_the_floor() -> None:
    result = again("G1 X55.5012 Y36.5261 F600", "G1 X55.5012 Y36.5261 Z-2.03 F600")
    assert result.judgement is not None and kinds(result) == {FindingKind.GOUGE}
    assert result.judgement.gouge.max_mm == pytest.approx(0.03, abs=1e-4)


def test_a_strip_that_is_left() -> None:
    result = again(ISLAND, "X40.0000 Y18.4500\nX30.0000\nX24.0000 Y18.5\nG2 X22.6584 Y20.6708")
    assert result.judgement is not None and kinds(result) == {FindingKind.LEFT_REACHABLE}
    spot = next(spot for spot in result.judgement.spots if spot.kind is SpotKind.LEFT)
    assert result.judgement.reachable_mm2 == pytest.approx(0.05 * (10 + 8 / 2 + 6 / 2), abs=0.03)
    assert (spot.y, spot.disc_mm) == (pytest.approx(19.975, abs=0.005), pytest.approx(0.05, abs=0.002))
    assert 30 < spot.x < 40 and spot.depth_mm == pytest.approx(2.0)


def test_a_pass_that_is_missing_is_left_at_its_height() -> None:
    text = made().nc.text
    first = text.index("G3 X89.2500 Y93.0933")
    result = again(text[first : text.index("G0", first)], "")
    assert result.judgement is not None and kinds(result) == {FindingKind.LEFT_REACHABLE}
    assert result.judgement.reachable_mm2 == pytest.approx(np.pi * (12**2 - 10.5**2) - 6.0, abs=6.0)
    spot = next(spot for spot in result.judgement.spots if spot.kind is SpotKind.LEFT)
    assert (spot.depth_mm, spot.disc_mm) == (pytest.approx(2.0), pytest.approx(1.5, abs=0.01))


def test_a_rapid_through_metal() -> None:
    result = again("M5\n(T2 flat", "G0 Z-1\nX70\nZ5\nM5\n(T2 flat")
    hits = [finding for finding in result.findings if finding.kind is FindingKind.RAPID_IN_MATERIAL]
    assert {finding.line for finding in hits} >= {line_of(made().nc.text, "M5\n(T2 flat") + 1}
    assert hits[0].amount == pytest.approx(1.0, abs=1e-4)


def test_beside_the_stock_nothing_is_cut() -> None:
    assert kinds(again("M5\n(T2 flat", "G0 X120 Y120\nZ-1\nX130\nZ5\nM5\n(T2 flat")) == set()
    assert FindingKind.GOUGE in kinds(again("M5\n(T2 flat", "G0 X98 Y98\nG1 Z-1 F100\nX99\nG0 Z5\nM5\n(T2 flat"))
    through = again("M5\n(T2 flat", "G0 X84 Y84\nG1 Z-1 F100\nY40\nX140\nG0 Z5\nM5\n(T2 flat").judgement
    assert through is not None and through.gouge.x is not None and through.gouge.x <= 96


def test_a_start_in_the_metal_is_told_and_cuts_no_way_to_it() -> None:
    text = "G21 G90 G94\nT1 M6\nS1000 M3\nG1 X80 Y84 Z-1 F500\nX85\nG0 Z5\nM2\n"
    setup = made().cut
    assert setup is not None
    result = cut(replace(setup.setup, programs=(program(text),)))
    finding = next(finding for finding in result.findings if finding.kind is FindingKind.START_IN_STOCK)
    assert (finding.x, finding.y, finding.line, finding.amount) == (80.0, 84.0, 4, pytest.approx(1.0))
    assert FindingKind.GOUGE not in kinds(result)
    cells = result.cut.heights < 0
    xs = result.cut.before.grid.xs()[cells.any(axis=0)]
    assert xs.min() > 76.9 and xs.max() < 88.1


def test_where_nobody_knows_nothing_is_cut() -> None:
    text = "G21 G90 G94\nT1 M6\nS1000 M3\nG0 Z5\nG0 X84 Y84\nG1 Z-1 F100\nG53 G0 Z0\nG0 X10 Y10\nG1 X30 F500\nM2\n"
    setup = made().cut
    assert setup is not None
    result = cut(replace(setup.setup, programs=(program(text),)))
    assert not result.cut.rapids
    cells = result.cut.heights < 0
    assert np.count_nonzero(cells) * result.cut.before.grid.pitch**2 == pytest.approx(np.pi * 9, rel=0.01)


@pytest.mark.parametrize(("flutes", "drilled", "told"), [(4, False, True), (2, False, False), (4, True, False)])
def test_a_plunge_of_a_mill_that_does_not_cut_at_its_centre(flutes: int, drilled: bool, told: bool) -> None:
    drill = "T2 M6\nS1 M3\nG0 Z5\nX50 Y50\nG1 Z-3 F100\nG0 Z5\n" if drilled else ""
    text = f"G21 G90 G94\n{drill}T1 M6\nS1000 M3\nG0 Z5\nX50 Y50\nG1 Z-2 F100\nX60\nG0 Z5\nM2\n"
    tools = {1: Tool(1, 6.0, flutes=flutes), 2: Tool(2, 3.0)}
    result = cut(CutSetup((program(text),), tools, BoxStock(StockBox(0, 0, -10, 100, 100, 0))), CutOptions(512))
    plunges = [finding for finding in result.findings if finding.kind is FindingKind.PLUNGE]
    assert bool(plunges) is told
    if told:
        assert (plunges[0].line, plunges[0].x, plunges[0].amount) == (6, pytest.approx(50), pytest.approx(2.0))


def test_the_table() -> None:
    text = "G21 G90 G94\nT1 M6\nS1000 M3\nG0 Z5\nX50 Y50\nG1 Z-10.2 F100\nX60\nG0 Z5\nM2\n"
    result = cut(
        CutSetup((program(text),), {1: Tool(1, 6.0)}, BoxStock(StockBox(0, 0, -10, 100, 100, 0))), CutOptions(256)
    )
    finding = next(finding for finding in result.findings if finding.kind is FindingKind.BELOW_TABLE)
    assert (finding.line, finding.amount) == (6, pytest.approx(0.2))


def solid_setup(text: str, tool: Tool, solid: SolidStock, leave: float = 0.0) -> CutSetup:
    return CutSetup((program(text),), {1: tool}, BoxStock(StockBox(0, 0, -10, 40, 20, 0)), SolidPart(solid, leave))


STEP = SolidStock(np.concatenate([box((0, 0, -10), (40, 20, -4)), box((0, 0, -4), (20, 20, 0))]))
"""A step of 4 mm at X 20."""


def facing(wall: float, floor: float) -> str:
    lanes = "".join(f"G0 Z5\nX{wall:.4f} Y{y}\nG1 Z{floor} F100\nX45\n" for y in np.arange(-2, 22.1, 2.0))
    return f"G21 G90 G94\nT1 M6\nS1000 M3\nG0 Z5\n{lanes}G0 Z5\nX{wall:.4f} Y-5\nG1 Z{floor}\nY25\nG0 Z5\nM2\n"


def test_a_solid_cut_as_it_is() -> None:
    result = cut(solid_setup(facing(22.0, -4.0), Tool(1, 4.0), STEP), CutOptions(512))
    assert result.judgement is not None and result.judgement.clean, result.findings
    assert kinds(result) == set()


def test_a_gouge_in_the_floor_of_a_solid() -> None:
    result = cut(solid_setup(facing(22.0, -4.05), Tool(1, 4.0), STEP), CutOptions(512))
    assert result.judgement is not None
    assert result.judgement.gouge.max_mm == pytest.approx(0.05, abs=1e-3)


@pytest.mark.parametrize("cells", [100, 1024])
@pytest.mark.parametrize("deep", [0.02, 0.05, 0.2])
def test_a_gouge_in_the_wall_of_a_solid_is_sized_sideways_however_wide_the_cells_are(deep: float, cells: int) -> None:
    result = cut(solid_setup(facing(22.0 - deep, -4.0), Tool(1, 4.0), STEP), CutOptions(cells))
    assert result.judgement is not None and FindingKind.GOUGE in kinds(result)
    assert result.judgement.gouge.max_mm == pytest.approx(deep, abs=1e-3)
    assert result.judgement.gouge.x == pytest.approx(20 - deep, abs=1e-3)
    assert result.judgement.certificate is not None and result.judgement.certificate.gouge_mm >= deep


def test_metal_left_on_a_solid_within_reach_and_beyond() -> None:
    result = cut(solid_setup(facing(24.0, -4.0), Tool(1, 4.0), STEP), CutOptions(512))
    assert result.judgement is not None and kinds(result) == {FindingKind.LEFT_REACHABLE}
    assert result.judgement.reachable_mm2 + result.judgement.unreachable_mm2 == pytest.approx(2.0 * 20, abs=4.0)
    assert result.judgement.reachable_mm2 > 35
    ball = cut(solid_setup(facing(22.0, -4.0), Tool(1, 4.0, ToolKind.BALL), STEP), CutOptions(512))
    assert ball.judgement is not None
    assert [spot for spot in ball.judgement.spots if spot.kind is SpotKind.UNREACHABLE]  # the foot of the wall


def test_stock_to_leave_is_taken_off() -> None:
    result = cut(solid_setup(facing(22.3, -3.7), Tool(1, 4.0), STEP, leave=0.3), CutOptions(512))
    assert result.judgement is not None and not [s for s in result.judgement.spots if s.kind is SpotKind.GOUGE]
    closer = cut(solid_setup(facing(22.3, -3.8), Tool(1, 4.0), STEP, leave=0.3), CutOptions(512))
    assert closer.judgement is not None and closer.judgement.gouge.max_mm == pytest.approx(0.1, abs=0.02)


@pytest.mark.parametrize("shift", [0.0, 0.07, 0.2])
@pytest.mark.parametrize("kind", [ToolKind.FLAT, ToolKind.BALL], ids=lambda kind: kind.value)
def test_the_certificate_holds_on_a_grid_eight_times_as_fine(shift: float, kind: ToolKind) -> None:
    rng = np.random.default_rng(int(100 * shift))
    lanes = "".join(
        f"G1 X{x:.3f} Y{y:.3f} Z{z:.3f} F500\n" for x, y, z in rng.uniform((21 - shift, 0, -4.2), (40, 20, -1), (60, 3))
    )
    text = f"G21 G90 G94\nT1 M6\nS1000 M3\nG0 Z5\nX30 Y10\n{lanes}G0 Z5\nM2\n"
    setup = solid_setup(text, Tool(1, 4.0, kind), STEP)
    coarse = cut(setup, CutOptions(100))
    assert coarse.judgement is not None and coarse.judgement.certificate is not None
    fine = cut(replace(setup, part=None), CutOptions(800)).cut
    xs, ys = np.meshgrid(fine.before.grid.xs(), fine.before.grid.ys())
    # way out of the part: up to the floor right of the step; left of it sideways or up
    down = np.maximum(-4.0 - fine.heights, 0)
    inside = np.where(xs >= 20, np.where(down > 0, down, 0.0), np.minimum(20 - xs + 0 * ys, 0.0 - fine.heights))
    inside[xs < 20] = np.where(fine.heights[xs < 20] < -4, np.hypot(20 - xs[xs < 20], down[xs < 20]), inside[xs < 20])
    deepest = float(np.max(np.where(fine.heights < fine.before.heights, inside, 0.0)))
    assert deepest <= coarse.judgement.certificate.gouge_mm
    assert coarse.judgement.certificate.gouge_mm <= deepest + 3 * coarse.judgement.certificate.pitch_mm
