"""Engagement along all moves of a job and the feed that follows it; contour tool 1 mm, pocket tool 2 mm, limit half the
diameter.
"""

import pytest
from pytest_benchmark.fixture import BenchmarkFixture

from app.formats.readers import read_drawing
from app.model.contour_operation import ContourOperation
from app.model.job import Job
from app.model.operation import CutParameters, PocketOperation
from app.model.tool import Tool
from app.operations.compute import compute
from app.toolpath.engagement.feed import followed
from tests.benchmarks.conftest import DRAWINGS, OURS, record

pytestmark = pytest.mark.benchmark


@pytest.mark.parametrize("name", DRAWINGS)
def test_followed(benchmark: BenchmarkFixture, name: str) -> None:
    path = DRAWINGS[name]
    part = read_drawing(path.name, path.read_bytes(), None, ()).part
    operations = (
        PocketOperation(CutParameters(1), 0.9, most_engaged=0.5),
        ContourOperation(CutParameters(2), most_engaged=0.5),
    )
    job = Job(part, (Tool(1, 2.0), Tool(2, 1.0)), operations)
    program = compute(job)
    after = benchmark.pedantic(followed, (program, job), rounds=3, warmup_rounds=1)
    assert len(after.moves) >= len(program.moves)
    record(benchmark, f"engagement and feed, {name}, {len(program.moves)} moves", OURS)
