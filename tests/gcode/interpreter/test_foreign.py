"""How Fanuc, Haas, Mach3 and grbl programs of every day are written, beside what LinuxCNC knows."""

import numpy as np
import pytest

from app.gcode.interpreter.dialect import Dialect
from app.gcode.interpreter.dialect_guess import guess_dialect
from app.gcode.interpreter.options import ReadOptions, ToolOffset
from app.gcode.interpreter.program import EventKind
from app.gcode.interpreter.reader import read_program
from app.model.motion import MotionKind
from tests.gcode.interpreter.programs import ends, read, told, warnings
from tests.gcode.interpreter.rs274_motions import rs274

OTHERS = [Dialect.FANUC, Dialect.HAAS, Dialect.MACH3]


@pytest.mark.parametrize("dialect", OTHERS)
def test_a_per_cent_sign_at_the_end_alone_skips_nothing(dialect: Dialect) -> None:
    assert ends(read("G21\nG0 X1.\nG1 X2. F100.\nM30\n%\n", dialect)) == [(1, 0, 0), (2, 0, 0)]
    assert ends(read("O1\nG21 G0 X1.\nM30\n%\nO2\nG0 X-500.\nM30\n", dialect)) == [(1, 0, 0)]
    assert ends(read("tape 7, made by hand\n%\nO1\nG21 G0 X1.\nM30\n%\n", dialect)) == [(1, 0, 0)]


@pytest.mark.parametrize("dialect", list(Dialect))
def test_g80_goes_with_any_motion(dialect: Dialect) -> None:
    assert ends(read("G21 G0 G17 G40 G80 G90\nG80 G0 X5.\nG1 G80 X6. F100.\nM2\n", dialect))[-2:] == [
        (5, 0, 0),
        (6, 0, 0),
    ]


@pytest.mark.parametrize("dialect", OTHERS)
def test_behind_a_cycle_the_motion_before_it_is_in_force(dialect: Dialect) -> None:
    text = "G21 G0 Z5.\nG81 G99 X1. Z-1. R2. F100.\nG80\nZ25.\nM30\n"
    assert ends(read(text, dialect))[-1] == (1, 0, 25)
    assert "no G code that uses them" in told(text, Dialect.LINUXCNC)


@pytest.mark.parametrize("text", ["G91 G28 Z0.", "G0 G91 G28 Z0.", "G91 G0 G28 Z0. M9", "G28 G91 Z0."])
def test_home_with_a_motion_word(text: str) -> None:
    assert ends(read(f"G21 G0 Z7.\n{text}\nM30\n", Dialect.FANUC)) == [(0, 0, 7), (0, 0, 0)]


def test_the_next_hole_is_reached_level() -> None:
    text = "G21 G0 Z50.\nG99 G81 X1. Z-1. R2. F100.\nG98 X2.\nG80\nM30\n"
    assert ends(read(text, Dialect.FANUC)) == [
        (0, 0, 50),
        (1, 0, 50),
        (1, 0, 2),
        (1, 0, -1),
        (1, 0, 2),
        (2, 0, 2),
        (2, 0, -1),
        (2, 0, 50),
    ]


@pytest.mark.parametrize("code", ["G5.1 Q1", "G05.1 Q1 R5", "G05 P10000", "G8 P1", "G103 P1"])
def test_modes_that_change_no_path_are_passed_over(code: str) -> None:
    text = f"G21\n{code}\nG0 X1.\nM30\n"
    assert ends(read(text, Dialect.FANUC)) == [(1, 0, 0)]
    others = [said for said in warnings(text, Dialect.FANUC) if "decimal point" not in said]
    assert ["passed over" in said for said in others] == [True]


def test_offsets_of_haas() -> None:
    assert read("G21 G154 P7\nG0 X1.\nM30\n", Dialect.HAAS).states[0].work_offset == "G54.1 P7"
    assert read("G21 G111\nG0 X1.\nM30\n", Dialect.HAAS).states[0].work_offset == "G54.1 P2"


@pytest.mark.parametrize("code", ["G112", "G113", "G120", "G154 P1"])
def test_offsets_of_haas_are_those_of_no_other(code: str) -> None:
    """To Fanuc G112 is polar interpolation, which was read as a work offset, without a word."""
    for dialect in (Dialect.FANUC, Dialect.MACH3):
        assert "is not known" in told(f"G21 {code}\nG0 X1.\nM30\n", dialect)
    told_here = warnings(f"G21 {code}\nG0 X1.\nM30\n", Dialect.HAAS)
    assert any("polar interpolation" in said for said in told_here) == (code in ("G112", "G113"))


