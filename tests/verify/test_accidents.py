"""What goes wrong on the way is found between the cells too, and what goes well is not told."""

from dataclasses import replace

import numpy as np
import pytest

from app.model.finding import Finding, FindingKind
from app.model.stock_box import StockBox
from app.model.tool import Tool
from app.model.tool_kind import ToolKind
from app.simulation.field.solid import SolidStock
from app.simulation.field.workpiece import BoxStock
from app.usecases.cutting.cut import CutOptions, CutProgram, CutSetup, cut
from app.verify import accidents, course, plunges
from app.verify.parts import SolidPart
from tests.simulation.test_target import box
from tests.verify.test_judge import program

PLATE = BoxStock(StockBox(0, 0, -5, 300, 300, 0))
THIN = Tool(1, 0.2)
ENGRAVER = Tool(1, 6.0, ToolKind.V, tip_angle=np.radians(30))
COARSE = CutOptions(cells=128)
BEGIN = "G21 G90 G94\nT1 M6\nS1000 M3\n"


def done(*bodies: str, tool: Tool = THIN, options: CutOptions = COARSE, begin: str = BEGIN) -> CutProgram:
    names = tuple(f"p{k}.ngc" for k in range(len(bodies)))
    texts = [f"{begin}{body}M2\n" for body in bodies]
    return cut(CutSetup(tuple(program(text) for text in texts), {1: tool}, PLATE, names=names), options)


def of(result: CutProgram, kind: FindingKind) -> list[Finding]:
    return [finding for finding in result.findings if finding.kind is kind]


def rapids(*bodies: str, tool: Tool = THIN) -> list[Finding]:
    return of(done(*bodies, tool=tool), FindingKind.RAPID_IN_MATERIAL)


@pytest.mark.parametrize("to", ["X290", "Y290", "X290 Y190", "X11 Y11"])
@pytest.mark.parametrize(("tool", "z"), [(THIN, -1.0), (ENGRAVER, -0.2)])
def test_rapids_of_cutters_narrower_than_a_cell_are_seen(to: str, tool: Tool, z: float) -> None:
    hits = rapids(f"G0 Z5\nX10 Y10.25\nG1 Z{z} F200\nG0 {to}\nG0 Z5\n", tool=tool)
    assert hits[0].line == 7
    assert 0.75 * -z <= (hits[0].amount or 0.0) <= -z
    assert hits[0].x is not None and 9.8 <= hits[0].x <= 290.2


@pytest.mark.parametrize("to", ["X290", "Y290", "X290 Y190"])
@pytest.mark.parametrize(("tool", "z"), [(THIN, -1.0), (ENGRAVER, -0.2)])
def test_rapids_through_slots_of_the_same_cutter_are_no_accidents(to: str, tool: Tool, z: float) -> None:
    slot = f"G0 Z5\nX10 Y10.25\nG1 Z{z} F200\nG1 {to}\n"
    assert not done(f"{slot}G0 X10 Y10.25\nG0 Z5\n", tool=tool).findings
    assert not done(f"{slot}G0 Z5\n", f"G0 Z5\nX10 Y10.25\nZ{z}\n{to}\nG0 Z5\n", tool=tool).findings


def test_metal_at_the_end_of_a_slot_is_met() -> None:
    slot = "G0 Z5\nX10 Y10.25\nG1 Z-1 F200\nG1 X280 Y190\n"
    hits = rapids(f"{slot}G0 X10 Y10.25\nG0 X280.54 Y190.36\nG0 Z5\n")
    assert (hits[0].line, hits[0].x) == (9, pytest.approx(280.3, abs=0.3))


def test_pecks_go_where_the_drill_was() -> None:
    pecks = "G0 Z5\nX10 Y10.25\nG1 Z-1 F200\nG0 Z1\nZ-0.9\nG1 Z-2\nG0 Z1\n{}\nG1 Z-3\nG0 Z5\n"
    assert not done(pecks.format("Z-1.9")).findings
    assert [hit.line for hit in rapids(pecks.format("Z-2.1"))] == [11]


def test_rapids_beyond_the_most_that_are_looked_at_are_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(accidents, "MOST", 1)
    monkeypatch.setattr(plunges, "MOST", 1)
    result = done("G0 Z5\nX10 Y10.25\nG1 Z-1 F200\nX20\nG0 X10\nX20\nX10\nZ5\n")
    assert [(finding.kind, finding.counts, finding.amount) for finding in result.findings] == [
        (FindingKind.TOLERANCE, False, 2.0)
    ]
    holes = "G0 Z5\nX10 Y10.25\nG1 Z-1 F200\nG0 Z5\nX20\nG1 Z-1\nG0 Z5\n"
    found = done(holes, tool=Tool(1, 0.2, flutes=4)).findings
    assert [(finding.kind, finding.amount) for finding in found] == [
        (FindingKind.PLUNGE, 1.0),
        (FindingKind.TOLERANCE, 1.0),
    ]


