"""Restart from a line: the rest of the program exactly, a way there that is safe, and a clear no where there is
none.
"""

import re
from dataclasses import replace

import numpy as np
import pytest

from app.core.errors import InputError
from app.gcode.interpreter.dialect import Dialect
from app.gcode.interpreter.options import ReadOptions
from app.gcode.interpreter.program import EventKind, NcProgram
from app.gcode.interpreter.reader import read_program
from app.gcode.rework.compare import compare
from app.gcode.rework.restart import RestartOptions, restart
from app.model.motion import MotionKind, Motions
from tests.gcode.interpreter.rs274_motions import TOOLS, assert_as_rs274

READ = ReadOptions(tool_table=TOOLS, block_delete=False)
OPTIONS = RestartOptions(READ)
HEADER = "G21 G17 G90 G94 G40 G49 G80\nG54 G64 P0.01\nT1 M6\nG43 H1\nS12000 M3\nG4 P2\nM8\nG0 Z15\n"
PART = (
    HEADER
    + """G0 X10 Y20
G0 Z2
G1 Z-1 F150
G1 X30 F800
G3 X40 Y30 I0 J10
(a comment)
X40 Y50 I0 J10
G2 X30 Y60 I-10 J0
G1 X10
Y20
G0 Z15
M5
T2 M6
G43 H2
S18000 M3
G0 X-5 Y-5
Z1
G1 Z-2 F90
X5 Y5 F400
G0 Z15
M9
M30
"""
)


def rest_of(program: NcProgram, line: int) -> NcProgram:
    """The motions, one tail of the columns, that a program without jumps does from a line on."""
    return tail(program, int(np.count_nonzero(program.motions.line >= line)))


def tail(program: NcProgram, count: int) -> NcProgram:
    motions = program.motions
    first = len(motions) - count
    names = ("start", "end", "centre", "kind", "plane", "turns", "feed", "line", "state")
    events = tuple(replace(event, before=event.before - first) for event in program.events if event.before > first)
    return NcProgram(Motions(*(getattr(motions, name)[first:].copy() for name in names)), program.states, events)


def assert_goes_on(data: bytes, line: int, options: RestartOptions = OPTIONS) -> NcProgram:
    """The restart program does what the original does from the line on, after a way there that is safe; return it."""
    made = restart(data, line, options)
    assert made.endswith(b"\n".join(data.split(b"\n")[line - 1 :])), "the text behind is not the file's own"
    original, again = read_program(data, options.read), read_program(made, options.read)
    assert (original.error, again.error) == (None, None)
    meant = rest_of(original, line)
    found = compare(meant, tail(again, len(meant.motions)), 1e-5)
    assert found.items == ()
    assert [run.count for run in found.runs] == [len(meant.motions)] if len(meant.motions) else found.runs == ()
    return again


@pytest.mark.parametrize("line", range(1, PART.count("\n") + 1))
def test_every_line_of_a_part_program_can_be_begun_from_and_linuxcnc_agrees(line):
    data = PART.encode()
    if line in (14, 15):
        with pytest.raises(
            InputError, match=r"goes on with words of a line before|would not go on as the program does"
        ):
            restart(data, line, OPTIONS)
        return
    assert_goes_on(data, line)
    assert_as_rs274(restart(data, line, OPTIONS), READ)


