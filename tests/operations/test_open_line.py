"""Paths on the lines: closed and open ones, their direction and order, and what clamps cut off."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.core.progress import NO_PROGRESS
from app.geometry.primitives import contour_rows, lengths, points_at, sample, signed_area
from app.model.contour_operation import ContourOperation
from app.model.curves import Arc, Line
from app.model.finding import FindingKind
from app.model.job import Job
from app.model.moves import Purpose
from app.model.operation import CutParameters, Direction, Side
from app.operations.compute import compute
from app.operations.engrave.open_line import clear_parts, line_paths
from app.toolpath.leads.contour_path import ContourPath
from tests import plain_distance
from tests.examples import examples
from tests.operations.contour_jobs import about, contour_job, rows_of, sheet_of
from tests.part_shapes import circle, fig2, square

ON = ContourOperation(CutParameters(2), Side.ON)


def paths_of(job: Job, direction: Direction = Direction.CLIMB) -> tuple[ContourPath, ...]:
    return line_paths(sheet_of(job), job.tools[0], direction, NO_PROGRESS)[0]


def test_the_centre_is_on_the_lines_and_all_of_them_are_followed() -> None:
    program = compute(contour_job(fig2(), ON))
    rows = rows_of(program.moves, Purpose.CONTOUR)
    assert plain_distance.distance(sample(rows, 1e-4), fig2()).max() < 1e-9
    whole = sum(float(lengths(contour_rows(contour)).sum()) for contour in fig2())
    assert lengths(rows).sum() == pytest.approx(whole)
    assert not rows_of(program.moves, Purpose.LEAD).size


@pytest.mark.parametrize("direction", list(Direction))
def test_loops_go_as_round_a_part_with_holes_and_inner_ones_come_first(direction: Direction) -> None:
    paths = paths_of(contour_job([square(40), circle(8, 20, 20)], ON), direction)
    sense = {path.rank: signed_area(path.rows) > 0 for path in paths}
    climb = direction is Direction.CLIMB
    assert sense == {0: not climb, 1: climb}


def test_open_lines_are_cut_as_they_are_drawn_before_loops() -> None:
    lines = [Line((50.0, 0.0), (80.0, 5.0)), Arc((50.0, 20.0), (60.0, 20.0), (55.0, 20.0), True)]
    paths = paths_of(contour_job([square(40)], ON, lines=lines))
    assert [(path.closed, path.rank) for path in paths] == [(True, 0), (False, 1), (False, 1)]
    assert paths[1].rows[0, :4].tolist() == [50, 0, 80, 5] and paths[2].length == pytest.approx(5 * math.pi)
    moves = compute(contour_job([square(40)], ON, lines=lines)).moves
    assert np.hypot(*(moves.end[moves.purpose == Purpose.CONTOUR, :2][0] - (0, 0))) > 45  # an open one first


def test_what_a_clamp_cuts_off_is_told_and_the_rest_is_cut() -> None:
    clamp = circle(4, 30, 10)
    job = contour_job([], ON, lines=[Line((0.0, 10.0), (60.0, 10.0))], clamps=[clamp])
    paths, told = line_paths(sheet_of(job), job.tools[0], Direction.CLIMB, NO_PROGRESS)
    assert sorted(round(path.length, 2) for path in paths) == [24.5, 24.5]
    (finding,) = told
    assert finding.kind is FindingKind.LEFT_OUT and finding.counts and finding.amount == pytest.approx(11, abs=3e-3)
    assert (finding.x, finding.y) == pytest.approx((30, 10), abs=2e-3)
    assert about(compute(job), "keep-out area cuts")


def test_a_contour_under_a_clamp_altogether_is_told() -> None:
    job = contour_job([square(10, 20, 20), square(10, 60, 60)], ON, clamps=[square(40, 5, 5)])
    paths, told = line_paths(sheet_of(job), job.tools[0], Direction.CLIMB, NO_PROGRESS)
    assert len(paths) == 1 and paths[0].closed
    assert [finding.amount for finding in told] == pytest.approx([40])


def test_a_loop_is_opened_at_a_clamp_in_one_piece() -> None:
    for corner in ((-3.0, -3.0), (17.0, -3.0)):
        (path,) = paths_of(contour_job([square(40)], ON, clamps=[square(6, *corner)]))
        assert not path.closed and path.length == pytest.approx(160 - 9, abs=0.1)


@settings(max_examples=examples(12), deadline=None)
@given(st.floats(0, math.tau), st.floats(-12, 12), st.floats(0.5, 6))
def test_parts_are_clear_and_nothing_clear_is_lost(angle: float, off: float, radius: float) -> None:
    along, aside = np.array([math.cos(angle), math.sin(angle)]), np.array([-math.sin(angle), math.cos(angle)])
    begin, end = off * aside - 50 * along, off * aside + 50 * along
    clamps = [square(8, -4, -4), circle(5, 20, 5)]
    job = contour_job([], ON, 2 * radius, lines=[Line(tuple(begin), tuple(end))], clamps=clamps)  # type: ignore[arg-type]
    sheet = sheet_of(job)
    rows = np.array([[*begin, *end, 0, 0, 0, 0]])
    row, low, high = clear_parts(rows, sheet.distances, radius)
    part = np.linspace(0, 1, 20001)
    places = points_at(np.repeat(rows, len(part), axis=0), part)
    clear = (plain_distance.distance(places, clamps) >= radius) & ~plain_distance.inside(places, clamps)
    told = np.zeros(len(part), bool)
    for a, b in zip(low, high, strict=True):
        told |= (part >= a) & (part <= b)
    assert not (told & ~clear & (plain_distance.distance(places, clamps) < radius - 1e-6)).any()
    assert (clear & ~told).sum() <= 8  # of 0.005 mm each
    assert (row == 0).all()