@pytest.mark.parametrize("dialect", [Dialect.FANUC, Dialect.HAAS])
@pytest.mark.parametrize(
    "line",
    [
        "G90.1",
        "G91.1",
        "G92.2",
        "G92.3",
        "G28.1",
        "G30.1",
        "G38.2 Z-1. F100.",
        "G38.5 Z-1. F100.",
        "G41.1 D5. X9.",
        "G42.1 D5. X9.",
        "G43.1 Z1.",
        "G43.2 H1",
        "G59.1",
        "G59.3",
    ],
)
def test_codes_of_linuxcnc_alone_are_refused(dialect: Dialect, line: str) -> None:
    """They were obeyed as LinuxCNC does, without a word."""
    text = f"O1\nG21 G90 G94 G0 X0. Y0. Z5.\n{line}\nG1 X2. F100.\nM30\n"
    said = told(text, dialect)
    assert "a.ngc:3:" in said and ("does not know" in said or "is not followed" in said)


@pytest.mark.parametrize("dialect", OTHERS)
@pytest.mark.parametrize("line", ["M50 P0", "M61 Q5", "M62 P1", "M66 P0 L0", "M70", "M72", "M73"])
def test_m_codes_of_linuxcnc_alone_are_the_builders(dialect: Dialect, line: str) -> None:
    """M72 brings no feed mode back, nor does M61 change the tool."""
    text = f"O1\nG21 G90 G94 G0 X0. Y0. Z5.\n{line}\nG1 X2. F100.\nM30\n"
    code = line.split()[0]
    assert [said for said in warnings(text, dialect) if code in said] == [
        f"{code} is the machine builder's own; what it does is not followed."
    ]
    assert read(text, dialect).states[-1].tool == 0


def test_smoothing_of_haas_is_no_code_of_others() -> None:
    for dialect in (Dialect.FANUC, Dialect.MACH3):
        assert "does not know G187" in told("G21 G0 X1.\nG187 P3\nM30\n", dialect)


def test_axes_that_mach3_sends_to_their_switches_are_told() -> None:
    text = "G21 G90 G0 X5 Y5 Z5\nG28.1 Z12\nG92 Z0\nG1 Z-1 F100\nM30\n"
    assert any("switches" in said for said in warnings(text, Dialect.MACH3))
    assert not warnings(text.replace(" Z12", ""), Dialect.MACH3)
    assert not warnings(text)


@pytest.mark.parametrize("dialect", [Dialect.HAAS, Dialect.MACH3, Dialect.FANUC])
def test_a_program_of_five_digits_is_called_by_all_of_them(dialect: Dialect) -> None:
    """Fanuc alone takes digits before the last four for a count, where no program has all of them for its number."""
    text = "G21 G90 G0 X0.\nM98 P{0}\nM30\nO{1}\nG91 G0 X1.\nM99\n"
    assert ends(read(text.format(32345, 32345), dialect)) == [(0, 0, 0), (1, 0, 0)]
    twice = text.format(22345, 2345)
    if dialect is Dialect.FANUC:
        assert ends(read(twice, dialect))[1:] == [(1, 0, 0), (2, 0, 0)]
    else:
        assert "there is no subroutine O22345" in told(twice, dialect)


@pytest.mark.parametrize("name", ["<PART-1>", "<PLATE_2> (of 2026)", "O<PART>"])
def test_names_of_programs_on_newer_fanucs(name: str) -> None:
    text = f"%\n{name}\nG21 G0 X1.\nM30\n%\n"
    assert ends(read(text, Dialect.FANUC)) == [(1, 0, 0)]
    assert not warnings(text, Dialect.FANUC)
    assert "called by names are not followed" in told("G21 G0 X1.\nM98 <SUB>\nM30\n", Dialect.FANUC)


@pytest.mark.parametrize("dialect", [Dialect.FANUC, Dialect.HAAS])
def test_what_macro_b_prints_changes_nothing(dialect: Dialect) -> None:
    text = "O1\nG21 G90\n#1=2.\nPOPEN\nN20 DPRNT[X#1[44]*Y#2[44]]\nBPRNT[ A #1[3] ]\nPCLOS\nG0 X#1\nM30\n"
    assert ends(read(text, dialect)) == [(2, 0, 0)]
    assert not warnings(text, dialect)
    assert told(text, Dialect.MACH3)


@pytest.mark.parametrize("cycle", ["G73", "G83"])
def test_p_of_pecks_is_a_dwell_on_haas(cycle: str) -> None:
    text = f"G21 G90 G0 X0. Y0. Z5.\nG99 {cycle} X1. Y1. Z-9. R1. Q4. P500 F100.\nG80\nM30\n"
    program = read(text, Dialect.HAAS)
    assert not program.problems
    assert [(e.value, e.before) for e in program.events if e.kind is EventKind.DWELL] == [
        (0.5, len(program.motions) - 1)
    ]
    assert any("P stands in a block" in said for said in warnings(text, Dialect.FANUC))


