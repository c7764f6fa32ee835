"""What is in force: units, feeds, offsets, tools, spindle, coolant, path control; and how dialects differ."""

import math

import pytest

from app.gcode.interpreter.dialect import Dialect
from app.gcode.interpreter.options import ToolOffset
from app.gcode.interpreter.program import EventKind, FeedMode, ModalState, NcProgram
from app.model.motion import MotionKind, Plane
from app.model.part import Units
from tests.gcode.interpreter.programs import ends, kinds, read, told, warnings


def last(program: NcProgram) -> ModalState:
    return program.states[program.motions.state[-1]]


def test_every_motion_knows_what_is_in_force() -> None:
    text = (
        "G20 G18 G91 G91.1 G61.1 T7 M6 G43 S1500 M4 M8 G55 G99\nG0 X1\nG17 G21 G90 M5 G64 P0.02 Q0.01 G54 "
        "G98\nM9\nM7\nG1 X5 F300\nM2\n"
    )
    program = read(text, tool_table={7: ToolOffset((0, 0, 50), 6)})
    first, second = program.states[program.motions.state[0]], last(program)
    assert (first.units, first.plane, first.absolute, first.tool, first.length_offset) == (
        Units.INCH,
        Plane.ZX,
        False,
        7,
        7,
    )
    assert (first.speed, first.spindle, first.flood, first.mist, first.work_offset) == (1500, -1, True, False, "G55")
    assert (first.path, first.path_tolerance, first.retract_to_r) == ("G61.1", 0.0, True)
    assert (second.units, second.plane, second.absolute, second.spindle) == (Units.MM, Plane.XY, True, 0)
    assert (second.flood, second.mist) == (False, True)
    assert (second.path, second.path_tolerance, second.work_offset, second.retract_to_r) == (
        "G64 P0.02 Q0.01",
        0.02,
        "G54",
        False,
    )
    assert program.motions.line.tolist() == [2, 6]


def test_inches() -> None:
    program = read("G20\nF10\nG1 X1 Y.5\nG2 X2 I.5\nM2\n")
    assert ends(program) == [(25.4, 12.7, 0), (50.8, 12.7, 0)]
    assert program.motions.centre[1, :2] == pytest.approx((38.1, 12.7))
    assert program.motions.feed.tolist() == [254, 254]


def test_only_linuxcnc_takes_a_feed_in_the_units_before_its_block() -> None:
    assert read("G20 F10\nG1 X1\nM2\n").motions.feed[0] == 10
    assert read("G20 F10\nG1 X1.\nM30\n", Dialect.FANUC).motions.feed[0] == 254


def test_feed_modes() -> None:
    program = read("G93 G1 X30 F2\nX40 F4\nG94 F100 X50\nG95 S500 M3 F.1 X60\nM2\n")
    assert program.motions.feed.tolist() == [60, 40, 100, 50]
    assert last(program).feed_mode is FeedMode.PER_REVOLUTION
    assert "needs a feed rate" in told("G93 G1 X1 F2\nX2\n")
    assert "a.ngc:2" in told("G93 G1 X1 F2\nG94 X2\n")


def test_offsets_add_up() -> None:
    text = (
        "G10 L2 P1 X10 Y20 Z1\nG10 L2 P2 X100\nG0 X1 Y1 Z1\nG55 X1\nG54 G92 X0\nG0 X2\nG92.2\nX2\nG92.3\nX2\nG92.1 "
        "X2\nM2\n"
    )
    assert ends(read(text.replace("G92.1 X2", "G92.1\nX2"))) == [
        (11, 21, 2),
        (101, 21, 2),
        (103, 21, 2),
        (12, 21, 2),
        (103, 21, 2),
        (12, 21, 2),
    ]


