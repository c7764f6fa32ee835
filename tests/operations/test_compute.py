"""A job to its program: order, heights, directions, findings; exact contour paths."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from app.core.errors import ParameterError
from app.geometry.outlines import polygon_contour
from app.model.contour_operation import ContourOperation
from app.model.curves import Line
from app.model.finding import FindingKind
from app.model.hole_operations import DrillOperation
from app.model.job import Job, Stock
from app.model.moves import MoveKind, Moves, Program, Purpose
from app.model.operation import CutParameters, Direction, Order, PocketOperation, Side
from app.model.part import Contour, Entity, Part
from app.model.tool import Tool
from app.operations.compute import compute
from tests import plain_distance
from tests.part_shapes import circle, fig2, random_part, square


def job_of(contours: list[Contour], pocket: float = 6.0, contour: float = 3.0, **changes: object) -> Job:
    curves = [curve for c in contours for curve in c.primitives]
    part = Part().with_entities(tuple(Entity(k, curve) for k, curve in enumerate(curves, 1)))
    return replace(Job(part, (Tool(1, pocket), Tool(2, contour))), **changes)  # type: ignore[arg-type]


def with_cut(job: Job, **changes: object) -> Job:
    return replace(job, operations=tuple(replace(op, cut=replace(op.cut, **changes)) for op in job.operations))


def along(moves: Moves, chosen: np.ndarray, per_move: int = 9) -> np.ndarray:
    """Points (n, 2) along some moves, arcs as arcs."""
    start, sweeps = moves.start, moves.sweeps()
    points = []
    for k in np.flatnonzero(chosen):
        for f in np.linspace(0, 1, per_move):
            if moves.kind[k] >= MoveKind.ARC_CW:
                away = start[k, :2] - moves.centre[k]
                angle = np.arctan2(away[1], away[0]) + f * sweeps[k]
                points.append(moves.centre[k] + np.hypot(*away) * np.array([np.cos(angle), np.sin(angle)]))
            else:
                points.append(start[k, :2] + f * (moves.end[k, :2] - start[k, :2]))
    return np.array(points)


def clearance(program: Program, contours: list[Contour], tool: int) -> float:
    moves = program.moves
    cutting = (moves.kind != MoveKind.RAPID) & (moves.end[:, 2] < 0) & (moves.tool == tool)
    return float(plain_distance.distance(along(moves, cutting), contours).min())


def test_no_cutting_move_comes_nearer_than_its_tool() -> None:
    program = compute(job_of(fig2()))
    assert clearance(program, fig2(), 2) == pytest.approx(1.5, abs=1e-6)
    assert clearance(program, fig2(), 1) == pytest.approx(4.5, abs=1e-6)


@pytest.mark.parametrize("seed", range(15))
def test_no_gouge_on_random_parts(seed: int) -> None:
    contours, crossing = random_part(seed)
    if crossing:
        contours = contours[:1] if seed % 5 == 3 else [square(30), circle(4, 15, 15)]
    program = compute(job_of(contours, pocket=2.4, contour=1.0))
    assert clearance(program, contours, 2) >= 0.5 - 1e-3
    assert clearance(program, contours, 1) >= 1.7 - 1e-3


def test_contour_path_is_the_exact_offset_with_arcs_kept() -> None:
    program = compute(job_of(fig2()))
    moves = program.moves
    contour = moves.purpose == Purpose.CONTOUR
    measured = plain_distance.distance(along(moves, contour), fig2())
    assert np.abs(measured - 1.5).max() < 1e-6
    radii = np.hypot(*(moves.end[:, :2] - moves.centre)[contour & (moves.kind >= MoveKind.ARC_CW)].T)
    assert {6.5, 9.5, 10.5} <= {round(float(r), 6) for r in radii}  # bulge 8 - 1.5, bay 8 + 1.5, circle 12 - 1.5


def test_pocket_cuts_first_and_the_tool_comes_down_once_a_stroke() -> None:
    program = compute(job_of(fig2()))
    assert program.strokes == 2
    assert list(dict.fromkeys(program.moves.tool.tolist())) == [1, 2]
    down = (program.moves.kind == MoveKind.RAPID) & (program.moves.end[:, 2] == 1.0)
    assert [int((down & (program.moves.tool == tool)).sum()) for tool in (1, 2)] == [2, 3]


def test_order_1986_cuts_the_contour_first_and_warns() -> None:
    program = compute(job_of(fig2(), order=Order.PATENT_1986))
    assert list(dict.fromkeys(program.moves.tool.tolist())) == [2, 1]
    assert any(f.kind is FindingKind.ENGAGEMENT and "100 %" in f.text for f in program.findings)


def test_rapids_travel_at_clearance_height_only() -> None:
    moves = compute(with_cut(job_of(fig2()), depth=5.0, stepdown=2.0)).moves
    rapid = moves.kind == MoveKind.RAPID
    travels = rapid & (np.hypot(*(moves.end - moves.start)[:, :2].T) > 0)
    assert np.all(moves.end[travels, 2] == 5.0) and np.all(moves.start[travels, 2] == 5.0)
    low = rapid & (moves.end[:, 2] < 1.0)
    assert np.all(moves.end[low, 2] > moves.start[low, 2]) and np.all(moves.end[low, :2] == moves.start[low, :2])
    plunge = moves.purpose == Purpose.PLUNGE
    fall = (moves.start[:, 2] - moves.end[:, 2])[plunge]
    aside = np.sqrt(np.maximum(moves.lengths()[plunge] ** 2 - fall**2, 0.0))
    assert np.all((aside < 1e-9) | (fall <= aside * np.tan(np.radians(3)) + 1e-9)) and np.all(fall > 0)


def test_depth_passes_are_equal_and_reach_the_floor() -> None:
    moves = compute(with_cut(job_of(fig2()), depth=5.0, stepdown=2.0)).moves
    cutting = moves.purpose == Purpose.POCKET
    assert sorted(set(np.round(moves.end[cutting, 2], 9))) == [-5.0, pytest.approx(-10 / 3), pytest.approx(-5 / 3)]


@pytest.mark.parametrize(
    ("direction", "sense"), [(Direction.CLIMB, MoveKind.ARC_CCW), (Direction.CONVENTIONAL, MoveKind.ARC_CW)]
)
def test_climb_is_counter_clockwise_inside_a_circle(direction: Direction, sense: MoveKind) -> None:
    moves = compute(with_cut(job_of([circle(20)]), direction=direction)).moves
    assert set(moves.kind[moves.kind >= MoveKind.ARC_CW].tolist()) == {sense}


def test_climb_is_clockwise_round_an_island() -> None:
    moves = compute(job_of([square(60), circle(5, 30, 30)])).moves
    wall = (moves.purpose == Purpose.CONTOUR) & (moves.kind >= MoveKind.ARC_CW)
    assert set(moves.kind[wall].tolist()) == {MoveKind.ARC_CW}


def test_stock_to_leave_keeps_both_tools_off_the_wall() -> None:
    program = compute(with_cut(job_of(fig2()), stock_to_leave=0.3))
    assert clearance(program, fig2(), 2) == pytest.approx(1.8, abs=1e-6)
    assert clearance(program, fig2(), 1) == pytest.approx(4.8, abs=1e-6)


def test_a_pocket_alone_goes_up_to_the_wall() -> None:
    job = job_of(fig2())
    assert clearance(compute(replace(job, operations=job.operations[:1])), fig2(), 1) == pytest.approx(3.0, abs=1e-6)


def test_a_region_too_small_is_named_and_located() -> None:
    program = compute(job_of([square(30), circle(1, 50, 10)]))
    found = [f for f in program.findings if f.kind is FindingKind.REGION_TOO_SMALL and f.counts]
    assert len(found) == 1
    assert (found[0].x, found[0].y) == pytest.approx((50, 10), abs=0.1) and found[0].amount == pytest.approx(
        2, abs=0.05
    )
    assert "T2" in found[0].text


def test_a_neck_too_narrow_is_named_and_located() -> None:
    bone = polygon_contour(
        [(0, 0), (20, 0), (20, 9), (30, 9), (30, 0), (50, 0), (50, 20), (30, 20), (30, 11), (20, 11), (20, 20), (0, 20)]
    )
    program = compute(job_of([bone]))
    neck = next(f for f in program.findings if f.kind is FindingKind.NECK_TOO_NARROW)
    assert (
        19 <= (neck.x or 0) <= 31 and neck.y == pytest.approx(10, abs=1.5) and neck.amount == pytest.approx(2, abs=0.1)
    )


def test_a_slot_exactly_as_wide_as_the_tool_is_cut_along_its_middle() -> None:
    slot = polygon_contour([(0, 0), (30, 0), (30, 3), (0, 3)])
    program = compute(job_of([slot]))
    contour = program.moves.purpose == Purpose.CONTOUR
    points = along(program.moves, contour)
    assert np.allclose(points[:, 1], 1.5, atol=1e-6)
    assert (points[:, 0].min(), points[:, 0].max()) == pytest.approx((1.5, 28.5), abs=1e-6)


def test_a_hole_exactly_as_wide_as_the_tool_is_plunged_at_its_centre() -> None:
    program = compute(job_of([circle(1.5, 7, 9)]))
    plunge = program.moves.purpose == Purpose.PLUNGE
    assert int(plunge.sum()) == 1 and program.moves.end[plunge, :2][0] == pytest.approx((7, 9), abs=1e-6)


def test_a_pocket_leads_through_a_neck_exactly_as_wide_as_the_tools() -> None:
    right, left = (
        [(20, 0), (20, 5.5), (30, 5.5), (30, 0), (50, 0)],
        [(50, 20), (30, 20), (30, 14.5), (20, 14.5), (20, 20), (0, 20)],
    )
    program = compute(job_of([polygon_contour([(0, 0), *right, *left])]))  # the neck is 9 mm = 3 + 6
    assert program.strokes == 1


def test_switched_off_operations_make_no_moves() -> None:
    assert len(compute(with_cut(job_of(fig2()), enabled=False)).moves) == 0


def test_a_drawing_without_closed_contours_says_so() -> None:
    opened = Contour(square().primitives[:3], closed=False)
    program = compute(job_of([opened]))
    assert len(program.moves) == 0 and any(f.kind is FindingKind.OPEN_CONTOUR for f in program.findings)


def test_unusable_parameters_are_refused_with_their_values() -> None:
    job = job_of(fig2())
    with pytest.raises(ParameterError, match=r"Stepover is 7 mm"):
        compute(replace(job, operations=(PocketOperation(CutParameters(1), stepover=7.0),)))
    with pytest.raises(ParameterError, match=r"stock is 10 mm"):
        compute(with_cut(replace(job, stock=Stock(thickness=10.0)), depth=12.0))
    with pytest.raises(ParameterError, match="T9"):
        compute(replace(job, operations=(ContourOperation(CutParameters(9)),)))


def test_the_same_job_gives_the_same_moves() -> None:
    first, second = (compute(job_of(fig2())).moves for _ in range(2))
    for name, column in first.columns().items():
        assert np.array_equal(column, second.columns()[name], equal_nan=column.dtype.kind == "f"), name


def test_that_lines_are_open_is_nothing_to_say_of_an_engraving() -> None:
    part = Part().with_entities((Entity(1, Line((0.0, 0.0), (30.0, 10.0))), Entity(2, Line((30.0, 10.0), (50.0, 0.0)))))
    engraving = Job(part, (Tool(1, 2.0),), (ContourOperation(CutParameters(1), Side.ON),))
    program = compute(engraving)
    assert FindingKind.OPEN_CONTOUR not in {finding.kind for finding in program.findings}
    assert len(program.moves)
    assert len(program.lines) == 1
    inside = replace(engraving, operations=(ContourOperation(CutParameters(1)),))
    assert FindingKind.OPEN_CONTOUR in {finding.kind for finding in compute(inside).findings}


def test_that_many_lines_are_open_is_nothing_to_say_of_an_engraving_either() -> None:
    part = Part().with_entities(tuple(Entity(n, Line((0.0, 5.0 * n), (30.0, 5.0 * n))) for n in range(1, 60)))
    program = compute(Job(part, (Tool(1, 2.0),), (ContourOperation(CutParameters(1), Side.ON),)))
    assert FindingKind.OPEN_CONTOUR not in {finding.kind for finding in program.findings}


def test_metal_under_a_clamp_in_the_middle_of_a_pocket_is_told() -> None:
    clamp = [Entity(50 + k, curve, "clamps") for k, curve in enumerate(circle(4.0, 20.0, 15.0).primitives)]
    task = job_of([square(40.0)])
    task = replace(
        task,
        part=task.part.with_entities((*task.part.entities, *clamp)),
        keep_out_layers=("clamps",),
        keep_out_height=5.0,
    )
    (told,) = [finding for finding in compute(task).findings if "under clamps" in finding.text]
    assert told.counts
    assert told.amount == pytest.approx(np.pi * 16, rel=1e-3)
    along = replace(task, operations=(ContourOperation(CutParameters(2)),))
    assert not any("is to be cleared" in finding.text for finding in compute(along).findings)


def test_lines_that_cross_count_for_nothing_where_they_are_engraved() -> None:
    part = Part().with_entities((Entity(1, Line((0.0, 0.0), (30.0, 0.0))), Entity(2, Line((15.0, -9.0), (15.0, 9.0)))))
    engraving = Job(part, (Tool(1, 2.0),), (ContourOperation(CutParameters(1), Side.ON),))
    assert not any(finding.counts for finding in compute(engraving).findings)


def test_a_circle_that_is_drilled_is_not_followed_as_well() -> None:
    contours = [square(40.0), circle(2.5, 20.0, 15.0)]
    task = job_of(
        contours, 5.0, 3.0, operations=(DrillOperation(CutParameters(1)), ContourOperation(CutParameters(2), Side.ON))
    )
    moves = compute(task).moves
    mill = (moves.tool == 2) & (moves.kind != MoveKind.RAPID)
    assert np.hypot(*(moves.end[mill, :2] - (20, 15)).T).min() > 10
    alone = compute(replace(task, operations=task.operations[1:])).moves
    assert np.hypot(*(alone.end[:, :2] - (20, 15)).T).min() < 3