@pytest.mark.parametrize(
    ("plane", "words"), [("G17", "X6 Y0 I3 J0 K0"), ("G18", "X6 Z0 I3 K0 J1"), ("G19", "Y6 Z0 J3 I-2 K0")]
)
def test_grbl_passes_over_the_third_coordinate_of_a_centre(plane: str, words: str) -> None:
    """Some posts write all three of each arc; LinuxCNC refuses it."""
    text = f"G21 G90 {plane}\nG0 X0 Y0 Z0\nG2 {words} F100\nM2\n"
    third = {"G17": "K", "G18": "J", "G19": "I"}[plane]
    without = " ".join(word for word in words.split() if word[0] != third)
    assert not read(text, Dialect.GRBL).problems
    for name in ("end", "centre"):
        both = [getattr(read(each, Dialect.GRBL).motions, name) for each in (text, text.replace(words, without))]
        assert np.array_equal(both[0], both[1], equal_nan=True)
    assert f"{third} is no coordinate of this plane's arcs" in told(text)
    lone = text.replace(words, f"X6 Y6 Z6 {third}3")
    assert "is no coordinate" in told(lone, Dialect.GRBL)
    assert "both a radius and a centre" in told(text.replace(words, f"{words} R3"), Dialect.GRBL)


def test_a_per_cent_sign_is_told_for_grbl() -> None:
    said = [each for each in warnings("%\nG21 G0 X1\nM2\n%\n", Dialect.GRBL) if "per cent" in each]
    assert said == ["grbl 1.1 refuses a per cent sign; take it out, if the sender does not."]
    assert not warnings("G21 G0 X1 (50 %)\nM2\n", Dialect.GRBL)


def test_lines_longer_than_grbl_takes_are_told() -> None:
    """It counts neither blanks nor comments, and has room for 79 characters."""
    words = "G3X-100.1234567Y-100.1234567Z-5.0000000I-50.1234567J-50.1234567F1000.0"
    assert len(words) == 70
    for line, tells in ((words + "S10000M3", False), (words + "S10000.0M3", True), (words + " (" + "a" * 90, False)):
        text = f"G21 G0 X0 Y0 Z0\n{line}{')' if '(' in line else ''}\nM30\n"
        assert any("79 characters" in said for said in warnings(text, Dialect.GRBL)) == tells, len(line)


def test_a_macro_gets_its_arguments_by_their_letters() -> None:
    text = "G21\nG65 P9 A1. B2. X3. I4. L2\nM30\nO9\nG91 G0 X#1 Y#2 Z[#24+#4]\nM99\n"
    assert ends(read(text, Dialect.FANUC)) == [(1, 2, 7), (2, 4, 14)]
    text = "G21\nG0 X0. Y0. Z0.\nG65 P9 M48 S5. T2\nM30\nO9\nG0 X#13 Y#19 Z#20\nM99\n"
    assert ends(read(text, Dialect.FANUC))[-1] == (48, 5, 2)
    assert "there is no subroutine O8" in told("G65 P8\n", Dialect.FANUC)


@pytest.mark.parametrize(
    ("code", "words"),
    [("G12 I5. F10.", "a circular pocket"), ("G70 I5. L4", "a circle of holes"), ("G150 X1.", "a pocket")],
)
def test_cycles_of_the_controls_own_are_refused_by_name(code: str, words: str) -> None:
    assert f"{words}" in told(f"G21\n{code}\n", Dialect.HAAS)


def test_rotary_axes_are_told() -> None:
    assert any("the axis A is not followed" in text for text in warnings("F100\nG1 X1 A90\nA120\nM2\n"))


def test_slashed_blocks_are_told() -> None:
    assert any("slash" in text for text in warnings("G0 X1\n/G0 X2\nM2\n"))
    assert ends(read("G21 G0 X1.\n/G0 X2.\nN5 /G0 X3.\nM2\n", Dialect.FANUC)) == [(1, 0, 0)]
    assert ends(read("G0 X1\n/G0 X2\n", Dialect.GRBL)) == [(1, 0, 0), (2, 0, 0)]  # it leaves nothing out
    assert ends(read("G0 X1\n/G0 X2\nM2\n")) == [(1, 0, 0)]
    text = b"G21 G0 X1.\n/G0 X2.\nN5 /2 G0 X3.\nM2\n"
    assert len(read_program(text, ReadOptions(Dialect.FANUC, block_delete=False)).motions) == 3


