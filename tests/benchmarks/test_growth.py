"""How the time of each stage of `make` grows with the number of contours: no faster than n log n.

Times are the processor's, so that other work beside does not count; the exponent is that of the line through the
logarithms.
"""

from __future__ import annotations

import io
import math
import time

import ezdxf
import numpy as np
import pytest

from app.cli.timings import StageTimes
from app.core.beside import one_after_another
from app.core.progress import Progress
from app.usecases.job.options import MakeOptions
from app.usecases.making.make import make

pytestmark = pytest.mark.benchmark
SIZES = (100, 400, 1600)
MOST = 1.15
"""Exponent that a stage may have."""
TOLD_S = 0.5
"""A stage that takes less at the largest size is not judged: what it takes once is more than what grows."""


def drawing(count: int, plate: bool) -> bytes:
    """Circles of 8 mm on a grid of 10 mm, alone or as holes of a plate."""
    document, side = ezdxf.new("R2000", units=4), math.isqrt(count)
    space = document.modelspace()
    for k in range(side * side):
        space.add_circle((10 * (k % side) + 5, 10 * (k // side) + 5), 4)
    if plate:
        far = 10 * side + 10
        space.add_lwpolyline([(-10, -10), (far, -10), (far, far), (-10, far)], close=True)
    text = io.StringIO()
    document.write(text)
    return text.getvalue().encode()


def stages(data: bytes) -> dict[str, float]:
    """Seconds of the processor by stage."""
    times = StageTimes(time.process_time)
    with one_after_another():
        made = make("growth.dxf", data, MakeOptions(contour_diameter=2.0, pocket_diameter=2.0), times.watch(Progress()))
    assert made.coverage.reachable_left_mm2 == 0
    return times.seconds()


@pytest.mark.parametrize("plate", [False, True], ids=["circles", "plate"])
def test_no_stage_grows_faster_than_n_log_n(plate: bool, capsys: pytest.CaptureFixture[str]) -> None:
    stages(drawing(4, plate))  # so that no kernel is loaded on the way
    found = [stages(drawing(size, plate)) for size in SIZES]
    table, slow = [], {}
    for stage in sorted(found[-1], key=lambda each: -found[-1][each]):
        spent = [max(each.get(stage, 0.0), 1e-4) for each in found]
        exponent = float(np.polyfit(np.log(SIZES), np.log(spent), 1)[0])
        table.append(f"  {stage:28s}" + "".join(f"{each:9.2f}" for each in spent) + f"{exponent:8.2f}")
        if spent[-1] >= TOLD_S and exponent > MOST:
            slow[stage] = exponent
    with capsys.disabled():
        print(
            "\n" + f"  {'plate' if plate else 'circles':28s}" + "".join(f"{size:9d}" for size in SIZES) + "  exponent"
        )
        print("\n".join(table))
    assert not slow
