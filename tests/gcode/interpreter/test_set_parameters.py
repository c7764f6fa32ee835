"""Parameters of the control's own that a program sets, and the reference points of G28 and G30."""

import random

import pytest

from app.gcode.interpreter.dialect import Dialect
from app.gcode.interpreter.options import ReadOptions
from app.gcode.interpreter.program import NcProgram, Severity
from app.gcode.interpreter.reader import read_program
from tests.gcode.interpreter.rs274_motions import MM_PER_INCH, OPTIONS, assert_same, rs274

SET = [5161, 5162, 5163, 5181, 5183, 5221, 5222, 5223, 5241, 5242, 5382]


def read(text: str, dialect: Dialect = Dialect.LINUXCNC) -> NcProgram:
    return read_program(text.encode(), ReadOptions(dialect))


def compared(text: str) -> None:
    """Read a program as rs274 does, whose own units are inches: a value "mm(3)" is 3 mm."""
    own = text.replace("mm(", "[").replace(")", "]")
    theirs = text.replace("mm(", "[").replace(")", f"/{MM_PER_INCH}]")
    printed, complaint = rs274(theirs.encode())
    program = read_program(own.encode(), OPTIONS)
    refused = [each.text for each in program.problems if each.severity is not Severity.WARNING]
    assert bool(refused) == bool(complaint), (complaint, refused)
    assert len(program.motions) >= len(printed)
    assert_same(program, printed)


@pytest.mark.parametrize(
    "text",
    [
        "#5161=mm(10)\n#5163=mm(5)\nG0 X1 Y2 Z3\nG28\nG0 X1\nG28 Z4\nG28.1\nG0 X9\nG28\nM2\n",
        "#5181=mm(10)\nG0 X1 Y2 Z3\nG30 X7\nG30.1\nG0 X0\nG30\nM2\n",
        "#5221=mm(10)\nG0 X1\nG54\nG0 X1\nG55\nG0 X1\nG54 G0 X2\nM2\n",
        "G10 L2 P1 R30\nG0 X1 Y2\n#5221=mm(10)\nG54\nG0 Y3\nG55\nG0 Y4\nG54\nG0 Y5\nM2\n",
        "G5 X5 Y5 I1 J2 P-1 Q-2 F100\nG10 L20 P6 Y3\nG10 L2 P1 Y3\nG0 X1\nM2\n",
        "#5241=mm(3)\n#5250=90\nG55 G0 X1 Y0\nG54\nG0 X1\nM2\n",
        "#5222=mm(3)\nG10 L2 P1 X4\nG0 X1 Y1\nG10 L2 P2 X1\nG55\nG0 X1 Y1\nM2\n",
        "#5222=mm(3)\nG10 L20 P1 X4\nG0 X1 Y1\nM2\n",
        "G92 X3\nG0 X1\n#5211=mm(5)\nG0 X2\nG92.2\nG0 X2\nG92.3\nG0 X2\n#5211=mm(9)\nG92 Y1\nG92.3\nG0 X2 Y2\nM2\n",
        "#5211=mm(5)\nG92.1\nG92.3\nG0 X2\n#5212=mm(2)\nG52 X1\nG92.3\nG0 X2 Y2\nM2\n",
        "G20\n#5161=mm(25.4)\nG0 X1 Y1 Z1\nG28\nM2\n",
        "#5161=mm(10)\nG43 H2\nG0 X1 Z1\nG28\nM2\n",
        "#5400=3\nG0 X1\nM2\n",
        "#5413=3\nG0 X1\nM2\n",
        "#5428=3\nG0 X1\nM2\n",
        "#5414=3\nG0 X1\nM2\n",
        "G0 X10 Y5 Z2\nG92 X0 Y1 Z0\nG1 X[#5211/mm(1)] Y[#5212/mm(1)] Z[#5213/mm(1)] F100\nM2\n",
        "T2 M6\nG0 X[#5403/mm(1)] Y[#5410/mm(1)]\nM2\n",
        "G20 T2 M6 G43\nG0 X[#5403/mm(1)] Y[#5410/mm(1)] Z9\nG49\nG0 X[#5403/mm(1)+1] Z9\nM2\n",
        "T2 M6\nG43.1 Z7\nG0 X[#5403/mm(1)] Z9\nG43 H3\nG0 X[#5403/mm(1)+1] Z9\nM2\n",
        "T2 M6\nG43\nG10 L1 P2 Z4 R3\nG0 X[#5403/mm(1)] Y[#5410/mm(1)] Z9\nM2\n",
        "T3\nG0 X[#5403+1]\nM2\n",
        "G0 X3 Y4\nG0 X[#<_y>] Y[#<_x>+1]\nG20 G0 X[#<_y>] Z[#<_x>]\nM2\n",
        "G20 G43.1 Z5\nG0 X#<_tool_offset> Y#<_metric> Z#<_imperial>\nG21 G0 Y[#<_metric>+2] Z[#<_imperial>+2]\nM2\n",
        "o1 sub\nG0 X#<_call_level>\no1 endsub\no1 call\nG0 Y[#<_call_level>+2]\nM2\n",
    ],
)
def test_what_linuxcnc_makes_of_it(text: str) -> None:
    compared(f"G21 G90\n{text}")