def test_numbers_and_units_that_settings_decide_are_told() -> None:
    assert any(
        "without a decimal point count in 0.001 mm" in text for text in warnings("G21 G0 X10\nM30\n", Dialect.HAAS)
    )
    assert not warnings("G21 G0 X10. Y0 Z-.5\nN100 G1 X1. F100. S1000\n(X10 F9)\nM30\n", Dialect.HAAS)
    assert any("names no units" in text for text in warnings("G0 X1.\nM30\n", Dialect.FANUC))


@pytest.mark.parametrize(
    ("dialect", "head", "steps"),
    [
        (Dialect.HAAS, "G21", "0.001 mm/min"),
        (Dialect.HAAS, "G20", "0.0001 in/min"),
        (Dialect.FANUC, "G20", "0.01 in/min"),
        (Dialect.FANUC, "G21 G95", "0.01 mm"),
        (Dialect.FANUC, "G21", ""),
        (Dialect.MACH3, "G20", ""),
    ],
)
def test_a_feed_that_a_setting_decides_is_told(dialect: Dialect, head: str, steps: str) -> None:
    text = f"{head}\nG0 X0. Y0. Z0. M3 S100\nG1 X1. F12\nM30\n"
    assert [steps in said for said in warnings(text, dialect)] == ([True] if steps else [])
    assert not warnings(text.replace("F12", "F12."), dialect)


def test_commands_of_grbl_itself_are_passed_over() -> None:
    assert ends(read("$H\n$32=1\nG0 X1\n", Dialect.GRBL)) == [(1, 0, 0)]


@pytest.mark.parametrize("line", ["#1=5\nG0 X#1", "G0 X[2+3]"])
def test_values_that_grbl_does_not_compute_are_told(line: str) -> None:
    text = f"G21 G0 X1 Y0 Z0\n{line}\nM2\n"
    assert ends(read(text, Dialect.GRBL))[-1] == (5, 0, 0)
    assert any("grbl 1.1 computes no values" in said for said in warnings(text, Dialect.GRBL))
    assert not warnings("G21 G0 X1 Y0 Z0\n(MSG, #1 [2])\nG0 X5 ;[1]\nM2\n", Dialect.GRBL)


def test_p_of_compensation_is_a_radius_on_mach3() -> None:
    text = "G21 G90 G0 X0 Y0 Z5\nG41 P5 X15 Y5\nG1 Y25 F10\nG40 X30 Y40\nM30\n"
    found = ends(read(text, Dialect.MACH3))
    assert found[1:3] == ends(read(text.replace("G41 P5", "G41.1 D10")))[1:3] and found[2] == (10, 25, 5)


@pytest.mark.parametrize("dialect", list(Dialect)[:1] + OTHERS)
def test_compensation_by_a_tool_that_nothing_names_is_told(dialect: Dialect) -> None:
    text = "G21 G90 G0 X0. Y0. Z5.\n{}G41 {}X15. Y5.\nG1 Y25. F10.\nG40 X30. Y40.\nM30\n"
    assert any("the tool that is in the spindle" in said for said in warnings(text.format("", ""), dialect))
    assert not warnings(text.format("", "D0 "), dialect)
    options = ReadOptions(dialect, tool_table={1: ToolOffset(10.0, 4.0)})
    assert not read_program(text.format("T1 M6\n", "D1 ").encode(), options).problems


@pytest.mark.parametrize("dialect", [Dialect.FANUC, Dialect.HAAS])
def test_programs_of_lathes_are_told(dialect: Dialect) -> None:
    """What a mill would move in silence: X as a radius, and F a minute in place of F a revolution."""
    turned = "G21 G97 S500 M3\nT0101\nG0 X50. Z1.\nG1 Z-20. F0.2\nM30\n"
    assert any("a program for a lathe" in said for said in warnings(turned, dialect))
    for code in ("G50", "G92"):
        assert f"{code} with S is the largest speed" in told(f"G21\n{code} S2000\nG0 X5.\nM30\n", dialect)
    for milled in (
        turned.replace("Z1.", "Y1. Z1."),
        turned.replace("T0101", "T0101 M06"),
        "G21 G50\nG0 X1. Z1.\nM30\n",
        "G21 G17 G40 G49 G50 G80 G90 S3000 M3\nG0 X1. Z1.\nM30\n",
        "G21\nG50 S3000 M3\nG0 X1. Z1.\nM30\n",
    ):
        assert not warnings(milled, dialect)


