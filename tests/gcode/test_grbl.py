"""What is written for grbl is a program a tool, each complete, in words that grbl knows."""

from __future__ import annotations

import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.gcode.posts import load_post
from app.gcode.writer.write import write_files
from app.model.job import OriginXY
from app.model.part import Part, Units
from app.model.tool import Tool
from tests.examples import examples
from tests.gcode.grbl_syntax import LINE, grbl_errors
from tests.gcode.one_file import write_program
from tests.gcode.programs import Path, job, two_tools
from tests.gcode.test_write_motion import arc_steps, line_steps, random_path

GRBL = load_post("grbl")
UNITS = pytest.mark.parametrize("units", [Units.MM, Units.INCH], ids=["mm", "inch"])


@pytest.mark.parametrize(
    ("line", "error"),
    [
        ("T1 M6", "M6 is not supported"),
        ("G64 P0.01", "G64 is not supported"),
        ("G98 G81 X1 Y1 Z-1 R1 F60", "G81 is not supported"),
        ("G43 H1", "G43 is not supported"),
        ("G5.2 X1 Y1 P1", "G5.2 is not supported"),
        ("G41 D1", "G41 is not supported"),
        ("G1 X1", "no feed rate"),
        ("G20 G21", "two words of a modal group"),
        ("G0 X1 X2", "a word twice"),
        ("G4", "G4 without P"),
        ("(" + "a" * 80 + ")", "longer than"),
        ("(what?)", "acts at once"),
        ("#1=2", "no words"),
        ("G2 X1 Y1 F60", "without a centre"),
        ("G0 X1 I1", "words that nothing uses"),
        ("M3", "M3 without a speed"),
    ],
)
def test_the_judge_sees_what_grbl_refuses(line: str, error: str) -> None:
    assert any(error in found for found in grbl_errors(line))


def test_the_judge_measures_radii() -> None:
    head = "G21 G90 G17\nG0 X0 Y0 Z1\n"
    assert grbl_errors(head + "G3 X10 Y10 I0 J10 F100") == []
    assert "radii differ" in grbl_errors(head + "G3 X10.02 Y10 I0 J10 F100")[0]
    assert grbl_errors(head + "G3 X100.02 Y100 I0 J100 F100") == [], "0.1 % of a large radius will do"


@UNITS
def test_every_file_is_one_that_grbl_takes(units: Units) -> None:
    part = Part(
        name="Getriebegehäuse (links) ? ! ~ $ with a name that is much longer than any line of grbl may ever be"
    )
    task = job(part=part, out_units=units, layer_names=("Kontur außen (1+2)" * 9, "0"), origin_xy=OriginXY.CENTRE)
    for file in write_files(two_tools().program(), task, GRBL):
        assert grbl_errors(file.nc.text) == []
        assert max(map(len, file.nc.text.splitlines())) <= LINE


def test_one_file_a_tool_numbered_each_complete_with_the_same_origin() -> None:
    files = write_files(two_tools().program(), job(), GRBL)
    assert [file.suffix for file in files] == ["_1_T1", "_2_T2"]
    assert [(file.first, len(file.nc.lines)) for file in files] == [(0, 8), (8, 9)]
    starts = [file.nc.text[: file.nc.text.index("S1")] for file in files]
    for number, (file, start) in enumerate(zip(files, starts, strict=True), start=1):
        assert f"(File {number} of 2, with T{number} alone, X and Y zero as in the others)" in start
        assert "(Set Z zero with this tool in the spindle)" in start and "(hitofude: origin_mm=0,0,0)" in start
        assert re.findall(r"hitofude: tool=(\d)", start) == [str(number)] and start.count("hitofude: operation=") == 1
        assert "makes no moves" not in start
        assert start.count("G17 G21 G90 G94 G40 G49 G80\nG91.1\nG54\nG61\n") == 1
        blocks = [line for line in file.nc.text.splitlines() if line[0] != "("]
        assert blocks[4:7] == [f"S{12000 if number == 1 else 18000} M3", "G4 P2", "G0 Z5.0000"]
        assert blocks[-3:] == ["G0 Z5.0000", "M5", "M30"]
        assert not re.search(r"\b[TH]\d", " ".join(blocks))


def test_a_tool_that_comes_back_has_another_file() -> None:
    path = Path().into_work(1, 1).line(5, 1, -1).out_of_work()
    for tool in (2, 1, 10):
        path.tool = tool
        path.into_work(2, 2).line(6, 2, -1).out_of_work()
    tools = tuple(Tool(number, 3.0) for number in (1, 2, 10))
    files = write_files(path.program(), job(tools=tools), GRBL)
    assert [file.suffix for file in files] == ["_1_T1", "_2_T2", "_3_T1", "_4_T10"]
    assert np.concatenate([np.arange(len(file.nc.lines)) + file.first for file in files]).tolist() == list(
        range(len(path.rows))
    )


def test_a_program_of_one_tool_is_one_plain_file() -> None:
    path = Path().into_work(1, 1).line(5, 1, -1).out_of_work()
    (file,) = write_files(path.program(), job(), GRBL)
    assert file.suffix == "" and "(File" not in file.nc.text and "Z zero" not in file.nc.text
    assert write_program(path.program(), job(), GRBL).text == file.nc.text


def test_it_never_leaves_the_path() -> None:
    (first, _) = write_files(two_tools().program(), job(), GRBL)
    assert "(Exact path: the control does not blend)" in first.nc.text and "(hitofude: blend_mm=0)" in first.nc.text


@UNITS
@settings(max_examples=examples(25), deadline=None)
@given(steps=st.lists(st.one_of(arc_steps, line_steps), min_size=1, max_size=40))
def test_random_lines_and_arcs_are_taken(units: Units, steps: list[tuple[object, ...]]) -> None:
    (file,) = write_files(random_path(steps).program(), job(out_units=units), GRBL)
    assert grbl_errors(file.nc.text) == []
