"""Strokes that are prepared beside other operations: the same program, finding for finding."""

from __future__ import annotations

import threading
from dataclasses import replace

import numpy as np
import pytest

from app.core.errors import Cancelled
from app.core.progress import NO_PROGRESS, Progress
from app.model.contour_operation import ContourOperation
from app.model.entry import Tabs
from app.model.job import Job
from app.model.moves import Program
from app.model.operation import CutParameters, PocketOperation, RestOperation, Side
from app.model.part import Entity, Part
from app.model.tool import Tool
from app.operations.compute import compute
from tests.part_shapes import circle, square


def job() -> Job:
    """A frame with a hole and a slot too narrow for the tools: pocket, rest, walls inside with relieved corners, walls
    outside with tabs.
    """
    drawn = [square(0, 0, 40), circle(20, 20, 8), square(50, 0, 40), square(58, 8, 1.5)]
    curves = [curve for contour in drawn for curve in contour.primitives]
    part = Part().with_entities(tuple(Entity(k, curve) for k, curve in enumerate(curves, 1)))
    operations = (
        PocketOperation(CutParameters(1)),
        RestOperation(CutParameters(2)),
        ContourOperation(CutParameters(2), dog_bones=True),
        ContourOperation(CutParameters(3), Side.OUTSIDE, tabs=Tabs(3)),
    )
    return replace(Job(part, (Tool(1, 6.0), Tool(2, 3.0), Tool(3, 4.0))), operations=operations)


def _in_turn(of: Job) -> Program:
    """Each operation after the one before: who is observed does nothing ahead."""
    return compute(of, NO_PROGRESS, lambda step, plane: None)


def test_the_program_is_that_of_one_operation_after_the_other() -> None:
    beside, in_turn = compute(job()), _in_turn(job())
    for name, column in beside.moves.columns().items():
        np.testing.assert_array_equal(column, in_turn.moves.columns()[name], name)
    assert beside.findings == in_turn.findings
    assert beside.tabs == in_turn.tabs
    assert beside.dog_bones == in_turn.dog_bones
    assert (beside.bitmap_area_mm2, beside.polyline_rings) == (in_turn.bitmap_area_mm2, in_turn.polyline_rings)
    assert beside.tabs
    assert beside.dog_bones
    assert beside.findings


@pytest.mark.parametrize("observed", [False, True])
def test_strokes_are_made_on_a_thread_beside_unless_somebody_observes(observed: bool) -> None:
    seen: set[bool] = set()
    tell = Progress(lambda *_: seen.add(any(t.name.startswith("beside") for t in threading.enumerate())))
    compute(job(), tell, (lambda step, plane: None) if observed else None)
    assert (True in seen) is not observed


def test_a_cancelled_job_leaves_no_thread() -> None:
    stop = threading.Event()

    def told(fraction: float, text: str) -> None:
        if text == "Link rings":
            stop.set()

    with pytest.raises(Cancelled):
        compute(job(), Progress(told, stop))
    assert not [t for t in threading.enumerate() if t.name.startswith("beside")]
