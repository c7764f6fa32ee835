"""A tool fits what is drawn as wide as it is: with the digits that drawings have, a nominal size is an equal size."""

from __future__ import annotations

import math
from collections.abc import Sequence

import pytest

from app.core.tolerances import NOMINAL
from app.model.finding import FindingKind
from app.model.operation import Side
from app.usecases.job.machining import MachiningOptions
from app.usecases.job.options import MakeOptions
from app.usecases.making.make import MakeResult, make
from app.usecases.pixels.options import BitmapOptions, BitmapSize

WIDTH = 3.175


def made_with(text: str, diameter: float = WIDTH) -> MakeResult:
    return make("words.draw", text.encode(), MakeOptions(pocket_diameter=diameter, contour_diameter=diameter))


def turned(angle: float, x: float, y: float, off: float = 0.0) -> str:
    """A point turned about zero, degrees, and moved along both axes, mm, written with four digits."""
    c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    return f"{c * x - s * y + off:.4f},{s * x + c * y + off:.4f}"


def outline(angle: float, corners: Sequence[tuple[float, float]], off: float = 0.0) -> str:
    """Lines from corner to corner and back to the first, turned and moved."""
    points = [turned(angle, x, y, off) for x, y in corners]
    return "".join(f"line {a} {b}\n" for a, b in zip(points, [*points[1:], points[0]], strict=True))


def slot(angle: float, off: float = 0.0) -> str:
    """A slot 20 mm from centre to centre."""
    corners = [
        (-10, -WIDTH / 2),
        (10, -WIDTH / 2),
        (10 + WIDTH / 2, 0),
        (10, WIDTH / 2),
        (-10, WIDTH / 2),
        (-10 - WIDTH / 2, 0),
    ]
    a, b, c, d, e, f = (turned(angle, x, y, off) for x, y in corners)
    return f"line {a} {b}\narc {b} {c} {d}\nline {d} {e}\narc {e} {f} {a}\n"


def assert_cleared(made: MakeResult) -> None:
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


@pytest.mark.parametrize("angle", [17.0, 30.0])
def test_a_slot_as_wide_as_its_tool_far_from_zero(angle: float) -> None:
    assert_cleared(made_with(slot(angle, 500.0)))


@pytest.mark.parametrize(("angle", "off"), [(17.0, 0.0), (30.0, 500.0)])
def test_rest_machining_goes_into_a_neck_as_wide_as_its_tool(angle: float, off: float) -> None:
    """The larger tool clears the square; the neck is the smaller one's. What stays are six corners: four of the square,
    two of the neck.
    """
    half = WIDTH / 2
    neck = [(0, 0), (20, 0), (20, 10 - half), (32, 10 - half), (32, 10 + half), (20, 10 + half), (20, 20), (0, 20)]
    made = make(
        "words.draw", outline(angle, neck, off).encode(), MakeOptions(pocket_diameter=6.0, contour_diameter=WIDTH)
    )
    assert made.coverage.reachable_left_mm2 == 0
    assert made.coverage.unreachable_mm2 == pytest.approx(6 * (1 - math.pi / 4) * half**2, abs=0.02)
    assert made.clean, [finding.text for finding in made.findings if finding.counts]


@pytest.mark.parametrize("side", [Side.INSIDE, Side.OUTSIDE])
@pytest.mark.parametrize(("angle", "off", "deep"), [(0.0, 0.0, 6.0), (17.0, 0.0, 2.0), (30.0, 500.0, 1.0)])
def test_a_bay_as_wide_as_its_tool_is_entered(side: Side, angle: float, off: float, deep: float) -> None:
    """Of a square with a bay in one side, into the part or out of it, corners alone are left: those of the square where
    it is cleared inside, the two of the bay either way.
    """
    half = WIDTH / 2
    end = 20 + (deep if side is Side.INSIDE else -deep) + (half if side is Side.INSIDE else -half)
    bay = [(0, 0), (20, 0), (20, 10 - half), (end, 10 - half), (end, 10 + half), (20, 10 + half), (20, 20), (0, 20)]
    pocket = WIDTH if side is Side.INSIDE else None
    options = MakeOptions(pocket_diameter=pocket, contour_diameter=WIDTH, machining=MachiningOptions.of(side=side))
    made = make("words.draw", outline(angle, bay, off).encode(), options)
    corners = 6 if side is Side.INSIDE else 2
    assert made.coverage.reachable_left_mm2 == 0
    assert made.coverage.unreachable_mm2 == pytest.approx(corners * (1 - math.pi / 4) * half**2, abs=0.02)
    assert made.clean, [finding.text for finding in made.findings if finding.counts]


