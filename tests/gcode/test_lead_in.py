"""The lead-in of a restart does on each control what the control's own post does: off the work first, no length by
itself.
"""

import re
from dataclasses import replace

import numpy as np
import pytest

from app.gcode.interpreter.dialect import Dialect
from app.gcode.interpreter.options import ReadOptions, ToolOffset
from app.gcode.interpreter.program import EventKind
from app.gcode.interpreter.reader import read_program
from app.gcode.rework.restart import RestartOptions, restart

TOOLS = {1: ToolOffset((0.0, 0.0, 80.0), 6.0), 2: ToolOffset((0.0, 0.0, 55.0), 3.0)}
PART = b"""%
O0001
G17 G21 G90 G94 G40 G49 G80
G54
HOME
T1 M6
G0 G43 H1 Z5.
S12000 M3
G4 P2000
M8
X12. Y12.
Z1.
G1 Z-1. F200.
X32. F600.
Y22.
G0 Z5.
M5
HOME
T2 M6
G0 G43 H2 Z5.
S18000 M3
X10. Y7.
Z1.
G1 Z-1. F200.
X34. F450.
G0 Z5.
M30
%
"""
HOMES = {Dialect.FANUC: b"G91 G28 Z0.\nG90", Dialect.HAAS: b"G53 G0 Z0."}


def part_for(dialect: Dialect) -> tuple[bytes, RestartOptions]:
    return PART.replace(b"HOME", HOMES[dialect]), RestartOptions(ReadOptions(dialect, TOOLS, block_delete=False))


def lead_in_lines(data: bytes, line: int, options: RestartOptions) -> list[str]:
    """The blocks of a restart before the file's own text."""
    made = restart(data, line, options)
    rest = data.split(b"\n", line - 1)[-1]
    assert made.endswith(rest)
    return made[: len(made) - len(rest)].decode().split("\n")[:-1]


@pytest.mark.parametrize(("dialect", "home"), [(Dialect.FANUC, ["G91 G28 Z0.", "G90"]), (Dialect.HAAS, ["G53 G0 Z0."])])
def test_home_then_tool_then_its_length_with_z_and_a_dwell_in_milliseconds(dialect, home):
    data, options = part_for(dialect)
    line = data.split(b"\n").index(b"Y22.") + 1
    assert lead_in_lines(data, line, options) == [
        "%",
        "O0001",
        f"(RESTART FROM LINE {line})",
        "(Y22.)",
        "G21 G17 G90 G94 G40 G49 G80",
        "G54",
        *home,
        "T1 M6",
        "G0 G43 H1 Z5.",
        "S12000 M3",
        "G4 P3000",
        "M8",
        "G0 X32. Y12.",
        "G0 Z1.",
        "G1 Z-1. F200.",
        "G98",
        "F600.",
    ]


@pytest.mark.parametrize("dialect", list(HOMES))
def test_from_every_line_nothing_is_touched_before_z_is_home_and_no_length_stands_alone(dialect):
    data, options = part_for(dialect)
    begun = 0
    for line in (
        number for number, text in enumerate(data.split(b"\n")[:-2], 1) if number > 3 and text not in (b"G90", b"%")
    ):
        lines = lead_in_lines(data, line, options)
        words = "\n".join(lines)
        assert not re.search(r"^G43 H\d+$", words, re.M), words
        assert not re.search(r"G4 P\d*\.", words), words
        touched = [row for row, text in enumerate(lines) if re.match(r"T\d|S\d|G0 |G1 |M[378]$", text)]
        if any("T1" in text or "T2" in text for text in lines[4:]):
            assert lines.index(HOMES[dialect].decode().split("\n")[0]) <= touched[0], words
            begun += 1
    assert begun >= 15


