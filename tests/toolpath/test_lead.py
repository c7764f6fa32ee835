"""Leads: tangent, clear of everything along all of their length, smaller where there is no room, and away from
corners.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.geometry.offset.offset import offset_levels
from app.geometry.outlines import nest
from app.geometry.primitives import TURN, Rows, lengths, pack, sample
from app.model.entry import Lead, LeadKind
from app.model.job import Job
from app.model.moves import Purpose
from app.model.operation import Direction, Side
from app.model.part import Contour
from app.model.tool import Tool
from app.operations.compute import compute
from app.toolpath.leads.contour_path import ContourPath, ContourPaths, headings_at, keep_clear
from app.toolpath.leads.lead import LeadContext, PathWithLeads, corners_of, lead_findings, overlap_findings, runs
from app.toolpath.machining_areas import wall_paths
from tests import plain_distance
from tests.examples import examples
from tests.operations.contour_jobs import about, contour_job, outside, rows_of, sheet_of
from tests.part_shapes import circle, fig2, random_part, square


def runs_of(
    job: Job, lead: Lead = Lead(), taken: list[tuple[float, float]] | None = None
) -> tuple[tuple[PathWithLeads, ...], LeadContext]:
    sheet, tool = sheet_of(job), job.tools[0]
    cut = job.operations[0].cut
    need = tool.radius + cut.stock_to_leave
    level = offset_levels(sheet.primitives, [need], frame=True)[0]
    paths = wall_paths(level, sheet, cut.direction)
    around = LeadContext(sheet.distances, tool, need, 1.0 if cut.direction is Direction.CLIMB else -1.0, lead)
    return runs(paths, [taken or [] for _ in paths], around), around


def ends(way: Rows) -> tuple[np.ndarray, np.ndarray]:
    return headings_at(way, np.zeros(len(way))), headings_at(way, np.ones(len(way)))


@pytest.mark.parametrize("direction", list(Direction))
@pytest.mark.parametrize("inside", [True, False])
def test_quarter_arcs_are_tangent_and_half_the_diameter_wide(direction: Direction, inside: bool) -> None:
    job = contour_job([square(40)]) if inside else contour_job([square(40)], outside())
    operation = job.operations[0]
    job = replace(job, operations=(replace(operation, cut=replace(operation.cut, direction=direction)),))
    (run,), _ = runs_of(job)
    assert run.bent and run.share == 1
    for way in (run.way_in, run.way_out):
        assert lengths(way).sum() == pytest.approx(1.5 * math.pi / 2) and way[0, 6] == pytest.approx(1.5)
    at = run.path.headings(np.array([run.start, run.stop]))
    assert ends(run.way_in)[1][0] == pytest.approx(at[0], abs=1e-9) and ends(run.way_out)[0][0] == pytest.approx(
        at[1], abs=1e-9
    )
    assert run.way_in[0, 2:4] == pytest.approx(run.path.points(np.array([run.start]))[0], abs=1e-12)
    assert run.stop - run.start == pytest.approx(run.path.length + 0.5)
    assert ends(run.way_in)[0][0] @ at[0] == pytest.approx(0, abs=1e-9)


def test_the_beginning_is_in_the_middle_of_the_longest_side() -> None:
    (run,), around = runs_of(contour_job([square(40)]))
    x, y = run.path.points(np.array([run.start]))[0]
    assert sorted((round(abs(x - 20), 9), round(abs(y - 20), 9))) == [0, 18.5]
    assert len(corners_of(run.path, around, 0.15)) == 4


def test_it_keeps_out_of_what_is_taken() -> None:
    job = contour_job([square(40)])
    (run,), around = runs_of(job)
    spans = [(run.start - 4, run.start + 4)]
    (other,), _ = runs_of(job, taken=spans)
    away = abs((other.start - run.start + other.path.length / 2) % other.path.length - other.path.length / 2)
    assert away >= 4 + around.size + around.tool.radius


@pytest.mark.parametrize("kind", [LeadKind.ARC, LeadKind.LINE])
@pytest.mark.parametrize("seed", range(8))
def test_every_lead_keeps_its_distance_from_walls(seed: int, kind: LeadKind) -> None:
    contours, crossing = random_part(seed)
    if crossing:
        contours = [square(30), circle(4, 15, 15)]
    for operation in (None, outside()):
        made, around = runs_of(contour_job(contours, operation, 1.0), Lead(kind))
        ways = [way for run in made for way in (run.way_in, run.way_out) if len(way)]
        if ways:
            points = np.concatenate([np.concatenate([sample(way, 1e-6), way[:, 2:4]]) for way in ways])
            assert plain_distance.distance(points, contours).min() >= around.need - 2e-6


def test_leads_keep_off_clamps_on_both_sides_of_the_wall() -> None:
    clamps = [square(6, 10, 45), square(6, 24, -7), square(6, 45, 17), square(6, -11, 17)]
    made, around = runs_of(contour_job([square(40)], outside(), clamps=clamps))
    assert made
    for run in made:
        for way in (run.way_in, run.way_out):
            assert (
                plain_distance.distance(np.concatenate([sample(way, 1e-6), way[:, 2:4]]), clamps).min()
                >= around.need - 2e-6
            )


def test_where_a_quarter_arc_does_not_fit_it_is_smaller_then_straight_then_left_out() -> None:
    def only(contours: list[Contour], lead: Lead) -> PathWithLeads:
        return runs_of(contour_job(contours), lead)[0][0]

    assert only([circle(2.2)], Lead()).share == 0.25 and only([circle(2.2)], Lead()).bent  # in a path of 0.7 mm
    assert only([circle(1.6)], Lead()).share == 0.125 and not only([circle(1.6)], Lead()).bent
    assert only([circle(1.51)], Lead()).share == 0  # the path is a circle of 0.01 mm
    # the largest half of a half that a square of 37 mm holds
    assert only([square(40)], Lead(radius=500.0)).share * 500 == 15.625
    line = only([square(40)], Lead(LeadKind.LINE, 36.9))
    assert not line.bent and line.share == 1 and lengths(line.way_in).sum() == pytest.approx(36.9)
    assert only([square(40)], Lead(LeadKind.NONE)).share == 0


def test_what_does_not_fit_is_told_once() -> None:
    made, around = runs_of(contour_job([circle(1.51), circle(1.51, 20, 0), circle(2.2, 40, 0), square(40, 60, 0)]))
    (finding,) = lead_findings(made, around)
    assert (
        "Of 4 paths" in finding.text
        and " 1 has smaller" in finding.text
        and "2 have no leads" in finding.text
        and not finding.counts
    )
    assert lead_findings(made[3:], around) == []
    assert lead_findings(made, replace(around, lead=Lead(LeadKind.NONE))) == []


@pytest.mark.parametrize("kind", [LeadKind.ARC, LeadKind.LINE])
@pytest.mark.parametrize("reach", [10.0, 80.0])
def test_leads_of_any_length_fit_outside_where_no_wall_or_clamp_is(kind: LeadKind, reach: float) -> None:
    operation = outside(lead=Lead(kind, reach), finish_width=1.25)
    operation = replace(operation, cut=replace(operation.cut, stock_to_leave=0.5))
    program = compute(contour_job([square(40)], operation))
    assert about(program, "leads") == []
    leads = rows_of(program.moves, Purpose.LEAD)
    whole = reach * (math.pi / 2 if kind is LeadKind.ARC else 1.0)
    assert len(leads) >= 4 and lengths(leads) == pytest.approx(whole)
    (text,) = about(compute(contour_job([circle(4)], replace(operation, side=Side.INSIDE, finish_width=0.0))), "leads")
    assert "because walls and clamps leave no room" in text


def test_an_overlap_longer_than_half_the_path_is_told() -> None:
    made, around = runs_of(contour_job([circle(2.5), square(40, 20, 0)]), Lead(overlap=4.0))
    (finding,) = overlap_findings(made, around)
    assert (
        "Of 2 paths" in finding.text
        and "1 goes on over the beginning by half the length" in finding.text
        and not finding.counts
    )
    assert overlap_findings(*runs_of(contour_job([circle(2.5)]), Lead(overlap=3.0))) == []
    inner = replace(outside(lead=Lead(overlap=4.0)), side=Side.INSIDE)
    assert about(compute(contour_job([circle(2.5)], inner)), "less than the 4 mm asked for")


def test_without_leads_there_is_no_overlap() -> None:
    (run,), _ = runs_of(contour_job([square(40)]), Lead(LeadKind.NONE))
    assert run.stop - run.start == pytest.approx(run.path.length)


@settings(max_examples=examples(25), deadline=None)
@given(st.floats(0.05, 3), st.floats(0.1, 20), st.floats(-math.pi, math.pi), st.floats(-0.5, 0.5))
def test_keep_clear_agrees_with_dense_sampling(need: float, reach: float, angle: float, off: float) -> None:
    contours = fig2()
    sheet = sheet_of(contour_job(contours))
    begin = np.array([30.0, 10.0 + off])
    row = np.array([[*begin, *(begin + reach * np.array([math.cos(angle), math.sin(angle)])), 0, 0, 0, 0]])
    least = float(
        plain_distance.distance(
            row[:, :2] + np.linspace(0, 1, 4001)[:, None] * (row[:, 2:4] - row[:, :2]), contours
        ).min()
    )
    told = bool(keep_clear(sheet.distances, row, np.array([need]))[0])
    assert told == (least >= need) or abs(least - need) < 1e-2
    assert not told or least >= need - 1e-5


def test_arcs_of_leads_turn_away_from_the_wall() -> None:
    for operation in (None, outside()):
        (run,), around = runs_of(contour_job([square(40)], operation))
        assert run.way_in[0, TURN] == run.way_out[0, TURN] == 1
        beyond = np.array([run.way_in[0, :2], run.way_out[0, 2:4]])
        assert around.field.nearest(beyond)[0] == pytest.approx(3.0)


def test_the_tool_decides_how_large_leads_are() -> None:
    (run,), around = runs_of(contour_job([square(40)], diameter=8.0))
    assert around.size == 4 and run.way_in[0, 6] == pytest.approx(4) and Tool(2, 8.0).radius == 4


def test_many_paths_are_cut_as_each_alone_is() -> None:
    """Closed ones and open ones, from anywhere and over their ends, with breaks and without."""
    rings = [
        ring.rows for part in (fig2(), [circle(6, 80, 5)]) for ring in offset_levels(pack(nest(part)), [1.0])[0].rings
    ]
    paths = [ContourPath(rows, True) for rows in rings] + [ContourPath(rows[:-1], False) for rows in rings]
    lengths_ = [path.length for path in paths]
    start = np.array([share * long for share, long in zip([0.0, 0.3, 0.9] * len(paths), lengths_, strict=False)])
    stop = np.array(
        [at + long + 0.5 if path.closed else long for path, at, long in zip(paths, start, lengths_, strict=True)]
    )
    breaks = [np.array([0.2, 0.7]) * long if k % 2 else np.zeros(0) for k, long in enumerate(lengths_)]
    found, middle = ContourPaths.of(paths).spans(start, stop, breaks)
    for k, path in enumerate(paths):
        rows, where = path.span(float(start[k]), float(stop[k]), breaks[k])
        mine = slice(*found.first[k : k + 2].tolist())
        assert found.rows[mine] == pytest.approx(rows, abs=1e-9) and middle[mine] == pytest.approx(where)
        assert np.array_equal(rows[1:, :2], rows[:-1, 2:4])
        assert lengths(rows).sum() == pytest.approx(stop[k] - start[k], abs=1e-6)
        assert rows[0, :2] == pytest.approx(path.points(start[k : k + 1])[0])
        assert rows[-1, 2:4] == pytest.approx(path.points(stop[k : k + 1])[0])
        ends = path.points(breaks[k][breaks[k] > start[k]])
        assert all(np.hypot(*(rows[:, :2] - end).T).min() < 1e-6 for end in ends)
