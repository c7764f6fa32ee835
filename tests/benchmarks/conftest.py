"""The parts of the benchmarks, and a line of ratios at the end of a run."""

from pathlib import Path

import pytest
from pytest_benchmark.fixture import BenchmarkFixture

from app.formats.readers import read_drawing
from app.model.job import Job
from app.model.part import Region
from app.operations.compute import regions_of
from tests.conftest import ROOT

DRAWINGS = {
    "fig2": ROOT / "resources" / "samples" / "fig2.dxf",
    "complex": ROOT / "tests" / "data" / "dxf" / "complex.dxf",
}
OURS = "hitofude"

medians: dict[str, dict[str, float]] = {}
"""Seconds by task and engine, filled while benchmarks run: medians, or the least where nothing else is as steady."""


@pytest.fixture(scope="session", params=DRAWINGS)
def part(request: pytest.FixtureRequest) -> tuple[str, tuple[Region, ...]]:
    """Name and regions of a drawing."""
    path: Path = DRAWINGS[request.param]
    drawing = read_drawing(path.name, path.read_bytes(), None, ())
    return request.param, regions_of(Job(drawing.part))[0]


def record(benchmark: BenchmarkFixture, task: str, engine: str, least: bool = False) -> None:
    """Keep the median of a benchmark that has run, or its least, for the ratios; nothing when benchmarks are
    disabled.
    """
    benchmark.extra_info.update(task=task, engine=engine)
    stats = benchmark.stats
    if stats is not None:
        medians.setdefault(task, {})[engine] = stats.stats.min if least else stats.stats.median
        if OURS in medians[task]:
            benchmark.extra_info["times_as_long_as_ours"] = medians[task][engine] / medians[task][OURS]


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Print where the program stands against its peers in this run."""
    for task, engines in medians.items():
        own = engines.get(OURS)
        peers = ", ".join(
            f"{name} {time * 1e3:.2f} ms" + (f" ({time / own:.2f} x ours)" if own else "")
            for name, time in engines.items()
            if name != OURS
        )
        terminalreporter.write_line(f"{task}: {OURS} {own * 1e3:.2f} ms; {peers}" if own else f"{task}: {peers}")
