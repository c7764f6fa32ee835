"""The drawing's contours are chained once for all who look at them, and anew where a job machines others."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import pytest

from app.drafting.document import Document
from app.model.hole_operations import DrillOperation
from app.model.job import Copies, Job
from app.model.operation import CutParameters
from app.model.tool import Tool
from app.model.tool_kind import ToolKind
from app.ui.shell.drawing.contour_store import ContourStore


@pytest.fixture
def job() -> Job:
    document = Document()
    for line in ("rectangle 0,0 40,30", "circle 20,15 3", "point 5,5"):
        document.run(line)
    drill = DrillOperation(CutParameters(7, 5.0), points=True)
    return replace(document.job, tools=(*document.job.tools, Tool(7, 4.0, ToolKind.DRILL)), operations=(drill,))


def test_all_who_ask_at_a_time_are_given_the_same(job: Job) -> None:
    store = ContourStore()
    with ThreadPoolExecutor(4) as pool:
        found = list(pool.map(store.of, [job] * 8))
    assert all(each is found[0] for each in found) and len(found[0].closed) == 3


def test_what_changes_no_contour_keeps_them_and_copies_are_none(job: Job) -> None:
    store = ContourStore()
    seen = store.of(job)
    assert store.of(replace(job, stock=replace(job.stock, thickness=3.0), copies=Copies(columns=2, dx=50.0))) is seen


@pytest.mark.parametrize(
    "change",
    [
        lambda job: replace(job, join_tolerance=0.5),
        lambda job: replace(job, operations=()),
        lambda job: replace(job, tools=tuple(replace(each, diameter=2.0) for each in job.tools)),
        lambda job: replace(job, part=replace(job.part, entities=job.part.entities[:-1])),
    ],
)
def test_other_contours_are_chained_anew(job: Job, change) -> None:
    store = ContourStore()
    seen = store.of(job)
    assert store.of(change(job)) is not seen
    assert [each.entity_ids for each in store.of(job).closed] == [each.entity_ids for each in seen.closed]