def test_long_ways_are_looked_at_in_pieces(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(course, "LOOKS", 4)
    assert [hit.line for hit in rapids("G0 Z5\nX10 Y10.25\nG1 Z-1 F200\nG0 X290 Y190\nG1 Z5\n")] == [7]


def test_a_narrow_cutter_that_starts_in_the_stock() -> None:
    (finding,) = of(done("G0 X10 Y10.25 Z-1\nG1 X20 F200\nG0 Z5\n"), FindingKind.START_IN_STOCK)
    assert (finding.line, finding.amount) == (4, pytest.approx(1.0))
    assert not of(done("G0 X10 Y10.25 Z0.1\nG1 X20 F200\nG0 Z5\n"), FindingKind.START_IN_STOCK)


def helix(radius: float, chords: bool) -> str:
    """Two turns down to Z-2 round X50 Y50, by arcs or by chords."""
    angle = np.linspace(0, 4 * np.pi, 97)
    places = np.column_stack([50 + radius * np.cos(angle), 50 + radius * np.sin(angle), -angle / (2 * np.pi)])
    lines = "".join(f"X{x:.4f} Y{y:.4f} Z{z:.4f}\n" for x, y, z in places)
    turns = f"G3 X{50 + radius} Y50 I-{radius} Z-1\nG3 X{50 + radius} Y50 I-{radius} Z-2\n"
    return f"G0 Z5\nX{50 + radius} Y50\nG1 Z0 F100\n{lines if chords else turns}G0 Z5\n"


DOWN = {
    "straight": ("X50 Y50\nG1 Z-2 F100\n", True),
    "slanted": ("X50 Y50\nG1 X50.3 Z-2 F100\n", True),
    "slanted from high": ("X50 Y50\nG1 X51 Z-2 F100\n", True),
    "narrow helix": (helix(0.5, chords=False), True),
    "narrow helix of chords": (helix(0.5, chords=True), True),
    "to and fro": ("X50 Y50\nG1 Z0 F100\n" + "X50.5 Z-0.1\nX50 Z-0.2\nX50.5 Z-0.3\nX50 Z-0.4\n", True),
    "then a ramp": ("X50 Y50\nG1 Z-1 F100\nX60 Z-2\n", True),
    "then a steep ramp": ("X50 Y50\nG1 Z-1 F100\nX54 Z-4\n", True),
    "narrow helix of half turns": ("X50.5 Y50\nG1 Z0 F100\nG3 X49.5 I-0.5 Z-0.4\nX50.5 I0.5 Z-0.8\n", True),
    "helix": (helix(2.0, chords=False), False),
    "helix of chords": (helix(2.0, chords=True), False),
    "ramp": ("X50 Y50\nG1 Z0 F100\nX70 Z-2\n", False),
    "short ramp": ("X50 Y50\nG1 Z0 F100\nX51 Z-0.1\nX60\n", False),
    "in air": ("X50 Y50\nG1 Z1 F100\nX60\n", False),
}


@pytest.mark.parametrize("way", DOWN)
@pytest.mark.parametrize("diameter", [6.0, 1.0])
def test_a_dead_centre_over_one_place(way: str, diameter: float) -> None:
    body, told = DOWN[way]
    small = diameter / 6.0
    begin = f"{BEGIN}G0 Z5\n"
    if small < 1:
        body = "\n".join(" ".join(_shrunk(word, small) for word in line.split()) for line in body.splitlines()) + "\n"
    found = of(done(body, tool=Tool(1, diameter, flutes=4), begin=begin), FindingKind.PLUNGE)
    assert bool(found) is told, found
    assert not of(done(body, tool=Tool(1, diameter, flutes=2), begin=begin), FindingKind.PLUNGE)


def _shrunk(word: str, by: float) -> str:
    """A word made smaller round X50 Y50 Z0."""
    letter, value = word[0], word[1:]
    if letter in "XY":
        return f"{letter}{50 + (float(value) - 50) * by:.5f}"
    return f"{letter}{float(value) * by:.5f}" if letter in "IJZ" else word


def test_how_deep_and_where_a_dead_centre_goes() -> None:
    (plunge,) = of(
        done("G0 Z5\nX50 Y50\nG1 X50.6 Z-1 F100\nX60\nG0 Z5\n", tool=Tool(1, 6.0, flutes=4)), FindingKind.PLUNGE
    )
    assert (plunge.line, plunge.x, plunge.amount) == (6, pytest.approx(50.6), pytest.approx(1.0))
    assert "sideways by only 0.050 mm" in plunge.text


HOME = "G0 Z5\nX50 Y50\nG1 Z-2 F100\nX80\n{}G53 G0 {}\n"


@pytest.mark.parametrize(
    ("before", "to", "told"),
    [
        ("", "X0 Y0", True),
        ("", "X0", True),
        ("", "X0 Y0 Z0", True),
        ("", "Z0\nG53 G0 X0 Y0", False),
        ("G0 Z1\n", "X0 Y0", False),
        ("X400\n", "X0 Y0", False),
        ("X-20\nX320\nX80\n", "X0", False),
        ("X-20\nX320\nX80\n", "Y0", True),
        ("Y-20\nY320\nY50\n", "Y0", False),
        ("Y-20\nY320\nY50\n", "X0", True),
    ],
)
def test_ways_out_of_the_metal_to_places_that_nobody_knows(before: str, to: str, told: bool) -> None:
    found = rapids(HOME.format(before, to), tool=Tool(1, 10.0))
    assert [finding.line for finding in found] == ([8 + before.count("\n")] if told else [])
    if told:
        assert found[0].amount == pytest.approx(2.0)


def test_ways_out_over_what_was_faced() -> None:
    assert not rapids("G0 Z5\nX150 Y150\nG1 Z-2 F100\nG53 G0 X0 Y0\n", tool=Tool(1, 500.0))
    (finding,) = rapids("G0 Z5\nX150 Y150\nG1 Z-2 F100\nZ-3 X130\nG53 G0 X0 Y0\n", tool=Tool(1, 400.0))
    assert (finding.line, finding.amount) == (8, pytest.approx(3.0))


@pytest.mark.parametrize(
    ("body", "line", "words", "count"),
    [
        ("G0 Z5\nG1 Z-1 F100\nX10\nG0 Z5\nX10 Y10\nG1 X20\n", 5, "X and Y are not known", 2),
        ("G1 X10 Y10 F100\nX20\nG0 Z5\n", 4, "Z is not known", 2),
        ("G0 Z5\nX50 Y50\nG53 G0 X0 Y0\nG1 Z-3 F100\nG0 Z5\nX0 Y0\n", 7, "X and Y are not known", 1),
    ],
)
def test_feed_where_nobody_knows_is_told(body: str, line: int, words: str, count: int) -> None:
    (finding,) = of(done(body), FindingKind.LEFT_OUT)
    assert (finding.counts, finding.line, finding.amount) == (True, line, count)
    assert f"NC line {line} cuts at a place that the program has not told" in finding.text and words in finding.text


@pytest.mark.parametrize(
    "body",
    [
        "G1 Z5 F500\nG1 X10 Y10\nZ-1\nG0 Z5\n",
        "G0 Z5\nX10 Y10\nG1 Z-1 F100\nG53 G1 Z0\n",
    ],
)
def test_feed_that_surely_meets_nothing_is_not_told(body: str) -> None:
    assert not of(done(body), FindingKind.LEFT_OUT)


def test_a_window_hides_no_accidents() -> None:
    body = "G0 Z5\nX10 Y10\nG1 Z-3 F100\nX20\nG0 X90\nZ5\n"
    whole = done(body, tool=Tool(1, 6.0))
    options = replace(COARSE, window=(8.0, 8.0, 12.0, 12.0))
    window = done(body, tool=Tool(1, 6.0), options=options)
    assert window.findings == whole.findings and window.cut.rapids == whole.cut.rapids and window.cut.rapids
    assert window.cut.before.grid.pitch == 4.0 / 128
    assert not done(body, tool=Tool(1, 6.0), options=replace(options, judge=False)).findings


def test_the_deepest_place_below_the_table_is_told_with_its_own_line() -> None:
    body = "G0 Z5\nX10 Y10\nG1 Z-5.1 F100\nX50 Y40\nZ-6\nG0 Z5\n"
    (finding,) = of(done(body), FindingKind.BELOW_TABLE)
    assert (finding.line, finding.x, finding.y, finding.amount) == (8, 50.0, 40.0, pytest.approx(1.0))
    assert "4 motions, the first in NC line 6, go below" in finding.text


def test_of_several_programs_the_one_is_named() -> None:
    good, bad = "G0 Z5\nX10 Y10\nG1 Z-1 F100\nG0 Z5\n", "G0 Z5\nX10 Y10\nG1 Z-1 F100\nG0 X90\nZ5\n"
    assert "NC line 7 of p1.ngc; do not run" in rapids(good, bad)[0].text
    assert "NC line 7 of p0.ngc; do not run" in rapids(bad, good)[0].text
    assert "NC line 7; do not run" in rapids(bad)[0].text


def test_a_gouge_of_several_programs_names_its_own() -> None:
    whole = SolidPart(SolidStock(box((0, 0, -5), (40, 20, 0))))
    texts = ("G0 Z5\nX10 Y10\nG1 Z-1 F100\nX11\nG0 Z5\n", "G0 Z5\nX30 Y10\nG1 Z-2 F100\nX31\nG0 Z5\n")
    programs = tuple(program(f"{BEGIN}{text}M2\n") for text in texts)
    setup = CutSetup(
        programs, {1: Tool(1, 6.0)}, BoxStock(StockBox(0, 0, -5, 40, 20, 0)), whole, ("first.ngc", "second.ngc")
    )
    (finding,) = of(cut(setup, COARSE), FindingKind.GOUGE)
    assert " of second.ngc; do not run" in finding.text
