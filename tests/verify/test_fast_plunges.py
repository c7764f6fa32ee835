"""Descents into metal at the feed for going sideways are told with block, place and depth; nothing else is."""

import re
from dataclasses import replace
from pathlib import Path

import pytest

from app.cli.main import main
from app.gcode.interpreter.program import HeaderNote
from app.model.finding import Finding, FindingKind
from app.model.stock_box import StockBox
from app.model.tool import Tool
from app.model.tool_kind import ToolKind
from app.simulation.field.workpiece import BoxStock
from app.usecases.cutting.cut import CutOptions, CutSetup, cut
from app.verify import plunges
from tests.surfaces.solids import pocketed_block, stl
from tests.verify.test_judge import program

BALL = Tool(1, 6.0, ToolKind.BALL)
BEGIN = "G21 G90 G94\nT1 M6\nS12000 M3\nG0 Z5\nX10 Y10\n"
SLOWLY = "G1 Z-0.5 F300\n"
SLOT = "X20 F900\n"


def told(body: str, tool: Tool = BALL, rate: float | None = None, cells: int = 300) -> list[Finding]:
    read = program(f"{BEGIN}{body}G0 Z5\nM2\n")
    if rate is not None:
        read = replace(read, header=HeaderNote(plunge_rates=((1, rate),)))
    setup = CutSetup((read,), {1: tool}, BoxStock(StockBox(0, 0, -10, 40, 30, 0)))
    return [finding for finding in cut(setup, CutOptions(cells)).findings if finding.kind is FindingKind.FEED]


def test_a_descent_as_fast_as_a_slot_is_told_where_the_program_plunges_more_slowly() -> None:
    """The ball has left the slot's round bottom: at a quarter of its radius from the axis it is 3 - sqrt(9 - 0.75²)
    higher.
    """
    (found,) = told(f"{SLOWLY}{SLOT}Z-6\nX30\n")
    assert found.counts and found.line == 8 and (found.x, found.y) == (20.0, 10.0)
    assert found.amount == pytest.approx(5.5 + 3 - (9 - 0.75**2) ** 0.5, abs=0.01)
    assert "900 mm/min" in found.text and "plunge rate is 300 mm/min" in found.text and "slow it down" in found.text
    assert [each.line for each in told(f"{SLOWLY}{SLOT}Z-6\nX30\n", cells=60)] == [8]  # the pin is narrower than a cell


def test_the_header_s_rate_counts_for_more_than_the_program_s_own() -> None:
    assert told(f"{SLOWLY}{SLOT}Z-6\nX30\n", rate=900) == []
    (found,) = told(f"{SLOWLY}{SLOT}Z-6\nX30\n", rate=200)
    assert "plunge rate is 200 mm/min" in found.text
    (first,) = told("G1 Z-4 F900\nX20\n", rate=300)  # that is all there is, so the program itself tells of no rate
    assert first.counts and first.amount == pytest.approx(4.0) and (first.x, first.y) == (10.0, 10.0)


def test_a_steep_way_to_the_side_is_held_by_how_fast_it_goes_down() -> None:
    """Three down for one sideways: of 315 mm/min 299 go down, of 325 mm/min 308."""
    assert told(f"{SLOWLY}{SLOT}X22 Z-6.5 F315\nX30 F900\n") == []
    (found,) = told(f"{SLOWLY}{SLOT}X22 Z-6.5 F325\nX30 F900\n")
    assert "straight down into metal at 308 mm/min" in found.text


@pytest.mark.parametrize(
    "body",
    [
        f"{SLOWLY}{SLOT}Z-6 F300\nX30 F900\n",  # as slowly as the first
        f"{SLOWLY}{SLOT}Z-1.4\nX30\n",  # less than a quarter of the diameter
        f"{SLOWLY}{SLOT}X26 Z-6\nX10\n",  # a ramp
        f"{SLOWLY}{SLOT}G2 X20 Y10 Z-6 I-3 J0 F900\nG1 X30\n",  # a helix
        f"{SLOWLY}{SLOT}Z-6 F300\nX22 F900\nG0 Z5\nX20\nG1 Z-6\n",  # down where it has been
        f"{SLOWLY}{SLOT}G0 Z5\nX60\nG1 Z-6\n",  # beside the stock
    ],
    ids=["slow", "shallow", "ramp", "helix", "cleared", "beside"],
)
def test_other_descents_are_not_told(body: str) -> None:
    assert told(body) == []


