"""Which control a program is taken for."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.gcode.interpreter.dialect import Dialect
from app.gcode.interpreter.dialect_guess import guess_dialect
from tests.conftest import ROOT

GOLDEN = sorted((ROOT / "tests" / "gcode" / "golden").iterdir())


@pytest.mark.parametrize(
    ("text", "dialect"),
    [
        ("", Dialect.LINUXCNC),
        ("G21\nG1 X1 F100\n", Dialect.LINUXCNC),
        ("; for grbl 1.1\nG21\n", Dialect.GRBL),
        ("$H\nG21\n", Dialect.GRBL),
        ("(Mach3 mill)\nO1000\n", Dialect.MACH3),
        ("N100G00G17G90\r\nN110G71G91.1\r\n", Dialect.MACH3),
        ("G90 G70 (inch)\n", Dialect.MACH3),
        ("G71 Q100 X5 Z2 D1 R.5\n", Dialect.LINUXCNC),
        ("G70 I5. J30. L4\n", Dialect.LINUXCNC),
        ("O<bore> sub\n", Dialect.LINUXCNC),
        ("N10 o100 if [#1 GT 2]\n", Dialect.LINUXCNC),
        ("G64 P0.01\n", Dialect.LINUXCNC),
        ("%\nO1234 (PLATE)\nG21\n", Dialect.FANUC),
        ("tape 7\n%\n\n:7\nG21\nM30\nO8\nM99\n", Dialect.FANUC),
        ("G21 G0 Z5\nM98 P7\nM30\nO7\nG91 G1 Z-1 F100\nM99\n", Dialect.LINUXCNC),
        ("WHILE [#1 LT 5] DO1\n", Dialect.FANUC),
        ("O1000\nG54.1 P3\n", Dialect.FANUC),
        ("O1000\nG187 P3\n", Dialect.HAAS),
        ("O1000\nG111\n", Dialect.HAAS),
        ("O1000\nG112\n", Dialect.FANUC),
        ("O1000 (PLATE)\nG21 G90 G91.1\n", Dialect.MACH3),
        ("O1000 (G91.1)\nG21 G90\n", Dialect.FANUC),
        ("%\n<PLATE> (of 2)\nG21\n", Dialect.FANUC),
        ("(T1 D=6.)\nG90 G54 G64 G50 G17 G40 G80 G94 G91.1 G49\n", Dialect.MACH3),
        ("%\nO1000 (POST FANUC)\nG17 G40 G49 G64 G50 G80 G90\n", Dialect.FANUC),
        ("%\nO1000 (POST HAAS)\nG17 G40 G49 G64 G50 G80 G90\n", Dialect.HAAS),
        ("%\nO1000\n(X)G21 G110\n", Dialect.HAAS),
        ("; Drawing 120\nG21\nX100 ; plunging 115\n", Dialect.LINUXCNC),
    ],
)
def test_what_only_one_control_says_tells(text: str, dialect: Dialect) -> None:
    assert guess_dialect(text.encode()) is dialect


@pytest.mark.parametrize("name", ["test_pycam.ngc", "tux.ngc", "jsdc.gcode", "rs274ngc_canned_cycles.ngc"])
def test_programs_that_tell_nothing_are_taken_for_linuxcnc(data: Path, name: str) -> None:
    assert guess_dialect((data / "nc" / name).read_bytes()) is Dialect.LINUXCNC


@pytest.mark.parametrize("path", GOLDEN, ids=lambda path: path.name)
def test_our_own_programs_are_known(path: Path) -> None:
    assert guess_dialect(path.read_bytes()).value == path.name.split("_")[0]
