"""Tools whose end, cone or flutes do not fit what they are to make are told."""

from __future__ import annotations

from dataclasses import replace

import pytest

from app.api import (
    BoreOperation,
    ContourOperation,
    CutParameters,
    DrillOperation,
    Job,
    PocketOperation,
    Side,
    Stock,
    Tool,
    ToolKind,
    make,
)
from app.model.curve_selectors import read_selectors
from app.model.finding import Finding, FindingKind
from app.model.operation import Operation
from app.model.part import Contour
from tests.part_shapes import circle, layered_part, square

CUT = CutParameters(1, 6.0, 6.0)
V, BALL = Tool(1, 6.0, ToolKind.V, tip_angle=1.5707963267948966), Tool(1, 6.0, ToolKind.BALL)
BULL = Tool(1, 6.0, ToolKind.BULL, corner_radius=0.5)


def told(operation: Operation, tool: Tool, *contours: Contour) -> list[Finding]:
    """What is said of a tool and what it cannot make."""
    return told_of((operation,), (tool,), *contours)


def told_of(operations: tuple[Operation, ...], tools: tuple[Tool, ...], *contours: Contour) -> list[Finding]:
    """The same of several."""
    stock = Stock(margin=8.0, thickness=8.0, under=6.0)
    kinds = {FindingKind.TOOL_SHAPE, FindingKind.SHANK_CONTACT}
    made = make(Job(layered_part({"a": list(contours)}), tools, operations, stock))
    return [each for each in made.findings if each.kind in kinds]


def test_a_bore_with_a_floor_wants_a_sharp_edge_and_one_that_goes_through_does_not() -> None:
    for tool in (BALL, BULL):
        (blind,) = told(BoreOperation(CUT), tool, circle(6.0))
        assert blind.counts and "its path is that of a flat one" in blind.text
        (narrow,) = told(BoreOperation(CUT, through=2.0), tool, circle(6.0))
        assert narrow.counts, "its full width ends above the lower side"
        assert not told(BoreOperation(CUT, through=5.0), tool, circle(6.0))


def test_a_cone_that_follows_lines_deeper_than_it_is_high_is_told() -> None:
    along = ContourOperation(CUT, Side.ON)
    (deep,) = told(along, V, square(20.0))
    assert deep.counts and "goes 6 mm deep, and its cone is 3.000 mm high" in deep.text
    assert not told(replace(along, cut=replace(CUT, depth=3.0)), V, square(20.0))
    assert not told(along, replace(V, flute_length=8.0), square(20.0))


@pytest.mark.parametrize("flutes", [0.0, 2.0, 6.0])
def test_flutes_shorter_than_a_pass_are_told_though_nobody_knows_the_shank(flutes: float) -> None:
    found = told(PocketOperation(CUT), Tool(1, 6.0, flute_length=flutes), square(20.0))
    assert bool(found) == (flutes == 2.0) and all(each.kind is FindingKind.SHANK_CONTACT for each in found)


def test_flutes_that_do_not_reach_out_of_a_hole_are_a_remark() -> None:
    drill = Tool(1, 6.0, ToolKind.DRILL, tip_angle=2.0)
    (short,) = told(DrillOperation(CUT), replace(drill, flute_length=4.0), circle(3.0))
    assert not short.counts and "its flutes are 4 mm long" in short.text
    assert not told(DrillOperation(CUT), replace(drill, flute_length=6.0), circle(3.0))


def test_a_hole_in_the_floor_of_a_pocket_begins_there() -> None:
    tools = (Tool(1, 6.0, ToolKind.DRILL, tip_angle=2.0, flute_length=4.0), Tool(2, 4.0))
    pocket = PocketOperation(CutParameters(2, 4.0, 4.0, curves=read_selectors("outer")))
    drill = DrillOperation(replace(CUT, curves=read_selectors("circles:6")))
    assert not told_of((pocket, drill), tools, square(20.0), circle(3.0))


def test_a_cone_that_goes_into_a_hole_deeper_than_it_is_high_is_told() -> None:
    (deep,) = told(DrillOperation(CUT), V, circle(3.0))
    assert deep.counts and "its cone is 3.000 mm high" in deep.text
    assert not told(DrillOperation(replace(CUT, depth=3.0)), V, circle(3.0))


def test_an_operation_that_is_off_wants_no_tool() -> None:
    off = BoreOperation(CutParameters(9, 6.0, 6.0, enabled=False))
    assert not told_of((PocketOperation(CUT), off), (Tool(1, 6.0),), square(20.0))