@pytest.mark.parametrize("word", ["F", "X"])
def test_a_number_of_many_digits_is_looked_at_once(word: str) -> None:
    """Whole numbers without a point were looked for digit by digit, from each digit on: 8,000 of them took 0.8 s."""
    assert read_program(f"G21\nG1 {word}{'1' * 150_000}.\nM30\n".encode(), ReadOptions(Dialect.HAAS)).problems


def test_plain_lines_that_repeat_cost_little() -> None:
    body = "".join(f"G1 X{k % 50}.{k % 7}\n" for k in range(2600))
    assert len(read(f"F100\nM98 P2 L60\nM2\nO2\n{body}M99\n").motions) == 60 * 2600


@pytest.mark.parametrize(
    ("text", "dialect"),
    [
        ("(Fixture: Haas 5C vise)\nG21\nG0 X10 Y20\n", Dialect.LINUXCNC),
        ("(HITOFUDE FOR HAAS, LENGTHS IN MM)\n", Dialect.HAAS),
        ("(Post: haas vf2)\n", Dialect.HAAS),
        ("%\nO1001 (PART)\nG5.1 Q1\n", Dialect.FANUC),
        ("G5.1 X1 Y1 I1 J1\n", Dialect.LINUXCNC),
        ("G187 P2\n", Dialect.HAAS),
        ("(G187)\n", Dialect.LINUXCNC),
    ],
)
def test_which_control_a_program_is_for(text: str, dialect: Dialect) -> None:
    assert guess_dialect(text.encode()) is dialect


def test_linuxcnc_wants_a_feed_behind_every_feed_mode() -> None:
    assert "a feed motion needs a feed rate" in told("F100\nG94\nG1 X1\n")
    assert "LinuxCNC does not know G187" in told("G187 P1\n")


def test_a_program_without_an_end_is_told() -> None:
    assert any("no end" in text for text in warnings("G0 X1\nG0 X2\n"))
    assert not warnings("%\nG0 X1\n%\n") + warnings("G0 X1\nM30\n") + warnings("G0 X1\n", Dialect.GRBL)


VECTRIC = "( for Mach2/3 from Vectric )\nN120G00{}G17G90G40G49G80\n{}G91.1\nG00X1.000Y2.000\nM30\n%\n"


@pytest.mark.parametrize(("unit", "older", "x"), [("G21", "G71", 1.0), ("G20", "G70", 25.4), ("", "G70", 25.4)])
def test_older_names_of_the_units_on_mach3(unit: str, older: str, x: float) -> None:
    text = VECTRIC.format(unit, older)
    assert guess_dialect(text.encode()) is Dialect.MACH3
    assert ends(read(text, Dialect.MACH3))[-1] == pytest.approx((x, 2 * x, 0.0))
    assert not any("units" in warning for warning in warnings(text, Dialect.MACH3))


def test_older_names_of_the_units_are_refused_beside_others_and_elsewhere() -> None:
    assert "both inch and mm" in told("G21 G70\n", Dialect.MACH3)
    assert "say --dialect" in told("G71 G91.1\n")
    assert "an arc of holes" in told("G71\n", Dialect.HAAS)


@pytest.mark.parametrize("line", ["G67", "G50.1 X0. Y0.", "G17 G40 G49 G50 G67 G69 G80 G90"])
def test_ends_of_what_is_never_in_force_are_nothing(line: str) -> None:
    text = f"G21\n{line}\nG0 X1.\nM30\n"
    assert ends(read(text, Dialect.FANUC)) == [(1, 0, 0)] and not warnings(text, Dialect.FANUC)


@pytest.mark.parametrize("code", ["G31 Z-5. F50.", "G76 X1. Z-5. R2. Q0.5 F100.", "G66 P9100"])
def test_what_is_not_followed_is_told_with_what_to_do(code: str) -> None:
    assert "is not followed; write out the moves that it makes" in told(f"G21\nG0 X1.\n{code}\n", Dialect.FANUC)


@pytest.mark.parametrize(
    ("expression", "value"),
    [
        ("5OR3", 7.0),
        ("5XOR3", 6.0),
        ("5AND3", 1.0),
        ("4+1AND1", 5.0),
        ("7AND3+4", 7.0),
        ("FIX[-2.5]", -2.0),
        ("FUP[-2.5]", -3.0),
        ("-7MOD3", -1.0),
        ("1+1EQ2", 1.0),
    ],
)
def test_operators_of_macro_b(expression: str, value: float) -> None:
    """AND binds as * does, OR and XOR as +; all three go bit by bit. FIX goes towards 0, and MOD keeps the sign."""
    for dialect in (Dialect.FANUC, Dialect.HAAS):
        assert ends(read(f"G21\n#1={expression}\nG0 X#1 Y0. Z0.\nM30\n", dialect)) == [(value, 0, 0)]
    assert "must be a whole number" in told("G21\n#1=0.5OR1\n", Dialect.FANUC)


