"""Holes: which circles are drilled, how deep, in which strokes, and what is told of the others."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from app.core.errors import ParameterError
from app.gcode.posts import load_post
from app.geometry.outlines import polygon_contour
from app.model.contour_operation import ContourOperation
from app.model.curve_selectors import on_layers
from app.model.curves import Arc
from app.model.finding import Finding, FindingKind
from app.model.hole_operations import DrillOperation
from app.model.job import Copies, Job, Stock
from app.model.moves import MoveKind, Moves, Program, Purpose
from app.model.operation import CutParameters, PocketOperation, Side
from app.model.part import Contour
from app.model.tool import Tool
from app.model.tool_kind import ToolKind
from app.operations.compute import compute
from app.toolpath.drawn_contours import drawn_contours
from app.toolpath.drill_holes import circle_of, holes_of, tip_depth
from app.toolpath.ordering.tour import in_short_order
from app.verify.verdict import gouge_depths, rapids_in_material
from tests.gcode.one_file import write_program
from tests.part_shapes import circle, layered_part, square

DRILL = Tool(1, 5.0, ToolKind.DRILL, tip_angle=math.radians(118))
TIP = 2.5 / math.tan(math.radians(59))
PLATE = [square(100), *(circle(2.5, x, y) for x in (10.0, 90.0) for y in (10.0, 90.0)), circle(4.0, 50, 50)]


def job_of(operation: DrillOperation, contours: list[Contour] = PLATE, tool: Tool = DRILL, **changes: object) -> Job:
    return replace(Job(layered_part({"a": contours}), (tool,), (operation,)), **changes)  # type: ignore[arg-type]


def places(moves: Moves) -> set[tuple[float, float]]:
    return {(round(x, 6), round(y, 6)) for x, y in moves.end[moves.purpose == Purpose.DRILL, :2].tolist()}


def texts(program: Program, kind: FindingKind = FindingKind.LEFT_OUT, counts: bool = True) -> str:
    return " ".join(each.text for each in program.findings if each.kind is kind and each.counts is counts)


def arcs(*cuts: float, radius: float = 3.0, centre: tuple[float, float] = (10.0, 10.0), off: float = 0.0) -> Contour:
    """A circle cut into arcs at some angles; with `off`, the first one's centre is that far away."""
    at = [(centre[0] + radius * math.cos(a), centre[1] + radius * math.sin(a)) for a in cuts]
    pieces = [
        Arc(a, b, (centre[0] + off * (k == 0), centre[1]), True)
        for k, (a, b) in enumerate(zip(at, at[1:] + at[:1], strict=True))
    ]
    return Contour(tuple(pieces))


def test_circles_by_any_number_of_arcs() -> None:
    for contour in (circle(3, 10, 10), arcs(0, math.pi), arcs(0, 1, 2.5, 5)):
        hole = circle_of(contour)
        assert hole is not None
        assert (hole.x, hole.y, hole.diameter) == pytest.approx((10, 10, 6))


def test_what_is_no_circle() -> None:
    assert circle_of(square()) is None
    assert circle_of(arcs(0, 2, 4, off=0.01)) is None
    assert circle_of(replace(arcs(0, math.pi), closed=False)) is None
    lens = Contour((Arc((0.0, 0.0), (10.0, 0.0), (5.0, -5.0), False), Arc((10.0, 0.0), (0.0, 0.0), (5.0, 5.0), False)))
    assert circle_of(lens) is None


def test_every_circle_as_wide_as_the_drill_is_drilled_once() -> None:
    program = compute(job_of(DrillOperation(CutParameters(1, 4.0))))
    assert places(program.moves) == {(10, 10), (10, 90), (90, 10), (90, 90)}
    drilling = program.moves.purpose == Purpose.DRILL
    assert program.moves.end[drilling, 2] == pytest.approx(-4.0 - TIP)
    assert set(program.moves.feed[drilling]) == {DRILL.plunge_rate}
    assert drilling.sum() == 4
    assert "drills 4 circles; of other diameters 1 circle is left out: 8 mm (1)" in texts(program, counts=False)
    assert "drills to the depth with its full width; its point goes 1.502 mm deeper, to 5.502 mm" in texts(
        program, FindingKind.ASSUMED, counts=False
    )
    twice = compute(job_of(DrillOperation(CutParameters(1, 4.0)), [*PLATE, *PLATE[1:]]))
    assert twice.moves.end.shape == program.moves.end.shape


