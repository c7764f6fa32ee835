"""Going to any moment of program C, 300,000 moves on 1024 x 1024 cells, side by side with cutting from the start."""

import numpy as np
import pytest
from pytest_benchmark.fixture import BenchmarkFixture

from app.exhibits.die_programs import PROGRAMS, block
from app.simulation.history.history import History, Playhead, changed_box
from app.simulation.sweeps.course import TrimOptions
from app.simulation.sweeps.sweeps import CutField
from app.simulation.sweeps.trim import trim
from tests.benchmarks.conftest import OURS, record

pytestmark = pytest.mark.benchmark
NAMES = ("A", "C")
kept: dict[str, History] = {}


def history(name: str) -> History:
    if name not in kept:
        kept[name] = History(block(1024), [PROGRAMS[name].course()], PROGRAMS[name].cutters)
    return kept[name]


@pytest.mark.parametrize("name", NAMES)
def test_seek(benchmark: BenchmarkFixture, name: str) -> None:
    head = Playhead(history(name))
    places = iter(np.random.default_rng(1).integers(0, head.history.motions + 1, 10_000).tolist())
    benchmark.pedantic(lambda: head.move_to(next(places)), rounds=200, warmup_rounds=3)
    benchmark.extra_info["kept_mb"] = head.history.bytes / 1e6
    benchmark.extra_info["slowest_ms"] = 1e3 * benchmark.stats.stats.max if benchmark.stats is not None else None
    record(benchmark, f"seek {name}", OURS)


@pytest.mark.parametrize("name", NAMES)
def test_from_the_start(benchmark: BenchmarkFixture, name: str) -> None:
    piece, program = block(1024), PROGRAMS[name]
    places = iter(np.random.default_rng(1).integers(0, program.moves + 1, 100).tolist())
    way, cutters = program.course(), program.cutters
    benchmark.pedantic(lambda: trim(piece, way, cutters, TrimOptions(trace=True, stop=next(places))), rounds=15)
    record(benchmark, f"seek {name}", "cut from the start")


@pytest.mark.parametrize("name", NAMES)
def test_a_frame(benchmark: BenchmarkFixture, name: str) -> None:
    """Onward as in playing at 60 pictures a second for 20 s, with what has changed told."""
    head = Playhead(history(name))
    shown = CutField(head.field.heights.copy(), head.field.owner.copy())
    step = max(head.history.motions // 1200, 1)

    def frame() -> None:
        head.move_to(head.motion + step)
        changed_box(head.field, shown)

    benchmark.pedantic(frame, rounds=300, warmup_rounds=3)
    record(benchmark, f"frame {name}", OURS)


def test_keep(benchmark: BenchmarkFixture) -> None:
    piece, program = block(1024), PROGRAMS["C"]
    benchmark.pedantic(lambda: History(piece, [program.course()], program.cutters), rounds=3)
    record(benchmark, "keep C", OURS)