def test_local_offsets_of_linuxcnc_and_fanuc() -> None:
    assert ends(read("G92 X5\nG52 X10\nG0 X1\nM2\n")) == [(11, 0, 0)]
    assert ends(read("G0 Y2\nG92 Y0\nG92.2\nG52 X1\nG0 X0 Y3\nM2\n"))[-1] == (1, 3, 0)
    assert ends(read("G92 X5.\nG52 X10.\nG0 X1.\nG52 X0.\nX1.\nM30\n", Dialect.FANUC)) == [(6, 0, 0), (-4, 0, 0)]


def test_a_turned_work_offset() -> None:
    program = read("G10 L2 P1 X10 Y0 R90\nG54 F10\nG0 X1 Y2\nG1 X2\nG3 X3 Y3 J1\nM2\n")
    assert ends(program) == [(8, 1, 0), (8, 2, 0), (7, 3, 0)]
    assert program.motions.centre[2, :2] == pytest.approx((7, 2))
    assert program.states[program.motions.state[0]].rotation == pytest.approx(math.pi / 2)


def test_work_offsets_from_where_the_tool_is() -> None:
    assert ends(read("G0 X7 Y3\nG10 L20 P1 X0 Y1\nG0 X1 Y1\nM2\n"))[-1] == (8, 3, 0)


def test_machine_coordinates_and_home() -> None:
    text = "G10 L2 P1 X10\nG0 X1 Y5 Z3\nG53 G0 X0\nG28 Z9\nG28\nG0 X1\nG28.1\nG0 X5\nG28\nM2\n"
    assert ends(read(text)) == [
        (11, 5, 3),
        (0, 5, 3),
        (0, 5, 9),
        (0, 5, 0),
        (0, 5, 0),
        (0, 0, 0),
        (11, 0, 0),
        (15, 0, 0),
        (15, 0, 0),
        (11, 0, 0),
    ]


def test_tool_length_moves_the_controlled_point_not_the_machine() -> None:
    program = read("G0 Z10\nT2 M6 G43 H2\nG0 X1\nG0 Z10\nG49\nG0 X2\nM2\n", tool_table={2: ToolOffset((0, 0, 30))})
    assert ends(program) == [(0, 0, 10), (1, 0, -20), (1, 0, 10), (2, 0, 40)]
    assert program.motions.start[1].tolist() == [0, 0, -20]


def test_tool_tables() -> None:
    assert "tool 3 is not in the tool table" in told_with_table("G43 H3\n")
    assert last(read("G10 L1 P3 Z5 R2\nT3 M6 G43\nG0 Z1\n#1=#5410\nG0 X#1\nM2\n")).tool == 3
    assert ends(read("G10 L1 P3 Z5 R2\nT3 M6 G43\nG0 X#5410\nM2\n"))[-1] == (4, 0, -5)
    assert ends(read("G10 L10 P3 R20.\nG43 H3\nG0 X1.\nM30\n", Dialect.FANUC))[-1] == (1, 0, -20)


def told_with_table(text: str) -> str:
    from app.gcode.interpreter.options import ReadOptions
    from app.gcode.interpreter.reader import read_program

    error = read_program(text.encode(), ReadOptions(tool_table={1: ToolOffset()})).error
    return error.text if error else ""


def test_events() -> None:
    program = read("T4\nM6\nG4 P1.5\nG0 X1\nM0\nM1\nM30\n")
    assert [(event.kind, event.before, event.line, event.value) for event in program.events] == [
        (EventKind.TOOL_CHANGE, 0, 2, 4),
        (EventKind.DWELL, 0, 3, 1.5),
        (EventKind.STOP, 1, 5, 0),
        (EventKind.OPTIONAL_STOP, 1, 6, 0),
        (EventKind.END, 1, 7, 0),
    ]


