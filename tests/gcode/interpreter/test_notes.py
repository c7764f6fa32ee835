"""Tools and stock out of comments: the habits of CAM systems and of people, text by text."""

import math
import time
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.gcode.interpreter.notes import notes
from app.gcode.interpreter.own_header import ProgramNotes
from app.gcode.interpreter.program import StockNote, ToolNote
from tests.conftest import ROOT
from tests.examples import examples

IN = 25.4
MM, INCH = "G21\nG0 X1\n", "G20\nG0 X1\n"


def tools(text: str, encoding: str = "utf-8") -> tuple[ToolNote, ...]:
    return notes(text.encode(encoding))[0]


def stock(text: str) -> StockNote | None:
    return notes(text.encode())[1]


@pytest.mark.parametrize(
    ("comment", "expected"),
    [
        ("(T1 D=6. CR=0. - ZMIN=-5. - flat end mill)", ToolNote(1, "flat", 6.0)),
        ("(T12 D=10. CR=0.5 - ZMIN=-5. - bullnose end mill)", ToolNote(12, "bull", 10.0, 0.5)),
        ("(T2 D=6. CR=3. - ZMIN=-1. - BALL END MILL - L=1.25/2.3917)", ToolNote(2, "ball", 6.0)),
        (
            "(T9  D=6. CR=0. TAPER=45deg - ZMIN=-1.3 - chamfer mill - 6mm Chamfer Mill)",
            ToolNote(9, "v", 6.0, 0.0, math.radians(90)),
        ),
        (
            "(T12  D=6.5 CR=0. TAPER=118deg - ZMIN=-14.9 - drill - Drill 118 Degree)",
            ToolNote(12, "drill", 6.5, 0.0, math.radians(118)),
        ),
        (
            "(T1  D=4. CR=0. TAPER=90deg - ZMIN=-1. - spot drill - 4mm Spot Drill)",
            ToolNote(1, "drill", 4.0, 0.0, math.radians(90)),
        ),
        (
            '(T8  Chamfering Bit - 1/8" Shank  D=3.175 CR=0. TAPER=45deg - chamfer mill)',
            ToolNote(8, "v", 3.175, 0.0, math.radians(90)),
        ),
        ("(T3 D=1. CR=0.032 - ZMIN=0.978 - face mill)", ToolNote(3, "bull", 1.0, 0.032)),
        ("(T3 D=8. CR=0. - ZMIN=0.2 - right hand tap)", ToolNote(3, "", 8.0)),
        ("(T1 D=3 CR=0 - ZMIN=-5 - Schaftfräser)", ToolNote(1, "flat", 3.0)),
        ("(TOOL 1 - 6MM BALL ENDMILL)", ToolNote(1, "ball", 6.0)),
        ("(TOOL 2 - 10MM BULL ENDMILL R1)", ToolNote(2, "bull", 10.0, 1.0)),
        ("(TOOL 2 - 10MM BULL NOSE CORNER RADIUS 2)", ToolNote(2, "bull", 10.0, 2.0)),
        ("( TOOL: T1 = 10.0 dia. ENDMILLM1000:REG )", ToolNote(1, "flat", 10.0)),
        ("(T1 | 1/4 in flat endmill)", ToolNote(1, "flat", 0.25 * IN)),
        ("; T1 | 1/4 in flat endmill", ToolNote(1, "flat", 0.25 * IN)),
        ("( T2 | 1/2 FLAT ENDMILL | H2 )", ToolNote(2, "flat", 0.5 * IN)),
        ("(T4 = End Mill {.75 inches})", ToolNote(4, "flat", 0.75 * IN)),
        ('(T4 = End Mill {1/4"})', ToolNote(4, "flat", 0.25 * IN)),
        ("(2 = Ball Nose {6 mm})", ToolNote(2, "ball", 6.0)),
        ("(1 = V-Bit {60 deg 12 mm})", ToolNote(1, "v", 12.0, 0.0, math.radians(60))),
        ('(T5 60° V-bit 1/2")', ToolNote(5, "v", 0.5 * IN, 0.0, math.radians(60))),
        ("(Tool 7: drill dia. 3.3)", ToolNote(7, "drill", 3.3)),
        ("(T3 Ø8 end mill)", ToolNote(3, "flat", 8.0)),
        ("(T1 D6 ball nose)", ToolNote(1, "ball", 6.0)),
        ("(tool radius 3.0)", ToolNote(0, "", 6.0)),
        ("(TOOL DIAMETER: 3.0 )", ToolNote(0, "", 3.0)),
        ("(tool diameter = 0.5 in)", ToolNote(0, "", 12.7)),
        ("(6mm end mill)", ToolNote(0, "flat", 6.0)),
        ("(1-1/4 inch face mill)", ToolNote(0, "flat", 1.25 * IN)),
        (
            ";@MKR|TOOL|number=7|name=End mill|type=Flat End|diameter=0.25|handlediameter=0.5|flutelength=1",
            ToolNote(7, "flat", 0.25),
        ),
        ("(T1 flat 0.23622 in, 12000 rpm)", ToolNote(1, "flat", 0.23622 * IN)),
        ("(TC: 5mm Endmill)", ToolNote(0, "flat", 5.0)),
    ],
)
def test_tools_that_comments_tell_of(comment: str, expected: ToolNote) -> None:
    assert_note(tools(f"%\n{comment}\n{MM}"), expected, 2)


