"""Cutter compensation: where the tool's centre goes, in closed form; what cannot be reached is refused."""

import pytest

from app.gcode.interpreter.dialect import Dialect
from app.gcode.interpreter.options import ReadOptions, ToolOffset
from app.gcode.interpreter.reader import read_program
from app.model.motion import MotionKind
from tests.gcode.interpreter.programs import ends, kinds, read
from tests.gcode.interpreter.rs274_motions import OPTIONS, assert_same, rs274

TABLE = {1: ToolOffset(diameter=2.0), 2: ToolOffset(diameter=10.0)}


def centre_path(text: str) -> list[tuple[float, ...]]:
    return ends(read(f"F100 T1 M6\n{text}\nM2\n", tool_table=TABLE))


def told(text: str) -> str:
    error = read_program(f"F100 T1 M6\n{text}\nM2\n".encode(), ReadOptions(tool_table=TABLE)).error
    return error.message("a.ngc") if error else ""


def test_inside_a_square_the_corners_are_cut_off() -> None:
    assert centre_path("G41 G1 X10\nY10\nX0\nY0\nG40\nX-5") == [(9, 1, 0), (9, 9, 0), (1, 9, 0), (1, 0, 0), (-5, 0, 0)]


def test_outside_a_square_the_tool_rolls_round_the_corners() -> None:
    program = read("F100 T1 M6\nG42 G1 X10\nY10\nX0\nG40 Y20\nM2\n", tool_table=TABLE)
    assert ends(program) == [(10, -1, 0), (11, 0, 0), (11, 10, 0), (10, 11, 0), (0, 11, 0), (0, 20, 0)]
    assert kinds(program) == [
        MotionKind.LINE,
        MotionKind.ARC_CCW,
        MotionKind.LINE,
        MotionKind.ARC_CCW,
        MotionKind.LINE,
        MotionKind.LINE,
    ]
    assert program.motions.centre[1].tolist() == [10, 0, 0]
    assert program.motions.line.tolist() == [2, 3, 3, 4, 4, 5]


def test_arcs_become_larger_or_smaller() -> None:
    program = read("F100 T1 M6\nG41 G1 X10\nG3 X14 Y4 J4\nG1 Y8\nG2 X18 Y12 I4\nG1 X20\nM2\n", tool_table=TABLE)
    assert ends(program) == [(10, 1, 0), (13, 4, 0), (13, 8, 0), (18, 13, 0), (20, 13, 0)]


def test_a_line_is_cut_off_where_it_meets_an_arc() -> None:
    path = centre_path("G41 G1 X10 Y0\nG1 X20\nG3 X20 Y8 R5\nG40 G1 X0")
    assert path[1] == pytest.approx((17 + (4**2 - 3**2) ** 0.5, 1, 0), abs=1e-6)


def test_heights_between_the_corners_go_with_them() -> None:
    assert centre_path("G41 G1 X10\nZ-1\nY10 Z-2") == [(9, 1, 0), (9, 1, -1), (9, 10, -2)]


def test_the_tool_stays_where_it_is_at_g40() -> None:
    program = read("F100 T1 M6\nG41 G1 X10\nY10\nG40\nY20\nM2\n", tool_table=TABLE)
    assert program.motions.start[-1].tolist() == [9, 10, 0]
    assert program.motions.end[-1].tolist() == [10, 20, 0]


def test_other_planes_and_given_diameters() -> None:
    assert centre_path("G18 G42 G1 Z10\nX10")[0] == (-1, 0, 10)
    assert centre_path("G41.1 D4 G1 X10\nY10")[0] == (8, 2, 0)
    assert centre_path("G41 D0 G1 X10\nY10") == [(10, 0, 0), (10, 10, 0)]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (
            "G41 G1 X0.5",
            "a.ngc:2:1: G41: the first move under cutter compensation must be longer than the tool's radius",
        ),
        ("G41 G1 X10\nG3 X10.5 Y0.5 J0.5", "the tool (radius 1 mm) does not fit into an arc of radius 0.5 mm"),
        ("G41 G1 X10\nY10\nX9.5\nY0", "does not reach into the inner corner"),
        ("G41 G1 X10\nG28", "G28 cannot be while cutter compensation is on"),
        ("G41 G1 X10\nG54", "G54 cannot be while cutter compensation is on"),
        ("G41 G1 X10\nG18", "G18 cannot be while cutter compensation is on"),
        ("G41 G1 X10\nG81 X5 Z-1 R1", "a canned cycle cannot be while"),
        ("G41 G1 X10\nG42 X20", "cutter compensation is on already"),
        ("G19 G41", "works in the planes G17 and G18"),
        ("G41 D9", "a.ngc:2:5: D9: G41 needs the diameter of tool 9"),
        ("G41 G1 X10\nG5 I1 J1 P1 Q1 X20", "follows no splines"),
    ],
)
def test_what_cannot_be_done_is_told(text: str, expected: str) -> None:
    assert expected in told(text)


