"""Places and numbers in sentences: never a zero with a sign, and never digits that say nothing."""

from __future__ import annotations

import pytest

from app.core.wording import in_plane, place_mm, trimmed


@pytest.mark.parametrize(
    ("value", "told"),
    [
        (0.0, "0.000"),
        (-0.0, "0.000"),
        (-4e-17, "0.000"),
        (-0.0004999, "0.000"),
        (-0.0006, "-0.001"),
        (12.5, "12.500"),
        (-1234567.0004, "-1234567.000"),
        (3e15, "3e+15"),
    ],
)
def test_a_coordinate_has_three_decimals_and_no_sign_at_zero(value: float, told: str) -> None:
    assert place_mm(value) == told


def test_a_place_is_two_coordinates() -> None:
    assert in_plane(-1e-9, 2.0) == "(0.000, 2.000)"


def test_numbers_lose_the_zeros_at_their_end() -> None:
    assert (trimmed(2.5, 3), trimmed(-0.0001, 3), trimmed(10.0, 3)) == ("2.5", "0", "10")
