"""Programs in languages that are not read say which, beside the first word that is not understood."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.gcode.interpreter.foreign_languages import foreign_language
from app.gcode.interpreter.program import Severity
from app.gcode.interpreter.reader import read_program
from tests.conftest import ROOT


@pytest.mark.parametrize(
    ("text", "named", "line"),
    [
        ("0  BEGIN PGM PART MM\n1  BLK FORM 0.1 Z X+0 Y+0 Z-20\n2 L X+10 R0 FMAX M3\n", "Heidenhain", 1),
        ("%PART G71 *\nN10 G30 G17 X+0 Y+0 Z-20*\nN50 G01 X+10 Y+5 F200*\n", "DIN/ISO", 1),
        ("N10 G00 G40 G90 Z+50*\nN20 X+10*\n", "DIN/ISO", 1),
        ("; Impeller\nG94 G710\nG17\nG1 X10 F300\n", "Siemens", 2),
        ("G17 G90\nG2 X60 Y10 CR=10\n", "Siemens", 2),
        ("G0 X0\nG1 X=IC(5) F10\n", "Siemens", 2),
        ("G0 X1\nR1=5\n", "Siemens", 2),
        ('G17 G90\nN20 T="MILL_10" D1\nN30 M6\n', "Siemens", 2),
        ("G17 G90\nG3 X10 Y10 I=AC(5) J=AC(5)\n", "Siemens", 2),
        ("$HOLES.MIN%\nG15 H1\nM2\n", "Okuma", 1),
        ("TOOL PATH/FACE,TOOL,MILL\nGOTO/0.0,0.0,10.0\n", "APT", 2),
        ("IN;SP1;PU0,0;PD100,0;\n", "HP-GL", 1),
        ("G28\nM82\nG1 X5 E3.2 F1200\n", "3D printer", 2),
        ("G21\nG1 X5 Y5 Z0.2 E3.2 F1200\n", "3D printer", 2),
        ("BEGIN PGM 1 MM\nTOOL CALL 5 Z S2000\n", "Heidenhain", 1),
        ("G17 G90 G71\nG1 X20 RND=2\n", "Siemens", 2),
        ("G17 G90\nG1 Z=-2 F=100\n", "Siemens", 2),
        ("G21\nsub cut\nG1 X5 F100\nendsub\n", "Eding", 4),
        ("G21\nM117 Turn it on\n", "Marlin", 2),
        ("SET_PIN PIN=laser VALUE=0\nG0 X1\n", "Klipper", 1),
        ("SA\nJZ,0.8\nM3,1.0,2.0,-0.1\n", "ShopBot", 2),
        ("%FSLAX46Y46*%\n%MOMM*%\nD10*\n", "Gerber", 1),
        ("G04 made by hand*\nX1Y1D02*\n", "Gerber", 1),
        ("M48\nFMAT,2\nMETRIC\nT1C0.8\n", "Excellon", 2),
        ("M48\nINCH,TZ\nT01C0.0315\n", "Excellon", 2),
    ],
)
def test_the_language_is_named_at_the_line_that_tells(text: str, named: str, line: int) -> None:
    program = read_program(text.encode())
    told = [problem for problem in program.problems if "looks like" in problem.text]
    assert any(problem.severity is Severity.ERROR for problem in program.problems)
    assert [(named in problem.text, problem.line) for problem in told] == [(True, line)]


@pytest.mark.parametrize(
    "text",
    [
        "G21\nG1 X1 F100 Q\n",
        "(T1 D=6. CR=0. - ZMIN=-3. - flat end mill)\nG21\nG1 X1 F100 Q\n",
        "M190 P0\nM66 P3 L3 Q1\nF#<_hal[plasmac.cut-feed-rate]>\n",
        "; from X=0 to X=20\n#<z>=-2\nG21\nG1 X1 F100 Q\n",
        "M117 P1\nM62 P0\nG21\nG1 X1 F100 Q\n",
    ],
)
def test_nothing_is_named_where_a_program_is_only_wrong(text: str) -> None:
    program = read_program(text.encode())
    assert program.error is not None
    assert not any("looks like" in problem.text for problem in program.problems)


@pytest.mark.parametrize("path", sorted((ROOT / "tests" / "gcode" / "golden").iterdir()), ids=lambda path: path.name)
def test_programs_of_our_own_are_in_no_foreign_language(path: Path) -> None:
    assert foreign_language(path.read_bytes()) is None


def test_programs_of_other_makers_are_in_no_foreign_language(data: Path) -> None:
    assert [path.name for path in (data / "nc").iterdir() if foreign_language(path.read_bytes())] == []
