"""Small programs at the edges of the language: taken and refused as LinuxCNC's interpreter does, held against it where
it is installed.
"""

import math

import numpy as np
import pytest

from app.gcode.interpreter.dialect import Dialect
from app.gcode.interpreter.options import ReadOptions
from app.gcode.interpreter.program import NcProgram
from app.gcode.interpreter.reader import read_program
from tests.gcode.interpreter.programs import ends, read
from tests.gcode.interpreter.rs274_motions import OPTIONS, assert_as_rs274, rs274
from tests.gcode.rs274_oracle import RS274

TAKEN = {
    "an arc in inch may miss its circle by 0.0028 in": "G20 F10\nG0 X0 Y0\nG2 X1.0 I0.5014\nM2\n",
    "and in mm by 0.028 mm": "G21 F100\nG0 X0 Y0\nG2 X10 I5.014\nM2\n",
    "a large one by 0.1 %": "G21 F100\nG0 X0 Y0\nG2 X200 I100.04\nM2\n",
    "return with a label of its own": "F100\no1 sub\nG1 X1\no2 return\nG1 X2\no1 endsub\no1 call\nG1 Y1\nM2\n",
    "return with another subroutine's label": "F100\no2 sub\no2 endsub\no1 sub\no2 return\nG1 X3\no1 endsub\no1 "
    "call\nG1 Y1\nM2\n",
    "a value by another label's return": "F100\no1 sub\no7 return [7]\no1 endsub\no1 call\nG1 X#<_value>\nM2\n",
    "endsub of another label": "F100\no1 sub\nG1 X1\no2 endsub\nG1 X2\no1 endsub\no1 call\nM2\n",
    "keywords in pieces": "F100\no1 sub\nG1 X1\no1 end sub\no2 re peat [2]\nG91 G1 X1\no2 end repeat\no3 if [1]\no1 ca "
    "ll\no3 end if\nM2\n",
    "a label in pieces": "F100\no1 0 0 sub\nG1 X1\no100 endsub\no1 00 call\nM2\n",
    "numbers always exist": "F100\n#2=exists[#1]\n#3=exists[#31]\nG1 X[#2+5] Y[#3+2]\n#4=exists[#<no>]\nG1 X#4\nM2\n",
    "polar places": "F100\nG0 @10 ^30\nG1 ^60 Z2\n@5\nG91\nG1 @5 ^10\nG1 ^5\nG90 G1 @[2*3] ^0\nM2\n",
    "polar holes": "F100\nG0 Z5\nG81 @10 ^10 Z-1 R1\n@5\n^90\nG80\nM2\n",
    "polar holes round the zero": "F100\nG0 X10 Z5\nG91 G81 ^60 R1 Z-1 L3\n^30 L2\nX5 Y1 L2\n^-5\nG80\nM2\n",
    "polar holes outwards, in inch": "G20 F10\nG90 G0 @1 ^33\nG91 G81 @1 R.1 Z-0.5 L5\n@.1 ^10 L3\nG90 @1\nM2\n",
    "polar from another zero": "G10 L2 P1 X5 Y5\nG0 X1\nG1 F10 @10 ^90\nG10 L2 P2 X3 Y1\nG55 G1 ^20\nM2\n",
    "polar in inch": "G0 X25.4 Y25.4\nG20 G0 ^0\nG1 F1 @2\nM2\n",
    "straight after G40, then an arc": "F100\nG41.1 D2\nG1 X5\nG40\nG0 X7\nG2 X9 I1\nM2\n",
    "M98 and call, each to its own": "F100\no200 sub\nG1 X9\no200 endsub\nM98 P100\no200 call\nM2\no100\nG1 X3\nM99\n",
    "a subroutine of M98 that calls one": "F100\nM98 P100\nM2\no100\nG1 X3\no5 call\nM99\no5 sub\nG1 X4\no5 endsub\n",
    "a subroutine behind the end": "F100\no100 call\nM2\no100 sub\nG1 X3\no100 endsub\n",
    "a per cent sign behind the end": "F100\no100 call\nG1 X1\nM2\n%\no100 sub\nG1 X3\no100 endsub\n",
    "a program between per cent signs": "%\nF100\nG1 X1\n  %  \nG1 X5\n",
    "begins with G91": "G91\nG1 F100 X1 Y1\nG1 Z-1\nG90\nG1 X0\nM2\n",
    "a line back along an arc, the tool outside": "F100\nG42.1 D2\nG1 X5\nX10\nG3 X7 Y3 I0 J3\nG1 Y20\nG40\nX0\nM2\n",
    "a way in by a rapid that the corner turns round": "F100\nG41.1 D5\nG0 X0.662185 Y-2.410718\nG1 X50 Y30\nG40\nG1 "
    "X0\nM2\n",
    "a kept state comes back": "F100\nM70\nG91 G20\nF5\nG18\nM72\nG1 X2\nG2 X4 I1\nM2\n",
    "a subroutine's by itself": "F100\no1 sub\nM73 G91 G0 X1\nG20\no1 endsub\no1 call\nG1 X2\nM2\n",
    "and behind each call of M98": "F100\nM98 P1 L2\nG1 X1\nM2\no1\nM73\nG91 G0 X4\nM99\n",
    "the program keeps its own over a call": (
        "F100\nM70\no1 sub\nG91 G20\nF5\nG0 X1\no1 endsub\no1 call\nM72\nG1 X2\nM2\n"
    ),
    "with the level that cycles go back to": "F100\nG0 Z5\nG98\nM70\nG99\nM72\nG81 X1 Z-1 R2\nX5\nM2\n",
    "with feeds a revolution": "S100 M3 G95 F1\nM70\nG94 F7\nM72\nG1 X5\nM2\n",
    "with the work offset": "F100\nG10 L2 P2 X5\nG55\nM70\nG54\nM72\nG0 X3\nM2\n",
    "with the length of the tool": "F100\nG0 Z7\nT1 M6\nG43\nM70\nG49\nM72\nG0 X3 Z3\nM2\n",
    "with cutter compensation": "F100\nG0 Z7\nT1 M6\nG41\nM70\nG40\nM72\nG1 X10\nX20 Y20\nG40\nX0\nM2\n",
    "twice": "F100\nM70\nG91\nM72\nG91\nM72\nG1 X5\nX5\nM2\n",
    "no motion in its block": "F100\nG1 X1\nM70\nG91\nM72 X5\nX6\nM2\n",
    "what it tells by name": (
        "F100\nG1 X#<_line> Y#<_ccomp>\nX#<_motion_mode> Y#<_retract_r_plane> Z#<_flood>\nX#<_units_per_minute>\nM2\n"
    ),
    "a length that a motion goes with": "F100\nG0 X1 Y2 Z3\nG43.1 Z1 G0 X5\nM2\n",
    "G80 beside home": "F100\nG1 X5\nG80 G28 X1\nM2\n",
}

