"""Strokes given to `emit` as an operation gives them, and what comes out, for tests."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from app.core.progress import NO_PROGRESS
from app.geometry.primitives import Rows, contour_rows
from app.model.contour_operation import ContourOperation
from app.model.job import Job
from app.model.moves import MoveKind, Moves, Purpose
from app.model.operation import CutParameters, Operation, PocketOperation
from app.model.part import Contour, Entity, Part
from app.model.tool import Tool
from app.toolpath.build import Stroke
from app.toolpath.drawn_contours import drawn_contours
from app.toolpath.machining_areas import MachiningAreas
from app.toolpath.operation_context import OperationContext, emit
from tests.part_shapes import square

TOOL = Tool(1, 6.0, feed_rate=600.0, plunge_rate=200.0)


def setting_of(
    contours: Sequence[Contour] = (square(100),), operation: Operation | None = None, **changes: object
) -> OperationContext:
    """A setting of one operation by T1, a flat mill of 6 mm."""
    curves = [curve for contour in contours for curve in contour.primitives]
    part = Part().with_entities(tuple(Entity(k, curve) for k, curve in enumerate(curves, 1)))
    job = replace(Job(part, (TOOL,), (operation or PocketOperation(CutParameters(1)),)), **changes)  # type: ignore[arg-type]
    return OperationContext(job, (), MachiningAreas(job, drawn_contours(job)))


def emitted(setting: OperationContext, strokes: Sequence[Stroke], index: int = 0) -> Moves:
    """All moves of a setting after some strokes of an operation."""
    sheet = setting.areas.of(setting.job.operations[index])
    assert sheet is not None
    emit(setting, index, sheet, strokes, NO_PROGRESS)
    return setting.builder.moves()


def path(points: Sequence[tuple[float, float]], purpose: Purpose = Purpose.POCKET) -> Stroke:
    """A stroke of straight lines."""
    rows = np.array([[*a, *b, 0, 0, 0, 0] for a, b in pairwise(points)], np.float64)
    return Stroke(rows, np.full(len(rows), purpose, np.uint8), 1)


def loop(contour: Contour, purpose: Purpose = Purpose.CONTOUR) -> Stroke:
    """A closed stroke along a contour."""
    rows: Rows = contour_rows(contour)
    return Stroke(rows, np.full(len(rows), purpose, np.uint8), 1)


def lifts(moves: Moves) -> int:
    """How often the tool goes up to where it travels."""
    return int(((moves.kind == MoveKind.RAPID) & (moves.start[:, 2] < 0) & (moves.end[:, 2] > 1)).sum())


def dense(moves: Moves, step: float = 0.02) -> tuple[np.ndarray, np.ndarray]:
    """Points (m, 3) along all feed moves, helices as helices, and which move each is of."""
    start, sweep, owner, points = moves.start, moves.sweeps(), [], []
    for k in np.flatnonzero(moves.kind != MoveKind.RAPID):
        count = max(2, math.ceil(float(moves.lengths()[k]) / step) + 1) if step else 2
        part = np.linspace(0, 1, count)[:, None]
        here = start[k] + (moves.end[k] - start[k]) * part
        if moves.kind[k] >= MoveKind.ARC_CW:
            away = start[k, :2] - moves.centre[k]
            angle = np.arctan2(away[1], away[0]) + sweep[k] * part[:, 0]
            here[:, :2] = moves.centre[k] + np.hypot(*away) * np.stack([np.cos(angle), np.sin(angle)], 1)
        points.append(here)
        owner.append(np.full(count, k))
    return np.concatenate(points), np.concatenate(owner)


def contour_operation(**changes: object) -> ContourOperation:
    """A contour operation by T1."""
    cut = {name: changes.pop(name) for name in list(changes) if name in CutParameters.__dataclass_fields__}
    return ContourOperation(CutParameters(1, **cut), **changes)  # type: ignore[arg-type]
