"""Loops that surely never end are refused at the end of a pass; all others are followed."""

from __future__ import annotations

import pytest

from app.gcode.interpreter.dialect import Dialect
from app.gcode.interpreter.options import ReadLimits, ReadOptions
from app.gcode.interpreter.program import NcProgram
from app.gcode.interpreter.reader import read_program

FEW = ReadLimits(looped_blocks=2000)


def read(text: str, dialect: Dialect = Dialect.LINUXCNC) -> NcProgram:
    return read_program(("G21 G90 F100\n" + text).encode(), ReadOptions(dialect, limits=FEW))


def is_told(program: NcProgram) -> bool:
    return program.error is not None and "changes whether it repeats" in program.error.text


ENDLESS = {
    "a constant": "#1=0\no1 do\nG1 X#1\n#1=[#1+1]\no1 while [+1 lt 3]\nM2\n",
    "a while": "#1=0\no1 while [1]\nG1 X#1\n#1=[#1+1]\no1 endwhile\nM2\n",
    "another counter": "#1=0 #2=0\no1 while [#1 lt 3]\nG1 X#2\n#2=[#2+1]\no1 endwhile\nM2\n",
    "a name": "#<a>=0 #<b>=0\no1 while [#<a> lt 3]\n#<b>=[#<b>+1]\no1 endwhile\nM2\n",
    "loops within": (
        "#2=0\no1 while [1]\n#2=[#2+1]\no2 if [#2 gt 3]\nG1 X2\no2 else\nG1 X1\no2 endif\no3 repeat [2]\nG1 Y#2\n"
        "o3 endrepeat\no1 endwhile\nM2\n"
    ),
}


@pytest.mark.parametrize("name", ENDLESS)
def test_what_never_ends_is_told_at_the_end_of_a_pass(name: str) -> None:
    program = read(ENDLESS[name])
    assert is_told(program) and len(program.motions) < 20


def test_a_loop_of_fanuc() -> None:
    program = read("#1=0\nWHILE [1 EQ 1] DO 1\nG1 X#1\n#1=#1+1\nEND 1\nM30\n", Dialect.FANUC)
    assert is_told(program) and len(program.motions) == 1


FIVE = "#1=0\no1 while [1]\n#1=[#1+1]\no2 if [#1 gt 4]\n{}\no2 endif\no1 endwhile\n"
"""A loop that is left, or not, when the counter is 5."""
ENDS = {
    "break": FIVE.format("o1 break") + "G1 X#1\nM2\n",
    "the end within": FIVE.format("G1 X#1\nM2"),
    "an end that is nearly written": FIVE.format("G1 X#1\nM1.999"),
    "a return": "o9 sub\n" + FIVE.format("o9 return [0]") + "o9 endsub\no9 call\nG1 X5\nM2\n",
    "an if that ends outside": "#1=0\no1 while [1]\n#1=[#1+1]\no2 if [#1 lt 5]\no1 endwhile\no2 endif\nG1 X#1\nM2\n",
    "a computed number": "#1=0 #2=1\no1 while [#1 lt 5]\n##2=[##2+1]\no1 endwhile\nG1 X#1\nM2\n",
    "a subroutine that sets it": (
        "o9 sub\n#100=[#100+1]\no9 endsub\n#100=0\no1 while [#100 lt 5]\no9 call\no1 endwhile\nG1 X#100\nM2\n"
    ),
    "a place": "o1 while [#5420 lt 5]\nG91 G1 X1\no1 endwhile\nM2\n",
    "zeros before its number": "#1=0\no1 while [#01 lt 5]\n#001=[#1+1]\no1 endwhile\nG1 X#1\nM2\n",
}


@pytest.mark.parametrize("name", ENDS)
def test_what_may_end_is_followed(name: str) -> None:
    program = read(ENDS[name])
    assert program.error is None, program.error
    assert program.motions.end[-1, 0] == 5.0


def test_a_comment_without_end_that_is_never_read_hides_nothing() -> None:
    text = "#1=0\no1 while [#1 lt 5]\n#1=[#1+1]\no2 if [0]\n(no end\no2 endif\no1 endwhile\nG1 X#1\nM2\n"
    assert read(text).error is None
