"""The compiled lane for lines of any kind: it does what the reader's core does block by block, to the last bit, and
leaves it the rest.
"""

import math
from unittest.mock import patch

import numpy as np
import pytest

from app.gcode.interpreter.dialect import Dialect
from app.gcode.interpreter.fast_lane import FastLane
from app.gcode.interpreter.options import ReadLimits, ReadOptions
from app.gcode.interpreter.places import Cursor
from app.gcode.interpreter.program import EventKind, NcProgram
from app.gcode.interpreter.reader import read_program, read_steps
from tests.examples import examples
from tests.gcode.interpreter.any_lines import AnyLines

COLUMNS = ("start", "end", "centre", "kind", "plane", "turns", "feed", "line", "state")


def assert_same(text: str, options: ReadOptions) -> NcProgram:
    """Assert that both ways give the same motions, states, events and problems."""
    quick, (slow, _) = read_program(text.encode(), options), read_steps(text.encode(), options)
    for name in COLUMNS:
        assert np.array_equal(getattr(quick.motions, name), getattr(slow.motions, name), equal_nan=True), (name, text)
    assert quick.motions.known_from == slow.motions.known_from, text
    assert (quick.states, quick.events, quick.problems) == (slow.states, slow.events, slow.problems), text
    return quick


def mended(lines: list[str], options: ReadOptions) -> str:
    """Return the program without the lines at which its reading ends."""
    while True:
        text = "\n".join([*lines, "M2", ""])
        error = read_steps(text.encode(), options).program.error
        if error is None:
            return text
        del lines[error.line - 1]


@pytest.mark.parametrize("dialect", Dialect)
def test_lines_of_every_kind_are_read_alike(dialect: Dialect) -> None:
    """As they are up to their first fault, and without the lines that have one."""
    motions, options = 0, ReadOptions(dialect)
    for seed in range(examples(60) * (3 if dialect is Dialect.LINUXCNC else 1)):
        lines = AnyLines(seed).program(30)
        assert_same("\n".join([*lines, "M2", ""]), options)
        motions += len(assert_same(mended(lines, options), options).motions)
    assert motions > examples(60)


DONE = [
    "G17 G90 G21",
    "S1000 M3",
    "M3 S[100*2]",
    "M8",
    "M9",
    "T2",
    "M6",
    "G4 P0.5",
    "M0",
    "M1",
    "G54",
    "G40",
    "G49",
    "G80",
    "G94",
    "#1=2",
    "#[1+1]=[#1*3]",
    "G1 X[#1+1] F100",
    "G1 X-#1",
    "G1 Y[2 mod 3]",
    "G1 X ATAN[1]/[2]",
    "G1 X[2**3]",
    "G1 X#[1+0]",
    "G1",
    "G2 I1",
    "G98",
    "G99",
    "G90.1",
    "G91",
    "N5 G91 G1 X1",
    "G81 X1 Y2 Z-3 R1",
    "G82 Z-1 R1 P0.1",
    "G83 Z-5 R1 Q2",
    "G73 Z-5 R1 Q2",
    "G85 Z-1 R0",
    "G89 Z-1 R0 P1",
    "G91 G81 X1 Z-1 R0 L3",
    "g 1 x 1 . 5",
    "G1 X1 (a) Y[1+1] ;b",
    "G1 X[sin[30]*cos[60]-tan[10]+sqrt[4]]",
    "G1 X[abs[-1]+fix[1.5]+fup[1.5]+round[1.5]+ln[2]+exp[1]+acos[0.5]+asin[0.5]]",
    "G1 X[[1 lt 2] and [2 ge 2]]",
]
LEFT = [
    "G1 X#<name>",
    "#<name>=1",
    "O1 if [1]",
    "G41 D1",
    "G43 H1",
    "G10 L2 P1 X1",
    "G92 X1",
    "G28",
    "G53 G0 X1",
    "G20",
    "G55",
    "G64 P0.1",
    "G1 X1 A2",
    "G84 Z-1 R1",
    "M2",
    "M98 P1",
    "G1 X1 X2",
    "G1 G0 X1",
    "M3 M4",
    "M7 M9",
    "M7 M8",
    "G0 N5 X1",
    "M70",
    "X#5602",
    "G81 Z-1",
    "G83 Z-1 R1",
    "G1 X1 P2",
    "G1 X1 R2",
    "X[1/0]",
    "X[1",
    "X1]",
    "X[sqrt[-1]]",
    "X#0",
    "X#5221",
    "#5001=1",
    "X[0**-1]",
    "X exists[#1]",
    "G1 X1 F0",
    "S-1",
    "T1.5",
    "G4",
    "G4 P-1",
    "G82 Z-1 R1",
    "G81 Z2 R1",
    "G81 Z-1 R1 L0",
    "G80 X1",
    "/X1",
    "@1",
    "G1.5",
    "M400",
]