REFUSED = {
    "a state that nobody has kept": ("F100\nM72\nM2\n", "nothing is kept"),
    "a state that was thrown away": ("F100\nM70\nM71\nM72\nM2\n", "nothing is kept"),
    "a state that a caller has kept": (
        "F100\no1 sub\nM72\no1 endsub\nM70\no1 call\nM2\n",
        "nothing is kept",
    ),
    "a state beside the spindle": ("M70 M3 S100\nM2\n", "not in one block"),
    "home beside a motion": ("F100\nG0 G28\nM2\n", "in one block both want"),
    "G92 beside a motion": ("F100\nG92 G0 X1\nM2\n", "in one block both want"),
    "G10 beside a motion": ("F100\nG10 L2 P1 G0\nM2\n", "in one block both want"),
    "G53 alone": ("F100\nG0 X1\nG53\nM2\n", "goes with G0 and G1 only"),
    "no length to add": ("G43.2\nM2\n", "needs a word H"),
    "a length beside axis words": ("G43.2 Z1 H1\nM2\n", "needs a word H"),
    "a curve without its point": ("F100\nG5.1 X1 Y1 I1\nM2\n", "control point"),
    "a curve that goes on": ("F100\nG5 X1 Y1 I1 J1 P1 Q1\nX5 Y5 P1 Q2\nM2\n", "wants G5 again"),
    "no turn of an arc": ("F100\nG2 X5 R2.5 P0\nM2\n", "P0 turns"),
    "R where no hole is": ("F100\nG0 Z5\nG81 X1 Z1 R2\nR3\nM2\n", "no code in this block"),
    "L where no hole is": ("F100\nG0 Z5\nG81 X1 Z1 R2\nL3\nM2\n", "no code in this block"),
    "no output": ("M64\nM2\n", "needs a word P"),
    "no analog output": ("M67 Q1\nM2\n", "needs a word E"),
    "no input": ("M66 L0\nM2\n", "one of P and E"),
    "a wait without an end": ("M66 P0 L3\nM2\n", "needs Q"),
    "a spindle that turns too far": ("M19 R400\nM2\n", "R0 to R360"),
    "a spindle that turns on no way": ("M19 R1 P3\nM2\n", "no way P3"),
    "a tool below zero": ("M61 Q-1\nM2\n", "must be 0 or more"),
    "two coolants": ("M7 M8\nM2\n", "one of M7, M8 and M9"),
    "a surface speed that is not said": ("G96 D100\nM2\n", "needs a word S"),
    "#0": ("G0 X#0\nM2\n", "no parameter #0"),
    "a parameter beyond the last": ("#5602=1\nM2\n", "use 1 to 5601"),
    "a parameter beyond the last to read": ("G0 X#9999\nM2\n", "use 1 to 5601"),
    "a name of its own": ("#<_line>=1\nM2\n", "control's own and cannot be set"),
    "a number behind words": ("G0 N5 X1\nM2\n", "at the beginning of a line"),
    "a slash behind the number": ("N5 /G0 X5\nM2\n", "at the beginning of a line"),
    "an arc in mm that misses by 2.86 mm": (
        "G21 F100\nG0 X0 Y0\nG2 X6000 I3001.4284\nM2\n",
        "does not end on its circle",
    ),
    "in inch by 0.0029 in": ("G20 F10\nG0 X0 Y0\nG2 X1.0 I0.50145\nM2\n", "does not end on its circle"),
    "by 0.0284 mm": ("G21 F100\nG0 X0 Y0\nG2 X10 I5.01425\nM2\n", "does not end on its circle"),
    "return outside": ("F100\nG1 X1\no2 return\nM2\n", "ends a subroutine that is not running"),
    "exists without a parameter": ("#2=exists[5]\nM2\n", "expected a parameter"),
    "a value of a pin": ("G1 X5 F#<_hal[plasmac.cut-feed-rate]>\nM2\n", "known to the machine alone"),
    "a value of the machine's file": ("#<a>=#<_ini[AXIS_X]MAX>\nM2\n", "known to the machine alone"),
    "polar without an angle at the zero": ("F100\nG1 @10\nM2\n", "the angle"),
    "polar under G91 at the zero": ("G0 X0 Y0\nG91 G0 @5 ^30\nM2\n", "no angle that G91"),
    "an angle under G91 at the zero": ("G0 X0 Y0\nG91 G0 ^30\nM2\n", "no angle that G91"),
    "polar in another plane": ("G18 F100\nG0 X5\nG1 ^30\nM2\n", "with G17 only"),
    "polar holes that meet the zero": ("F100\nG0 X10 Z5\nG91 G81 @-5 R1 Z-1 L4\nM2\n", "the angle"),
    "polar beside Y": ("F100\nG1 X1\nG1 ^30 Y2\nM2\n", "contradict one another"),
    "polar under G53": ("G53 G0 @5 ^3\nM2\n", "with a motion only"),
    "polar in G92": ("G92 @10 ^30\nM2\n", "with a motion only"),
    "polar without a motion": ("@5 ^3\nM2\n", "with a motion only"),
    "an arc after G40": ("F100\nG1 X1\nG41.1 D2\nG1 X10\nG1 Y10\nG40\nG2 X12 Y10 I1\nM2\n", "must be straight"),
    "an arc with G40": ("F100\nG41.1 D2\nG1 X5\nG40 G2 X9 I1\nM2\n", "must be straight"),
    "a call of what is M98's": ("F100\no100 call\nM2\no100\nG1 X3\nM99\n", "call it with M98"),
    "M98 of what is call's": ("F100\nM98 P100\nM2\no100 sub\nG1 X3\no100 endsub\n", "not M98"),
    "M99 in what is call's": ("F100\no200 sub\nG1 X9\nM99\no200 endsub\no200 call\nM2\n", "must end it, not M99"),
    "endsub in what is M98's": ("F100\nM98 P100\nM2\no100\nG1 X3\no100 endsub\n", "M99 must end it"),
    "a subroutine behind the closing %": (
        "%\nF100\no100 call\nM2\n%\no100 sub\nG1 X3\no100 endsub\n",
        "no subroutine O100",
    ),
    "a subroutine in no file": ("F100\no<abc> call\nM2\n", "a file of its own beside the program is not read"),
    "a stray %": ("F100\nG1 X1\n%\nG1 X2\nM2\n", "per cent sign"),
    "a % with something behind": ("%\nF100\nG1 X1\n%(end)\nM2\n", "per cent sign"),
    "a probe without axes": ("F100\nG38.2\nM2\n", "needs axis words"),
    "a probe that goes nowhere": ("F100\nG0 X1\nG38.2 X1\nM2\n", "begins where it ends"),
    "a way in as long as the radius": (
        "F100\nG41.1 D2\nG1 X0.6 Y0.8\nG1 X5\nG40\nM2\n",
        "must be longer than the tool's radius",
    ),
    "a slot too narrow": ("F100\nG41.1 D2\nG1 X10\nY10\nX9.5\nY0\nG40\nM2\n", "does not reach into the inner corner"),
    "a slot too narrow at the end": ("F100\nG41.1 D2\nG1 X10\nY10\nX9.5\nM2\n", "does not reach into the inner corner"),
}