def assert_note(found: tuple[ToolNote, ...], expected: ToolNote, line: int) -> None:
    assert len(found) == 1, found
    note = found[0]
    assert (note.number, note.kind, note.line) == (expected.number, expected.kind, line)
    told = (note.diameter, note.corner_radius, note.angle)
    assert told == pytest.approx((expected.diameter, expected.corner_radius, expected.angle)), note


@pytest.mark.parametrize(
    "comment",
    [
        "(disable tool radius compensation)",
        "(MILLING AN ENCLOSED POCKET)",
        '(Cutter does not descend more than 0.94" below top)',
        "(compensate 0.8mm tip radius)",
        "(Pocket T1: depth 2 mm, stepdown 2 mm)",
        "(drill 4 holes 6 mm deep)",
        "(tool change at Z 50 mm height)",
        "(T3)",
        "(probe tool 5 mm above stock)",
        "G43 H1 D2 (tool length offset)",
        "( FINISH1 FLOWLINE SRF_MILL1 )",
        "(2 flute 1/8 shank)",
        "(MSG, Specified probe tool #<n> not in spindle)",
        "(debug, tool = #<toolnum> wear = #<wear>)",
        "(T1 D=0 - flat end mill)",
        "(tool radius 1/0)",
    ],
)
def test_comments_that_tell_of_none(comment: str) -> None:
    assert tools(f"{comment}\n{MM}") == ()


def test_the_units_are_those_of_the_program_near_it() -> None:
    comment = "(T1 D=0.5 - flat end mill)\n"
    assert tools(comment + INCH)[0].diameter == 12.7
    assert tools(comment + MM)[0].diameter == 0.5
    assert tools(comment)[0].diameter == 0.5
    assert tools("(G20 is not used)\n" + comment + "G210\n" + MM)[0].diameter == 0.5
    both = MM + comment + INCH + "(T2 D=0.5 - flat end mill)\n"
    assert [tool.diameter for tool in tools(both)] == [0.5, 12.7]


@pytest.mark.parametrize(
    "text",
    [
        "T3 M6 (6mm)\n",
        "(6mm)\nT3 M6\n",
        "M06 T03 ; 6 mm\n",
        "N30 T3 M6 (ball 6 mm)\n",
        "(6 mm end mill)\nG54\nT3\nM6\n",
        "M6 T3 (Change Tool: Diameter: 6.0000 mm)\n",
        "(TOOL DIAMETER: 6 )\nN1 G21; mm mode\nN2 G0 G17 G40; rapid\nN3 T3 M6; change\n",
    ],
)
def test_a_comment_at_a_tool_change_belongs_to_that_tool(text: str) -> None:
    found = tools("G21\n" + text + "G0 X1\n")
    assert [(tool.number, tool.diameter) for tool in found] == [(3, 6.0)]


