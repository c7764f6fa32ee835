"""The published method, by facets in the depth buffer, side by side with its modern form, the engine of record and
plain software.

Figure 11 of the text, measured again: `hitofude figure11` prints the same as a table.
"""

import math
from collections.abc import Iterator

import moderngl
import numpy as np
import pytest
from pytest_benchmark.fixture import BenchmarkFixture

from app.exhibits.die_programs import PROGRAMS, block
from app.simulation.engines import published_error
from app.simulation.gpu.depth_buffer import DepthBuffer
from app.simulation.gpu.graphics import standalone_context
from app.simulation.gpu.quads import quad_heights
from app.simulation.sweeps.trim import trim
from tests.benchmarks.conftest import OURS, record
from tests.exhibits.plain import plain_heights

pytestmark = pytest.mark.benchmark
CELLS = 1024
GRAPHICS = "published", "a quad a move"


@pytest.fixture(scope="module")
def ctx() -> Iterator[moderngl.Context]:
    context = standalone_context()
    yield context
    context.release()


@pytest.mark.parametrize("name", PROGRAMS)
def test_ours(benchmark: BenchmarkFixture, name: str) -> None:
    program = PROGRAMS[name]
    benchmark.pedantic(trim, (block(CELLS), program.course(), program.cutters), rounds=9, warmup_rounds=1)
    record(benchmark, f"figure 11, {name}", OURS, least=True)


@pytest.mark.parametrize("name", PROGRAMS)
@pytest.mark.parametrize("way", GRAPHICS)
def test_graphics(benchmark: BenchmarkFixture, ctx: moderngl.Context, way: str, name: str) -> None:
    piece, program = block(CELLS), PROGRAMS[name]
    job = piece, program.course(), program.cutters
    with ctx:
        engine = DepthBuffer(ctx)
        run = engine.heights if way == "published" else lambda *job: quad_heights(ctx, *job)
        got = benchmark.pedantic(run, job, rounds=3 if way == "published" else 7, warmup_rounds=1)
        engine.release()
    record(benchmark, f"figure 11, {name}", way, least=True)
    apart = np.abs(got - trim(*job).heights)
    assert apart.max() < 1e-4 if way != "published" else np.median(apart) < published_error(*job) * math.sqrt(2)


@pytest.mark.parametrize("name", PROGRAMS)
def test_plain(benchmark: BenchmarkFixture, name: str) -> None:
    benchmark.pedantic(plain_heights, (PROGRAMS[name], CELLS), rounds=3, warmup_rounds=1)
    record(benchmark, f"figure 11, {name}", "plain", least=True)