def test_numbers_without_a_point() -> None:
    assert ends(read("G0 X1000 Y1. Z-500\nM30\n", Dialect.FANUC)) == [(1, 1, -0.5)]
    assert ends(read("G20\nG0 X10000 Y1.\nM30\n", Dialect.HAAS)) == [(25.4, 25.4, 0)]
    program = read("G4 P500\nG4 P1.5\nG4 X2.\nG1 X1. F100\nM30\n", Dialect.FANUC)
    assert [event.value for event in program.events[:3]] == [0.5, 1.5, 2]
    assert program.motions.feed.tolist() == [100]


def test_what_only_some_controls_know() -> None:
    assert "grbl does not know G64" in told("G64\n", Dialect.GRBL)
    assert "grbl does not know M6" in told("T1 M6\n", Dialect.GRBL)
    assert "G43 needs a word H on a Fanuc control" in told("T1 M6\nG43 Z5.\n", Dialect.FANUC)
    assert "M123 is not known" in told("M123\n", Dialect.GRBL)
    assert any("M123 is the machine builder's own" in text for text in warnings("M123\n", Dialect.HAAS))
    assert any("M100" in text for text in warnings("M100\n"))
    assert "draws no curve" in told("G1 F1 X1\nG5 I1 J1 P1 Q1 X2\n", Dialect.FANUC)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("G41 D1", "a.ngc:1:5: D1: G41 needs the diameter of tool 1, which is in no tool table"),
        ("G0 X1 G1", "a.ngc:1:7: G0 and G1 in one block contradict one another (motion)"),
        ("G90 G91", "contradict one another (distance mode)"),
        ("M3 M5", "contradict one another (spindle)"),
        ("G0 X1 X2", "a.ngc:1:7: a block takes one word X only"),
        ("X1", "a.ngc:1:1: X1: there are axis words, but no G code that uses them is in force"),
        ("G80 X1", "no G code that uses them"),
        ("G1 X1", "a.ngc:1: a feed motion needs a feed rate"),
        ("G0 X1 R5", "a.ngc:1:7: R5: no code in this block takes this word."),
        ("G28 G1 X1", "both want its axis words"),
        ("G4", "G4 needs how long to wait"),
        ("G4 P-1", "a.ngc:1:4: P-1: the dwell is -1 s"),
        ("S-5", "a.ngc:1:1: S-5: the spindle speed is -5"),
        ("T1.5", "it must be a whole number"),
        ("F-1", "a.ngc:1:1: F-1: the feed rate is -1"),
        ("G92", "G92 needs axis words"),
        ("G10 L2 P99 X1", "a.ngc:1:8: P99: there is no work offset P99"),
        ("G10 P1", "G10 needs a word L"),
        ("G17.3", "G17.3 is not known"),
        ("M55", "M55 is not known"),
        ("G7", "the diameter mode of lathes"),
        ("G53 G81 X1", "G53 goes with G0 and G1 only"),
        ("G0 X1 (no end", "a.ngc:1:7: (: the comment has no end"),
        ("G0 (a (b) X1)", "a comment begins within another"),
        ("G0 X1 ä", "begins no word"),
        ("G33 Z1 K1", "needs a turning spindle"),
        ("G10 L2 P1 R30\nG18 F1 G2 X1 I.5", "a.ngc:2:8: G2: G2 in another plane than X Y is not followed"),
    ],
)
def test_what_is_wrong_is_told_with_its_place(text: str, expected: str) -> None:
    assert expected in told(text + "\n")


def test_only_linuxcnc_refuses_words_that_nothing_takes() -> None:
    assert ends(read("G0 X1. Q5\nM30\n", Dialect.FANUC)) == [(1, 0, 0)]
    assert any("Q stands in a block" in text for text in warnings("G0 X1. Q5\nM30\n", Dialect.FANUC))