@pytest.mark.parametrize(
    ("units", "place"), [("G21", (1.235, -1.235, 2.47)), ("G20", (25.4 * 1.2346, 25.4 * -1.2346, 25.4 * 2.4692))]
)
@pytest.mark.parametrize("dialect", [Dialect.FANUC, Dialect.HAAS])
def test_round_in_a_word_goes_to_the_step_of_lengths(
    dialect: Dialect, units: str, place: tuple[float, float, float]
) -> None:
    """The manuals' own rule: to a whole number in what a parameter is set to, a condition, or a count."""
    words = "X[ROUND[#1]] Y-ROUND[#1] Z[ROUND[#1]+ROUND[#1]]"
    assert ends(read(f"{units}\n#1=1.23456\nG0 {words}\nM30\n", dialect))[0] == pytest.approx(place, abs=1e-9)
    text = "G21\n#1=1.6\n#2=ROUND[#1]\nIF[ROUND[#1]NE2]GOTO9\nG0 X#2 Y#[ROUND[#1]] Z[ROUND[1.6]]\nN9 M30\n"
    assert ends(read(text, dialect)) == [(2, 2, 1.6)]
    assert ends(read("G21\n#1=1.6\nG0 X[ROUND[#1]] Y0. Z0.\nM30\n", Dialect.MACH3)) == [(2, 0, 0)]


def test_modes_are_kept_and_brought_back_by_macro_b() -> None:
    text = "G21 G90 G0 X0. Y0. Z0.\n#1=#4003\n#2=#4001\nG91 G1 X1. F10.\nG#1 G#2\nX5.\nX[#5041+#4120]\nM30\n"
    assert ends(read(text, Dialect.FANUC)) == [(0, 0, 0), (1, 0, 0), (5, 0, 0), (5, 0, 0)]
    assert not warnings(text, Dialect.FANUC)


@pytest.mark.parametrize("number", [2001, 3011, 4130, 5021, 5221])
def test_what_fanuc_alone_knows_is_told(number: int) -> None:
    known = warnings(f"G21 G0 X1.\n#1=#{number}\nG0 X#1\nM30\n", Dialect.FANUC)
    assert any(f"#{number} is what the control knows" in text for text in known)


@pytest.mark.parametrize("dialect", list(Dialect)[:1] + OTHERS)
def test_the_length_of_another_tool_is_told(dialect: Dialect) -> None:
    text = "G21 G0 X1. Y0. Z9.\nT1 M6\nG43 H{} G0 Z5.\nM30\n"
    assert any("another tool than T1" in said for said in warnings(text.format(2), dialect))
    assert not warnings(text.format(1), dialect) and not warnings(text.format(0), dialect)


def feeds_down(text: str, dialect: Dialect) -> list[float]:
    """Heights that a program feeds to."""
    program = read(text, dialect)
    return program.motions.end[program.motions.kind == MotionKind.LINE, 2].tolist()


@pytest.mark.parametrize("cycle", ["G73", "G83"])
def test_pecks_that_lessen_on_haas(cycle: str) -> None:
    """I is the first, each one is less by J, and K is the least; they stay, and Q ends them."""
    head = f"G21 G90 G0 X0. Y0. Z5.\nG99 {cycle} X1. Y1. Z-9. R1. "
    assert feeds_down(head + "I4. J1. K2. F100.\nG80\nM30\n", Dialect.HAAS) == [-3, -6, -8, -9]
    text = head + "I5. J0.5 K3. F100.\nX2.\nG83 Q8. X3.\nG80\nM30\n"
    assert feeds_down(text, Dialect.HAAS) == [-4, -8.5, -9, -4, -8.5, -9, -7, -9]
    assert not read(head + "I4. J1. K2. F100.\nG80\nM30\n", Dialect.HAAS).problems
    for words in ("Q2. K4.", "I2. K1.", "Q2. I4. J1. K1."):
        assert f"{cycle} with some of Q, I, J and K is not followed" in told(f"{head}{words} F9.\n", Dialect.HAAS)
    for words in ("I0. J1. K2.", "I4. J-1. K2.", "I4. J1. K0."):
        assert "must be above 0" in told(f"{head}{words} F9.\n", Dialect.HAAS)


def test_k_repeats_holes_on_fanuc_alone() -> None:
    text = "G21 G90 G0 X0. Y0. Z5.\nG91 G81 X1. Z-3. R-4. {} F100.\nG80\nM30\n"
    assert len(feeds_down(text.format("K3"), Dialect.FANUC)) == 3
    for dialect in (Dialect.HAAS, Dialect.MACH3):
        assert len(feeds_down(text.format("L3"), dialect)) == 3
        assert len(feeds_down(text.format("K3"), dialect)) == 1
        assert any(
            "K stands in a block where no code takes it" in said for said in warnings(text.format("K3"), dialect)
        )