@pytest.mark.parametrize("name", ["test_pycam.ngc", "tux.ngc", "jsdc.gcode"])
def test_real_programs_go_on_from_every_so_manieth_line(data, name):
    text = (data / "nc" / name).read_bytes()
    lines = text.count(b"\n")
    begun = 0
    for line in range(lines // 50, lines, lines // 12):
        assert_goes_on(text, line)
        begun += 1
    assert begun >= 10
    if name != "jsdc.gcode":  # which has no end, so that LinuxCNC refuses it
        assert_as_rs274(restart(text, lines // 2, OPTIONS), READ)


def lead_in_of(made: bytes, rest: int) -> list[tuple[MotionKind, tuple[float, float, float]]]:
    program = read_program(made, READ)
    ends, kinds = program.motions.end.tolist(), program.motions.kind.tolist()
    return [(MotionKind(kind), tuple(end)) for kind, end in zip(kinds, ends, strict=True)][: len(kinds) - rest]


def test_the_tool_goes_up_across_and_down_before_anything_else():
    made = restart(PART.encode(), 16, OPTIONS)
    rest = int(np.count_nonzero(read_program(PART.encode(), READ).motions.line >= 16))
    assert lead_in_of(made, rest)[:4] == [
        (MotionKind.RAPID, (0.0, 0.0, 15.0)),
        (MotionKind.RAPID, (40.0, 50.0, 15.0)),
        (MotionKind.RAPID, (40.0, 50.0, 1.0)),
        (MotionKind.LINE, (40.0, 50.0, -1.0)),
    ]


def test_everything_in_force_is_set_before_the_first_motion():
    text = restart(PART.encode(), 12, OPTIONS).decode()
    head = text.split("G0 Z15.\n")[0]
    assert re.findall(r"^(?:T\d+ M6|G43 H\d+|S\d+ M3|G4 P\S+|M8|G54|G21 .*)$", head, re.M) == [
        "G21 G17 G90 G94 G40 G49 G80",
        "G54",
        "T1 M6",
        "G43 H1",
        "S12000 M3",
        "G4 P3.",
        "M8",
    ]
    assert "G0 X10. Y20.\nG0 Z1.\nG1 Z-1. F90.\n" in text, "down at the slowest plunge of the program"
    assert "\nG64 P0.01\n" in text
    program = read_program(text.encode(), READ)
    state = program.states[program.motions.state[0]]
    assert (state.tool, state.length_offset, state.spindle, state.speed, state.flood) == (1, 1, 1, 12000.0, True)
    assert [event.kind for event in program.events[:2]] == [EventKind.TOOL_CHANGE, EventKind.DWELL]


def test_clearance_approach_and_feed_can_be_chosen():
    text = restart(
        PART.encode(), 12, RestartOptions(READ, clearance=40.0, approach=0.5, plunge_feed=33.0, spin_up=0.0)
    ).decode()
    assert "G0 Z40.\nG0 X10. Y20.\nG0 Z-0.5\nG1 Z-1. F33.\n" in text
    assert "G4" not in text.split("G1 X30")[0]


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("G20\nG90\nG0 Z1\nG0 X1 Y2\nG1 Z-.1 F5\nG1 X2\nG1 Y3\nM2\n", 6),
        ("G21\nG90\nG0 Z5\nG0 X10 Y10\nG91\nG1 Z-6 F100\nX5\nY5\nX-5\nG90\nG0 Z5\nM2\n", 8),
        ("G21\nG0 Z5\nG0 X10 Y0\nG18\nG1 Z0 F100\nG3 X0 Z10 I-10 K0\nG0 Z20\nG17\nG2 X10 Y0 I5 J0\nM2\n", 6),
        ("G21\nG10 L2 P2 X100 Y50 Z-20 R30\nG55\nG0 Z5\nG0 X1 Y2\nG1 Z-1 F100\nG1 X9\nG1 Y9\nG54\nG0 Z50\nM2\n", 7),
        ("G21\nG0 Z5\nG0 X1 Y2\nG92 X0 Y0 Z0\nG1 Z-6 F50\nG1 X5\nG92.1\nG0 Z9\nM2\n", 6),
        ("G21\nG0 Z5\nG52 X10 Y20\nG0 X1 Y2\nG1 Z-6 F50\nG1 X5\nG52 X0 Y0\nG0 Z9\nM2\n", 6),
        ("G21\n#1=5\n#<depth>=-2.5\n#100=[#1*2]\nG0 Z5\nG0 X1 Y2\nG1 Z#<depth> F50\nG1 X#1\nG1 Y#100\nM2\n", 8),
        (
            "o100 sub\nG1 X[#1] F80\no100 endsub\nG21\nG0 Z5\nG0 X1 Y2\nG1 Z-1 F50\no100 call [7]\nG1 Y3\no100 call "
            "[9]\nM2\n",
            8,
        ),
        ("G21\nG0 Z5\nG0 X1 Y2\nG93\nG1 Z-1 F2\nG1 X5 F3\nG1 Y9 F4\nG94\nG0 Z9\nM2\n", 6),
        ("G21 S1000 M3\nG0 Z5\nG0 X1 Y2\nG95\nG1 Z-1 F.1\nG1 X5\nG1 Y9\nG94\nG0 Z9\nM2\n", 6),
        ("G21\nG90.1\nG0 Z5\nG0 X10 Y0\nG1 Z-1 F50\nG2 X0 Y10 I0 J0\nG1 X0 Y0\nM2\n", 6),
        ("G21 G61\nT3\nG0 Z5\nG0 X10 Y0 M4 S500 M7\nG1 Z-1 F50\nG1 X0 Y0\nM6\nG0 Z9\nM2\n", 6),
        ("G21\nG0 Z5\nG0 X1 Y1\nG98 G81 X5 Y5 Z-2 R1 F100\nX9\nG80\nG0 Z9\nX4\nM2\n", 7),
        ("G21\nG0 Z5\nG0 X1 Y1\nG99 G81 X5 Y5 Z-2 R1 F100\nX9\nG80\nG0 Z9\nX4\nM2\n", 4),
        ("%\nG21\nG0 Z5\nG0 X1 Y1\nG1 Z-1 F50\nX4\n%\n", 6),
    ],
)
def test_whatever_is_in_force_is_set_again_and_linuxcnc_agrees(text, line):
    assert_goes_on(text.encode(), line)
    assert_as_rs274(restart(text.encode(), line, OPTIONS), READ)


@pytest.mark.parametrize(
    ("dialect", "text", "line", "has"),
    [
        (Dialect.GRBL, "G21\nG0 Z5\nG0 X1 Y2\nM3 S9000\nG1 Z-1 F50\nG1 X5\nM5\nM2\n", 6, "G0 Z5.\nG0 X1. Y2.\n"),
        (
            Dialect.GRBL,
            "G21\nG0 Z5\nG0 X1 Y2\nG92 X0 Y0 Z0\nG1 Z-6 F50\nG1 X5\nM2\n",
            6,
            "G0 Z5.\nG0 X1. Y2.\nG92 X0. Y0. Z0.\n",
        ),
        (
            Dialect.FANUC,
            "%\nO0012 (PART)\nG21 G90 G54\nT3 M6\nG43 H3 Z5.\nG0 X1. Y2.\nG1 Z-1. F50.\nX5.\nM30\n%\n",
            8,
            "%\nO0012 (PART)\n(RESTART",
        ),
        (
            Dialect.FANUC,
            "%\nO0012\nG21 G90 G54\nG0 X1. Y2. Z5.\nM98 P20 L2\nG0 X9.\nM30\nO0020\nG1 Z-1. F50.\nG0 Z5.\nM99\n%\n",
            5,
            "M98 P20 L2",
        ),
        (
            Dialect.HAAS,
            "%\nO1\nG21 G90 G54\nT1 M6\nG43 H1 Z5.\nG0 X1. Y2.\nG1 Z-1. F50.\nG53 G0 Z0.\nT2 M6\nG43 H2 "
            "Z5.\nX5.\nM30\n%\n",
            9,
            "G53 G0 Z0.\n",
        ),
        (
            Dialect.HAAS,
            "%\nO1\nG21 G90 G54\nT1 M6\nG43 H1 Z5.\nG0 X1. Y2.\nG1 Z-1. F50.\nG91 G28 Z0.\nG90\nT2 M6\nG43 H2 "
            "Z5.\nM30\n%\n",
            10,
            "G91 G28 Z0.\nG90\nG0 X1. Y2.\n",
        ),
        (
            Dialect.LINUXCNC,
            "G21 G90 G54\nG0 Z5\nG0 X1 Y2\nG1 Z-1 F50\nG30\nT2 M6\nG43 H2\nG0 Z5\nX5\nM30\n",
            6,
            "G91 G30 Z0.\nG90\nG91 G30 X0. Y0.\nG90\n",
        ),
        (Dialect.MACH3, "G21\nG52 X5 Y6\nG0 Z5\nG0 X1 Y2\nG1 Z-1 F50\nG1 X5\nM30\n", 6, "G52 X5. Y6. Z0.\n"),
    ],
)
def test_other_controls_get_their_own_words(dialect, text, line, has):
    options = RestartOptions(ReadOptions(dialect))
    made = restart(text.encode(), line, options)
    assert has in made.decode()
    original, again = read_program(text.encode(), options.read), read_program(made, options.read)
    assert (original.error, again.error) == (None, None)
    assert np.allclose(again.motions.end[-2:], original.motions.end[-2:])


@pytest.mark.parametrize(
    ("text", "line", "told"),
    [
        (PART, 0, "Line 0 is not there: the program has 30 lines"),
        (PART, 31, "Line 31 is not there"),
        (PART + "G0 X99\n", 31, "never comes to line 31: it ends before, at line 30"),
        ("G0 X1 Y1 Z1\nG1 X1 F-5\nG1 X2\n", 3, "stands behind an error.*line:2:7: F-5"),
        ("o1 sub\nG0 X1 Y1 Z1\nG0 X2\no1 endsub\no1 call\nM2\n", 3, "within a subroutine or a loop"),
        ("o1 sub\nG0 X1 Y1 Z1\no1 endsub\nM2\n", 2, "never comes to line 2"),
        ("G0 X1 Y1 Z1\no1 repeat [3]\nG0 X2\no1 endrepeat\nM2\n", 3, "within a subroutine or a loop"),
        ("G0 X1 Y1 Z1\no1 if [1]\nG0 X2\no1 endif\nM2\n", 3, "within what O1 begins before and ends at line 4"),
        (
            "G0 X1 Y1 Z9\nG81 X2 Y2 Z-1 R1 F50\nX4\nX6\nG80\nM2\n",
            4,
            "run of a canned cycle; start at the line that begins it, 2",
        ),
        ("G17\nG0 X0 Y0 Z1\nG5.2 P1 X0 Y1 F50\nX1 Y2 P1\nX3 Y0 P1\nG5.3\nM2\n", 5, "within a spline"),
        ("G91\nG0 X1 Y1 Z1\nX2\nM2\n", 3, "where X is there depends on where the tool stood when the program began"),
        ("G0 X3 Y3\nG0 Z5\nM2\n", 2, "where Z is there"),
        ("G0 Z5\nG1 Z1 F99\nG1 X3 Y3\nG0 Z9\nM2\n", 3, "Where X is at this line the program does not say"),
        ("G92 X0 Y0 Z0\nG0 X1 Y1 Z5\nG1 Z-1 F50\nM2\n", 3, "a zero that the program sets from where the tool was"),
        ("G0 X1 Y1 Z5\n#1=5\nG43.1 Z9\nG1 Z-1 F50\nM2\n", 4, "a tool length that is not one of the tool table"),
        ("G0 X1 Y1 Z5\nG10 L1 P1 Z9\nG1 Z-1 F50\nM2\n", 3, "behind a change of the tool table"),
        (
            "#5=#5420\nG0 X1 Y1 Z5\nG1 X#5 F50\nM2\n",
            3,
            r"parameters \(#\) that the program takes from where the tool stood",
        ),
        ("G0 X1 Y1 Z5\nG41.1 D2\nG1 X5 F50\nG1 Y9\nG1 X7\nG40\nM2\n", 5, "under cutter compensation"),
        ("%\nG0 X1 Y1 Z5\n%\n", 1, "the program's beginning.*start at line 2|never comes to line 1"),
    ],
)
def test_where_it_cannot_be_safe_it_says_why(text, line, told):
    with pytest.raises(InputError, match=told):
        restart(text.encode(), line, OPTIONS)


@pytest.mark.parametrize(
    "data",
    [
        PART.replace("\n", "\r\n").encode(),
        b"\xef\xbb\xbf" + PART.encode(),
        PART.replace("a comment", "Fräser").encode("latin-1"),
        PART[:-1].encode(),
    ],
)
def test_the_text_behind_is_the_files_own_byte_for_byte(data):
    made = restart(data, 19, OPTIONS)
    ends = [0, *(end.end() for end in re.finditer(b"\n", data))]
    assert made.endswith(data[ends[18] :])
    assert (b"\r\n" in made) == (b"\r\n" in data)
    assert b"\xef\xbb\xbf" not in made
    assert read_program(made, READ).error is None


@pytest.mark.parametrize(
    "name", ["fanuc_mm.nc", "grbl_inch_2_T2.nc", "haas_inch.nc", "linuxcnc_inch.ngc", "mach3_mm.tap"]
)
def test_what_the_posts_write_can_be_begun_from_nearly_every_line_and_never_across_below_clearance(root, name):
    data = (root / "tests" / "gcode" / "golden" / name).read_bytes()
    options = RestartOptions(ReadOptions(Dialect(name.split("_")[0].split(".")[0])))
    original = read_program(data, options.read)
    refused = 0
    for line in range(1, original.line_count):
        try:
            made = restart(data, line, options)
        except InputError:
            refused += 1
            continue
        again = read_program(made, options.read)
        motions, home = again.motions, False
        for row in range(len(motions) - int(np.count_nonzero(original.motions.line >= line))):
            across = np.any(np.abs(motions.end[row, :2] - motions.start[row, :2]) > 1e-6)
            high = min(motions.start[row, 2], motions.end[row, 2]) >= original.motions.end[:, 2].max() - 1e-4
            home = row in again.homeward or (home and motions.start[row, 2] == motions.end[row, 2])
            assert not across or (motions.kind[row] == MotionKind.RAPID and (high or home)), (line, made)
    assert refused <= 5


def test_parameters_that_nobody_asks_for_are_left_out():
    assert b"#" not in restart(b"G21\n#1=5\nG0 X#1 Y1 Z5\nG1 Z-1 F50\nM2\n", 4, OPTIONS)
