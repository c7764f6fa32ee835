"""Centres of arcs that are given by their radius, against the plane geometry that they must obey."""

import math

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from app.gcode.interpreter.arc_kernels import centre_by_radius, radii

coordinates = st.floats(-1000, 1000)


@given(
    coordinates,
    coordinates,
    coordinates,
    coordinates,
    st.floats(1.0, 5.0),
    st.sampled_from([1, -1]),
    st.sampled_from([1, -1]),
)
def test_the_centre_is_at_the_radius_from_both_ends_and_on_the_right_side(x0, y0, x1, y1, more, turn, sign) -> None:  # type: ignore[no-untyped-def]
    chord = math.hypot(x1 - x0, y1 - y0)
    assume(chord > 1e-3)
    radius = more * chord / 2
    cx, cy = centre_by_radius(x0, y0, x1, y1, sign * radius, turn, 1e-9)
    assert radii(x0, y0, x1, y1, cx, cy) == pytest.approx((radius, radius), rel=1e-9, abs=1e-9)
    sweep = turn * (math.atan2(y1 - cy, x1 - cx) - math.atan2(y0 - cy, x0 - cx)) % math.tau
    slack = 1e-5
    assert sweep <= math.pi + slack if sign > 0 else sweep >= math.pi - slack


def test_known_centres() -> None:
    assert centre_by_radius(0.0, 0.0, 1.0, 1.0, 1.0, 1, 0.0) == pytest.approx((0.0, 1.0), abs=1e-15)
    assert centre_by_radius(0.0, 0.0, 1.0, 1.0, 1.0, -1, 0.0) == pytest.approx((1.0, 0.0), abs=1e-15)
    assert centre_by_radius(0.0, 0.0, 1.0, 1.0, -1.0, 1, 0.0) == pytest.approx((1.0, 0.0), abs=1e-15)
    assert centre_by_radius(0.0, 0.0, 2.0, 0.0, 1.0, 1, 0.0) == (1.0, 0.0)


def test_a_radius_that_is_too_small_reaches_only_with_slack() -> None:
    assert math.isnan(centre_by_radius(0.0, 0.0, 2.0, 0.0, 0.9995, 1, 0.0)[0])
    assert centre_by_radius(0.0, 0.0, 2.0, 0.0, 0.9995, 1, 0.001) == (1.0, 0.0)
    assert math.isnan(centre_by_radius(0.0, 0.0, 2.0, 0.0, 0.998, 1, 0.001)[0])


@pytest.mark.parametrize(
    "numbers",
    [
        (0.0, 0.0, 0.0, 0.0, 1.0),
        (0.0, 0.0, 1.0, 0.0, 0.0),
        (math.nan, 0.0, 1.0, 0.0, 1.0),
        (0.0, 0.0, 1.0, 0.0, math.nan),
    ],
)
def test_without_a_chord_or_a_radius_there_is_no_centre(numbers: tuple[float, ...]) -> None:
    assert all(map(math.isnan, centre_by_radius(*numbers, 1, 0.001)))