@pytest.mark.parametrize("seed", range(12))
def test_random_programs_that_set_them(seed: int) -> None:
    rng = random.Random(seed)
    lines = ["G21 G90"]
    codes = ["G54", "G55", "G59.3", "G92.2", "G92.3", "G28", "G30", "G28 X3", "G30 Y1 Z2", "G28.1", "G30.1", "G92.1"]
    for _ in range(60):
        value = rng.randint(-40, 40)
        lines.append(
            rng.choice(
                [
                    f"#{rng.choice(SET)}=mm({value})",
                    f"#{rng.choice((5211, 5212))}=mm({value})\nG92.3",
                    f"G0 X{rng.randint(-9, 9)} Y{value}",
                    rng.choice(codes),
                    f"G92 X{value}",
                    f"G52 Y{value}",
                    f"G10 L2 P{rng.choice((1, 2, 9))} {rng.choice('XYZ')}{value}",
                    f"G10 L20 P{rng.choice((1, 2))} X{value}",
                ]
            )
        )
    compared("\n".join([*lines, "M2", ""]))


def test_it_is_said_in_what_units_they_are_and_from_where_on_they_count() -> None:
    said = [each.text for each in read("G21 G90\n#5241=3\n#5162=4\n#5211=1\nG0 X1\nM2\n").problems]
    assert [text.split("counts from the next ")[1] for text in said] == ["G55 on.", "G28 on.", "G92.3 on."]
    assert all(text.startswith("#5") and "machine's own units" in text for text in said)


@pytest.mark.parametrize("dialect", [Dialect.FANUC, Dialect.HAAS, Dialect.MACH3])
@pytest.mark.parametrize("block", ["G91 G30 P2 Z0.", "G30 P3 X1. Y2.", "G30 P4 Z1.", "G30 Z1."])
def test_the_second_to_fourth_reference_point(dialect: Dialect, block: str) -> None:
    program = read(f"G21 G90\nG0 X1. Y2. Z3.\n{block}\nM30\n", dialect)
    assert not program.problems and len(program.homeward) == 1


@pytest.mark.parametrize(
    ("block", "dialect", "what"),
    [
        ("G30 P5 Z0.", Dialect.FANUC, "G30 has no reference point P5; write G30 with P2, P3 or P4."),
        ("G30 P2.5 Z0.", Dialect.FANUC, "P of G30 is 2.5; it must be a whole number."),
        ("G28 P2 Z0.", Dialect.LINUXCNC, "no code in this block takes this word."),
        ("G30 P2 Z0.", Dialect.LINUXCNC, "no code in this block takes this word."),
        ("G30 P2 Z0.", Dialect.GRBL, "no code in this block takes this word."),
    ],
)
def test_reference_points_that_are_none(block: str, dialect: Dialect, what: str) -> None:
    assert [each.text for each in read(f"G21 G90\n{block}\nM30\n", dialect).problems] == [what]