@pytest.mark.parametrize("name", TAKEN)
def test_what_it_takes_moves_alike(name: str) -> None:
    program = read_program(TAKEN[name].encode(), OPTIONS)
    assert program.error is None and len(program.motions)
    if RS274 is not None:
        assert_as_rs274(TAKEN[name])


@pytest.mark.parametrize("name", REFUSED)
def test_what_it_refuses_is_refused_by_name(name: str) -> None:
    text, told = REFUSED[name]
    error = read_program(text.encode(), OPTIONS).error
    assert error is not None and told in error.text, error
    if RS274 is not None:
        assert rs274(text.encode())[1]


def test_upright_arcs_under_a_turned_offset_are_refused_by_name() -> None:
    """LinuxCNC takes them; as they lie in no plane of the machine they cannot be shown."""
    error = read_program(b"G10 L2 P1 R30\nF100\nG18 G2 X10 Z0 I5\nM2\n").error
    assert error is not None and error.word == "G2" and "turned" in error.text


def test_polar_in_closed_form() -> None:
    program = read("F100\nG0 @10 ^30\nG91 G1 @5 ^10\nM2\n")
    places = [
        (10 * math.cos(math.radians(30)), 5.0, 0.0),
        (15 * math.cos(math.radians(40)), 15 * math.sin(math.radians(40)), 0.0),
    ]
    assert np.allclose(ends(program), places)


