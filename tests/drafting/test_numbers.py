"""Numbers as people type them."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.drafting.expressions.errors import CommandError
from app.drafting.expressions.numbers import angle, length
from app.drafting.expressions.words import number_text


@pytest.mark.parametrize(
    ("text", "mm"),
    [
        ("12.5", 12.5),
        (".5", 0.5),
        ("-3", -3.0),
        ("1e2", 100.0),
        ("1in", 25.4),
        ("1in+8mm", 33.4),
        (" 1in + 8 mm ", 33.4),
        ("1/4in", 6.35),
        ("-1/4in", -6.35),
        ("-(1/4)in", -6.35),
        ('3/8"', 9.525),
        ("(1+2)*3", 9.0),
        ("10/4", 2.5),
        ("2cm-5", 15.0),
        ("1ft", 304.8),
        ("500um", 0.5),
        ("-(2+3)mm", -5.0),
        ("5thou", 0.127),
        ("0.5*1in", 12.7),
        ("--2", 2.0),
    ],
)
def test_lengths_take_units_and_arithmetic(text: str, mm: float) -> None:
    assert length(text) == pytest.approx(mm, abs=1e-12)


@pytest.mark.parametrize(
    ("text", "degrees"),
    [
        ("45", 45.0),
        ("180/8", 22.5),
        ("0.5rad", math.degrees(0.5)),
        ("30°", 30.0),
        ("30 deg", 30.0),
    ],
)
def test_angles_are_degrees_unless_they_say_otherwise(text: str, degrees: float) -> None:
    assert angle(text) == pytest.approx(degrees)


@pytest.mark.parametrize(
    ("text", "column", "says"),
    [
        ("", 1, "too early"),
        ("1+", 3, "too early"),
        ("2x4", 2, "'x' is no unit"),
        ("3 4", 3, "not expected"),
        ("1/0", 3, "zero"),
        ("(1+2", 5, "bracket"),
        ("1e9", 1, "too large"),
        ("5 parsec", 3, "mm, cm"),
        ("1;2", 2, "';'"),
        ("__import__", 1, "is no number"),
        ("5,5", 1, "a point"),
    ],
)
def test_a_wrong_number_says_where_and_what(text: str, column: int, says: str) -> None:
    with pytest.raises(CommandError) as caught:
        length(text)
    assert caught.value.column == column
    assert says in caught.value.reason


def test_nesting_without_end_is_an_error_and_no_crash() -> None:
    with pytest.raises(CommandError, match="brackets"):
        length("(" * 5000 + "1")
    with pytest.raises(CommandError, match="signs"):
        length("-" * 5000 + "1")


@given(st.floats(-1e7, 1e7))
def test_a_written_number_reads_back_exactly(value: float) -> None:
    assert length(number_text(value)) == value


@given(st.text(max_size=30))
def test_any_text_is_a_number_or_a_sentence(text: str) -> None:
    try:
        assert math.isfinite(length(text))
    except CommandError as error:
        assert error.reason.endswith(".")
        assert 1 <= error.column <= len(text) + 1
