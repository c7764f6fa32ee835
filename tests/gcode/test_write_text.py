"""The text of a program: its header, its order, nothing said twice; the same bytes for the same input."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest

from app.core.errors import Cancelled, ParameterError
from app.core.progress import Progress
from app.gcode.posts import Coolant, load_post
from app.gcode.writer.header import tool_words
from app.gcode.writer.write import NcText, blend_mm, writing_tolerance
from app.model.contour_operation import ContourOperation
from app.model.job import Job
from app.model.operation import CutParameters, PocketOperation
from app.model.part import Part, Units
from app.model.tool import Tool
from app.model.tool_kind import ToolKind
from tests.gcode.one_file import write_program
from tests.gcode.programs import Path, job, square, two_tools
from tests.gcode.rs274_oracle import canonical_calls

LINUXCNC = load_post("linuxcnc")


def write(path: Path, **changes: object) -> NcText:
    return write_program(path.program(), job(**changes), LINUXCNC)


def body(nc: NcText) -> list[str]:
    """Blocks behind the header, without comments."""
    return [line for line in nc.text.splitlines() if not line.startswith("(")]


def test_same_input_same_bytes() -> None:
    assert write(two_tools()).text == write(two_tools()).text


def test_text_is_ascii_with_line_feeds_and_short_lines() -> None:
    text = write(two_tools(), part=Part(name="Getriebegehäuse (links)\n歯車; M30 %" * 9)).text
    assert text.isascii() and text.endswith("M2\n") and "\r" not in text
    assert max(map(len, text.splitlines())) <= 122
    assert text.startswith("(Part Getriebegehause _links_____ M30 _")
    assert all(re.fullmatch(r"\([^()]*\)|[^()]+", line) for line in text.splitlines())
    canonical_calls(text)


def test_a_name_cannot_become_a_command() -> None:
    text = write(two_tools(), part=Part(name="MSG,hello")).text
    calls = [name for name, _ in canonical_calls(text)]
    assert "MESSAGE" not in calls


def test_order_round_a_tool_change() -> None:
    """Up first, then the spindle stops; length, speed, time to spin up; up again before any move in XY."""
    blocks = body(write(two_tools()))
    change = blocks.index("T2 M6")
    assert blocks[change - 2 : change + 8] == [
        "G0 Z5.0000",
        "M5",
        "T2 M6",
        "G43",
        "S18000 M3",
        "G4 P2",
        "G0 Z5.0000",
        "X8.0000 Y5.0000",
        "Z1.0000",
        "G1 Z-1.0000 F200",
    ]
    assert blocks[:4] == ["G17 G21 G90 G94 G40 G49 G80", "G91.1", "G54", "G64 P0.0100 Q0"]
    assert blocks[-3:] == ["G0 Z5.0000", "M5", "M2"]


def test_the_control_sees_that_order() -> None:
    calls = [name for name, _ in canonical_calls(write(two_tools()).text)]
    second = len(calls) - 1 - calls[::-1].index("CHANGE_TOOL")
    up, off, change, on, wait = (
        "STRAIGHT_TRAVERSE",
        "STOP_SPINDLE_TURNING",
        "CHANGE_TOOL",
        "START_SPINDLE_CLOCKWISE",
        "DWELL",
    )
    wanted = [up, off, change, on, wait, up, "STRAIGHT_FEED"]
    seen = [name for name in calls[second - 6 :] if name in wanted]
    assert [name for i, name in enumerate(seen) if i == 0 or name != seen[i - 1]][:7] == wanted


def test_a_path_that_ends_in_work_is_lifted_out() -> None:
    path = Path().into_work(1, 1).line(5, 1, -1)
    path.tool, path.operation = 2, 1
    path.into_work(2, 2).line(6, 2, -1)
    blocks = body(write(path))
    assert blocks[blocks.index("T2 M6") - 2 :][:2] == ["G0 Z5.0000", "M5"]
    assert blocks[-3:] == ["G0 Z5.0000", "M5", "M2"]


def test_words_are_modal() -> None:
    """No axis word, feed or motion word that the control knows already; arcs always carry X, Y, I and J."""
    known: dict[str, str] = {}
    for block in body(write(two_tools())):
        words = dict(re.findall(r"([A-Z])(-?[\d.]+)", block))
        if block.startswith("T"):
            known.clear()
        if not re.match(r"[GXYZ]", block) or words.get("G") not in ("0", "1", "2", "3", None):
            continue
        arc = "I" in words
        assert not arc or {"X", "Y", "I", "J"} <= set(words)
        for letter in ("G", "Z", "F") if arc else ("G", "X", "Y", "Z", "F"):
            assert letter not in words or words[letter] != known.get(letter), block
        known |= words


def test_no_negative_zero_and_all_decimals() -> None:
    path = (
        Path()
        .rapid(-0.00001, 0.00004, 5.0)
        .rapid(-0.00001, 0.00004, 1.0)
        .line(-0.00001, 0.00004, -0.00003)
        .line(3, 0, -0.00003)
    )
    path.arc((3, 6, -0.00003), (3, 3)).out_of_work()
    for units, decimals in ((Units.MM, 4), (Units.INCH, 5)):
        text = write(path, out_units=units).text
        assert not re.search(r"-0\.0*(?!\d)", text)
        blocks = " ".join(line for line in text.splitlines() if line[0] != "(")
        assert {len(fraction) for fraction in re.findall(r"[XYZIJ]-?\d+\.?(\d*)", blocks)} == {decimals}


def test_moves_that_round_to_nothing_are_left_out() -> None:
    path = Path().into_work(1, 1).line(2, 1, -1).line(2.00003, 1.00002, -1).line(2.00003, 1.00002, -1).line(3, 1, -1)
    nc = write(path)
    assert nc.lines.tolist()[3:] == [nc.lines[3]] * 3 + [nc.lines[3] + 1]
    assert "X2.0000 F600" in nc.text and nc.text.count("X2.0000") == 1


def test_each_move_knows_the_line_that_ends_it() -> None:
    path = two_tools()
    nc, moves = write(path), path.moves()
    text = nc.text.splitlines()
    assert nc.lines.dtype == np.int32 and len(nc.lines) == len(moves)
    assert text[nc.lines[1] - 1] == "Z1.0000"
    circle = next(i for i in range(1, len(moves)) if moves.kind[i] == 2)
    assert text[nc.lines[circle] - 2].startswith("G2 X25") and text[nc.lines[circle] - 1].startswith("X35")


def test_feed_is_in_out_units() -> None:
    assert "F23.62" in write(Path().into_work(0, 0).line(5, 0, -1), out_units=Units.INCH).text


def test_a_feed_never_rounds_to_nothing() -> None:
    text = write(Path(feed=0.01).into_work(0, 0).line(5, 0, -1), out_units=Units.INCH).text
    assert "F0.01" in text
    canonical_calls(text)


def test_blending_stays_below_its_tolerance_in_either_unit() -> None:
    assert blend_mm(job(), LINUXCNC) == 0.01
    assert 0.0099 < blend_mm(job(out_units=Units.INCH), LINUXCNC) <= 0.01
    assert "G64 P0.00039 Q0" in write(two_tools(), out_units=Units.INCH).text
    assert "the control may blend by up to P 0.01 mm" in write(two_tools()).text


def test_exact_path() -> None:
    text = write(two_tools(), exact_path=True).text
    assert "\nG61\n" in text and "G64" not in text
    assert "(Exact path: the control does not blend)" in text and "(hitofude: blend_mm=0)" in text


def test_writing_tolerance() -> None:
    assert writing_tolerance(job(), LINUXCNC) == pytest.approx(2e-4)
    assert writing_tolerance(job(out_units=Units.INCH), LINUXCNC) == pytest.approx(2e-5 * 25.4)
    coarse = replace(
        LINUXCNC, decimals=replace(LINUXCNC.decimals, mm=replace(LINUXCNC.decimals.mm, X=3, Y=3, I=3, J=3))
    )
    assert writing_tolerance(job(), coarse) == pytest.approx(1e-3)


def test_coolant_is_the_posts_choice() -> None:
    flood = replace(LINUXCNC, coolant=replace(LINUXCNC.coolant, use=Coolant.FLOOD))
    text = write_program(two_tools().program(), job(), flood).text
    assert text.count("M8\n") == 2 and text.count("M9\n") == 2
    assert text.index("G4 P2\nM8\n") < text.index("G0 Z5.0000")
    assert "M8" not in write(two_tools()).text and "M9" not in write(two_tools()).text


def test_header_names_stock_origin_tools_and_operations() -> None:
    tools = (Tool(1, 6.0, name="Schlichtfräser"), Tool(2, 3.175, ToolKind.BALL, spindle_speed=18000.0), Tool(3, 1.0))
    operations = (
        PocketOperation(CutParameters(tool=1, stock_to_leave=0.1), stepover=2.5),
        ContourOperation(CutParameters(tool=2)),
        ContourOperation(CutParameters(tool=3)),
        ContourOperation(CutParameters(tool=3, enabled=False)),
    )
    comments = [
        line[1:-1]
        for line in write(two_tools(), tools=tools, operations=operations).text.splitlines()
        if line[0] == "("
    ]
    for words in (
        "Part plate",
        "Stock 44 mm x 34 mm x 8 mm",
        "Work origin: drawing zero, top of stock",
        "T1 flat 6 mm Schlichtfraser, 12000 rpm",
        "T2 ball 3.175 mm, 18000 rpm",
        "Contour T3: depth 2 mm, stepdown 2 mm, stock to leave 0 mm, climb, makes no moves",
        "Pocket T1: depth 2 mm, stepdown 2 mm, stock to leave 0.1 mm, climb, stepover 2.5 mm",
        "hitofude: part=plate",
        "hitofude: units=mm",
        "hitofude: origin_mm=0,0,0",
        "hitofude: stock_mm=-2,-2,-8,42,32,0",
        "hitofude: tool=2,ball,3.175",
        "hitofude: operation=pocket,tool=1,depth=2,stock_to_leave=0.1,stepover=2.5",
        "hitofude: path_tolerance_mm=0.0012",
        "hitofude: blend_mm=0.01",
    ):
        assert words in comments
    assert not [line for line in comments if line.startswith("T3")]


def test_header_tells_what_a_later_comparison_needs() -> None:
    part = Part(name="plate", units=Units.INCH)
    text = write(two_tools(), part=part, layer_names=("Kontur außen (1+2)", "0"), join_tolerance=0.05).text
    for note in ("drawing_units=inch", "layer=Kontur au+DF+en +28+1+2B+2+29+", "layer=0", "join_tolerance_mm=0.05"):
        assert f"(hitofude: {note})" in text
    canonical_calls(text)


def test_the_stated_tolerance_counts_curves_that_became_arcs() -> None:
    region = square()
    curved = replace(region, boundary=replace(region.boundary, deviation=0.0007))
    text = write_program(two_tools().program(curved), job(), LINUXCNC).text
    assert "(Path within 0.0019 mm of the exact offset of the drawing)" in text


def test_out_units_must_be_known_to_controls() -> None:
    with pytest.raises(ParameterError, match="mm or inch, not in cm"):
        write(two_tools(), out_units=Units.CM)


def test_a_tool_that_the_job_lacks() -> None:
    with pytest.raises(ParameterError, match="no tool T2"):
        write(two_tools(), tools=(Tool(1, 6.0),))


def test_cancel() -> None:
    def stop(_fraction: float, _text: str) -> None:
        raise Cancelled

    task: Job = job()
    with pytest.raises(Cancelled):
        write_program(two_tools().program(), task, LINUXCNC, Progress(listener=stop))


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("", "T2 flat 1 mm"),
        ("Flat 1 mm", "T2 flat 1 mm"),
        ("flat 1 MM", "T2 flat 1 mm"),
        ("Long one", "T2 flat 1 mm Long one"),
    ],
)
def test_a_tool_is_not_named_twice(name: str, words: str) -> None:
    assert tool_words(Tool(2, 1.0, name=name), Units.MM) == words