@pytest.mark.parametrize(
    "path",
    [
        "G1 X10 Y0\nG3 X20 Y10 J10\nG3 X10 Y20 I-10\nG3 X18 Y28 J8",
        "G1 X10 Y0\nG2 X20 Y10 I10\nG2 X10 Y20 J10\nG1 X0",
        "G1 X30 Y0\nG3 X30 Y20 R10\nG3 X10 Y30 R15\nG1 X0",
        "G1 X30 Y0\nG3 X30 Y40 R20\nG3 X20 Y5 R25\nG1 X0",
        "G1 X30 Y0\nG3 X10 Y30 R40\nG3 X-20 Y0 R50\nG3 X0 Y-30 R40",
    ],
)
@pytest.mark.parametrize("side", ["G41.1", "G42.1"])
@pytest.mark.parametrize("diameter", [1.0, 6.0, 30.0])
def test_arcs_that_meet_arcs_are_cut_off_and_rolled_round_as_linuxcnc_does(
    path: str, side: str, diameter: float
) -> None:
    text = f"G21 F100 G17\nG0 X30 Y-40\n{side} D{diameter}\n{path}\nG40 G1 X-90\nM2\n"
    printed, complaint = rs274(text.encode())
    program = read_program(text.encode(), OPTIONS)
    assert bool(program.error) == bool(complaint), (complaint, program.error)
    if not complaint:
        assert_same(program, printed)


def test_the_first_move_is_measured_from_where_the_tool_is() -> None:
    assert "must be longer than the tool's radius" in told("G0 X30 Y-10\nG41 G1 X30.5\nX40")
    assert told("G0 X30 Y-10\nG41 G1 X31.5\nX40") == ""


@pytest.mark.parametrize("dialect", [Dialect.FANUC, Dialect.HAAS])
@pytest.mark.parametrize(
    ("side", "first"),
    [("G41", (10, 5, 0)), ("G42", (20, 5, 0))],
)
def test_fanuc_and_haas_begin_beside_the_start_of_the_next_move(
    dialect: Dialect, side: str, first: tuple[float, ...]
) -> None:
    """LinuxCNC cuts an inner corner off and rolls round an outer one; these go straight there, however short the way
    is.
    """
    text = "G21 G90 G17 F100.\nG0 X0. Y0. Z0.\n{} D2 G1 X15. Y5.\n{}Y25.\nG40 X0.\nM30\n"
    assert ends(read(text.format(side, ""), dialect, tool_table=TABLE))[1:3] == [first, (first[0], 25, 0)]
    assert ends(read(text.format(side, "Z-1.\n"), dialect, tool_table=TABLE))[1:3] == [first, (*first[:2], -1)]
    short = text.format(side, "").replace("G0 X0.", "G0 X13.").replace("Y0.", "Y4.")
    assert ends(read(short, dialect, tool_table=TABLE))[1] == first
    assert ends(read(text.format(side, ""), tool_table=TABLE))[1] != first


@pytest.mark.parametrize("dialect", [Dialect.FANUC, Dialect.HAAS])
def test_an_arc_way_in_of_a_haas_training_manual(dialect: Dialect) -> None:
    """A way in at a right angle to the arc that leads to the wall, radius 0.5 in, with a mill of 0.375 in."""
    text = "G20 G90 G17 F50.\nG0 X0. Y1.25 Z1.\nG1 Z-0.3\nG41 D3 X-0.5\nG3 X0. Y0.75 R0.5\nG1 X1.94\nG40 Y2.\nM30\n"
    table = {3: ToolOffset(diameter=0.375 * 25.4)}
    inch = [tuple(round(value / 25.4, 6) for value in end) for end in ends(read(text, dialect, tool_table=table))]
    assert inch[2:5] == [(-0.3125, 1.25, -0.3), (0.0, 0.9375, -0.3), (1.94, 0.9375, -0.3)]


def test_no_arc_leads_in_on_fanuc() -> None:
    text = "G21 F100.\nG0 X0. Y0. Z0.\nG41 D1 G3 X10. Y10. R10.\nM30\n"
    error = read_program(text.encode(), ReadOptions(Dialect.FANUC, tool_table=TABLE)).error
    assert error is not None and "begins on a straight move" in error.text
