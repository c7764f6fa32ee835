"""Moves until a probe touches: what LinuxCNC's own interpreter does where nothing is touched."""

import pytest

from app.gcode.interpreter.reader import read_program
from tests.gcode.interpreter.programs import ends, read


@pytest.mark.parametrize("code", ["G38.3", "G38.5"])
def test_a_probe_that_need_not_touch_may_go_nowhere(code: str) -> None:
    assert ends(read(f"G21 F100\nG0 X1\n{code} X1\nG1 X2\nM2\n")) == [(1, 0, 0), (2, 0, 0)]


@pytest.mark.parametrize("code", ["G38.2", "G38.4"])
def test_one_that_has_to_touch_may_not(code: str) -> None:
    error = read_program(f"G21 F100\nG0 X1\n{code} X1\nM2\n".encode()).error
    assert error is not None and "begins where it ends" in error.text


def test_parameters_tell_where_it_stopped_and_that_nothing_was_touched() -> None:
    program = read("G20 F9\n#5070=7\n#5061=3\nG0 X1\nG10 L2 P1 X.5\nG38.3 X1.5\nG1 X#5070 Y#5061\nM2\n")
    assert ends(program)[-1] == pytest.approx((0.5 * 25.4, 1.5 * 25.4, 0))


def test_a_loop_until_nothing_is_touched_ends() -> None:
    text = "G21 F100\n#5070=1\no1 while [#5070 ne 0]\nG38.5 Z0\nG38.3 X5\no1 endwhile\nG1 X9\nM2\n"
    assert [end[0] for end in ends(read(text))] == [5, 9]
