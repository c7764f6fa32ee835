"""Each operation works on its own curves: areas in closed form, selector by selector; selectors that find nothing."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from app.drafting.document import Document
from app.model.contour_operation import ContourOperation
from app.model.curve_selectors import read_selectors
from app.model.finding import FindingKind
from app.model.hole_operations import DrillOperation
from app.model.job import Copies, Job
from app.model.moves import Program
from app.model.operation import CutParameters, Operation, PocketOperation, Side
from app.model.part import Contour
from app.model.tool import Tool
from app.model.tool_kind import ToolKind
from app.operations.compute import compute
from app.toolpath.coverage.areas import region_shapes
from app.toolpath.coverage.coverage import measure
from app.toolpath.drawn_contours import drawn_contours, selected, selection_findings
from app.toolpath.machining_areas import MachiningAreas
from tests.part_shapes import circle, layered_part, square

PLATE = {
    "0": [square(100, 0, 0), circle(5, 20, 20), square(30, 50, 50)],
    "holes": [circle(3, 20, 80), circle(3, 80, 20), circle(4, 65, 65)],
}
"""A plate 100 x 100 (#1 to #4), a hole of 10 mm (#5), a pocket 30 x 30 (#6 to #9), holes of 6 mm (#10, #11), and a
boss of 8 mm in the pocket (#12).
"""
MILL, DRILL = Tool(1, 2.0), Tool(2, 6.0, ToolKind.DRILL)


def cut(*curves: str, tool: int = 1, depth: float = 2.0) -> CutParameters:
    return CutParameters(tool, depth, curves=read_selectors(curves))


def job(*operations: Operation, **changes: object) -> Job:
    return replace(Job(layered_part(PLATE), (MILL, DRILL), operations), **changes)  # type: ignore[arg-type]


def area(operation: Operation, task: Job) -> float:
    found = MachiningAreas(task, drawn_contours(task)).of(operation)
    return 0.0 if found is None else float(shapely.union_all(region_shapes(found.regions, 1e-4)).area)


def disc(radius: float) -> float:
    return math.pi * radius**2


@pytest.mark.parametrize(
    ("curves", "wanted"),
    [
        (("#6",), 900.0),
        (("#9",), 900.0),  # any curve of a contour stands for all of it
        (("#6", "#12"), 900.0 - disc(4)),
        (("circles:6",), 2 * disc(3)),
        (("circles:6-8",), 2 * disc(3) + disc(4)),
        (("circles:10", "#12"), disc(5) + disc(4)),
        (("layer:holes",), 2 * disc(3) + disc(4)),
        (("outer",), 10_000.0),
        (("inner",), disc(5) + 2 * disc(3) + 900.0 - disc(4)),
        (("outer", "inner"), 10_000.0 - disc(5) - 2 * disc(3) - 900.0 + disc(4)),
        ((), 10_000.0 - disc(5) - 2 * disc(3) - 900.0 + disc(4)),
        (("open",), 0.0),
    ],
)
def test_the_area_of_a_selection(curves: tuple[str, ...], wanted: float) -> None:
    operation = PocketOperation(cut(*curves))
    assert area(operation, job(operation)) == pytest.approx(wanted, rel=1e-4)
    copied = job(operation, copies=Copies(2, 1, 200.0))
    assert area(operation, copied) == pytest.approx(2 * wanted, rel=1e-4)


def reached(program: Program, operation: int) -> tuple[float, float, float, float]:
    at = program.moves.end[(program.moves.operation == operation) & (program.moves.end[:, 2] < 0)]
    return tuple(np.concatenate([at[:, :2].min(0), at[:, :2].max(0)]).round(6).tolist())


def farthest(program: Program, operation: int, middle: float) -> float:
    at = program.moves.end[(program.moves.operation == operation) & (program.moves.end[:, 2] < 0)]
    return float(np.hypot(at[:, 0] - middle, at[:, 1] - middle).max())


def test_each_operation_keeps_to_its_own_curves_and_is_judged_by_them() -> None:
    """Pocket, contours on all three sides and drill, each of other curves; nothing is left and nothing is told."""
    task = job(
        DrillOperation(cut("circles:6", tool=2, depth=4.0)),
        PocketOperation(cut("#6", "#12", depth=3.0)),
        ContourOperation(cut("#5"), Side.INSIDE),
        ContourOperation(cut("#12", depth=1.0), Side.ON),
        ContourOperation(cut("outer", depth=5.0), Side.OUTSIDE),
    )
    program = compute(task)
    assert not [each.text for each in program.findings if each.counts]
    assert reached(program, 0) == (20, 20, 80, 80)
    assert reached(program, 1) == (51, 51, 79, 79)
    assert farthest(program, 2, 20.0) == pytest.approx(4.0) and farthest(program, 3, 65.0) == pytest.approx(4.0)
    assert reached(program, 4) == (-2, -1, 101, 101)  # with its lead
    left = measure(program, task)
    assert left.reachable_left_mm2 == 0.0
    wrong = replace(task, operations=(*task.operations[:1], replace(task.operations[1], cut=cut("inner", depth=3.0))))
    assert measure(replace(program, areas=compute(wrong).areas), wrong).reachable_left_mm2 > 50.0


@pytest.mark.parametrize(
    ("operation", "text"),
    [
        (PocketOperation(cut("#99")), "Pocket T1 asks for #99, and there is none; the drawing has #1 to #12."),
        (PocketOperation(cut("circles:7")), "the drawing has circles:6, circles:8, circles:10."),
        (ContourOperation(cut("open"), Side.ON), "the drawing has 1 outer, 5 inner and no open contours."),
        (DrillOperation(cut("#6", tool=2)), "Drill T2 asks for #6, which is no circle to drill."),
    ],
)
def test_a_selector_that_finds_nothing_says_what_is_there(operation: Operation, text: str) -> None:
    task = job(operation)
    (finding,) = selection_findings(task, drawn_contours(task))
    assert finding.counts and finding.kind is FindingKind.LEFT_OUT and finding.text.endswith(text)
    assert text in " ".join(each.text for each in compute(task).findings)


def test_a_curve_that_is_open_cannot_be_a_pocket_and_is_told() -> None:
    document = Document()
    document.run("line 0,0 50,0; circle 20,20 5")
    task = Job(document.part, (MILL,), (PocketOperation(cut("#1")),))
    (finding,) = selection_findings(task, drawn_contours(task))
    assert "asks for #1, which is open, beginning at (0.000, 0.000): close it" in finding.text
    assert not selection_findings(
        replace(task, operations=(ContourOperation(cut("#1"), Side.ON),)), drawn_contours(task)
    )


def test_named_circles_are_drilled_however_wide_they_are_and_their_width_is_told() -> None:
    named = [each.text for each in compute(job(DrillOperation(cut("circles:6-8", tool=2)))).findings]
    assert "Holes come out 6 mm wide, as T2 is; drawn are 8 mm (1)." in named
    others = [each.text for each in compute(job(DrillOperation(cut("inner", tool=2)))).findings]
    assert any("2 circles are left out: 8 mm (1), 10 mm (1)" in text for text in others)


def test_a_number_stays_with_its_curve_through_edits_and_undo() -> None:
    document = Document()
    document.run("circle 0,0 5; circle 30,0 6; circle 60,0 7")
    curves = read_selectors(["#2"])

    def radius() -> list[float]:
        task = Job(document.part)
        return [
            round(math.sqrt(abs(each.primitives[0].radius ** 2)), 6)
            for each in selected(drawn_contours(task), curves).closed
        ]  # type: ignore[union-attr]

    assert radius() == [6.0]
    document.run("delete 1")
    document.run("circle 90,0 8")
    document.run("move @0,50 2")
    assert radius() == [6.0]
    document.run("delete 2")
    assert radius() == []
    document.undo()
    assert radius() == [6.0]
    again = Document()
    for line in document.log:
        again.run(line.command)
    assert [each.id for each in again.part.entities] == [each.id for each in document.part.entities]


@st.composite
def nested_rings(draw: st.DrawFn) -> tuple[list[Contour], list[tuple[int, float]]]:
    """Return circles and squares that lie in one another without touching, and depth and area of each."""
    contours: list[Contour] = []
    facts: list[tuple[int, float]] = []

    def put(x: float, y: float, radius: float, depth: int) -> None:
        if draw(st.booleans()):
            contours.append(circle(radius, x, y))
            facts.append((depth, disc(radius)))
            room = radius / math.sqrt(2)
        else:
            contours.append(square(1.4 * radius, x - 0.7 * radius, y - 0.7 * radius))
            facts.append((depth, (1.4 * radius) ** 2))
            room = 0.7 * radius
        if depth < 4 and room > 2.0:
            for corner in draw(st.lists(st.integers(0, 3), unique=True, max_size=3)):
                dx, dy = (corner % 2 - 0.5) * room, (corner // 2 - 0.5) * room
                put(x + dx, y + dy, 0.45 * room, depth + 1)

    for k in range(draw(st.integers(1, 3))):
        put(100.0 * k, 0.0, 40.0, 0)
    return contours, facts


@given(nested_rings())
def test_of_nested_curves_the_parity_of_depth_decides(made: tuple[list[Contour], list[tuple[int, float]]]) -> None:
    contours, facts = made
    task = Job(layered_part({"0": contours}), (MILL,), (PocketOperation(cut("outer")), PocketOperation(cut("inner"))))
    sizes = [area(each, task) for each in task.operations]
    outer = sum(size for depth, size in facts if depth == 0)
    inner = sum(size * (1 if depth % 2 else -1) for depth, size in facts if depth)
    assert sizes == [pytest.approx(outer, rel=1e-4), pytest.approx(inner, rel=1e-4, abs=1e-2)]
