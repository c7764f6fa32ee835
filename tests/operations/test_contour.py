"""Contour operations as a whole: order, finish and spring passes, what is told, and programs that are cut and
judged.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from app.core.tolerances import NOMINAL
from app.model.contour_operation import ContourOperation
from app.model.entry import Entry, EntryKind, Lead, LeadKind, Tabs
from app.model.finding import FindingKind
from app.model.job import Copies, Job, Stock
from app.model.moves import Program, Purpose
from app.model.operation import CutParameters, Side
from app.model.part import Contour, Part
from app.model.tool import Tool
from app.operations.compute import compute
from app.toolpath.leads import contour_path
from app.usecases.job.options import MakeOptions
from app.usecases.making.make import make
from tests import plain_distance
from tests.operations.contour_jobs import about, contour_job, outside, rows_of
from tests.part_shapes import circle, fig2, square

DEEP = CutParameters(2, depth=6.0, stepdown=2.0, entry=Entry(EntryKind.PLUNGE))


def at_distance(program: Program, contours: list[Contour], distance: float) -> np.ndarray:
    """Heights (n,) of the contour moves that end at a distance from the walls, in the order of cutting."""
    moves = program.moves
    along = moves.purpose == Purpose.CONTOUR
    far = plain_distance.distance(moves.end[along, :2], contours)
    return np.asarray(moves.end[along, 2][np.abs(far - distance) < 1e-6])


def heights(values: np.ndarray) -> list[float]:
    return [float(z) for z in dict.fromkeys(values.round(6).tolist())]


def test_a_finish_pass_is_run_once_at_the_floor_after_all() -> None:
    program = compute(contour_job([square(40)], ContourOperation(DEEP, finish_width=0.3)))
    assert not about(program, "finish pass")
    assert heights(at_distance(program, [square(40)], 1.8)) == [-2, -4, -6]
    assert heights(at_distance(program, [square(40)], 1.5)) == [-6]


def test_or_at_each_pass_before_going_deeper() -> None:
    program = compute(contour_job([square(40)], ContourOperation(DEEP, finish_width=0.4, finish_each_pass=True)))
    assert heights(at_distance(program, [square(40)], 1.5)) == [-2, -4, -6]
    cut = program.moves.purpose == Purpose.CONTOUR
    assert np.all(np.diff(program.moves.end[cut, 2]) <= 1e-9)


@pytest.mark.parametrize("side", [Side.INSIDE, Side.OUTSIDE])
def test_more_than_thin_metal_is_never_finished_at_full_depth_at_once(side: Side) -> None:
    deep = CutParameters(2, depth=12.0, stepdown=2.0, entry=Entry(EntryKind.PLUNGE))
    program = compute(
        contour_job(
            [square(40)], ContourOperation(deep, side, finish_width=2.9), stock=Stock(margin=10.0, thickness=20.0)
        )
    )
    assert heights(at_distance(program, [square(40)], 1.5)) == [-2, -4, -6, -8, -10, -12]
    (told,) = [each for each in program.findings if "finish pass" in each.text]
    assert not told.counts and told.amount == 2.9 and "at every depth" in told.text
    flat = ContourOperation(CutParameters(2, depth=2.0, stepdown=2.0), side, finish_width=2.9)
    # one pass alone is as deep as was asked for
    assert not about(compute(contour_job([square(40)], flat)), "finish pass")


def test_a_finish_path_where_nothing_was_roughed_is_cut_at_every_depth() -> None:
    slot = square(3.4)
    program = compute(contour_job([slot], ContourOperation(DEEP, finish_width=0.4)))
    assert heights(at_distance(program, [slot], 1.5)) == [-2, -4, -6]


def test_spring_passes_run_the_last_path_again_at_the_floor() -> None:
    plain, sprung = (
        compute(contour_job([square(40)], ContourOperation(DEEP, lead=Lead(LeadKind.NONE), spring_passes=n)))
        for n in (0, 2)
    )
    once, again = (at_distance(program, [square(40)], 1.5).round(6).tolist() for program in (plain, sprung))
    assert (
        again.count(-6.0) == 3 * once.count(-6.0)
        and again.count(-2.0) == once.count(-2.0)
        and again.count(-4.0) == once.count(-4.0)
    )


def test_holes_are_cut_before_the_outline_that_frees_the_part() -> None:
    contours = [square(60), circle(8, 20, 20), circle(8, 40, 40)]
    moves = compute(contour_job(contours, outside(), copies=Copies(2, 1, 80.0))).moves
    cut = moves.purpose == Purpose.CONTOUR
    inside = np.array([any(x0 < x < x0 + 60 and 0 < y < 60 for x0 in (0, 80)) for x, y in moves.end[cut, :2]])
    last = int(np.flatnonzero(inside)[-1])
    assert inside[: last + 1].all() and not inside[last + 1 :].any() and inside.sum() >= 8


def test_where_the_tool_does_not_fit_is_told_outside_too() -> None:
    program = compute(contour_job([square(20)], outside(), copies=Copies(2, 1, 22.0)))
    (finding,) = [each for each in program.findings if each.kind is FindingKind.NECK_TOO_NARROW]
    assert (
        finding.counts
        and finding.amount == pytest.approx(2, abs=1e-3)
        and (finding.x, finding.y) == pytest.approx((21, 10), abs=1e-3)
    )
    hole = compute(contour_job([square(40), circle(1, 20, 20)], outside()))
    assert [each.kind for each in hole.findings if each.counts] == [FindingKind.REGION_TOO_SMALL]
    assert about(hole, "is too small")


def test_a_smaller_tool_that_follows_takes_what_the_larger_one_leaves() -> None:
    job = contour_job(
        [square(20)],
        outside(),
        copies=Copies(2, 1, 22.0),
        tools=(Tool(2, 3.0), Tool(3, 1.0)),
        operations=(outside(), ContourOperation(CutParameters(3), Side.OUTSIDE)),
    )
    assert not [each for each in compute(job).findings if each.counts]


def test_clamps_are_told_with_the_length_of_wall_they_take() -> None:
    program = compute(contour_job([square(60)], clamps=[square(20, -10, 20)]))
    (text,) = about(program, "keeps T2")
    assert "23.00 mm" in text  # 20 mm under the clamp, and 1.5 mm on both sides of it
    assert not about(compute(contour_job([square(60)], clamps=[square(10, 80, 20)])), "keeps T2")


@pytest.mark.parametrize("side", list(Side))
def test_no_cut_touches_a_clamp(side: Side) -> None:
    clamps = [square(12, -4, 20), square(6, 50, 50), circle(4, 65, 63), circle(2, 30, 41)]
    tabs = Tabs(2, places=((30.0, 0.0),))
    operation = ContourOperation(CutParameters(2), side, tabs=tabs, dog_bones=side is not Side.ON)
    moves = compute(contour_job([square(60), circle(5, 30, 30)], operation, clamps=clamps)).moves
    low = (moves.end[:, 2] < 0) & (moves.kind != 0)
    points = moves.end[low, :2]
    least = 1.5 - (NOMINAL if side is Side.ON else 1e-6)
    assert plain_distance.distance(points, clamps).min() >= least and not plain_distance.inside(points, clamps).any()


def test_leads_begin_and_end_every_path() -> None:
    program = compute(contour_job(fig2(), outside()))
    assert len(rows_of(program.moves, Purpose.LEAD)) == 6


def test_a_part_of_real_life_is_clean(data: Path) -> None:
    drawing = data / "dxf" / "gear.dxf"
    job = Job(Part(), (Tool(2, 1.0),), (outside(tabs=Tabs(3)),))
    made = make(drawing.name, drawing.read_bytes(), MakeOptions(job=job))
    assert made.program.tabs and not [finding.text for finding in made.findings if finding.counts]


@pytest.mark.filterwarnings("error")
def test_a_path_of_no_length_is_at_its_point_all_along() -> None:
    """As of a tool that is as wide as its hole: places along it were the remainder of a division by zero."""
    path = contour_path.ContourPath(np.array([[1.0, 2, 1, 2, 0, 0, 0, 0]]), closed=True)
    assert path.points(np.array([0.0, 0.5, 3.0])).tolist() == [[1, 2]] * 3