def test_a_cycle_from_below_r_rises_over_the_hole() -> None:
    """LinuxCNC rises before it goes to the hole; Fanuc and Haas go there first, as low as the tool is."""
    text = "G21 G90 G0 X0. Y0. Z-5.\nG99 G81 X9. Z-6. R1. F100.\nG80\nM30\n"
    for dialect in (Dialect.FANUC, Dialect.HAAS):
        assert ends(read(text, dialect))[1:4] == [(9, 0, -5), (9, 0, 1), (9, 0, -6)]
    for dialect in (Dialect.LINUXCNC, Dialect.MACH3):
        assert ends(read(text, dialect))[1:4] == [(0, 0, 1), (9, 0, 1), (9, 0, -6)]


@pytest.mark.parametrize("dialect", [*OTHERS, Dialect.GRBL])
def test_turns_of_an_arc_are_a_word_of_linuxcnc(dialect: Dialect) -> None:
    text = "G21 G90 G0 X0. Y0. Z5.\n{}G2 I1. Z-5. {}F100.\nM30\n"
    assert "P, the turns of an arc" in told(text.format("", "P3 "), dialect)
    assert ends(read(text.format("", "P3 ")))[-1] == (0, 0, -5)
    if dialect is Dialect.FANUC:
        assert read(text.format("G54.1 P3 ", ""), dialect).motions.turns[-1] == 1


@pytest.mark.parametrize("dialect", [Dialect.FANUC, Dialect.HAAS])
def test_a_bore_from_behind_is_not_followed(dialect: Dialect) -> None:
    assert "G87, a bore from behind" in told("G21 G0 Z5. M3 S9\nG87 X1. Z-2. R-5. I1. J1. K1. F9.\n", dialect)


def test_heights_of_holes_stay_where_g91_follows() -> None:
    text = "G21 G90 G0 X0. Y0. Z5.\nG99 G81 X50. Z-1. R1. F100.\nG91 X30.\nG80\nM30\n"
    for dialect in (Dialect.FANUC, Dialect.HAAS):
        assert ends(read(text, dialect))[-3:] == [(80, 0, 1), (80, 0, -1), (80, 0, 1)]
    text = "G21 G90 G0 X0. Y0. Z5.\nG91 G81 X1. R-3. Z-4. F100.\nG90 X9.\nG80\nM30\n"
    assert ends(read(text, Dialect.FANUC))[-3:] == [(9, 0, 2), (9, 0, -2), (9, 0, 5)]


TURNED = "G21 G90 G17\nG0 X0. Y0. Z0.\nG68 {} R90.\nG1 X20. Y0. F100.\nG2 Y10. I0. J5.\nG69\nG0 X1. Y2.\nM30\n"


@pytest.mark.parametrize(
    ("dialect", "centre"),
    [(Dialect.FANUC, "X10. Y0."), (Dialect.HAAS, "X10. Y0."), (Dialect.MACH3, "A10. B0.")],
)
def test_a_program_turned_about_a_point(dialect: Dialect, centre: str) -> None:
    program = read(TURNED.format(centre), dialect)
    assert ends(program) == [(0, 0, 0), (10, 10, 0), (0, 10, 0), (1, 2, 0)]
    assert program.motions.centre[2][:2].tolist() == pytest.approx([5, 10])
    assert not warnings(TURNED.format(centre), dialect)


def test_a_program_turned_where_the_tool_stands_with_other_zeros() -> None:
    text = "G21 G90 G10 L2 P1 X100. Y0. Z0.\nG54 G52 X1.\nG0 X10. Y0. Z0.\nG68 R-90.\nG0 X11. Y0.\nG69\nM30\n"
    assert ends(read(text, Dialect.FANUC)) == [(111, 0, 0), (111, -1, 0)]


@pytest.mark.parametrize(
    ("lines", "words"),
    [
        ("G68 R30.\nG68 R30.", "turned already"),
        ("G91 G68 R30.", "under G91"),
        ("G18 G68 R30.", "plane X Y"),
        ("G68 X1. Y1.", "needs a word R"),
        ("G68 R30.\nG92 X0.", "write G69 before"),
        ("G68 R30.\nG55", "write G69 before"),
        ("G68 R30.\nG28 X0.", "write G69 before"),
    ],
)
def test_turns_that_controls_take_differently_are_refused(lines: str, words: str) -> None:
    assert words in told(f"G21 G90 G17 G0 X0. Y0.\n{lines}\n", Dialect.FANUC)


