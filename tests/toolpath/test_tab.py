"""Tabs: how many, where, how wide and how high; by hand on every copy; none in the way of leads or round corners."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from app.geometry.outlines import polygon_contour
from app.geometry.primitives import lengths, points_at
from app.model.contour_operation import ContourOperation
from app.model.curves import Line, Primitive
from app.model.entry import Entry, EntryKind, Lead, LeadKind, Tabs
from app.model.job import Copies, Job
from app.model.moves import Program, Purpose
from app.model.operation import CutParameters, Side
from app.model.part import Contour
from app.operations.compute import compute
from app.toolpath.coverage.areas import move_rows
from tests import plain_distance
from tests.examples import examples
from tests.operations.contour_jobs import about, contour_job, outside, rows_of
from tests.part_shapes import circle, fig2, square

PLUNGE = Entry(EntryKind.PLUNGE)


def job_with(tabs: Tabs, contours: list[Contour] | None = None, depth: float = 4.0, **changes: object) -> Job:
    operation = replace(outside(tabs=tabs), cut=CutParameters(2, depth=depth, stepdown=depth, entry=PLUNGE))
    return contour_job([square(40)] if contours is None else contours, operation, **changes)  # type: ignore[arg-type]


def top_moves(program: Program) -> np.ndarray:
    moves = program.moves
    return (moves.purpose == Purpose.TAB) & (np.hypot(*(moves.end - moves.start)[:, :2].T) > 0)


def test_four_tabs_are_spread_over_the_sides_of_a_square() -> None:
    program = compute(job_with(Tabs(4, width=5.0, height=1.5)))
    assert len(program.tabs) == 4 and not about(program, "tabs")
    assert {(tab.width, tab.top, tab.diameter) for tab in program.tabs} == {(5.0, -2.5, 3.0)}
    over = top_moves(program)
    assert set(program.moves.end[over, 2]) == {-2.5}
    assert lengths(
        rows_of(program.moves, Purpose.TAB)[over[program.moves.purpose == Purpose.TAB]]
    ).sum() == pytest.approx(4 * (5 + 3))
    middles = np.array([(tab.x, tab.y) for tab in program.tabs])
    assert plain_distance.distance(middles, [square(40)]) == pytest.approx(np.full(4, 1.5))
    inside = (np.abs(middles - 20) < 20 - 4 + 1e-9).any(axis=1)
    assert inside.all()  # a tab's 8 mm lie beside one straight side, off the corners


def test_metal_stands_exactly_as_wide_as_asked() -> None:
    program = compute(job_with(Tabs(1, width=5.0, height=1.5)))
    (tab,) = program.tabs
    moves = program.moves
    low = (moves.kind != 0) & (moves.end[:, 2] < -3.9) & (moves.start[:, 2] < -3.9)
    points = moves.end[low, :2]
    assert np.hypot(*(points - (tab.x, tab.y)).T).min() == pytest.approx(4.0)  # half the metal and the cutter's radius


def test_by_hand_the_nearest_contour_gets_it_on_every_copy() -> None:
    places = ((20.0, -3.0), (20.0, 26.0))
    job = job_with(Tabs(places=places), [square(40), circle(8, 20, 20)], copies=Copies(2, 2, 60.0, 60.0))
    tabs = sorted((round(tab.x, 6), round(tab.y, 6)) for tab in compute(job).tabs)
    assert tabs == sorted((20.0 + dx, y + dy) for dx in (0, 60) for dy in (0, 60) for y in (-1.5, 26.5))


def test_by_hand_and_automatic_ones_keep_apart() -> None:
    program = compute(job_with(Tabs(3, places=((0.0, 20.0),))))
    middles = np.array([(tab.x, tab.y) for tab in program.tabs])
    assert len(middles) == 4
    apart = np.hypot(*(middles[:, None] - middles[None]).transpose(2, 0, 1))
    assert apart[np.triu_indices(4, 1)].min() >= 8


def test_no_tab_is_higher_than_the_stock() -> None:
    program = compute(job_with(Tabs(2, height=50.0)))
    assert {tab.top for tab in program.tabs} == {-0.001} and about(program, "as high as the cut is deep")
    assert program.moves.end[top_moves(program), 2].max() < 0


def test_short_paths_have_fewer_and_that_is_told() -> None:
    program = compute(job_with(Tabs(8, width=5.0), [circle(6)]))
    assert 0 < len(program.tabs) < 8 and about(program, "fewer than 8 tabs")
    none = compute(job_with(Tabs(2, width=60.0), [square(10)]))
    assert not none.tabs and any(finding.counts for finding in none.findings if "no tab" in finding.text)


def test_paths_with_neighbours_on_two_sides_have_fewer_for_want_of_metal_and_that_is_told() -> None:
    program = compute(job_with(Tabs(8), [square(40, 44.0 * k, 0.0) for k in range(3)]))
    (told,) = [finding.text for finding in program.findings if "fewer than 8 tabs" in finding.text]
    assert told.startswith("3 paths of T2") and "because no metal stands on the far side of the cut" in told
    alone = compute(job_with(Tabs(8, width=20.0), [square(40)]))
    assert about(alone, "fewer than 8 tabs") and not about(alone, "no metal stands")


@pytest.mark.parametrize("lead", [Lead(), Lead(LeadKind.NONE)])
def test_paths_that_clamps_cut_open_are_held_too(lead: Lead) -> None:
    clamps = [square(10, 15, -5)]
    operation = replace(outside(tabs=Tabs(4), lead=lead), cut=CutParameters(2, depth=4.0, stepdown=2.0, entry=PLUNGE))
    program = compute(contour_job([square(40)], operation, clamps=clamps))
    assert len(program.tabs) == 4 and not about(program, "tabs") and not about(program, "no tab")
    middles = np.array([(tab.x, tab.y) for tab in program.tabs])
    assert plain_distance.distance(middles, [square(40)]) == pytest.approx(np.full(4, 1.5))
    apart = np.hypot(*(middles[:, None] - middles[None]).transpose(2, 0, 1))
    assert apart[np.triu_indices(4, 1)].min() >= 20  # spread along all of it
    assert plain_distance.distance(middles, clamps).min() > 4
    over = top_moves(program)
    assert (
        lengths(rows_of(program.moves, Purpose.TAB)[over[program.moves.purpose == Purpose.TAB]]).sum() >= 4 * 8 - 1e-6
    )


def test_a_part_that_no_piece_of_its_path_holds_is_told() -> None:
    clamps = [square(10, 15, -5)]
    operation = outside(tabs=Tabs(4, width=200.0))
    program = compute(contour_job([square(40)], operation, clamps=clamps))
    (told,) = [each for each in program.findings if "no tab" in each.text]
    assert not program.tabs and told.counts and told.text.startswith("1 path of") and "has no tab" in told.text
    pieces = [square(6, 10, -4), square(6, 20, -4)]  # a short piece between two clamps, and a long one
    program = compute(contour_job([square(40)], outside(tabs=Tabs(4)), clamps=pieces))
    assert program.tabs and not about(program, "no tab")


def test_lines_that_clamps_cut_open_are_held_piece_by_piece() -> None:
    operation = ContourOperation(CutParameters(2, depth=4.0, stepdown=2.0, entry=PLUNGE), Side.ON, tabs=Tabs(3))
    clamps = [square(10, 15, -5), square(10, 15, 35)]
    program = compute(contour_job([square(40)], operation, clamps=clamps))
    middles = np.array([(tab.x, tab.y) for tab in program.tabs])
    # three on either piece, as on a closed one
    assert sorted((middles[:, 0] > 20).tolist()) == [False] * 3 + [True] * 3
    assert plain_distance.distance(middles, [square(40)]) == pytest.approx(np.zeros(6), abs=1e-9)
    assert plain_distance.distance(middles, clamps).min() > 4
    apart = np.hypot(*(middles[:, None] - middles[None]).transpose(2, 0, 1))
    assert apart[np.triu_indices(6, 1)].min() >= 5 + 2 * 3 - 1e-6
    assert (
        lengths(rows_of(program.moves, Purpose.TAB)[top_moves(program)[program.moves.purpose == Purpose.TAB]]).sum()
        >= 6 * 8 - 1e-6
    )
    assert not about(program, "tabs") and not about(program, "no tab")
    lines: list[Primitive] = [Line((60.0, 0.0), (90.0, 0.0))]
    assert len(compute(contour_job([], operation, lines=lines)).tabs) == 0  # an open line holds nothing


def test_each_loop_on_the_line_is_held_by_itself() -> None:
    """Two alike, clamps over both; nothing of the one under the larger clamp is long enough for a tab."""
    operation = ContourOperation(CutParameters(2, depth=4.0, stepdown=4.0, entry=PLUNGE), Side.ON, tabs=Tabs(2))
    clamps = [square(10, 15, -5), polygon_contour([(98, -5), (145, -5), (145, 45), (104, 45), (104, 38), (98, 38)])]
    program = compute(contour_job([square(40), square(40, 100, 0)], operation, clamps=clamps))
    assert len(program.tabs) == 2 and max(tab.x for tab in program.tabs) < 45
    (told,) = [each for each in program.findings if "no tab" in each.text]
    assert told.counts and (told.x or 0) > 90


@pytest.mark.parametrize("round_a_part", [True, False])
def test_a_tab_by_hand_on_a_path_too_short_for_it_is_told(round_a_part: bool) -> None:
    operation = replace(
        outside(tabs=Tabs(places=((6.0, 0.0), (60.0, -2.0)), width=40.0)), cut=CutParameters(2, entry=PLUNGE)
    )
    if not round_a_part:
        operation = replace(operation, side=Side.INSIDE)
    program = compute(contour_job([circle(5), square(40, 40, 0)], operation))
    assert len(program.tabs) == 1 and program.tabs[0].x == pytest.approx(60)
    (told,) = [each for each in program.findings if "by hand" in each.text]
    assert "is left out" in told.text and (told.x, told.y) == (6.0, 0.0) and told.counts == round_a_part
    assert told.amount == pytest.approx(2 * np.pi * (6.5 if round_a_part else 3.5))


def test_a_place_far_from_every_contour_is_told() -> None:
    program = compute(job_with(Tabs(places=((20.0, -16.4), (20.0, 120.0)))))
    (told,) = [each for each in program.findings if "by hand" in each.text]
    assert (
        told.counts
        and (told.x, told.y) == (20.0, 120.0)
        and told.amount == pytest.approx(78.5)
        and len(program.tabs) == 2
    )
    program = compute(job_with(Tabs(places=((20.0, -3.0),)), copies=Copies(2, 1, 60.0)))
    assert not about(program, "by hand")


def test_leads_and_overlap_keep_off_tabs() -> None:
    program = compute(job_with(Tabs(12), [circle(40)]))
    leads = rows_of(program.moves, Purpose.LEAD)
    middles = np.array([(tab.x, tab.y) for tab in program.tabs])
    assert len(middles) == 12 and len(leads) == 2
    for row in leads:
        for point in (row[:2], row[2:4]):
            assert np.hypot(*(middles - point).T).min() >= 4 + 1.5 - 0.1


def test_each_depth_pass_goes_over_the_tabs() -> None:
    operation = replace(outside(tabs=Tabs(4, height=1.0)), cut=CutParameters(2, depth=6.0, stepdown=2.0, entry=PLUNGE))
    moves = compute(contour_job([square(40)], operation)).moves
    over = (moves.purpose == Purpose.TAB) & (np.hypot(*(moves.end - moves.start)[:, :2].T) > 0)
    assert sorted(set(moves.end[over, 2].round(6))) == [-5, -4, -2]


@settings(max_examples=examples(8), deadline=None)
@given(st.integers(1, 12), st.floats(0.5, 12), st.floats(0.5, 8), st.sampled_from([LeadKind.ARC, LeadKind.NONE]))
def test_no_cut_at_the_floor_comes_into_a_tab(count: int, width: float, diameter: float, kind: LeadKind) -> None:
    operation = replace(
        outside(tabs=Tabs(count, width=width), lead=Lead(kind)), cut=CutParameters(2, 4.0, 4.0, entry=PLUNGE)
    )
    program = compute(contour_job(fig2()[::2], operation, diameter))
    moves = program.moves
    deep = (moves.end[:, 2] < -3.9) & (moves.start[:, 2] < -3.9) & (moves.purpose == Purpose.CONTOUR)
    ends = np.concatenate([moves.start[deep, :2], moves.end[deep, :2]])
    for tab in program.tabs:
        chord = np.hypot(*(ends - (tab.x, tab.y)).T).min()
        # corners bring the path's ends nearer than they are along it: the triangle is left out
        assert chord > 0.6 * (width + diameter) / 2 or width + diameter > 15
    assert len(program.tabs) <= 3 * count


def standing(program: Program) -> list[float]:
    """Return how wide the metal in each tab is: between the cutter where it rises and where it comes down."""
    moves = program.moves
    over = (moves.purpose == Purpose.TAB) & (np.hypot(*(moves.end - moves.start)[:, :2].T) > 0)
    begins = np.flatnonzero(over & ~np.append(False, over[:-1]) & (moves.start[:, 2] > -3.9))
    found = []
    for begin in begins.tolist():
        end = begin
        while over[end + 1]:
            end += 1
        found.append(float(np.hypot(*(moves.end[end] - moves.start[begin])[:2])))
    return [each - tab.diameter for each, tab in zip(found, program.tabs, strict=False)]


def sample_row(row: np.ndarray) -> np.ndarray:
    """Return points along a line or arc."""
    return points_at(np.repeat(row[None], 65, axis=0), np.linspace(0.0, 1.0, 65))


CORNERS = polygon_contour([(0, 0), (60, 0), (60, 30), (30, 30), (30, 60), (0, 60)])


@pytest.mark.parametrize("side", [Side.OUTSIDE, Side.INSIDE])
@pytest.mark.parametrize("place", [(0.0, 0.0), (30.0, 30.0), (60.0, 29.0), (31.5, 30.0)])
@pytest.mark.parametrize("width", [1.0, 5.0])
def test_a_tab_by_hand_at_a_corner_is_as_wide_as_asked_for(
    width: float, place: tuple[float, float], side: Side
) -> None:
    operation = replace(
        outside(tabs=Tabs(places=(place,), width=width)), side=side, cut=CutParameters(2, depth=4.0, entry=PLUNGE)
    )
    program = compute(contour_job([CORNERS], operation))
    assert min(standing(program)) >= width - 2e-6 and not about(program, "narrower")


@pytest.mark.parametrize("finish_width", [0.2, 0.8])
@pytest.mark.parametrize("side", [Side.OUTSIDE, Side.INSIDE])
def test_what_stands_between_roughed_and_finished_is_as_wide_as_asked_for(side: Side, finish_width: float) -> None:
    operation = replace(
        outside(tabs=Tabs(places=((0.0, 0.0), (30.0, 30.0)), width=4.0), finish_width=finish_width),
        side=side,
        cut=CutParameters(2, depth=4.0, stepdown=2.0, entry=PLUNGE),
    )
    program = compute(contour_job([CORNERS], operation))
    low = (program.moves.kind != 0) & (np.maximum(program.moves.start, program.moves.end)[:, 2] < -3.9)
    paths = shapely.MultiLineString([sample_row(row) for row in move_rows(program.moves)[low]])
    for tab in program.tabs:
        round_it = paths.intersection(shapely.Point(tab.x, tab.y).buffer(tab.width / 2 + tab.diameter / 2 + 1.0))
        cut = sorted(shapely.get_parts(round_it.buffer(tab.diameter / 2, 64)), key=lambda each: -each.area)
        assert cut[0].distance(cut[1]) >= 4.0 - 2e-3


def narrowest(program: Program, look: float) -> list[float]:
    """Return how far apart what the cutter cuts to the floor before and behind each tab is, within a distance, mm."""
    low = (program.moves.kind != 0) & (np.maximum(program.moves.start, program.moves.end)[:, 2] < -3.9)
    paths = shapely.MultiLineString([sample_row(row) for row in move_rows(program.moves)[low]])
    found = []
    for tab in program.tabs:
        near = paths.intersection(shapely.Point(tab.x, tab.y).buffer((tab.width + tab.diameter) / 2 + look))
        cut = sorted(shapely.get_parts(near.buffer(tab.diameter / 2, 64)), key=lambda each: -each.area)
        found.append(cut[0].distance(cut[1]) if len(cut) > 1 else 0.0)
    return found


@pytest.mark.parametrize("finish_width", [0.0, 0.3])
@pytest.mark.parametrize("beside", [2.6, 4.0])
@pytest.mark.parametrize("angle", [40.0, 60.0, 80.0])
def test_a_tab_beside_an_acute_corner_is_as_wide_as_asked_for(angle: float, beside: float, finish_width: float) -> None:
    turn, around = np.radians(angle), 1.5 / np.tan(np.radians(angle) / 2)  # where the path of 3 mm has its corner
    wedge = polygon_contour([(0, 0), (60, 0), (60 * float(np.cos(turn)), 60 * float(np.sin(turn)))])
    operation = replace(
        outside(tabs=Tabs(places=((around + beside, 0.0),), width=2.0), finish_width=finish_width),
        side=Side.INSIDE,
        cut=CutParameters(2, depth=4.0, stepdown=4.0 if not finish_width else 2.0, entry=PLUNGE),
    )
    program = compute(contour_job([wedge], operation))
    assert len(program.tabs) == 1 and not about(program, "narrower")
    assert min(narrowest(program, 3.0)) >= 2.0 - 2e-3


@settings(max_examples=examples(8), deadline=None)
@given(st.floats(2.0, 30.0), st.integers(1, 6), st.floats(0.5, 12), st.floats(0.5, 8))
def test_a_tab_on_a_bend_is_as_wide_as_asked_for_or_told(
    radius: float, count: int, width: float, diameter: float
) -> None:
    operation = replace(outside(tabs=Tabs(count, width=width)), cut=CutParameters(2, 4.0, 4.0, entry=PLUNGE))
    program = compute(contour_job([circle(radius)], operation, diameter))
    widths = standing(program)
    assert len(widths) == len(program.tabs)
    assert min(widths, default=width) >= width - 2e-6 or about(program, "narrower than asked for")
    assert width + diameter > 2 * radius + diameter or not about(program, "narrower than asked for")


def test_a_bend_too_tight_for_a_tab_is_told() -> None:
    program = compute(job_with(Tabs(places=((3.0, 0.0),), width=6.5), [circle(3)]))
    (told,) = [each for each in program.findings if "narrower" in each.text]
    assert told.amount == pytest.approx(standing(program)[0]) and not told.counts
