"""Facing: the whole top is cleared by closed areas, from beside the stock, in passes; what is refused."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import shapely

from app.core.errors import ParameterError
from app.geometry.outlines import polygon_contour
from app.model.face_operation import FaceOperation, FacePattern
from app.model.finding import FindingKind
from app.model.job import Job, OriginZ, Stock
from app.model.moves import MoveKind, Program, Purpose
from app.model.operation import CutParameters, PocketOperation
from app.model.stock_box import stock_box, work_origin
from app.model.tool import Tool
from app.model.tool_kind import ToolKind
from app.operations.compute import compute
from tests.part_shapes import layered_part

PATTERNS = pytest.mark.parametrize("pattern", list(FacePattern))


def job_of(width: float = 60.0, height: float = 40.0, tool: Tool | None = None, **values: object) -> Job:
    stock = Stock(5.0, 10.0, above=0.8)
    operation = FaceOperation(CutParameters(1, stepdown=0.5), **values)
    return Job(
        layered_part({"a": [polygon_contour([(0, 0), (width, 0), (width, height), (0, height)])]}),
        (tool or Tool(1, 10.0),),
        (operation,),
        stock=stock,
    )


def cleared(program: Program, radius: float, height: float) -> shapely.Geometry:
    moves = program.moves
    low = (moves.kind == MoveKind.LINE) & (moves.purpose == Purpose.POCKET) & (np.abs(moves.end[:, 2] - height) < 1e-9)
    ways = shapely.linestrings(np.stack([moves.start[low, :2], moves.end[low, :2]], axis=1))
    return shapely.union_all(shapely.buffer(ways, radius, quad_segs=64))


@PATTERNS
@pytest.mark.parametrize(("width", "height"), [(60, 40), (40, 60), (200, 3), (33, 33), (2, 2), (500, 120)])
def test_every_pass_clears_the_whole_top(pattern: FacePattern, width: float, height: float) -> None:
    job = job_of(width, height, pattern=pattern)
    program = compute(job)
    box = stock_box(job, program.regions)
    top = shapely.box(box.x0, box.y0, box.x1, box.y1)
    for z in (0.4, 0.0):
        assert shapely.difference(top, cleared(program, 5.0, z)).area < 1e-9
    down = program.moves.purpose == Purpose.PLUNGE
    beside = shapely.distance(shapely.points(program.moves.end[down, :2]), top)
    assert down.any() and beside.min() > 5.0  # down beside the stock, with all of its width
    assert program.moves.end[:, 2].min() == 0.0
    assert not [each for each in program.findings if each.counts]


@PATTERNS
def test_a_bull_nose_clears_with_its_level_end_alone(pattern: FacePattern) -> None:
    job = job_of(tool=Tool(1, 10.0, ToolKind.BULL, corner_radius=2.0), pattern=pattern)
    program = compute(job)
    box = stock_box(job, program.regions)
    assert shapely.difference(shapely.box(box.x0, box.y0, box.x1, box.y1), cleared(program, 3.0, 0.0)).area < 1e-9


def test_one_way_goes_one_way_and_zigzag_does_not_lift() -> None:
    def runs(pattern: FacePattern) -> tuple[np.ndarray, int]:
        moves = compute(job_of(pattern=pattern)).moves
        cuts = moves.purpose == Purpose.POCKET
        return (moves.end - moves.start)[cuts, 0], int((moves.purpose == Purpose.PLUNGE).sum())

    ways, plunges = runs(FacePattern.ONE_WAY)
    assert np.all(ways > 0) and plunges == len(ways)
    assert runs(FacePattern.ZIGZAG)[1] == 2 and runs(FacePattern.SPIRAL)[1] == 2  # one a pass


def test_the_stock_stands_above_zero_and_the_origin_stays() -> None:
    job = job_of()
    box = stock_box(job, compute(job).regions)
    assert (box.z0, box.z1) == (-10.0, 0.8)
    assert work_origin(job, box)[2] == 0.0
    assert work_origin(replace(job, origin_z=OriginZ.BOTTOM), box)[2] == -10.0


def test_what_is_not_faced_first_is_told() -> None:
    job = job_of()
    pocket = Job(job.part, job.tools, (PocketOperation(CutParameters(1)), *job.operations), stock=job.stock)
    (told,) = [each for each in compute(pocket).findings if each.counts and each.kind is FindingKind.ENGAGEMENT]
    assert "put a face operation first" in told.text and told.amount == 0.8


@pytest.mark.parametrize(
    ("values", "tool", "words"),
    [
        ({"stepover": 10.5}, None, "meet in this pattern up to 10.000 mm"),
        ({"stepover": 7.5, "pattern": FacePattern.SPIRAL}, None, "up to 7.071 mm"),
        ({}, Tool(1, 6.0, ToolKind.BALL), "leaves no level floor"),
    ],
)
def test_what_cannot_face_is_refused(values: dict[str, object], tool: Tool | None, words: str) -> None:
    with pytest.raises(ParameterError, match=words):
        compute(job_of(tool=tool, **values))


def test_nothing_above_and_a_retract_in_metal_are_refused() -> None:
    job = job_of()
    with pytest.raises(ParameterError, match="nothing to face"):
        compute(replace(job, stock=Stock(5.0, 10.0)))
    with pytest.raises(ParameterError, match="stands 2 mm above Z 0, and retract Z is only 1 mm"):
        replace(job, stock=Stock(5.0, 10.0, above=2.0))
