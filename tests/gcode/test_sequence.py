"""Moves that no machine should make are refused, by number and place."""

from __future__ import annotations

import math

import pytest

from app.core.errors import ParameterError
from app.gcode.posts import load_post
from app.gcode.writer.write import check_sequence
from tests.gcode.one_file import write_program
from tests.gcode.programs import Path, job, two_tools


def second_tool_low() -> Path:
    path = Path().into_work(1, 1).out_of_work()
    path.tool = 2
    return path.rapid(5, 5, 1.0)


REFUSED = {
    "no moves": (None, "has no moves"),
    "first below safe Z": (
        Path().rapid(0, 0, 4.0),
        "Move 1 to X 0 Y 0 Z 4 is the first of T1 and must be a rapid at safe Z 5",
    ),
    "first is a cut": (Path().line(0, 0, 5.0), "is the first of T1"),
    "second tool below safe Z": (second_tool_low(), "Move 5 to X 5 Y 5 Z 1 is the first of T2"),
    "diagonal rapid": (Path().rapid(0, 0, 5.0).rapid(3, 0, 1.0), "changes XY and Z at once"),
    "rapid down into work": (Path().rapid(0, 0, 5.0).rapid(0, 0, 0.5), "is a rapid down below retract Z 1"),
    "level rapid in work": (Path().into_work(0, 0).rapid(3, 0, -1.0), "is a rapid in XY below retract Z 1"),
    "another job's": (Path(operation=2).rapid(0, 0, 5.0), "an operation that the job does not have any more"),
    "no feed": (Path(feed=0.0).rapid(0, 0, 5.0).line(0, 0, 1.0), "cuts without a feed rate"),
    "no number": (Path().rapid(0, 0, 5.0).rapid(math.nan, 0, 5.0), "has a coordinate that is no number"),
    "arc without radius": (Path().into_work(0, 0).arc((0, 0, -1), (0, 0)), "is an arc without a radius"),
    "arc that may be a circle": (Path().into_work(3, 0).arc((3, -1e-12, -1), (0, 0)), "ends nearly meet"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_refused(case: str) -> None:
    path, sentence = REFUSED[case]
    moves = path.moves() if path else Path().rapid(0, 0, 5.0).moves()
    if path is None:
        moves = moves.part(0, 0)
    with pytest.raises(ParameterError, match=sentence):
        check_sequence(moves, job())


def test_a_good_sequence_passes() -> None:
    check_sequence(two_tools().moves(), job())


def test_the_writer_checks() -> None:
    with pytest.raises(ParameterError, match="must be a rapid at safe Z"):
        write_program(Path().rapid(0, 0, 4.0).program(), job(), load_post("linuxcnc"))
