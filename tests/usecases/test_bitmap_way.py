"""The bitmap way never gouges: its moves against the drawing, by plain float64 distances that share no code with it."""

import math
from dataclasses import replace

import numpy as np
import pytest

from app.core.errors import ParameterError
from app.formats.readers import read_drawing
from app.geometry.primitives import points_at
from app.model.contour_operation import ContourOperation
from app.model.job import Job
from app.model.moves import MoveKind
from app.model.operation import CutParameters, PocketOperation
from app.model.part import Contour, Entity, Part
from app.model.tool import Tool
from app.toolpath.coverage.areas import move_rows
from app.usecases.making.bitmap_job import drawn_job
from app.usecases.making.make import finish
from app.usecases.pixels.part import BitmapSize
from app.usecases.pixels.way import BitmapProgram, compute_on_bitmap
from tests.conftest import ROOT
from tests.part_shapes import random_part
from tests.plain_distance import distance, inside

DRAWINGS = [path for path in sorted((ROOT / "tests" / "data" / "dxf").glob("*.dxf")) if path.stem != "broken_loop"]
ROUNDING = 1e-6
"""mm by which distances may differ for the sake of arithmetic: 0 px."""


def job_of(contours: list[Contour], contour: float = 2.0, pocket: float = 4.0, stepover: float | None = None) -> Job:
    """Both tools on a drawing; a contour tool of 0 mm is none."""
    curves = [curve for each in contours for curve in each.primitives]
    operations = (PocketOperation(CutParameters(1), stepover), ContourOperation(CutParameters(2)))
    return Job(
        Part().with_entities(tuple(Entity(k, curve) for k, curve in enumerate(curves, 1))),
        (Tool(1, pocket), Tool(2, contour or 1.0)),
        operations if contour else operations[:1],
    )


def made(job: Job, points: int = 400) -> BitmapProgram:
    ready = drawn_job(job, BitmapSize(points))
    return compute_on_bitmap(ready.job, ready.part)


def along(result: BitmapProgram, tool: int, step: float) -> np.ndarray:
    """Points along all moves of a tool below Z 0, about a step apart, ends included."""
    moves = result.program.moves
    chosen = (moves.kind != MoveKind.RAPID) & (moves.tool == tool)
    rows = move_rows(moves)[chosen]
    counts = np.maximum(np.ceil(moves.lengths()[chosen] / step), 1).astype(int)
    owner = np.repeat(np.arange(len(rows)), counts + 1)
    part = np.concatenate([np.arange(n + 1) / n for n in counts]) if len(counts) else np.zeros(0)
    return points_at(rows[owner], part)


def deepest_gouge(result: BitmapProgram, job: Job, step: float) -> float:
    """How far any tool reaches beyond a wall, mm; negative = nowhere. Walls are the drawing's own curves."""
    walls = [contour for region in result.program.regions for contour in region.contours]
    worst = -math.inf
    for tool in job.tools:
        points = along(result, tool.number, step)
        if len(points):
            away = distance(points, walls)
            assert np.all(inside(points, walls) | (away < 0.02))
            worst = max(worst, tool.radius - float(away.min()))
    return worst


def check_no_gouge(job: Job, points: int) -> None:
    try:
        result = made(job, points)
    except ParameterError as error:
        assert "pixel" in str(error)
        return
    assert deepest_gouge(result, job, 0.1) <= ROUNDING


@pytest.mark.parametrize("seed", range(40))
def test_random_parts_are_not_gouged(seed: int) -> None:
    contours, _ = random_part(seed)
    rng = np.random.default_rng(seed)
    check_no_gouge(
        job_of(contours, float(rng.choice([0, 1, 1.5])), float(rng.choice([1, 2, 3])), rng.choice([None, 0.9])), 400
    )


@pytest.mark.exhaustive
@pytest.mark.parametrize(
    ("seed", "points"), [(seed, points) for seed in range(500) for points in (400, 800 if seed % 4 else 1600)]
)
def test_500_random_parts_are_not_gouged(seed: int, points: int) -> None:
    contours, _ = random_part(seed + 1000)
    rng = np.random.default_rng(seed)
    check_no_gouge(
        job_of(contours, float(rng.choice([0, 0.6, 1, 2])), float(rng.choice([1, 2, 4])), rng.choice([None, 0.9])),
        points,
    )


@pytest.mark.parametrize("path", DRAWINGS, ids=lambda path: path.stem)
def test_no_sample_drawing_is_gouged(path) -> None:
    part = read_drawing(path.name, path.read_bytes(), None, ()).part
    job = replace(job_of([]), part=part)
    size = max(np.ptp([(e.curve.start, e.curve.end) for e in part.entities], axis=(0, 1)))
    tools = (Tool(1, float(size) / 20), Tool(2, float(size) / 40))
    result = made(replace(job, tools=tools))
    assert len(result.program.moves)
    done = finish(result.program, replace(job, tools=tools))
    assert done.report.data["gouge"]["max_mm"] <= ROUNDING
    assert done.report.data["rapids_in_material"] == []
