"""Bytes that LinuxCNC refuses or obeys otherwise than a text is read: no program that has one is without a problem."""

import codecs

import pytest

from app.gcode.interpreter.dialect import Dialect
from app.gcode.interpreter.options import ReadOptions
from app.gcode.interpreter.program import ProgramProblem
from app.gcode.interpreter.reader import read_program
from tests.gcode.interpreter.judged import judged
from tests.gcode.interpreter.programs import told
from tests.gcode.interpreter.rs274_motions import assert_same, rs274

PLAIN = "G21 G90\nG0 X1 Y2 Z3\nG1 X4 F100\nM2\n"
ODD = {
    "utf-16": PLAIN.encode("utf-16"),
    "a mark": b"\xef\xbb\xbf" + PLAIN.encode(),
    "utf-16 without a mark": PLAIN.encode("utf-16-le"),
    "carriage returns": PLAIN.encode().replace(b"\n", b"\r"),
    "a carriage return": b"G21\rG0 X1 Y2\r\nG1 X4 F100\nM2\n",
    "NUL": b"G21 G90\nG0 X1 Y2\0 Z3\nG1 X4 F100\nM2\n",
    "a form feed": b"G21 G90\n\fG0 X1 Y2 Z3\nM2\n",
    "a vertical tab": b"G21 G90\nG0 X1\v Y2\nM2\n",
}
HARMLESS = (
    PLAIN.encode(),
    PLAIN.encode().replace(b"\n", b"\r\n"),
    PLAIN.encode().replace(b"\n", b"\r\r\n"),
    b"\0\0\n" + PLAIN.encode(),
)


def problems(data: bytes, dialect: Dialect = Dialect.LINUXCNC) -> list[ProgramProblem]:
    return [each for each in read_program(data, ReadOptions(dialect=dialect)).problems if "save it as" in each.text]


@pytest.mark.parametrize("data", ODD.values(), ids=ODD)
def test_what_linuxcnc_takes_otherwise_is_a_problem_with_its_remedy(data: bytes) -> None:
    assert problems(data)


@pytest.mark.parametrize("data", ODD.values(), ids=ODD)
def test_linuxcnc_itself_refuses_it_or_moves_otherwise(data: bytes) -> None:
    """Or, for a carriage return alone, has one line where two are written."""
    motions, complaint = rs274(data)
    program = read_program(data, ReadOptions())
    otherwise = bool(complaint) or data.count(b"\r") > data.count(b"\r\n")
    try:
        assert_same(program, motions)
    except AssertionError:
        otherwise = True
    assert otherwise


@pytest.mark.parametrize("data", HARMLESS)
def test_line_ends_of_other_systems_and_the_leader_of_a_tape_are_none(data: bytes) -> None:
    motions, complaint = rs274(data)
    assert not problems(data) and not complaint
    assert_same(read_program(data, ReadOptions()), motions)


def test_it_is_told_with_its_line() -> None:
    (found,) = problems(b"G21\r\nG90\r\nG0 X1\rY2\r\nM2\r\n")
    assert found.line == 3 and "one line" in found.text


def test_two_bytes_a_letter_are_read_by_no_control() -> None:
    assert all(problems(ODD["utf-16"], dialect) for dialect in Dialect)
    assert not problems(ODD["a carriage return"], Dialect.GRBL)


def test_what_stands_where_a_word_should_is_told_with_what_to_write() -> None:
    assert "expected a decimal point" in told("G1 X8,5 F100\n")
    assert "found '\u2212'; write minus as -." in told("G1 X\u22128 F100\n")
    assert "are not followed: write them as moves" in told("G1 X8. ,C2. F100.\n", Dialect.FANUC)


@pytest.mark.parametrize("mark", [codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE, codecs.BOM_UTF8])
def test_a_mark_without_a_line_behind_it_is_told_without_a_line_that_is_not_there(mark: bytes) -> None:
    program = judged(mark)  # which looks at the place of every problem
    assert program.line_count == 0 and not any("UTF-16" in problem.text for problem in program.problems)