def test_every_tool_is_told_once_with_all_that_is_known() -> None:
    text = "(T1 D=6. - flat end mill)\n(T2 D=3. - drill)\nT1 M6 (6 mm)\nG1 X1\nT2 M6 (drill)\n(T1 D=9.)\n"
    assert [(tool.number, tool.kind, tool.diameter, tool.line) for tool in tools(text)] == [
        (1, "flat", 6.0, 1),
        (2, "drill", 3.0, 2),
    ]
    apart = "(TOOL 4 BALL NOSE)\n(TOOL 4 DIA 6)\n" + "\n" * 30 + "(TOOL 4 DIA 8 DRILL)\n"
    assert tools(apart) == (ToolNote(4, "ball", 6.0, line=2),)


HEADER = """(Stock 1.73 in x 1.34 in x 0.31 in)
(T1 flat 0.23622 in, 12000 rpm)
(hitofude: origin_mm=-2,-2,-8)
(hitofude: stock_mm=-2,-2,-8,42,32,0)
(hitofude: tool=1,flat,6)
(hitofude: tool=2,v,3.5)
G20
"""


@pytest.mark.parametrize(
    "written", [HEADER, HEADER.upper(), HEADER.replace("(", "; ").replace(")", ""), HEADER.replace("\n", "\r\n")]
)
def test_our_own_header_is_believed_alone(written: str) -> None:
    found, box, _ = notes(written.encode())
    assert found == (ToolNote(1, "flat", 6.0, line=5), ToolNote(2, "v", 3.5, line=6))
    assert box == StockNote((0.0, 0.0, 0.0), (44.0, 34.0, 8.0), (44.0, 34.0, 8.0), 4)


@pytest.mark.parametrize(
    "line", ["tool=x,flat,6", "tool=1,flat", "tool=1,flat,nan", "stock_mm=1,2,3", "stock_mm=1,2,3,4,5,1e999", "tool="]
)
def test_a_damaged_header_of_ours_tells_nothing(line: str) -> None:
    assert notes(f"(hitofude: {line})\n(hitofude: origin_mm=1,2)\n".encode())[:2] == ((), None)


N = math.nan


@pytest.mark.parametrize(
    ("comment", "low", "high", "size"),
    [
        ("(STOCK 100 x 50 x 10)", (N, N, N), (N, N, N), (100, 50, 10)),
        ("(Stock: 100mm*50mm*10mm)", (N, N, N), (N, N, N), (100, 50, 10)),
        ("; stock size 4 x 2 x 1/2 in", (N, N, N), (N, N, N), (4 * IN, 2 * IN, IN / 2)),
        ('(Assumes 4"x4"x2" finished stock)', (N, N, N), (N, N, N), (4 * IN, 4 * IN, 2 * IN)),
        ("(Stock size X100 x Y50 x Z10)", (N, N, N), (N, N, N), (100, 50, 10)),
        ("(workpiece 100 \u00d7 50 \u00d7 10 mm)", (N, N, N), (N, N, N), (100, 50, 10)),
        ("(Stock X=100 Y=50 Z=10)", (N, N, N), (N, N, N), (100, 50, 10)),
        ("(STOCK: X0 Y0 Z-10 X100 Y50 Z0)", (0, 0, -10), (100, 50, 0), (100, 50, 10)),
        ("(Stock: X0 .. 100 Y0..50 Z-10..0)", (0, 0, -10), (100, 50, 0), (100, 50, 10)),
        ("(stock X -5 to 100, Y 0 to 50, Z -10 to 2)", (-5, 0, -10), (100, 50, 2), (105, 50, 12)),
        ("(Stock: X0 Y0 Z-10)", (0, 0, -10), (N, N, N), (N, N, N)),
        ("(stock 10 x 20 x 5)\n(top of stock at Z = 1)", (N, N, -4), (N, N, 1), (10, 20, 5)),
        ("( Material Size)\n( X= 14.000, Y= 20.000, Z= 0.750)", (N, N, N), (N, N, N), (14, 20, 0.75)),
        (
            ";[Bounds]\n;maxz = 0.0\n;maxx = 14.0\n;maxy = 5\n;minx = -1\n;miny = -2\n;minz = -3",
            (-1, -2, -3),
            (14, 5, 0),
            (15, 7, 3),
        ),
    ],
)
def test_stock_that_comments_tell_of(
    comment: str, low: tuple[float, ...], high: tuple[float, ...], size: tuple[float, ...]
) -> None:
    note = stock(f"%\n{comment}\n{MM}")
    assert note is not None
    assert note.low == pytest.approx(low, nan_ok=True)
    assert note.high == pytest.approx(high, nan_ok=True)
    assert note.size == pytest.approx(size, nan_ok=True)
    assert comment.splitlines()[note.line - 2].lower().startswith(("(", ";"))