@pytest.mark.parametrize(
    ("tool", "depth", "words"),
    [
        (DRILL, 4.5 + TIP, "with its full width"),
        (replace(DRILL, tip_angle=0.0), 4.5, "tells no tip angle"),
        (Tool(1, 5.0), 4.5, "goes straight down to 4.500 mm"),
    ],
)
def test_which_depth_counts_is_said(tool: Tool, depth: float, words: str) -> None:
    operation = DrillOperation(CutParameters(1, 4.0), through=0.5)
    program = compute(job_of(operation, tool=tool))
    assert float(program.moves.end[:, 2].min()) == pytest.approx(-depth)
    assert tip_depth(job_of(operation, tool=tool), operation) == pytest.approx(depth)
    assert words in texts(program, FindingKind.ASSUMED, counts=False)


@pytest.mark.parametrize(
    ("least", "most", "drilled"),
    [
        (None, None, 4),
        (5.0, 5.0, 4),
        (1.0, 8.0, 5),
        (6.0, None, 1),
        (None, 6.0, 4),
        (8.0, 8.0, 1),
        (9.0, 20.0, 0),
    ],
)
def test_diameters(least: float | None, most: float | None, drilled: int) -> None:
    operation = DrillOperation(CutParameters(1), least, most)
    job = job_of(operation)
    assert len(holes_of(job, drawn_contours(job), operation).drilled) == drilled
    assert bool(texts(compute(job))) == (drilled == 0)


@pytest.mark.parametrize("chords", [12, 48])
def test_circles_in_chords_are_drilled_and_nothing_else_follows_them(chords: int) -> None:
    turns = np.arange(chords) * math.tau / chords
    rough = polygon_contour(
        [(round(30 + 2.5 * math.cos(a), 3), round(40 + 2.5 * math.sin(a), 3)) for a in turns.tolist()]
    )
    nut = polygon_contour([(70 + 2.5 * math.cos(a), 40 + 2.5 * math.sin(a)) for a in np.arange(6) * math.tau / 6])
    on_line = ContourOperation(CutParameters(2), side=Side.ON)
    job = Job(
        layered_part({"a": [*PLATE, rough, nut]}),
        (DRILL, Tool(2, 2.0)),
        (DrillOperation(CutParameters(1, 4.0)), on_line),
    )
    program = compute(job)
    assert (30, 40) in {(round(x, 3), round(y, 3)) for x, y in places(program.moves)}
    assert (70, 40) not in {(round(x, 3), round(y, 3)) for x, y in places(program.moves)}
    assert "drills 5 circles" in texts(program, counts=False)
    begins = np.array([line.primitives[0].start for line in program.areas[1].lines])
    assert np.hypot(*(begins - (70, 40)).T).min() < 2.6
    assert np.hypot(*(begins - (30, 40)).T).min() > 2.6


def test_nothing_to_drill_counts() -> None:
    program = compute(job_of(DrillOperation(CutParameters(1)), tool=Tool(1, 3.0)))
    assert len(program.moves) == 0
    assert (
        "has nothing to drill: the drawing has no circle that it is for. Circles there are of 5 mm (4), 8 mm (1)."
        in texts(program)
    )


def test_circles_narrower_than_the_drill_are_not_drilled() -> None:
    program = compute(job_of(DrillOperation(CutParameters(1), least=1.0, most=20.0), [*PLATE, circle(1, 30, 30)]))
    assert (30, 30) not in places(program.moves)
    assert "the circle at (30.000, 30.000) is narrower than the drill by more than 0.1 mm and not drilled" in texts(
        program
    )
    assert "drawn are 8 mm (1)" in texts(program, FindingKind.TOLERANCE, counts=False)


def test_no_hole_goes_into_a_clamp() -> None:
    layers = {"a": PLATE, "k": [square(20, 0, 0), square(5, 81, 7.5)]}
    job = replace(
        Job(layered_part(layers), (DRILL,), (DrillOperation(CutParameters(1)),)),
        keep_out_layers=("k",),
        keep_out_height=20.0,
    )
    program = compute(job)
    assert places(program.moves) == {(10, 90), (90, 10), (90, 90)}
    assert "the circle at (10.000, 10.000) is under a clamp" in texts(program)
    assert program.moves.end[:, 2].max() == 21.0
    wide = replace(job, tools=(replace(DRILL, holder=((0.0, 8.0), (30.0, 8.0)), stick_out=20.0),))
    assert places(compute(wide).moves) == {(10, 90), (90, 90)}


def test_pecks_go_no_deeper_than_asked_and_rapids_stay_in_the_hole() -> None:
    job = job_of(DrillOperation(CutParameters(1, 6.0), peck=2.0), contours=[square(50), circle(2.5, 20, 20)])
    moves = compute(job).moves
    drilling = moves.purpose == Purpose.DRILL
    assert moves.end[drilling, 2] == pytest.approx([-1, -3, -5, -7, -6 - TIP])
    deepest = 0.0
    for k in range(1, len(moves)):
        if moves.kind[k] == MoveKind.RAPID:
            assert moves.end[k, 2] > deepest
        else:
            assert deepest - moves.end[k, 2] <= 2.0 + 1e-9
            deepest = min(deepest, moves.end[k, 2])
    program = compute(job)
    assert rapids_in_material(program, job) == ()
    assert float(gouge_depths(program, job).depth.max()) <= 1e-6