@pytest.mark.parametrize("dialect", list(HOMES))
def test_with_a_length_in_force_at_home_z_goes_to_clearance_with_it_and_home_again(dialect):
    data, options = part_for(dialect)
    line = data.split(b"\n").index(b"T2 M6") + 1
    words = "\n".join(lead_in_lines(data, line, options))
    assert "G0 G43 H1 Z5.\n" in words
    assert words.rindex(HOMES[dialect].decode()) > words.index("G43 H1")
    assert words.index("T1 M6") > words.index(HOMES[dialect].decode())


@pytest.mark.parametrize("dialect", list(HOMES))
def test_home_is_gone_to_also_where_the_program_has_not_moved_yet(dialect):
    data = b"%\nO1\nG21 G90 G54\nT1 M6\nS900 M3\nG0 X1. Y2.\nG43 H1 Z5.\nG1 Z-1. F50.\nM30\n%\n"
    read = ReadOptions(dialect, TOOLS, start=(3.0, 4.0, 50.0), block_delete=False)
    lines = lead_in_lines(data, 6, RestartOptions(read))
    assert lines.index(HOMES[dialect].decode().split("\n")[0]) < lines.index("T1 M6") < lines.index("S900 M3")


@pytest.mark.parametrize("dialect", list(HOMES))
def test_clearance_is_no_machine_home_however_the_work_offset_lies(dialect):
    data, options = part_for(dialect)
    data = data.replace(b"G54\n", b"G54\nG10 L2 P1 X-100. Y-50. Z-300.\n")
    line = data.split(b"\n").index(b"Y22.") + 1
    assert "G0 G43 H1 Z5." in lead_in_lines(data, line, options)


def test_the_first_motion_of_a_lead_in_is_along_z_alone():
    for dialect in (Dialect.FANUC, Dialect.HAAS, Dialect.LINUXCNC, Dialect.MACH3):
        data = part_for(Dialect.HAAS)[0] if dialect is Dialect.HAAS else part_for(Dialect.FANUC)[0]
        data = (
            data if dialect in HOMES else re.sub(rb"%\n|O0001\n|G91 G28 Z0.\nG90\n", b"", data).replace(b"P2000", b"P2")
        )
        options = RestartOptions(ReadOptions(dialect, TOOLS, start=(7.0, 8.0, 90.0), block_delete=False))
        line = data.split(b"\n").index(b"Y22.") + 1
        again = read_program(restart(data, line, options), options.read)
        ways = again.motions.end - again.motions.start
        first = int(np.flatnonzero(np.any(ways != 0, axis=1))[0])
        assert np.all(ways[first, :2] == 0), dialect
        change = next(event for event in again.events if event.kind is EventKind.TOOL_CHANGE)
        assert (change.before > 0) == (dialect in HOMES), "home before the tool where the control has words for it"


@pytest.mark.parametrize(
    ("dialect", "told"),
    [
        (Dialect.LINUXCNC, True),
        (Dialect.GRBL, True),
        (Dialect.MACH3, True),
        (Dialect.FANUC, False),
        (Dialect.HAAS, False),
    ],
)
def test_where_no_words_go_home_the_operator_is_told_to_stand_clear(dialect, told):
    data = b"G21\nG0 Z5.\nG0 X1. Y2.\nM3 S9000\nG1 Z-1. F50.\nX5.\nM30\n"
    lines = lead_in_lines(data, 6, RestartOptions(ReadOptions(dialect)))
    assert ("(THE TOOL MUST STAND CLEAR ABOVE THE WORK BEFORE THE START)" in lines[:3]) == told


def test_a_dwell_with_a_point_stays_in_seconds_where_the_control_counts_seconds():
    data, options = b"G21\nM3 S900\nG0 Z5\nG0 X1 Y2\nG1 Z-1 F50\nX5\nM2\n", RestartOptions(ReadOptions(), spin_up=1.5)
    assert "G4 P1.5" in lead_in_lines(data, 6, options)
    for dialect in HOMES:
        dotted = data.replace(b"5\n", b"5.\n").replace(b"X1 Y2", b"X1. Y2.").replace(b"Z-1", b"Z-1.")
        assert "G4 P1500" in lead_in_lines(dotted, 6, replace(options, read=ReadOptions(dialect)))
