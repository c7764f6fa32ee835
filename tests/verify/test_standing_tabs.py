"""Tabs that one operation leaves and another one cuts off are told."""

from __future__ import annotations

from dataclasses import replace

import pytest

from app.api import (
    ContourOperation,
    CutParameters,
    Job,
    OriginXY,
    OriginZ,
    PocketOperation,
    Side,
    Stock,
    Tool,
    make,
    read_selectors,
)
from app.model.curves import Line
from app.model.entry import Tabs
from app.model.finding import Finding, FindingKind
from app.model.operation import Operation
from app.model.part import Contour
from tests.part_shapes import circle, layered_part, square

TOOLS = (Tool(1, 6.0), Tool(2, 3.0))
OUTER = ContourOperation(CutParameters(1, 4.0, 4.0), Side.OUTSIDE, tabs=Tabs(3, 5.0, 1.0))
FINISH = replace(OUTER, cut=CutParameters(2, 4.0, 4.0), tabs=Tabs())


A, B = read_selectors(["layer:a"]), read_selectors(["layer:b"])


def cut_off(
    contours: list[Contour],
    operations: tuple[Operation, ...],
    others: list[Contour] | None = None,
    tools: tuple[Tool, ...] = TOOLS,
) -> list[Finding]:
    """What is said of tabs that do not stand; the others lie on a layer of their own, b."""
    drawn = layered_part({"a": contours, "b": others or []})
    made = make(Job(drawn, tools, operations, Stock(margin=25.0, thickness=4.0)))
    return [each for each in made.findings if each.kind is FindingKind.TAB]


@pytest.mark.parametrize(("first", "then"), [(OUTER, FINISH), (FINISH, OUTER)], ids=["after", "before"])
def test_another_contour_without_tabs_cuts_them_off(first: Operation, then: Operation) -> None:
    (told,) = cut_off([square(40.0)], (first, then))
    assert told.counts and told.amount == pytest.approx(1.0)
    assert told.text.startswith("3 tabs do not stand") and "its top is at Z -3.000" in told.text
    assert f"NC line {told.line} cuts down to Z -4.000 across it or at its end" in told.text


def test_what_goes_over_the_same_tabs_leaves_them() -> None:
    places = replace(OUTER, tabs=Tabs(0, 5.0, 1.0, ((20.0, 0.0), (20.0, 40.0))))
    assert not cut_off([square(40.0)], (OUTER,))
    assert not cut_off([square(40.0)], (places, replace(places, cut=FINISH.cut)))


def test_a_pocket_that_crosses_a_tab_cuts_it_off_wherever_the_zero_is() -> None:
    part, notch = read_selectors(["layer:a"]), read_selectors(["layer:b"])
    contour = replace(OUTER, tabs=Tabs(0, 5.0, 1.0, ((20.0, 0.0),)), cut=replace(OUTER.cut, curves=part))
    pocket = PocketOperation(CutParameters(2, 3.5, 3.5, curves=notch))
    stock = Stock(margin=12.0, thickness=4.0)
    drawn = layered_part({"a": [square(40.0)], "b": [square(12.0, 14.0, -10.0)]})
    job = Job(drawn, TOOLS, (contour, pocket), stock, OriginXY.CENTRE, OriginZ.BOTTOM)
    (told,) = [each for each in make(job).findings if each.kind is FindingKind.TAB]
    assert told.counts and (told.x, told.y) == pytest.approx((20.0, -3.0))
    assert "its top is at Z 1.000" in told.text and "cuts down to Z 0.500" in told.text


def test_what_tabs_within_a_contour_hold_is_waste() -> None:
    inner = replace(OUTER, side=Side.INSIDE)
    (told,) = cut_off([circle(20.0)], (inner, PocketOperation(CutParameters(1, 4.0, 4.0))))
    assert not told.counts


def test_tabs_of_neighbours_are_where_metal_stands_between_them() -> None:
    """Discs a cutter's width apart: evenly spread, tabs lie where a neighbour's path, or its lead, cuts them off."""
    discs = [circle(20.0, 46.0 * (k % 3), 46.0 * (k // 3)) for k in range(6)]
    assert not cut_off(discs, (replace(OUTER, tabs=Tabs(4, 5.0, 1.0)),))


@pytest.mark.parametrize(("gap", "stands"), [(11.8, False), (11.9, False), (12.0, False), (12.2, True)])
def test_a_tab_that_ends_in_a_neighbours_channel_holds_nothing(gap: float, stands: bool) -> None:
    by_hand = replace(OUTER, tabs=Tabs(0, 5.0, 1.0, ((43.0, 20.0),)))
    told = cut_off([square(40.0), square(40.0, 40.0 + gap, 0.0)], (by_hand,))
    assert [each.counts for each in told] == ([] if stands else [True])


def test_a_part_among_neighbours_two_cutters_away_hangs_on_nothing() -> None:
    squares = [square(40.0, 52.0 * (k % 3), 52.0 * (k // 3)) for k in range(9)]
    (told,) = cut_off(squares, (replace(OUTER, tabs=Tabs(4, 5.0, 1.0)),))
    assert told.counts


@pytest.mark.parametrize("x", [50.2, 50.594])
def test_a_narrow_cut_across_a_wide_cutters_tab_is_seen(x: float) -> None:
    wide = ContourOperation(CutParameters(1, 4.0, 4.0, curves=A), Side.OUTSIDE, tabs=Tabs(0, 5.0, 1.0, ((40.0, 20.0),)))
    narrow = ContourOperation(CutParameters(2, 4.0, 2.0, curves=B), Side.ON)
    line = Contour((Line((x, -5.0), (x, 45.0)),), False)
    (told,) = cut_off([square(40.0)], (wide, narrow), [line], (Tool(1, 20.0), Tool(2, 1.0)))
    assert told.counts and told.amount == pytest.approx(1.0)


def test_a_disc_that_a_pocket_clears_is_waste_though_its_outline_was_followed_on_the_line() -> None:
    both = replace(OUTER, side=Side.ON, tabs=Tabs(2, 5.0, 1.0))
    pocket = PocketOperation(CutParameters(1, 4.0, 4.0, curves=B))
    told = cut_off([square(80.0)], (both, pocket), [circle(20.0, 40.0, 40.0)])
    assert told and not any(each.counts for each in told)


def test_a_part_in_a_hole_is_no_waste_though_the_holes_wall_is_nearer() -> None:
    part = replace(OUTER, tabs=Tabs(4, 5.0, 1.0), cut=replace(OUTER.cut, curves=A))
    hole = replace(OUTER, side=Side.INSIDE, tabs=Tabs(), cut=replace(OUTER.cut, curves=B))
    (told,) = cut_off([circle(20.0)], (part, hole), [circle(25.8)])
    assert told.counts and told.text.startswith("4 tabs do not stand")


def test_tabs_on_the_lines_are_where_no_neighbour_is() -> None:
    """Squares whose channels meet: of each one three sides are free."""
    on = replace(OUTER, side=Side.ON, tabs=Tabs(4, 5.0, 1.0))
    assert not cut_off([square(40.0), square(40.0, 44.0, 0.0)], (on,))