@pytest.mark.parametrize("text", DONE)
def test_it_does(text: str) -> None:
    assert _lines_done(text) == 3


@pytest.mark.parametrize("text", LEFT)
def test_it_leaves_to_the_core(text: str) -> None:
    assert _lines_done(text) == 2


def _lines_done(text: str) -> int:
    """Return how many lines of a program whose third line is `text` are done at the lane's first call."""
    ends: list[int] = []
    run = FastLane.run

    def counted(self: FastLane, begin: Cursor, stop: int) -> Cursor:
        behind = run(self, begin, stop)
        ends.append(behind.line)
        return behind

    program = f"#1=5 F100\nG0 X5 Y0 Z9\n{text}\nO2 if [0]\nO2 endif\nM2\n"
    with patch.object(FastLane, "run", counted):
        read_program(program.encode())
    assert_same(program, ReadOptions())
    return ends[0] - 1


def test_values_in_closed_form() -> None:
    text = (
        "#1=3 #2=4\n#3=[sqrt[#1**2+#2**2]]\nG0 X#3 Y[-7 mod 5] Z[2*3+4/2-1]\nX[atan[1]/[1]] Y[sin[30]] "
        "Z[1+2*3**2]\nM2\n"
    )
    ends = read_program(text.encode()).motions.end
    assert np.allclose(ends, [[5.0, 3.0, 7.0], [45.0, 0.5, 19.0]], rtol=0, atol=1e-12)


def test_parameters_are_set_after_all_of_the_line_is_known() -> None:
    ends = read_program(b"#1=1\n#1=2 #2=#1 G0 X#1\nG0 X#1 Y#2\nM2\n").motions.end
    assert ends[:, 0].tolist() == [1.0, 2.0] and ends[1, 1] == 1.0


def test_what_is_in_force_is_told_of_every_motion() -> None:
    program = read_program(b"G0 X1\nS100 M3\nX2\nM8 T3\nM6\nX3\nM3\nG4 P2\nX4\nM2\n")
    states = [program.states[k] for k in program.motions.state]
    assert [(s.speed, s.spindle, s.tool) for s in states] == [(0, 0, 0), (100, 1, 0), (100, 0, 3), (100, 1, 3)]
    assert [s.flood for s in states] == [False, False, True, True]
    told = [(event.kind, event.before, event.line, event.value) for event in program.events]
    assert told == [(EventKind.TOOL_CHANGE, 2, 5, 3.0), (EventKind.DWELL, 3, 8, 2.0), (EventKind.END, 4, 10, 0.0)]


def test_a_subroutine_has_parameters_of_its_own() -> None:
    text = b"O1 sub\n#1=[#1+1]\nG0 X#1\nO1 endsub\n#1=50 #31=7\nO1 call [2]\nG0 X#1 Y#31\nM2\n"
    assert read_program(text).motions.end[:, :2].tolist() == [[3.0, 0.0], [50.0, 7.0]]


def test_holes_are_counted_against_the_limit_of_the_program() -> None:
    """Three motions a hole: what the lane may not do any more the core refuses, at the same line."""
    text = "G0 X0 Y0 Z5\nF100\nG81 X1 Y1 Z-1 R1\n" + "X2\n" * 20 + "M2\n"
    program = assert_same(text, ReadOptions(limits=ReadLimits(looped_blocks=20)))
    assert program.error is not None and "more than 20 blocks" in program.error.text and program.error.line == 9


def test_motions_end_at_the_limit() -> None:
    program = assert_same("F100\nG81 X1 Y1 Z-1 R1\n" + "X2\n" * 20 + "M2\n", ReadOptions(limits=ReadLimits(motions=10)))
    assert len(program.motions) == 10 and program.error is not None and "10 motions" in program.error.text


def test_states_and_cycles_last_over_many_calls() -> None:
    """More lines than the lane does at once."""
    lines = [f"S{k % 7} M{3 + k % 3} X{k % 11} Z[{k % 5}*2]" for k in range(10_000)]
    program = assert_same("\n".join(["G1 F100", *lines, "M2", ""]), ReadOptions())
    assert (
        len(program.motions) == 10_001
        and len(program.states) <= 22
        and math.isclose(program.motions.end[-1, 0], 9_999 % 11)
    )
