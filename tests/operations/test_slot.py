"""Slots: what is cleared is the line grown by half of the width, both ways; what is refused and told."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
import shapely

from app.core.errors import ParameterError
from app.geometry.primitives import contour_rows, sample
from app.model.curves import Arc, Line, Primitive
from app.model.finding import FindingKind
from app.model.job import Job
from app.model.moves import MoveKind, Program
from app.model.operation import CutParameters
from app.model.part import Contour
from app.model.slot_operation import SlotOperation
from app.model.tool import Tool
from app.model.tool_kind import ToolKind
from app.operations.compute import compute
from app.toolpath.coverage.areas import lines as shapes_of
from app.toolpath.coverage.areas import move_rows
from tests.operations.contour_jobs import contour_job
from tests.part_shapes import circle, square

LINE, ARC = Line((0.0, 0.0), (50.0, 0.0)), Arc((30.0, 40.0), (10.0, 60.0), (10.0, 40.0), True)
CROSS = Line((25.0, -20.0), (25.0, 20.0))


def slot_job(
    lines: list[Primitive], closed: list[Contour], width: float | None, diameter: float = 3.0, **changes: object
) -> Job:
    operation = SlotOperation(CutParameters(2, depth=3.0, stepdown=1.5), width)
    return contour_job(closed, replace(operation, **changes), diameter, lines=lines)  # type: ignore[arg-type]


def cleared(program: Program, job: Job) -> shapely.Geometry:
    """What the moves at the floor cover, with chords of 1 um."""
    moves = program.moves
    low = (moves.kind != MoveKind.RAPID) & (np.maximum(moves.start[:, 2], moves.end[:, 2]) < -3 + 1e-9)
    ways = shapes_of(move_rows(moves)[low], 1e-6)
    return shapely.union_all(shapely.buffer(ways, job.tools[0].radius, quad_segs=128))


def wanted(lines: list[Primitive], closed: list[Contour], width: float) -> shapely.Geometry:
    rows = [contour_rows(each) for each in (*(Contour((line,), False) for line in lines), *closed)]
    ways = [shapely.LineString(np.vstack([sample(each, 1e-6), each[-1:, 2:4]])) for each in rows]
    return shapely.union_all(shapely.buffer(ways, width / 2, quad_segs=128))


DRAWINGS: dict[str, tuple[list[Primitive], list[Contour]]] = {
    "line": ([LINE], []),
    "arc": ([ARC], []),
    "ring": ([], [circle(20, 5, 5)]),
    "square": ([], [square(30)]),
    "cross": ([LINE, CROSS], []),
    "crossed ring": ([LINE], [circle(20, 5, 5)]),
}


@pytest.mark.parametrize("width", [None, 3.0, 3.2, 5.0, 7.3, 12.0])
@pytest.mark.parametrize("name", DRAWINGS)
def test_what_is_cleared_is_the_line_grown(name: str, width: float | None) -> None:
    lines, closed = DRAWINGS[name]
    job = slot_job(lines, closed, width)
    program = compute(job)
    goal, made = wanted(lines, closed, width or 3.0), cleared(program, job)
    assert shapely.difference(made, goal.buffer(2e-3)).area == 0
    assert shapely.difference(goal, made).area < 0.02  # no wall of it bends in more sharply than a tool can follow
    assert not [each for each in program.findings if each.counts]


CLOSED_FORMS = {
    "line": 50 * 5 + math.pi * 2.5**2,
    "arc": 20 * math.pi / 2 * 5 + math.pi * 2.5**2,
    "ring": math.pi * (22.5**2 - 17.5**2),
}


@pytest.mark.parametrize("name", CLOSED_FORMS)
def test_areas_are_those_of_closed_forms(name: str) -> None:
    job = slot_job(*DRAWINGS[name], 5.0)
    assert cleared(compute(job), job).area == pytest.approx(CLOSED_FORMS[name], rel=1e-4)


def test_a_slot_as_wide_as_the_tool_goes_once_along_its_line_at_each_depth() -> None:
    moves = compute(slot_job([LINE], [], None)).moves
    cuts = (moves.kind != MoveKind.RAPID) & (moves.start[:, 2] == moves.end[:, 2]) & (moves.end[:, 2] < 0)
    assert np.all(moves.end[cuts, 1] == 0)
    assert set(moves.end[cuts, 2].tolist()) == {-1.5, -3.0}
    assert moves.lengths()[cuts & (moves.end[:, 2] == -3.0)].sum() <= 2 * 50 + 1e-9  # the way down is a ramp along it


def test_a_trochoidal_slot_is_cleared_too() -> None:
    short = Line((0.0, 0.0), (12.0, 0.0))
    job = slot_job([short], [], 6.0, trochoidal=True)
    program = compute(job)
    goal, made = wanted([short], [], 6.0), cleared(program, job)
    assert shapely.difference(made, goal.buffer(2e-3)).area == 0
    assert shapely.difference(goal, made).area < 0.01
    assert not [each for each in program.findings if each.counts]


def test_tools_that_make_no_slot_are_refused() -> None:
    for job, word in (
        (slot_job([LINE], [], 2.5), "thinner mill"),
        (slot_job([LINE], [], 3.0, trochoidal=True), "larger slot_width"),
        (replace(slot_job([LINE], [], 5.0), tools=(Tool(2, 3.0, ToolKind.BALL),)), "flat mill"),
    ):
        with pytest.raises(ParameterError, match=word):
            compute(job)


@pytest.mark.parametrize("trochoidal", [False, True])
@pytest.mark.parametrize("width", [None, 5.0])
def test_what_clamps_hold_is_told_and_the_rest_is_cut(width: float | None, trochoidal: bool) -> None:
    if width is None and trochoidal:
        width = 4.0
    operation = SlotOperation(CutParameters(2, depth=3.0, stepdown=3.0), width, trochoidal=trochoidal)
    job = contour_job([], operation, lines=[LINE], clamps=[circle(6, 25, 0)])
    program = compute(job)
    told = [each for each in program.findings if each.kind is FindingKind.LEFT_OUT]
    assert told and all(each.counts for each in told)
    if width is not None:
        assert told[0].amount == pytest.approx(
            shapely.Point(25, 0).buffer(6, 64).intersection(wanted([LINE], [], width)).area, abs=0.02
        )
    made = cleared(program, job)
    assert made.area > 100 and made.distance(shapely.Point(25, 0)) > 6 - 1e-3
