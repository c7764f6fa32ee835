"""Subroutines, loops, conditions and jumps, of LinuxCNC and of Fanuc: which way a program goes."""

import pytest

from app.gcode.interpreter.dialect import Dialect
from tests.gcode.interpreter.programs import ends, read, told, warnings


def way(text: str, dialect: Dialect = Dialect.LINUXCNC) -> list[float]:
    """X of every motion: programs here mark their way with it."""
    return [end[0] for end in ends(read(text, dialect))]


def test_a_subroutine_has_parameters_of_its_own_and_gives_a_value() -> None:
    text = "#1=9\no100 sub\nG0 X#1\n#1=7\no100 endsub [#2*2]\no100 call [3] [4]\nG0 X#<_value>\nG0 X#1\nM2\n"
    assert way(text) == [3, 8, 9]


def test_a_subroutine_is_passed_over_where_nobody_calls_it() -> None:
    assert way("o<a> sub\nG0 X1\no<a> endsub\nG0 X2\nM2\n") == [2]


def test_return_leaves_early() -> None:
    assert way("o1 sub\nG0 X1\no1 return\nG0 X2\no1 endsub\no1 call\nG0 X3\nM2\n") == [1, 3]


@pytest.mark.parametrize(("value", "expected"), [(3, 1), (2, 2), (1, 3)])
def test_one_branch_is_taken(value: int, expected: int) -> None:
    text = f"#1={value}\no1 if [#1 gt 2]\nG0 X1\no1 elseif [#1 gt 1]\nG0 X2\no1 else\nG0 X3\no1 endif\nG0 X9\nM2\n"
    assert way(text) == [expected, 9]


def test_loops_within_loops() -> None:
    text = (
        "#1=0\no1 while [#1 lt 2]\n#2=0\no2 repeat [2]\nG0 X[#1*10+#2]\n#2=[#2+1]\no2 endrepeat\n#1=[#1+1]\no1 "
        "endwhile\nM2\n"
    )
    assert way(text) == [0, 1, 10, 11]


def test_break_and_continue() -> None:
    text = (
        "#1=0\no1 while [1]\n#1=[#1+1]\no2 if [#1 eq 2]\no1 continue\no2 endif\no3 if [#1 gt 3]\no1 break\no3 "
        "endif\nG0 X#1\n"
        "o1 endwhile\nG0 X9\nM2\n"
    )
    assert way(text) == [1, 3, 9]


def test_a_do_loop_runs_once_at_least() -> None:
    assert way("#1=5\no1 do\nG0 X#1\n#1=[#1+1]\no1 while [#1 lt 5]\nM2\n") == [5]


def test_m98_repeats_and_shares_the_callers_parameters() -> None:
    assert way("#1=1\nM98 P7 L3\nG0 X#1\nM2\nO7\nG0 X[#1*10]\n#1=[#1+1]\nM99\n") == [10, 20, 30, 4]


def test_fanuc_writes_the_count_before_the_number() -> None:
    assert way("%\nO1\nM98 P30007\nM30\nO7\nG91 G0 X1.\nM99\n%\n", Dialect.FANUC) == [1, 2, 3]


def test_fanuc_jumps() -> None:
    text = (
        "#1=1\nN10 G0 X[#1]\n#1=#1+1\nIF [#1 LT 4] GOTO 10\nIF [#1 EQ 4] THEN #2=7\nG0 X#2\nGOTO 99\nG0 X50.\nN99 G0 "
        "X9.\nM30\n"
    )
    assert way(text.replace("#1=#1+1", "#1=[#1+1]"), Dialect.FANUC) == [1, 2, 3, 7, 9]


def test_fanuc_loops() -> None:
    text = (
        "#1=0\nWHILE [#1 LT 2] DO1\n#2=0\nWHILE [#2 LT 2] DO2\nG0 X[#1*10+#2]\n#2=[#2+1]\nEND2\n#1=[#1+1]\nEND1\nG0 "
        "X9.\nM30\n"
    )
    assert way(text, Dialect.FANUC) == [0, 1, 10, 11, 9]


OTHER = "O2\nN10 G0 X77.\nN20 G0 X88.\nM99\n"
"""A subroutine with block numbers that the main program has too."""


@pytest.mark.parametrize(
    ("text", "dialect", "expected"),
    [
        (f"O1\n#1=0\nN10 G0 X#1\n#1=#1+1\nIF [#1 LT 3] GOTO 10\nM98 P2\nM30\n{OTHER}", "fanuc", [0, 1, 2, 77, 88]),
        ("O1\nM98 P2\nM30\nN50 G0 X9.\nM99\nO2\nM97 P50\nM99\nN50 G0 X7.\nM99\n", "haas", [7]),
        ("O1\nM98 P2\nG0 X9.\nN20 G0 X1.\nM30\nO2\nG0 X3.\nM99 P20\nN20 G0 X8.\nM99\n", "fanuc", [3, 1]),
        ("O1\nN20 G0 X1.\nIF [#1 EQ 1] GOTO 30\n#1=1\nM98 P2\nN30 M30\nO2\nG0 X3.\nM99 P20\n", "fanuc", [1, 3, 1]),
    ],
)
def test_block_numbers_are_those_of_the_program_that_runs(text: str, dialect: str, expected: list[float]) -> None:
    program = read(f"%\nG21\n{text}%\n", Dialect(dialect))
    assert [end[0] for end in ends(program)] == expected and not program.problems


