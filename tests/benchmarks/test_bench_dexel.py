"""Cutting three finishing programs into 1024 x 1024 cells, side by side with a plain trim: one thread, all cells of
each move's box, branches, float64. The programs are zigzags over a curved die, 100 mm square, by ball cutters.
"""

import numpy as np
import pytest
from pytest_benchmark.fixture import BenchmarkFixture

from app.exhibits.die_programs import PROGRAMS, SIZE, STOCK, block
from app.formats.tools.holders import outline_of
from app.model.tool import Tool
from app.model.tool_kind import ToolKind
from app.simulation.field.workpiece import Grid, Heights
from app.simulation.sweeps.course import TrimOptions
from app.simulation.sweeps.trim import trim
from app.verify.holder_contacts import holder_contacts
from tests.benchmarks.conftest import OURS, record
from tests.exhibits.plain import plain_heights

pytestmark = pytest.mark.benchmark


def cut(
    name: str, cells: int = 1024, traced: bool = False, box: tuple[float, float, float, float] = (0.0, 0.0, SIZE, SIZE)
) -> Heights:
    program = PROGRAMS[name]
    return trim(STOCK.over(Grid.over(box, cells)), program.course(), program.cutters, TrimOptions(trace=traced)).heights


def plain(name: str) -> Heights:
    return plain_heights(PROGRAMS[name], 1024)


@pytest.mark.parametrize("name", PROGRAMS)
def test_ours(benchmark: BenchmarkFixture, name: str) -> None:
    program = PROGRAMS[name]
    done = benchmark.pedantic(trim, (block(1024), program.course(), program.cutters), rounds=15, warmup_rounds=1)
    apart = np.abs(done.heights - plain(name))
    assert np.mean(apart > 1e-5) < 1e-5
    record(benchmark, f"cut {name}", OURS)


@pytest.mark.parametrize("name", PROGRAMS)
def test_a_holder_that_touches_nothing(benchmark: BenchmarkFixture, name: str) -> None:
    """And how far the tool must stick out, beside the cut alone."""
    program = PROGRAMS[name]
    wide = 2 * program.radius
    tool = Tool(
        1, wide, ToolKind.BALL, flute_length=50, shank_diameter=wide, stick_out=60, holder=outline_of("Shrink fit 6")
    )
    looked = benchmark.pedantic(
        holder_contacts, (program.course(), block(1024), program.cutters, {1: tool}), rounds=5, warmup_rounds=1
    )
    assert looked.contacts == () and 10 < looked.least[1] < 25
    record(benchmark, f"cut {name}", "holder")


@pytest.mark.parametrize("name", PROGRAMS)
def test_plain(benchmark: BenchmarkFixture, name: str) -> None:
    benchmark.pedantic(plain, (name,), rounds=3, warmup_rounds=1)
    record(benchmark, f"cut {name}", "plain")


@pytest.mark.parametrize("name", PROGRAMS)
def test_ours_with_volume_and_cutting_move(benchmark: BenchmarkFixture, name: str) -> None:
    benchmark.pedantic(cut, (name, 1024, True), rounds=3, warmup_rounds=1)
    record(benchmark, f"cut {name}", "ours, traced")


@pytest.mark.parametrize("name", PROGRAMS)
def test_a_window_of_ten_millimetres(benchmark: BenchmarkFixture, name: str) -> None:
    benchmark.pedantic(cut, (name, 1024, False, (42.0, 47.0, 52.0, 57.0)), rounds=7, warmup_rounds=1)
    record(benchmark, f"window {name}", OURS)


def test_sixteen_million_cells(benchmark: BenchmarkFixture) -> None:
    benchmark.pedantic(cut, ("B", 4096), rounds=3, warmup_rounds=1)
    record(benchmark, "cut B, 4096 x 4096", OURS)