def test_only_linuxcnc_knows_polar_words() -> None:
    error = read_program(b"G0 @10 ^30\n", ReadOptions(Dialect.FANUC)).error
    assert error is not None and error.word == "@"


def warnings(program: NcProgram) -> list[str]:
    return [problem.text for problem in program.problems]


def test_a_feed_beside_the_word_that_changes_the_units_is_told() -> None:
    told = warnings(read("G20 F60\nG1 X1\nM2\n"))
    assert len(told) == 1 and "F60" in told[0] and "60 mm, not in" in told[0]
    assert read("G20 F60\nG1 X1\nM2\n").motions.feed.tolist() == [60.0], "as LinuxCNC does"
    assert not warnings(read("G20\nF60\nG1 X1\nM2\n")) and not warnings(read("G21 F60\nG1 X1\nM2\n"))
    assert read_program(b"G20 F60.\nG1 X1.\nM2\n", ReadOptions(Dialect.FANUC)).motions.feed.tolist() == [60 * 25.4]


def test_a_tool_in_no_table_is_told() -> None:
    text = "G0 X1\nT9 M6\nG0 X2\nM2\n"
    told = warnings(read_program(text.encode(), OPTIONS))
    assert told == ["tool 9 is not in the tool table, and LinuxCNC stops there."]
    assert not warnings(read(text)), "nobody has given a table"
    if RS274 is not None:
        assert rs274(text.encode())[1]


@pytest.mark.parametrize("text", ["G0 X#5221", "G0 X#5421", "T1 M6\nG0 X#5410", "G0 X#5161"])
def test_what_the_machine_alone_knows_is_told(text: str) -> None:
    told = warnings(read(f"G21\n{text}\nM2\n"))
    assert len(told) == 1 and "is what the control knows when the program runs" in told[0], told


@pytest.mark.parametrize("text", ["G10 L2 P1 X5\nG0 X#5221", "G0 X5\nG0 X#5420", "#5221=4\nG0 X#5221"])
def test_what_the_program_says_itself_is_known(text: str) -> None:
    assert not any("is what the control knows" in told for told in warnings(read(f"G21\n{text}\nM2\n")))


def test_r_of_g64_is_known() -> None:
    told = warnings(read("G64 P0.01 R0.1\nG1 X1 F100\nM2\n"))
    assert len(told) == 1 and "2.10" in told[0]


@pytest.mark.parametrize(
    "text", ["n--5 g0 x1\nm2\n", "n-138 g0 x1\nm2\n", "n131n131 g0 x1\nm2\n", "n.5 g0 x1\nm2\n", "n[5] g0 x1\nm2\n"]
)
def test_a_block_number_is_one_and_begins_with_a_digit(text: str) -> None:
    assert rs274(text.encode())[1] != ""
    error = read_program(text.encode()).error
    assert error is not None and error.line == 1 and "number N" in error.text


@pytest.mark.parametrize("text", ["n5 g0 x1\nm2\n", "n0005 g0 x1\nn5 x2\nm2\n", "n5.5 g0 x1\nm2\n", "/n7 g0 x3\nm2\n"])
def test_other_block_numbers_stay(text: str) -> None:
    assert read_program(text.encode()).error is None