def test_probing_and_threads_are_lines() -> None:
    program = read("G38.2 X5 F10\nS100 M3\nG33.1 Z-5 K1.5\nM2\n")
    assert kinds(program) == [MotionKind.LINE] * 3
    assert program.motions.feed.tolist() == [10, 150, 150]
    assert any("stops where the probe touches" in problem.text for problem in program.problems)


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "latin-1", "utf-16"])
@pytest.mark.parametrize("ending", ["\n", "\r\n", "\r"])
def test_any_encoding_and_line_end(encoding: str, ending: str) -> None:
    from app.gcode.interpreter.reader import read_program

    text = ending.join(["(Fräser ö)", "n10 g0 x1 (ü) y2", "; ä", "M2"])
    program = read_program(text.encode(encoding))
    assert ends(program) == [(1, 2, 0)]
    assert program.motions.line.tolist() == [2]


def test_columns_count_what_is_written() -> None:
    assert told("N10 (x1 y2)  G1  F10 (note) Q 3 X1\n").startswith("a.ngc:1:29: Q 3:")


def test_axes_that_the_program_has_not_set() -> None:
    assert read("G0 Z5\nX1\nG91 X1\nM2\n").motions.known_from == (1, 3, 0)
    assert read("G28 Z5 F1\nT1 M6\nG1 X1 S5\nM2\n").motions.known_from == (2, 3, 0)


def test_axes_that_begin_in_g91_count_from_zero_as_linuxcnc_has_it() -> None:
    """Known from the motion before; where there is none, from before the first."""
    assert read("G0 Z5\nX1\nG91 Y1\nM2\n").motions.known_from == (1, 1, 0)
    assert read("G91\nX1\nM2\n", Dialect.FANUC).motions.known_from == (-1, -1, -1)
    assert read("G90 G0 X1\nG91 Y1\nG90 Z1\nM2\n").motions.known_from == (0, 0, 0)
    told = read("G91\nG1 F100 X1 Y1\nG1 Z-1\nX2\nM2\n").problems
    assert [problem.line for problem in told] == [2] and "X0 Y0 Z0" in told[0].text
    assert not read("G91 G28 Z0.\nG90\nG1 F100 X1 Y1 Z1\nM2\n").problems


def test_fanuc_repeats_holes_by_k() -> None:
    text = "G21 G0 X0 Y0 Z0\nG91 F100.\nG81 X1. Z-1. R1. K2\nG80\nM30\n"
    assert [end[0] for end in ends(read(text, Dialect.FANUC))][-1] == 2
    assert not warnings(text, Dialect.FANUC)


def test_motions_to_the_machines_own_places_are_told_apart() -> None:
    assert read("G0 X1\nG28 Z5\nG0 X2\nG53 G0 Z0\nG0 X3\nM2\n").homeward == (2, 4)
    assert read("G0 X1.\nG91 G28 Z0.\nG90 X2.\nM30\n", Dialect.FANUC).homeward == (1,)


@pytest.mark.parametrize("dialect", [Dialect.FANUC, Dialect.HAAS])
def test_offsets_grow_by_what_g91_sets_on_fanuc_and_haas(dialect: Dialect) -> None:
    text = "G21 G90 G54\nG10 L2 P1 X10. Y4.\nG91 G10 L2 P1 X5. Y-1.\nG90 G0 X1. Y1.\nM30\n"
    assert ends(read(text, dialect)) == [(16, 4, 0)]
    assert ends(read(text)) == [(6, 0, 0)], "LinuxCNC sets them, whatever the mode"


@pytest.mark.parametrize("dialect", [Dialect.FANUC, Dialect.HAAS])
def test_the_common_offset_moves_every_other_one(dialect: Dialect) -> None:
    text = "G21 G90 G54\nG10 L2 P0 X10.\nG0 X1.\nG10 L2 P1 X3.\nG0 X1.\nG55 X1.\nM30\n"
    assert ends(read(text, dialect)) == [(11, 0, 0), (14, 0, 0), (11, 0, 0)]


def test_a_radius_that_is_too_small_is_told_with_how_far_the_end_is() -> None:
    far = "the radius 5 mm is too small to reach the end, which is 20 mm away"
    assert far in told("G0 X10 Y10\nG2 X30 Y10 R5 F100\nM2\n")
