"""A tool fits what is drawn as wide as it is: with the digits that drawings have, a nominal size is an equal size."""

from __future__ import annotations

import math
from collections.abc import Sequence

import pytest

from app.workflow.make import Made, make
from app.workflow.options import MakeOptions

WIDTH = 3.175


def made_with(text: str, diameter: float = WIDTH) -> Made:
    return make("words.draw", text.encode(), MakeOptions(pocket_diameter=diameter, contour_diameter=diameter))


def turned(angle: float, x: float, y: float) -> str:
    """A point turned about zero, degrees, written with four digits."""
    c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    return f"{c * x - s * y:.4f},{s * x + c * y:.4f}"


def slot(angle: float) -> str:
    """A slot 20 mm from centre to centre."""
    corners = [(-10, -WIDTH / 2), (10, -WIDTH / 2), (10 + WIDTH / 2, 0), (10, WIDTH / 2), (-10, WIDTH / 2), (-10 - WIDTH / 2, 0)]
    a, b, c, d, e, f = (turned(angle, x, y) for x, y in corners)
    return f"line {a} {b}\narc {b} {c} {d}\nline {d} {e}\narc {e} {f} {a}\n"


def assert_cleared(made: Made) -> None:
    assert made.coverage.reachable_left_mm2 == 0
    assert made.coverage.unreachable_mm2 < 0.01
    assert made.clean, [finding.text for finding in made.findings if finding.counts]


@pytest.mark.parametrize("angles", [(17, 30), pytest.param(range(1, 180, 7), marks=pytest.mark.exhaustive)])
def test_a_slot_as_wide_as_its_tool(angles: Sequence[int]) -> None:
    for angle in angles:
        assert_slot_is_cut(angle)


def assert_slot_is_cut(angle: float) -> None:
    made = made_with(slot(angle))
    assert_cleared(made)
    assert not [finding.text for finding in made.findings if "too small" in finding.text]
    assert made.coverage.area_mm2 == pytest.approx(20 * WIDTH + math.pi * WIDTH**2 / 4, abs=0.01)


@pytest.mark.parametrize("spare", [-9e-4, 0.0, 9e-4])
def test_a_hole_as_wide_as_its_tool(spare: float) -> None:
    made = made_with(f"circle 0,0 {(WIDTH + spare) / 2!r}\n")
    assert_cleared(made)


@pytest.mark.parametrize("angle", [23.0])
def test_a_passage_as_wide_as_its_tool(angle: float) -> None:
    half = WIDTH / 2
    low = [(0, 0), (20, 0), (20, 10 - half), (30, 10 - half), (30, 0), (50, 0)]
    corners = [*low, *((x, 20 - y) for x, y in reversed(low))]
    points = [turned(angle, x, y) for x, y in corners]
    made = made_with("".join(f"line {a} {b}\n" for a, b in zip(points, [*points[1:], points[0]], strict=True)))
    assert made.coverage.reachable_left_mm2 == 0
    assert made.coverage.unreachable_mm2 == pytest.approx(8 * (1 - math.pi / 4) * half**2, abs=0.02)


def test_a_tool_that_is_wider_by_more_does_not_fit() -> None:
    made = made_with("circle 0,0 10\n" + f"circle 30,0 {WIDTH / 2 - 7e-4!r}\n")
    assert made.coverage.unreachable_mm2 == pytest.approx(math.pi * WIDTH**2 / 4, abs=0.02)
    assert [finding for finding in made.findings if "too small" in finding.text]