def test_a_first_move_behind_a_turn_that_is_not_sure_is_told() -> None:
    head = "G21 G90 G17 G0 X0. Y0.\n"
    for lines in ("G68 R30.\nX5.\nM30\n", "G68 R30.\nG91 X5. Y1.\nM30\n", "G68 R30.\nX5. Y5.\nG69\nY5.\nM30\n"):
        assert any("first move behind G68" in text for text in warnings(head + lines, Dialect.FANUC)), lines
    assert not warnings(head + "G69\nX5.\nM30\n", Dialect.FANUC)


def test_polar_coordinates_of_fanuc() -> None:
    holes_of_g16 = "G16 G99 G81 X50. Y0. Z-1. R1. F100.\nY90.\nG91 Y30. K2\nG90 G80 G15\n"
    text = f"G21 G90 G17 G0 X0. Y0. Z5.\n{holes_of_g16}X1. Y1.\nM30\n"
    holes = [end for end in ends(read(text, Dialect.FANUC)) if end[2] == -1]
    across, up = 50 * 3**0.5 / 2, 25.0
    assert np.allclose(holes, [(50, 0, -1), (0, 50, -1), (-up, across, -1), (-across, up, -1)])
    assert ends(read(text, Dialect.FANUC))[-1] == (1, 1, 1)
    assert "are not followed" in told("G21\nG16\n", Dialect.HAAS)


@pytest.mark.parametrize("line", ["G91 G1 X5. Y3. F10.", "G2 X5. Y90. I1. J0. F10."])
def test_polar_coordinates_that_mean_another_centre_are_refused(line: str) -> None:
    assert "under G16" in told(f"G21 G90 G17 G0 X5. Y0.\nG16\n{line}\n", Dialect.FANUC)


@pytest.mark.parametrize(
    "code", ["M48", "M62 P1", "M70", "G33 Z1 K1", "G43.2 H1", "G41.1 D1", "G92.2", "G0 G28", "M19"]
)
def test_what_grbl_does_not_know_is_refused(code: str) -> None:
    assert told(f"G21 F10\n{code}\n", Dialect.GRBL)


@pytest.mark.parametrize("text", ["(only a comment)\n", "G21\nG90\n"])
def test_a_program_without_moves_has_no_end_either(text: str) -> None:
    assert rs274(text.encode())[1] and any("has no end" in warning for warning in warnings(text))


@pytest.mark.parametrize("dialect", [Dialect.GRBL, *OTHERS])
def test_blocks_behind_a_per_cent_sign_are_told(dialect: Dialect) -> None:
    """A program of which nothing was read had no problem."""
    for sign in ("% spindle on", "%"):
        text = f"%\n(made by hand)\n{sign}\nG21 G90\nG1 X5. F100.\nM30\n"
        assert any("blocks behind it are not read" in said for said in warnings(text, dialect)), sign
    said = warnings("%\nG21 G90\nG1 X5. F100.\nM30\n%\nmade by hand\n", dialect)
    assert [each for each in said if "grbl 1.1 refuses" not in each] == []
    called = "%\nO1\nG21\nM98 P2\nM30\n%\n(the other one)\nO2\nG0 X1.\nM99\n"
    assert not any("are not read" in said for said in warnings(called, Dialect.FANUC))


@pytest.mark.parametrize("dialect", [Dialect.FANUC, Dialect.HAAS])
def test_the_number_of_a_cutter_stays_until_another_one(dialect: Dialect) -> None:
    """G41 without D took the diameter that has the tool's number."""
    table = {1: ToolOffset(diameter=2.0), 7: ToolOffset(diameter=6.0)}
    path = "G0 X0. Y0.\nG41{} G1 X10. Y5. F100.\nY20.\nG40 X0.\n"
    text = f"G21 G90 T1 M6 D7\n{path.format('')}{path.format(' D1')}{path.format('')}M30\n"
    walls = [x for x, y, _ in ends(read(text, dialect, tool_table=table)) if y == 20 and x]
    assert walls == pytest.approx([7.0, 9.0, 9.0])
    assert not warnings(text, dialect)


def test_the_number_of_a_length_stays_until_another_one() -> None:
    text = "G21 G90 G0 X0. Y0. Z0.\nT1 M6\nG43 H1 Z9.\nG43 Z5.\nM30\n"
    for dialect in (Dialect.FANUC, Dialect.HAAS):
        assert ends(read(text, dialect))[-1] == (0, 0, 5) and not warnings(text, dialect)
        assert "needs a word H" in told(text.replace("H1 ", "H0 "), dialect)