@pytest.mark.parametrize("begin", ["", "%\n"])
def test_a_subroutine_behind_the_per_cent_sign_is_called_and_told(begin: str) -> None:
    program = read(f"%\nO1\nG21\nM98 P2\nM30\n%\n{begin}O2\nG0 X3.\nM99\n%\n", Dialect.FANUC)
    assert [end[0] for end in ends(program)] == [3]
    assert [each.text for each in program.problems] == [
        "O2 stands behind the per cent sign that ends the program; load it into the control by itself."
    ]


def test_programs_that_nothing_calls_are_told() -> None:
    text = "%\nO1\nG21\nG0 X1.\nM98 P5\nM30\nO3\nG0 X3.\nM30\nO4\nM30\nO5\nG0 X5.\nM99\n%\n"
    program = read(text, Dialect.FANUC)
    assert [end[0] for end in ends(program)] == [1, 5]
    assert [each.text for each in program.problems] == [
        "O3 and 1 more are programs of their own that nothing here calls; what stands there is not read."
    ]
    assert program.problems[0].line == 7


def test_a_program_that_runs_on_into_the_next_is_told() -> None:
    program = read("%\nO1\nG21\nG0 X1.\nO2\nG0 X2.\nM30\n%\n", Dialect.FANUC)
    assert [each.text for each in program.problems] == [
        "the program runs on into the next one, for no M30 or M99 stands before its number."
    ]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("IF [#9 EQ #0] GOTO 5\nG0 X7.\nN5 G0 X1.\n", [1]),
        ("#9=0\nIF [#9 EQ #0] GOTO 5\nG0 X7.\nN5 G0 X1.\n", [7, 1]),
        ("IF [#9 NE 0] GOTO 5\nG0 X7.\nN5 G0 X1.\n", [1]),
        ("IF [#9 GE 0] GOTO 5\nG0 X7.\nN5 G0 X1.\n", [1]),
        ("IF [#9 LT 0] GOTO 5\nG0 X7.\nN5 G0 X1.\n", [7, 1]),
        ("#8=#9\nIF [#8 EQ #0] GOTO 5\nG0 X7.\nN5 G0 X[#9+1]\n", [1]),
        ("#9=3.\n#9=#0\nG0 X4.\nG0 X#9 Y1.\nG0 X-#9 Y2.\n", [4, 4, 4]),
        ("G65 P2 X3.\nM30\nO2\nIF [#26 NE #0] THEN #1=9\nG0 X5.\nG0 X#25 Y1. Z#1\nG0 X#24\nM99\n", [5, 5, 3]),
    ],
)
@pytest.mark.parametrize("dialect", [Dialect.FANUC, Dialect.HAAS])
def test_what_nobody_has_set_is_vacant_in_macro_b(text: str, expected: list[float], dialect: Dialect) -> None:
    assert way(f"%\nO1\nG21 G90\n{text}{'' if 'M30' in text else 'M30'}\n%\n", dialect) == expected


def test_mach3_takes_what_nobody_has_set_for_0() -> None:
    assert way("G21\nG0 X4\nG0 X#9 Y1\nM30\n", Dialect.MACH3) == [4, 0]


def test_what_the_control_keeps_is_told_where_it_is_not_set() -> None:
    program = read("G21\n#501=3.\nG0 X#501\nG0 Y#500 Z1.\nM30\n", Dialect.FANUC)
    assert [(each.line, each.text.split(";")[0]) for each in program.problems] == [(4, "#500 is set nowhere before")]


@pytest.mark.parametrize("text", ["#3000=1 (NO TOOL)\n", "IF [#9 EQ #0] THEN #3000=5\n"])
def test_an_alarm_ends_the_reading(text: str) -> None:
    found = told(f"G21\nG0 X1.\n{text}G0 X2.\nM30\n", Dialect.FANUC)
    assert found.startswith("a.ngc:3") and "stops here with an alarm of its own (#3000)" in found


def test_a_subroutine_may_be_called_from_a_block_on() -> None:
    text = "%\nO1\nG21\nM98 P2 Q{}\nM30\nN30 G0 X9.\nO2\nG0 X1.\nN20 G0 X2.\nM99\n%\n"
    assert way(text.format(20), Dialect.FANUC) == [2]
    assert "there is no block N30 in the program that is called" in told(text.format(30), Dialect.FANUC)


