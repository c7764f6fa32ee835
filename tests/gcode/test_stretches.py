"""Which lines of a program are in stretches that may be written anew, why others are not, and what follows a
stretch.
"""

import pytest

from app.gcode.interpreter.dialect import Dialect
from app.gcode.interpreter.options import ReadOptions
from app.gcode.interpreter.reader import read_program
from app.gcode.interpreter.text import ProgramBuffer
from app.gcode.rework.stretches import FoundStretches, SkipReason, find_stretches

HEAD = "G21 G90 G94\nG0 X0 Y0 Z0\n"


def found(text: str) -> FoundStretches:
    data = text.encode()
    return find_stretches(read_program(data, ReadOptions(Dialect.LINUXCNC)), ProgramBuffer(data))


@pytest.mark.parametrize("line", ["X2", "x2.", "X+2.0 Y0", "N7 G1 X2", "g01x2", "X 2", "\t G1 X2 F100", "X2\n\n"])
def test_a_line_that_says_where_to_go_is_in_a_stretch(line: str) -> None:
    """All of these end at X 2."""
    made = found(f"{HEAD}G1 X1 F100\n{line}\nX3\nM2\n").stretches
    assert len(made) == 1
    assert made[0].last_line == 5 + line.count("\n")
    assert made[0].points[-1].tolist() == [3, 0, 0]
    assert made[0].feed == "100"


def test_a_feed_that_is_said_again_ends_no_stretch_and_another_one_does() -> None:
    made = found(f"{HEAD}G1 X1 F100\nX2 F100.0\nG1 X3 F100\nX4 F50\nX5 F50\nM2\n").stretches
    assert [(each.first_line, each.last_line, each.feed) for each in made] == [(3, 5, "100"), (6, 7, "50")]
    assert len(found(f"{HEAD}F100\nG1 X1\nX2 F100\nX3 F100\nM2\n").stretches) == 1


@pytest.mark.parametrize("line", ["X2 (a)", "G1 X2 M8", "X[1+1]", "X2 ; b"])
def test_a_line_that_says_more_is_in_none(line: str) -> None:
    made = found(f"{HEAD}G1 X1 F100\nX1.5\n{line}\nX3\nX4\nM2\n")
    assert [(each.first_line, each.last_line) for each in made.stretches] == [(3, 4), (6, 7)]
    assert made.left[SkipReason.WORDS] == 1


def test_lines_that_are_done_twice_are_in_none() -> None:
    assert found(f"{HEAD}G1 F100\no1 repeat [2]\nX1\nX2\no1 endrepeat\nM2\n").left[SkipReason.REPEATED] == 4


@pytest.mark.parametrize(
    ("behind", "resumed"),
    [
        ("G0 Z5\n", True),
        ("(a comment)\n\nG00 Z5\n", True),
        ("N9 G2 X4 I0.5\n", True),
        ("Z5 F20\n", False),
        ("G21\n", False),
        ("M5\nG0 Z5\n", False),
    ],
)
def test_what_follows_says_itself_how_to_move_or_does_not(behind: str, resumed: bool) -> None:
    """G2 in G21 is none; only the first line that says anything counts."""
    made = found(f"{HEAD}G1 X1 F100\nX2\nX3\n{behind}M2\n").stretches
    assert made[0].resumed is resumed