def test_a_program_with_one_feed_is_told_of_what_is_deep_and_that_does_not_count() -> None:
    (found,) = told("G1 Z-7 F200\nX20\n")
    assert not found.counts and found.amount == pytest.approx(7.0) and "fast it cuts sideways, too" in found.text
    assert told("G1 Z-5 F200\nX20\n") == []
    assert told("G1 Z-7 F200\nG0 Z5\nX20\nG1 Z-7\n") == []  # nothing is cut sideways, so nothing says what that is
    assert told("G1 Z-7 F200\nX20\n", tool=Tool(1, 6.0, ToolKind.DRILL)) == []


def test_descents_are_counted_by_tool_and_the_deepest_is_told() -> None:
    body = f"{SLOWLY}{SLOT}Z-3\nG0 Z5\nX30\nG1 Z-8\nG0 Z5\nY20\nG1 Z-4\nX20\n"
    (found,) = told(body)
    assert (found.line, found.x, found.y, found.amount) == (11, 30.0, 10.0, pytest.approx(8.0, abs=0.01))
    assert "the deepest of 3 such descents" in found.text


@pytest.mark.parametrize("few", [0, 10**6], ids=["together", "one by one"])
def test_ways_between_the_cells_are_looked_at_closer_together_or_one_by_one(
    few: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Six descents, the last but one over a place that is cut by then and the last before that place is cut deeper."""
    monkeypatch.setattr(plunges, "FEW", few)
    places = [f"G0 Z5\nX{6 * k + 3} Y{4 * k + 4}\nG1 Z-{2 + k}\n" for k in range(5)]
    again = "G0 Z5\nX3 Y4\nG1 Z-2\nG0 Z5\nX35 Y25\nG1 Z-9\nZ-9.5 F300\n"
    body = f"{SLOWLY}{SLOT}{''.join(places)}{again}"
    (found,) = told(body, tool=Tool(1, 1.0), cells=12)
    assert "the deepest of 6 such descents" in found.text
    assert (found.x, found.y, found.amount) == (35.0, 25.0, pytest.approx(9.0, abs=1e-6))


def test_descents_that_were_not_looked_at_to_the_end_are_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    """One of the five lies on a cell's centre and is seen at once, two are looked at closer, two are not."""
    monkeypatch.setattr(plunges, "FEW", 10**6)
    monkeypatch.setattr(plunges, "MOST", 2)
    places = "".join(f"G0 Z5\nX{6 * k + 3} Y{4 * k + 4}\nG1 Z-{2 + k} F900\n" for k in range(5))
    setup = CutSetup(
        (program(f"{BEGIN}{SLOWLY}{SLOT}{places}G0 Z5\nM2\n"),),
        {1: Tool(1, 1.0)},
        BoxStock(StockBox(0, 0, -10, 40, 30, 0)),
    )
    said = [each for each in cut(setup, CutOptions(12)).findings if "fast ways down" in each.text]
    assert [(each.amount, each.counts) for each in said] == [(2.0, False)]


@pytest.mark.parametrize(("aside", "seen"), [(0.0002, True), (0.009, True), (0.5, False)])
def test_a_descent_by_way_of_tiny_steps_is_one(aside: float, seen: bool) -> None:
    """Each half goes through less metal than tells of a plunge, both together through more."""
    halves = f"G0 Z5\nX30 Y20 Z0\nG1 Z-1.2 F900\nX{30 + aside}\nZ-2.4\nG0 Z5\n"
    found = told(f"{SLOWLY}{SLOT}{halves}")
    assert bool(found) is seen
    if seen:
        assert found[0].amount == pytest.approx(2.4, abs=1e-6)


SCENE = """
name = "part"
stock = { box = [-1, -1, -10, 41, 31, 1] }
tool = [{ number = 1, kind = "ball", diameter = 6.0, feed_rate = 900, plunge_rate = 300 }]
surface = [{ name = "part", shape = { kind = "mesh", file = "part.stl" } }]
passes = [{ tool = 1, pitch = 4 }]
"""


def test_programs_of_our_own_are_clean_and_faster_ones_are_not(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "part.stl").write_bytes(stl(pocketed_block()))
    (tmp_path / "s.toml").write_text(SCENE)
    # a wall between two passes
    assert main(["surface", str(tmp_path / "s.toml"), "-o", str(tmp_path / "s.ngc"), "--quiet"]) == 1
    text = (tmp_path / "s.ngc").read_text()
    assert "(hitofude: plunge_mm_min=1,300)" in text
    (tmp_path / "fast.ngc").write_text(re.sub(r"F300\b", "F900", text))
    capsys.readouterr()
    for name, status in (("s.ngc", 0), ("fast.ngc", 1)):
        assert main(["cut", str(tmp_path / name), "--grid", "256"]) == status
        assert ("its plunge rate is 300 mm/min" in capsys.readouterr().out) is bool(status)