@pytest.mark.parametrize(
    ("text", "lines"),
    [("G1 X9.; Y2.\n", [3]), ("G1 X9.;G1 Z-2.;\n", [3]), ("G1 X9.; T1 is it\n", []), ("; G1 X5.\nG1 X9.;\n", [])],
)
def test_a_block_behind_a_semicolon_is_told_on_controls_where_that_ends_one(text: str, lines: list[int]) -> None:
    program = read(f"G21 F9.\nG0 X1.\n{text}M30\n", Dialect.FANUC)
    assert [each.line for each in program.problems] == lines
    assert not read(f"G21 F9\nG0 X1\n{text}M30\n").problems


def test_haas_calls_a_block_of_the_same_program() -> None:
    assert way("M97 P100 L2\nG0 X9.\nM30\nN100 G91 G0 X1.\nM99\n", Dialect.HAAS) == [1, 2, 11]


def test_block_delete() -> None:
    assert way("/G0 X1\nG0 X2\nM2\n") == [2]
    assert [end[0] for end in ends(read("/G0 X1\nG0 X2\nM2\n", block_delete=False))] == [1, 2]


def test_nothing_is_read_behind_the_end() -> None:
    assert way("%\nG0 X1\n%\nG0 X2\n") == [1]
    assert way("G0 X1\nM30\nG0 X2\n") == [1]
    assert way("tape leader\n%\nG0 X1.\n%\nG0 X2.\n", Dialect.FANUC) == [1]


@pytest.mark.parametrize(
    ("text", "dialect", "expected"),
    [
        ("F1\no1 while [1]\nG1 X1\no1 endwhile\n", Dialect.LINUXCNC, "a.ngc:4: this goes on for ever"),
        ("N1 G0 X1.\nGOTO 1\n", Dialect.FANUC, "a.ngc:2: this goes on for ever"),
        ("#1=0\no1 while [1]\n#1=[#1+1]\no1 endwhile\n", Dialect.LINUXCNC, "a.ngc:4: this goes on for ever"),
        (
            "#1=0\no1 while [#1 ge 0]\n#1=[#1+1]\no1 endwhile\n",
            Dialect.LINUXCNC,
            "a.ngc:2: loops, calls and cycles repeat more than",
        ),
        ("O1\nM98 P1\nM99\n", Dialect.FANUC, "subroutines call one another more than 10 deep"),
        ("o1 sub\no1 call\no1 endsub\no1 call\n", Dialect.LINUXCNC, "subroutines call one another more than 9 deep"),
        ("F100\nG81 G91 X1 Z-1 R1 L99999999\n", Dialect.LINUXCNC, "a.ngc:2: loops, calls and cycles repeat more than"),
        ("o1 if [0]\nG0 X1\n", Dialect.LINUXCNC, "a.ngc:1: O1 if has no elseif, else or endif"),
        ("G0 X1\no5 call\n", Dialect.LINUXCNC, "a.ngc:2: there is no subroutine O5"),
        ("o5 endsub\n", Dialect.LINUXCNC, "ends a subroutine that is not running"),
        ("o5 endwhile\n", Dialect.LINUXCNC, "belongs to no loop"),
        ("o5 break\n", Dialect.LINUXCNC, "belongs to no loop"),
        ("o5 while 3\n", Dialect.LINUXCNC, "a.ngc:1:10: expected [ with a condition"),
        ("o5 fly\n", Dialect.LINUXCNC, "a.ngc:1:4: behind an O word stands"),
        ("GOTO 5\n", Dialect.FANUC, "there is no block N5"),
        ("WHILE [1] DO1\n", Dialect.FANUC, "has no END 1"),
        ("END1\n", Dialect.FANUC, "ends no loop"),
        ("M98 P5\n", Dialect.FANUC, "a.ngc:1:5: P5: there is no subroutine O5"),
        ("o1 sub\no1 endsub\n", Dialect.GRBL, "grbl knows no O words"),
    ],
)
def test_what_leads_nowhere_is_told(text: str, dialect: Dialect, expected: str) -> None:
    assert expected in told(text, dialect)


def test_a_main_program_that_begins_again_is_read_once() -> None:
    assert way("G91 G0 X1.\nM99\n", Dialect.FANUC) == [1]
    assert any("for ever" in text for text in warnings("G91 G0 X1.\nM99\n", Dialect.FANUC))


def test_what_was_read_before_an_error_stays() -> None:
    from app.gcode.interpreter.reader import read_program

    program = read_program(b"G0 X1\nG0 X2\nG0 Q1\nG0 X3\n")
    assert ends(program) == [(1, 0, 0), (2, 0, 0)]
    assert program.error is not None
    assert program.error.line == 3


def test_a_condition_in_a_fanuc_subroutine_is_asked_at_every_pass() -> None:
    text = "O1\n#100=0\nM98 P2 L3\nM30\nO2\n#100=#100+1\nIF [#100 EQ 1] THEN #101=7\nG91 G0 X#101\n#101=0\nM99\n"
    assert way(text, Dialect.FANUC) == [7, 7, 7]
