"""How the time of each stage of `surface` grows with the number of triangles, the passes being the same: no faster than
n log n.

Times are the processor's. The last size takes a million triangles; `HITOFUDE_GROWTH_MOST` sets another end.
"""

from __future__ import annotations

import os
import struct
import time

import numpy as np
import pytest

from app.cli.timings import StageTimes
from app.core.progress import Progress
from app.formats.scene.toml import read_scene, sources_of
from app.usecases.scene.compute import compute
from app.usecases.scene_program.nc import write_scene_nc

pytestmark = pytest.mark.benchmark
MOST_TRIANGLES = int(os.environ.get("HITOFUDE_GROWTH_MOST", "1000000"))
SIDES = tuple(side for side in (22, 71, 224, 707) if 2 * side * side <= MOST_TRIANGLES)
"""Squares along each side of the mesh: 968, 10,082, 100,352 and 999,698 triangles."""
LEFT = "Looking for what is left"
MOST = 1.15
"""Exponent that a stage may have."""
TOLD_S = 0.5
"""A stage that takes less at the largest size is not judged: what it takes once is more than what grows."""

SCENE = b"""name = "growth"
stock = { box = [0, 0, -15, 100, 100, 9] }
[[tool]]
number = 1
kind = "ball"
diameter = 6.0
[[surface]]
name = "bumps"
shape = { kind = "mesh", file = "bumps.stl" }
[[passes]]
tool = 1
pitch = 4.0
"""


def bumps(side: int) -> bytes:
    """Return a binary STL of 2 side² triangles over 100 x 100 mm, the same bumps whatever their number."""
    at = np.linspace(0.0, 100.0, side + 1)
    x, y = np.meshgrid(at, at)
    grid = np.stack([x, y, 4 * np.sin(x / 9) * np.cos(y / 7)], axis=-1).astype(np.float32)
    a, b, c, d = (part.reshape(-1, 3) for part in (grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1]))
    rows = np.zeros(2 * side * side, np.dtype([("normal", "<f4", 3), ("corner", "<f4", (3, 3)), ("more", "<u2")]))
    rows["corner"] = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    return bytes(80) + struct.pack("<I", len(rows)) + rows.tobytes()


def stages(side: int) -> dict[str, float]:
    """Seconds of the processor by stage."""
    mesh, times = bumps(side), StageTimes(time.process_time)
    progress = times.watch(Progress())
    made = compute(read_scene("growth.toml", SCENE), sources_of(lambda name: mesh), progress.part(0.0, 0.7))
    written = write_scene_nc(made, progress.part(0.7, 1.0))
    assert not len(written.unproven) and written.left is not None
    return times.seconds()


def test_no_stage_of_surface_grows_faster_than_n_log_n(capsys: pytest.CaptureFixture[str]) -> None:
    stages(8)  # so that no kernel is loaded on the way
    found = [stages(side) for side in SIDES]
    sizes = [2 * side * side for side in SIDES]
    table, slow = [], {}
    for stage in sorted(found[-1], key=lambda each: -found[-1][each]):
        spent = [max(each.get(stage, 0.0), 1e-4) for each in found]
        exponent = float(np.polyfit(np.log(sizes), np.log(spent), 1)[0])
        table.append(f"  {stage:28s}" + "".join(f"{each:9.2f}" for each in spent) + f"{exponent:8.2f}")
        if spent[-1] >= TOLD_S and exponent > MOST:
            slow[stage] = exponent
    with capsys.disabled():
        print("\n" + f"  {'triangles':28s}" + "".join(f"{size:9d}" for size in sizes) + "  exponent")
        print("\n".join(table))
    assert not slow
    # that what is left is told makes nothing twice as slow
    assert all(each[LEFT] <= sum(each.values()) / 2 for each in found)