@pytest.mark.parametrize(
    "comment", ["(stock top is zero)", "(leave 0.2 mm stock)", "(stock)", "G1 X100 Y50 Z10", "(start 2x2x2)"]
)
def test_comments_that_tell_of_no_stock(comment: str) -> None:
    assert stock(f"{comment}\n{MM}") is None


def test_the_shared_programs() -> None:
    folder = ROOT / "tests" / "data" / "nc"
    assert tools((folder / "test_pycam.ngc").read_text("latin-1")) == (
        ToolNote(1, "flat", 6.0, line=27),
        ToolNote(2, "bull", 2.0, 0.2, line=441),
        ToolNote(3, "ball", 1.0, line=1699),
    )
    box = stock((folder / "test_pycam.ngc").read_text("latin-1"))
    assert box is not None
    assert (box.low, box.high) == ((-10.0, -2.0, -10.0), (140.0, 52.0, 0.0))
    for name in ("tux.ngc", "jsdc.gcode", "helical-thread-milling.gcode", "rs274ngc_canned_cycles.ngc"):
        assert notes((folder / name).read_bytes()) == ProgramNotes(), name


@pytest.mark.parametrize("encoding", ["latin-1", "utf-8", "utf-8-sig", "utf-16"])
@pytest.mark.parametrize("text", ["T1 M6 (Ø8)", "G0 X1\r(T2 D=8)\r", "G0 X1\r\n(T2 drill 8 mm)\r\n"])
def test_encodings_and_line_ends(text: str, encoding: str) -> None:
    assert [tool.diameter for tool in notes(text.encode(encoding))[0]] == [8.0]


def test_a_large_program_is_read_at_once() -> None:
    data = Path(ROOT / "tests" / "data" / "nc" / "test_pycam.ngc").read_bytes()
    assert seconds(data) < 0.1


@pytest.mark.parametrize(
    "text",
    [
        "(tool " + "1 " * 200_000,
        "(T1 D=" + "9" * 500_000 + ")",
        "(tool dia 1/1/1/1" * 20_000,
        "(stock " + "1x" * 300_000,
        "T1 M6 " + "(" * 300_000,
        "(mill)" * 100_000,
        "tool " * 100_000 + "\n",
        "; tool (tool) " * 50_000,
        "(T1 6mm tool)\n" * 40_000,
        "G20 G21 (tool 1 mm)\n" * 20_000,
        "T1 M6\n" * 50_000,
        "(" + "a" * 1_000_000 + " tool diameter 3)",
        "stock x0" * 90_000,
        "(minx = " * 50_000,
        "(hitofude: tool=1,flat,6)\n" * 20_000,
    ],
)
def test_hostile_texts_do_not_hang_it(text: str) -> None:
    assert seconds(text.encode()) < 2.0


def seconds(data: bytes) -> float:
    begun = time.process_time()
    notes(data)
    return time.process_time() - begun


PARTS = [
    "(",
    ")",
    ";",
    "\n",
    "\r",
    "tool",
    "T1",
    "M6",
    "D=",
    "6",
    ".5",
    "1/4",
    "1/0",
    "mm",
    " in",
    '"',
    " ",
    "x",
    "stock",
    "X",
    "-",
    "=",
    "mill",
    "dia",
    "ball",
    "R",
    "minx",
    "G20",
    "hitofude:",
    "tool=",
    "stock_mm=",
    ",",
    "radius",
    "°",
    "taper=",
    "top of stock",
    "material size",
]


@settings(max_examples=examples(400), deadline=None)
@given(st.lists(st.sampled_from(PARTS), max_size=60).map("".join))
def test_nonsense_gives_sane_notes_or_none(text: str) -> None:
    found, box, _ = notes(text.encode())
    for tool in found:
        assert 0 < tool.diameter <= 500
        assert 0 <= tool.corner_radius <= tool.diameter / 2
        assert 0 <= tool.angle < math.pi
        assert 1 <= tool.line <= text.count("\n") + text.count("\r") + 1
    assert box is None or box.line >= 1