@pytest.mark.parametrize(("peck", "cycle"), [(None, "G98 G81"), (2.0, "G98 G83"), (0.3, "G98 G83")])
def test_holes_are_canned_cycles(peck: float | None, cycle: str) -> None:
    job = job_of(DrillOperation(CutParameters(1, 6.0), peck=peck))
    program = compute(job)
    lines = write_program(program, job, load_post("linuxcnc")).text.splitlines()
    assert sum(line.startswith(f"{cycle} X") for line in lines) == 1
    assert sum(line.startswith("X") and "R1.0000" in line for line in lines) == 3
    assert lines[-3:] == ["G80", "M5", "M2"]


def test_a_peck_shorter_than_the_gap_still_goes_down() -> None:
    job = job_of(DrillOperation(CutParameters(1, 1.0), peck=0.1), contours=[square(50), circle(2.5, 20, 20)])
    program = compute(job)
    assert rapids_in_material(program, job) == ()
    assert float(program.moves.end[:, 2].min()) == pytest.approx(-1.0 - TIP)


def test_holes_come_in_a_short_order() -> None:
    rng = np.random.default_rng(3)
    contours = [square(200), *(circle(2.5, *rng.uniform(10, 190, 2)) for _ in range(40))]
    moves = compute(job_of(DrillOperation(CutParameters(1)), contours)).moves
    down = moves.end[moves.purpose == Purpose.DRILL, :2]
    travel = float(np.hypot(*np.diff(np.vstack([[0, 0], down]), axis=0).T).sum())
    drawn_order = np.array([contour.primitives[0].centre for contour in contours[1:]])  # type: ignore[union-attr]
    assert travel < 0.5 * float(np.hypot(*np.diff(drawn_order, axis=0).T).sum())
    assert in_short_order([]) == ()


def test_copies_are_drilled_too() -> None:
    program = compute(job_of(DrillOperation(CutParameters(1)), copies=Copies(2, 2, 110.0, 110.0)))
    assert len(places(program.moves)) == 16


def test_layers() -> None:
    part = layered_part({"a": PLATE, "b": [circle(2.5, 30, 70)]})
    program = compute(Job(part, (DRILL,), (DrillOperation(CutParameters(1, curves=on_layers(("b",)))),)))
    assert places(program.moves) == {(30, 70)}


def test_deeper_than_the_stock_is_refused_but_going_through_is_not() -> None:
    with pytest.raises(ParameterError, match="Depth is 12 mm, but the stock is 10 mm thick"):
        compute(job_of(DrillOperation(CutParameters(1, 12.0))))
    through = compute(job_of(DrillOperation(CutParameters(1, 10.0), through=1.0), stock=Stock(0.0, 10.0)))
    assert float(through.moves.end[:, 2].min()) == pytest.approx(-11.0 - TIP)


def test_a_circle_that_drills_make_is_neither_wall_nor_region_for_mills() -> None:
    """Circles that no mill enters count as findings, unless they are drilled as wide as they are drawn."""
    tools = (DRILL, Tool(2, 6.0))
    apart = [square(20, -40, 0), circle(2.5, 10, 10), circle(2.5, 30, 10), circle(2.0, 50, 10)]
    mills = (PocketOperation(CutParameters(2)), ContourOperation(CutParameters(2)))
    part = layered_part({"a": apart})

    def too_small(job: Job) -> list[Finding]:
        return [each for each in compute(job).findings if each.kind is FindingKind.REGION_TOO_SMALL and each.counts]

    assert len(too_small(Job(part, tools, mills))) == 3
    assert len(too_small(Job(part, tools, (DrillOperation(CutParameters(1)), *mills)))) == 1
    assert len(too_small(Job(part, tools, (DrillOperation(CutParameters(1, enabled=False)), *mills)))) == 3
    begun = Job(
        part,
        (Tool(1, 2.0, ToolKind.DRILL), Tool(2, 6.0)),
        (DrillOperation(CutParameters(1), least=1.0, most=9.0), *mills),
    )
    assert len(too_small(begun)) == 3
    crossing = [square(20, 0, 0), circle(2.5, 20, 10), circle(2.5, 30, 10), circle(2.5, 32, 10)]
    across = compute(Job(layered_part({"a": crossing}), tools, (DrillOperation(CutParameters(1)), *mills)))
    assert not [each.text for each in across.findings if each.counts]
    assert [len(area.regions) for area in across.areas] == [3, 1, 1]
