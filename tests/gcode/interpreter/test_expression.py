"""Values of words: closed results, and those of LinuxCNC's own interpreter where a text leaves it open."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.gcode.interpreter.programs import ends, read, told


def value(expression: str) -> float:
    return read(f"G0 X{expression}\nM2\n").motions.end[-1, 0]


@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        ("[2+3*4**2/8]", 8),
        ("[2**3**2]", 64),
        ("[-2**2]", 4),
        ("[1 or 0 and 0]", 0),
        ("[1+2 gt 2*1]", 1),
        ("[-7 mod 3]", 2),
        ("[7 mod -3]", 1),
        ("[7 MOD 3]", 1),
        ("fix[-2.5]", -3),
        ("fup[-2.5]", -2),
        ("round[-2.5]", -3),
        ("round[2.5]", 3),
        ("atan[1]/[-1]", 135),
        ("[1 eq 1.00005]", 1),
        ("[1 ne 1.00005]", 0),
        ("[1 ge 1.00001]", 0),
        ("[1 lt 1.00001]", 1),
        ("[1 xor 1]", 0),
        ("sin[30]", 0.5),
        ("cos[60]", 0.5),
        ("tan[45]", 1),
        ("asin[0.5]", 30),
        ("acos[0.5]", 60),
        ("sqrt[16]", 4),
        ("abs[-3]", 3),
        ("exp[0]", 1),
        ("ln[1]", 0),
        ("-sin[30]", -0.5),
        ("- 1 . 5", -1.5),
        ("+.5", 0.5),
        ("1 000", 1000),
        ("-[1+2]", -3),
        ("exists[#<no>]", 0),
        ("-#30", 0),
        ("5.", 5),
    ],
)
def test_values(expression: str, expected: float) -> None:
    assert value(expression) == pytest.approx(expected, abs=1e-12)


@given(st.floats(-1e6, 1e6), st.floats(-1e6, 1e6), st.sampled_from("+-*/"))
def test_arithmetic_is_that_of_numbers(a: float, b: float, operator: str) -> None:
    left, right = f"{a:.6f}", f"{b:.6f}"
    if operator == "/" and float(right) == 0:
        return
    expected = {"+": float.__add__, "-": float.__sub__, "*": float.__mul__, "/": float.__truediv__}[operator](
        float(left), float(right)
    )
    if abs(expected) < 1e8:
        assert value(f"[{left} {operator} {right}]") == expected


def test_settings_count_from_the_next_block() -> None:
    assert ends(read("#1=1 #2=[#1+1] G0 X#1\nG0 X#1 Y#2\nM2\n"))[1][:2] == (1, 1)


def test_parameters_of_parameters_and_names() -> None:
    assert ends(read("#1=5\n##1=7\n#<a b>=2\n#[1+1]=3\nG0 X#5 Y#<AB> Z##1\nG0 X#2\nM2\n")) == [(7, 2, 7), (3, 2, 7)]


def test_the_controls_own_parameters() -> None:
    text = (
        "G10 L2 P1 X2 R0\nG54 G0 X1 Y4\n#1=#5420 #2=#5221 #3=#5220\nG0 X#1 Y#2 Z#3\nG0 X#<_y> Y#<_metric> "
        "Z[#<_coord_system>/100]\nM2\n"
    )
    assert ends(read(text))[1:] == [(3, 2, 1), (4, 1, 5.4)]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("G0 X[1", "a.ngc:1:7: expected ] or an operator, found the end of the line."),
        ("G0 X[1+]", "a.ngc:1:8: expected a number, #, [ or a function, found ']'."),
        ("G0 X (a) [ 1 / 0 ]", "divides by zero"),
        ("G0 X[1 mod 0]", "divides by zero in MOD"),
        ("G0 Xsqrt[-1]", "has no value: -1 is out of range"),
        ("G0 Xln[0]", "has no value"),
        ("#1=[9**9**9**9**9]", "has no value"),
        ("G0 X#<no>", "#<no> has no value here"),
        ("G0 X#999999", "there is no parameter #999999"),
        ("#0=1", "there is no parameter #0 to set"),
        ("#5=", "expected a number"),
        ("#5 7", "expected = behind the parameter"),
        ("G0 X#[1.5]", "it must be a whole number"),
        ("#<_x>=1", "#<_x> is the control's own"),
        ("G0 X", "a.ngc:1:5: expected a number"),
        ("G0 X1e3", "a.ngc:1:6: e3: no code in this block takes this word."),
        ("G0 X99999999999999999999", "the number is too large"),
        ("G0 Xatan[1]", "expected / and [ behind ATAN"),
        ("G0 X" + "[" * 100, "too deep"),
        ("G0 X" + "-" * 100 + "[1]", "too deep"),
    ],
)
def test_what_has_no_value_is_told_with_its_place(text: str, expected: str) -> None:
    assert expected in told(text + "\n")


def test_every_value_is_finite() -> None:
    assert math.isfinite(value("[2**29]"))
    assert "more than 1000 km" in told("G0 X[2**50]\n")