@pytest.mark.parametrize(("angle", "off"), [(17.0, 0.0), (30.0, 500.0)])
def test_a_line_as_far_from_a_clamp_as_its_tool_is_wide_is_cut(angle: float, off: float) -> None:
    half = WIDTH / 2
    clamp = outline(angle, [(10, half), (30, half), (30, 20), (10, 20)], off)
    text = f"layer clamps\n{clamp}layer 0\nline {turned(angle, 0, 0, off)} {turned(angle, 40, 0, off)}\n"
    machining = MachiningOptions.of(side=Side.ON, keep_out=("clamps",), keep_out_height=5.0)
    made = make("words.draw", text.encode(), MakeOptions(contour_diameter=WIDTH, machining=machining))
    assert not [finding.text for finding in made.findings if "cuts" in finding.text]
    assert made.clean, [finding.text for finding in made.findings if finding.counts]


@pytest.mark.parametrize("spare", [-9e-4, 0.0, 9e-4])
def test_a_hole_as_wide_as_its_tool(spare: float) -> None:
    made = made_with(f"circle 0,0 {(WIDTH + spare) / 2!r}\n")
    assert_cleared(made)


@pytest.mark.parametrize("angle", [23.0])
def test_a_passage_as_wide_as_its_tool(angle: float) -> None:
    half = WIDTH / 2
    low = [(0, 0), (20, 0), (20, 10 - half), (30, 10 - half), (30, 0), (50, 0)]
    corners = [*low, *((x, 20 - y) for x, y in reversed(low))]
    made = made_with(outline(angle, corners))
    assert made.coverage.reachable_left_mm2 == 0
    assert made.coverage.unreachable_mm2 == pytest.approx(8 * (1 - math.pi / 4) * half**2, abs=0.02)


def test_a_tool_that_is_wider_by_more_does_not_fit() -> None:
    made = made_with("circle 0,0 10\n" + f"circle 30,0 {WIDTH / 2 - 7e-4!r}\n")
    assert made.coverage.unreachable_mm2 == pytest.approx(math.pi * WIDTH**2 / 4, abs=0.02)
    assert [finding for finding in made.findings if "too small" in finding.text]


def narrow_words(made: MakeResult) -> list[str]:
    return [
        finding.text
        for finding in made.findings
        if finding.kind in (FindingKind.REGION_TOO_SMALL, FindingKind.NECK_TOO_NARROW)
    ]


@pytest.mark.parametrize("width", [5.999, 5.9989, 5.998, 5.996])
def test_a_hole_that_is_too_small_is_told_to_be_smaller_than_the_tool_and_out_of_its_reach(width: float) -> None:
    made = made_with(f"circle 0,0 10\ncircle 30,0 {width / 2!r}\n", 6.0)
    assert made.coverage.reachable_left_mm2 == 0
    (told,) = {float(text.split("about ")[1].split()[0]) for text in narrow_words(made)}
    assert width - 0.006 < told <= 5.999


def test_what_no_path_enters_is_out_of_reach_at_the_very_limit() -> None:
    """0.5 um of radius too large, to the last digit: the ring at that distance is one point, and nothing."""
    made = made_with(f"circle 0,0 10\ncircle 30,0 {3 - NOMINAL!r}\n", 6.0)
    assert made.coverage.reachable_left_mm2 == 0 and made.coverage.unreachable_mm2 == pytest.approx(
        math.pi * 9, abs=0.05
    )


@pytest.mark.parametrize("width", [6.0, 10.0])
def test_the_corners_of_a_slot_beside_another_area_are_no_necks(width: float) -> None:
    made = made_with(f"rect 0,{7 - width / 2!r} 40,{7 + width / 2!r}\nrect 40,-5 60,20\n", 6.0)
    assert narrow_words(made) == []
    assert made.coverage.unreachable_mm2 == pytest.approx(8 * (1 - math.pi / 4) * 9, abs=0.02)


@pytest.mark.parametrize("width", [3.175, 3.3])
def test_on_pixels_an_area_without_a_path_is_told_once_and_not_to_be_too_small(width: float) -> None:
    options = MakeOptions(pocket_diameter=3.175, contour_diameter=3.175, bitmap=BitmapOptions(BitmapSize(400)))
    made = make("words.draw", f"slot -8,0 8,0 {width}\nrect 20,0 60,40\n".encode(), options)
    (told,) = narrow_words(made)
    assert "has no room for T1 Flat 3.175 mm on pixels of 0.176 mm" in told
    (left,) = [finding.text for finding in made.findings if finding.kind is FindingKind.LEFT_REACHABLE]
    assert left.endswith("use a smaller pocket tool or a larger bitmap.")
