"""How the time of each stage of `make` grows with the number of contours: no faster than n log n.

Times are the processor's, so that other work beside does not count; the exponent is that of the line through the
logarithms. `HITOFUDE_GROWTH_MOST` sets another end.
"""

from __future__ import annotations

import math
import os
import time
from collections.abc import Callable

import numpy as np
import pytest
from ezdxf.layouts import Modelspace

from app.cli.timings import StageTimes
from app.core.beside import one_after_another
from app.core.progress import Progress
from app.model.job import Job, Stock
from app.model.operation import CutParameters
from app.model.part import Part
from app.model.tool import Tool
from app.model.tool_kind import ToolKind
from app.model.vcarve_operation import VcarveOperation
from app.usecases.job.options import MakeOptions
from app.usecases.making.make import make

from .growing_drawings import circles, drawing, islands, letters, outline, plate, spline

pytestmark = pytest.mark.benchmark
MOST_CURVES = int(os.environ.get("HITOFUDE_GROWTH_MOST", "10000"))
SIZES = tuple(size for size in (100, 1_000, 10_000, 100_000) if size <= MOST_CURVES)
MOST = 1.15
"""Exponent that a stage may have."""
TOLD_S = 0.5
"""A stage that takes less at the largest size is not judged: what it takes once is more than what grows."""


FLAT = MakeOptions(contour_diameter=2.0, pocket_diameter=2.0)
CARVED = MakeOptions(
    Job(
        Part(),
        tools=(Tool(1, 12.0, ToolKind.V, tip_angle=math.radians(90)),),
        operations=(VcarveOperation(CutParameters(1, depth=4.0, stepdown=4.0)),),
        stock=Stock(thickness=10.0),
    )
)


def stages(data: bytes, options: MakeOptions) -> dict[str, float]:
    """Seconds of the processor by stage."""
    times = StageTimes(time.process_time)
    with one_after_another():
        made = make("growth.dxf", data, options, times.watch(Progress()))
    assert made.coverage.reachable_left_mm2 == 0
    return times.seconds()


@pytest.mark.parametrize("kind", [circles, plate, islands, outline, spline, letters])
def test_no_stage_grows_faster_than_n_log_n(
    kind: Callable[[Modelspace, int], None], capsys: pytest.CaptureFixture[str]
) -> None:
    options = CARVED if kind is letters else FLAT
    stages(drawing(kind, 36), options)  # so that no kernel is loaded on the way
    found = [stages(drawing(kind, size), options) for size in SIZES]
    table, slow = [], {}
    for stage in sorted(found[-1], key=lambda each: -found[-1][each]):
        spent = [max(each.get(stage, 0.0), 1e-4) for each in found]
        exponent = float(np.polyfit(np.log(SIZES), np.log(spent), 1)[0])
        table.append(f"  {stage:28s}" + "".join(f"{each:9.2f}" for each in spent) + f"{exponent:8.2f}")
        if spent[-1] >= TOLD_S and exponent > MOST:
            slow[stage] = exponent
    with capsys.disabled():
        print("\n" + f"  {kind.__name__:28s}" + "".join(f"{size:9d}" for size in SIZES) + "  exponent")
        print("\n".join(table))
    assert not slow
