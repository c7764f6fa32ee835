"""Rest machining: nothing within reach is left, nothing is cut twice for nothing, no wall is touched, and the tool
seldom lifts.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from app.core import tolerances
from app.core.errors import ParameterError
from app.geometry.outlines import nest, polygon_contour
from app.geometry.primitives import lengths, points_at
from app.model.contour_operation import ContourOperation
from app.model.job import Job
from app.model.moves import MoveKind, Moves, Program, Purpose
from app.model.operation import CutParameters, Direction, Operation, PocketOperation, RestOperation
from app.model.part import Contour, Entity, Part
from app.model.tool import Tool
from app.operations.compute import compute
from app.toolpath.coverage.areas import grown, lines, move_rows, region_shapes
from tests import plain_distance
from tests.examples import examples
from tests.part_shapes import circle, random_part, square

FINE = 5e-4
"""mm; chords of the oracle."""


def job_of(contours: list[Contour], tools: tuple[float, ...], *kinds: str) -> Job:
    """A job of operations such as "pocket 1", "rest 2" with tools of these diameters."""
    curves = [curve for c in contours for curve in c.primitives]
    part = Part(tuple(Entity(k, c) for k, c in enumerate(curves, 1)))
    ways: dict[str, type[Operation]] = {"pocket": PocketOperation, "rest": RestOperation, "contour": ContourOperation}
    operations = tuple(ways[word.split()[0]](CutParameters(int(word.split()[1]))) for word in kinds)
    return Job(part, tuple(Tool(k, d) for k, d in enumerate(tools, 1)), operations)


def cutting(moves: Moves, index: int) -> np.ndarray:
    """Which moves an operation makes on the floor."""
    deep = np.maximum(moves.start[:, 2], moves.end[:, 2]) <= -2 + 1e-9
    chosen: np.ndarray = deep & (moves.kind != MoveKind.RAPID) & (moves.operation == index)
    return chosen


def swept(program: Program, job: Job, *operations: int) -> shapely.Geometry:
    """What operations sweep on the floor, as polygons."""
    shapes = []
    for index in operations:
        rows = move_rows(program.moves)[cutting(program.moves, index)]
        radius = job.tool(job.operations[index].cut.tool).radius
        shapes += list(grown(lines(rows, FINE), radius, FINE)) if len(rows) else []
    return shapely.union_all(shapes)


def reached(contours: list[Contour], radius: float, leave: float = 0.0) -> shapely.Geometry:
    """What a tool reaches that keeps off the walls: the opening of the area by its disc."""
    area = shapely.union_all(region_shapes(nest(contours), FINE))
    return grown(grown(area, -radius - leave, FINE), radius - 3e-3, FINE)


def solid(shape: shapely.Geometry) -> float:
    """Area of what is thicker than 12 um."""
    return float(shapely.buffer(shapely.buffer(shape, -6e-3, join_style="mitre"), 6e-3, join_style="mitre").area)


def left(program: Program, job: Job, contours: list[Contour]) -> float:
    """What the job leaves of all that its smallest tool reaches, mm2."""
    radius = min(tool.radius for tool in job.tools)
    return solid(shapely.difference(reached(contours, radius), swept(program, job, *range(len(job.operations)))))


def lifts(program: Program, index: int) -> int:
    """How often an operation leaves the metal for clearance height."""
    moves = program.moves
    return int(
        np.count_nonzero(
            (moves.operation == index) & (moves.kind == MoveKind.RAPID) & (moves.end[:, 2] > moves.start[:, 2] + 1e-9)
        )
    )


def keeps_off(program: Program, index: int, contours: list[Contour], distance: float) -> None:
    """No place of an operation's moves below the stock's top is nearer to a wall than its tool is wide."""
    moves = program.moves
    low = (np.minimum(moves.start[:, 2], moves.end[:, 2]) < 0) & (moves.operation == index)
    rows = move_rows(moves)[low]
    for part in np.linspace(0, 1, 17):
        if len(rows):
            assert (
                plain_distance.distance(points_at(rows, np.full(len(rows), part)), contours).min()
                >= distance - tolerances.LEVEL
            )


BONE = [
    polygon_contour(
        [(0, 0), (20, 0), (20, 8), (40, 8), (40, 0), (60, 0), (60, 20), (40, 20), (40, 12), (20, 12), (20, 20), (0, 20)]
    )
]
"""Two rooms joined by a passage 4 mm wide and 20 mm long."""

WEDGE = [polygon_contour([(0, 0), (60, 0), (0, 16)])]
"""A part with sharp corners."""


@pytest.mark.parametrize("contours", [BONE, WEDGE], ids=["bone", "wedge"])
@pytest.mark.parametrize(
    "kinds", [("pocket 1", "rest 2", "contour 2"), ("pocket 1", "rest 2")], ids=["contour later", "no contour"]
)
def test_what_the_pocket_leaves_is_cleared(contours: list[Contour], kinds: tuple[str, ...]) -> None:
    job = job_of(contours, (6.0, 1.5), *kinds)
    program = compute(job)
    assert left(program, job, contours) == 0
    keeps_off(program, 1, contours, 0.75)
    without = replace(job, operations=tuple(each for each in job.operations if not isinstance(each, RestOperation)))
    assert left(compute(without), without, contours) > 1


def test_where_nothing_is_left_nothing_is_cut() -> None:
    program = compute(job_of([square(40)], (6.0, 3.0), "pocket 1", "rest 2", "contour 2"))
    assert not np.any(program.moves.operation == 1)


def test_a_passage_is_cut_by_the_rest_tool_in_one_stroke() -> None:
    job = job_of(BONE, (8.0, 2.0), "pocket 1", "rest 2")
    program = compute(job)
    assert left(program, job, BONE) == 0
    assert lifts(program, 1) <= 2
    passage = shapely.box(20, 8, 40, 12)
    assert solid(shapely.difference(passage, swept(program, job, 1))) == pytest.approx(0, abs=0.02)


def test_a_slot_as_wide_as_the_tool_is_cut_once_along_its_middle() -> None:
    slot = [polygon_contour([(0, 0), (30, 0), (30, 3), (0, 3)])]
    program = compute(job_of(slot, (6.0, 3.0), "pocket 1", "rest 2"))
    chosen = cutting(program.moves, 1) & (program.moves.purpose == Purpose.POCKET)
    rows = move_rows(program.moves)[chosen]
    assert np.allclose(rows[:, [1, 3]], 1.5, atol=1e-6)
    assert program.moves.lengths()[chosen].sum() == pytest.approx(27, abs=0.6)


def test_a_third_and_smaller_tool_clears_what_the_second_leaves() -> None:
    job = job_of(WEDGE, (6.0, 2.0, 0.5), "pocket 1", "rest 2", "rest 3")
    program = compute(job)
    assert left(program, job, WEDGE) == 0
    second = swept(program, job, 2)
    again = shapely.area(shapely.intersection(second, swept(program, job, 0, 1)))
    assert again < 0.75 * second.area  # most of what it sweeps is not cut before


def test_stock_to_leave_keeps_the_tool_off_the_walls() -> None:
    job = job_of(BONE, (8.0, 2.0), "pocket 1", "rest 2")
    job = replace(
        job, operations=tuple(replace(each, cut=replace(each.cut, stock_to_leave=0.4)) for each in job.operations)
    )
    program = compute(job)
    keeps_off(program, 1, BONE, 1.4)
    assert solid(shapely.difference(reached(BONE, 1.0, 0.4), swept(program, job, 0, 1))) == 0


def test_a_stepover_keeps_runs_together() -> None:
    """A room that the pocket tool cannot enter is cleared with as many runs as the stepover asks for."""
    room = [polygon_contour([(0, 0), (20, 0), (20, 11), (0, 11)])]
    job = job_of(room, (12.0, 4.0), "pocket 1", "rest 2")
    lengths = []
    for stepover in (4.0, 1.8):
        changed = replace(job, operations=(job.operations[0], RestOperation(CutParameters(2), stepover=stepover)))
        program = compute(changed)
        assert left(program, changed, room) == 0
        lengths.append(program.moves.lengths()[cutting(program.moves, 1)].sum())
    assert lengths[1] > 1.5 * lengths[0]


def test_a_stepover_beyond_the_diameter_is_refused() -> None:
    job = job_of([square(20)], (6.0, 3.0), "pocket 1")
    with pytest.raises(ParameterError, match=r"3.5 mm, more than the diameter of T2"):
        compute(replace(job, operations=(*job.operations, RestOperation(CutParameters(2), stepover=3.5))))


def test_metal_that_a_shallower_operation_cut_is_still_there() -> None:
    job = job_of([square(20)], (6.0, 3.0), "pocket 1", "rest 2")
    shallow = replace(job.operations[0], cut=replace(job.operations[0].cut, floor_to_leave=0.5))
    job = replace(job, operations=(shallow, job.operations[1]))
    assert solid(shapely.difference(reached([square(20)], 1.5), swept(compute(job), job, 1))) == 0


def test_the_same_paths_are_cut_at_each_depth() -> None:
    job = job_of(WEDGE, (6.0, 1.5), "pocket 1", "rest 2")
    job = replace(job, operations=tuple(replace(each, cut=replace(each.cut, stepdown=1.0)) for each in job.operations))
    moves = compute(job).moves
    runs = (moves.operation == 1) & (moves.purpose == Purpose.POCKET)
    upper, lower = (moves.end[runs & np.isclose(moves.end[:, 2], z), :2] for z in (-1.0, -2.0))
    assert len(upper) and np.array_equal(np.unique(np.round(upper, 6), axis=0), np.unique(np.round(lower, 6), axis=0))


def test_the_same_job_gives_the_same_moves() -> None:
    first, second = (compute(job_of(WEDGE, (6.0, 1.5), "pocket 1", "rest 2", "contour 2")).moves for _ in range(2))
    assert np.array_equal(first.end, second.end)


def sides(program: Program, job: Job) -> tuple[float, float]:
    """Metal, mm2, that the rest operation's runs take with it on the right of travel, and on the left; slots are in
    neither.
    """
    moves, radius = program.moves, job.tool(job.operations[1].cut.tool).radius
    rows, runs = move_rows(moves), cutting(moves, 1)
    low, high = rows[runs, :4].reshape(-1, 2).min(axis=0) - radius, rows[runs, :4].reshape(-1, 2).max(axis=0) + radius
    pitch = radius / 10
    cells = np.stack(np.meshgrid(*(np.arange(a, b, pitch) for a, b in zip(low, high, strict=True))), -1).reshape(-1, 2)
    cells = cells[~shapely.contains_xy(swept(program, job, 0), cells)]
    taken = [0, 0]
    for row, purpose in zip(rows[runs], moves.purpose[runs], strict=True):
        count = int(np.ceil(float(lengths(row[None])[0]) / (radius / 4))) + 1
        points = points_at(np.repeat(row[None], count + 1, axis=0), np.linspace(0, 1, count + 1))
        for a, b in pairwise(points):
            there = np.hypot(*(cells - (a + b) / 2).T) < radius
            aside = (b - a)[0] * (cells[there] - a)[:, 1] - (b - a)[1] * (cells[there] - a)[:, 0]
            share = [np.count_nonzero(aside < 0), np.count_nonzero(aside > 0)]
            if purpose == Purpose.POCKET and max(share) > 0.65 * sum(share):
                taken[int(np.argmax(share))] += max(share)
            cells = cells[~there]
    return taken[0] * pitch**2, taken[1] * pitch**2


@pytest.mark.parametrize("direction", list(Direction))
@pytest.mark.parametrize(
    ("contours", "tools", "least"),
    [
        ([square(40)], (12.0, 3.0), 20.0),
        (WEDGE, (6.0, 1.5), 3.0),
        ([square(60), circle(8, 20, 21), circle(8, 38, 39)], (12.0, 2.0), 5.0),
    ],
    ids=["corners", "wedge", "islands"],
)
def test_runs_keep_the_direction_that_is_asked_for(
    contours: list[Contour], tools: tuple[float, float], least: float, direction: Direction
) -> None:
    job = job_of(contours, tools, "pocket 1", "rest 2")
    turned = replace(job.operations[1], cut=replace(job.operations[1].cut, direction=direction))
    job = replace(job, operations=(job.operations[0], turned))
    right, left = sides(compute(job), job)
    kept, against = (right, left) if direction is Direction.CLIMB else (left, right)
    assert kept >= least * against


@settings(max_examples=examples(8), deadline=None)
@given(st.integers(0, 10**6))
def test_random_parts(seed: int) -> None:
    # none that cross: polygons are no oracle where walls touch themselves
    contours, _ = random_part(seed - seed % 5 + seed % 3)
    rng = np.random.default_rng(seed)
    small = float(rng.uniform(0.8, 2.5))
    kinds = ("pocket 1", "rest 2", "contour 2") if rng.random() < 0.5 else ("pocket 1", "rest 2")
    job = job_of(contours, (small * float(rng.uniform(1.2, 4)), small), *kinds)
    program = compute(job)
    assert left(program, job, contours) <= 1e-4
    keeps_off(program, 1, contours, small / 2)


def test_holes_in_a_plate_are_a_region_each() -> None:
    contours = [square(40), circle(4, 12, 12), circle(4, 28, 28)]
    job = job_of(contours, (14.0, 2.0), "pocket 1", "rest 2", "contour 2")
    program = compute(job)
    assert left(program, job, contours) == 0


@pytest.mark.parametrize("most", [1, 4])
def test_many_regions_are_cleared_part_by_part_as_they_are_together(monkeypatch: pytest.MonkeyPatch, most: int) -> None:
    """Walls lie between regions, so neither what is left of one nor a way in it has to do with another."""
    holes = [circle(4.0 + 0.1 * k, 12.0 * k + 0.37 * k * k, 11.0 * row) for k in range(4) for row in range(3)]
    job = job_of(holes, (14.0, 3.0), "pocket 1", "rest 2", "contour 2")
    together = compute(job)
    monkeypatch.setattr("app.operations.rest.paths._TOGETHER", most)
    apart = compute(job)
    assert left(apart, job, holes) <= 1e-4
    lengths_of = [np.sort(each.moves.lengths()[cutting(each.moves, 1)]) for each in (together, apart)]
    assert len(lengths_of[0]) >= len(holes)
    np.testing.assert_allclose(lengths_of[1], lengths_of[0], atol=1e-6)
