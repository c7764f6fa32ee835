"""One pocket of the same part, tool and depth, by us and by FreeCAD's Offset pattern: length, lifts, metal left, time.

FreeCAD (Debian's package `freecad`) is optional: without `freecadcmd` there is nothing to compare with. What its
program leaves is measured from its own G-code by the same exact measure as ours. (On apu-mount FreeCAD 0.20.2 gives up
most of the floor: FaceMakerBullseye returns a null shape.)
"""

import json
import math
import shutil
import subprocess
import time
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest

from app.formats.readers import read_drawing
from app.gcode.interpreter.reader import read_program
from app.model.curves import Circle, Line, Primitive
from app.model.job import Job
from app.model.motion import MotionKind
from app.model.moves import Moves, Program, Purpose
from app.model.operation import CutParameters, PocketOperation
from app.model.part import Region
from app.model.stock_box import extent
from app.model.tool import Tool
from app.operations.compute import compute
from app.toolpath.coverage.coverage import measure
from tests.conftest import ROOT

pytestmark = [
    pytest.mark.benchmark,
    pytest.mark.skipif(shutil.which("freecadcmd") is None, reason="freecad is not installed"),
]
SCRIPT = Path(__file__).with_name("freecad_pocket.py")
DEPTH = 2.0
PARTS = {
    "fig2": (ROOT / "resources" / "samples" / "fig2.dxf", 6.0),
    "gear": (ROOT / "tests" / "data" / "dxf" / "gear.dxf", 2.0),
    "apu-mount": (ROOT / "tests" / "data" / "dxf" / "apu-mount.dxf", 6.0),
    "insert": (ROOT / "tests" / "data" / "dxf" / "insert.dxf", 3.0),
}


@dataclass(frozen=True)
class Figures:
    """What a program comes to: mm of cutting in the plane, ways up out of the metal, mm2 within reach that it leaves,
    seconds.
    """

    length: float
    lifts: int
    left: float
    seconds: float

    def __str__(self) -> str:
        return f"{self.length:.0f} mm, {self.lifts} lifts, {self.left:.2f} mm2 left, {self.seconds:.2f} s"


def figures(program: Program, job: Job, seconds: float) -> Figures:
    moves = program.moves
    cuts = (moves.kind != MotionKind.RAPID) & (moves.end[:, 2] < 0)
    lifts = (moves.end[:, 2] > 0) & (moves.start[:, 2] < 0)
    return Figures(
        float(moves.lengths()[cuts].sum()), int(lifts.sum()), measure(program, job).reachable_left_mm2, seconds
    )


def described(primitive: Primitive) -> list[object]:
    if isinstance(primitive, Line):
        return ["line", primitive.start, primitive.end]
    if isinstance(primitive, Circle):
        return ["circle", primitive.centre, primitive.radius]
    angle, (x, y) = primitive.start_angle + primitive.sweep / 2, primitive.centre
    middle = x + primitive.radius * math.cos(angle), y + primitive.radius * math.sin(angle)
    return ["arc", primitive.start, middle, primitive.end]


def by_freecad(regions: tuple[Region, ...], diameter: float, percent: int, folder: Path) -> tuple[Moves, float, str]:
    """Moves, seconds and version of FreeCAD's pocket."""
    box = extent(contour for region in regions for contour in region.contours)
    part = {
        "regions": [
            [[described(each) for each in contour.primitives] for contour in region.contours] for region in regions
        ],
        "box": box,
        "depth": DEPTH,
        "diameter": diameter,
        "stepover_percent": percent,
    }
    (folder / "part.json").write_text(json.dumps(part))
    names = {
        "PART": str(folder / "part.json"),
        "OUT": str(folder / "out.nc"),
        "QT_QPA_PLATFORM": "offscreen",
        "HOME": str(folder),
        "PATH": "/usr/bin:/bin",
    }
    subprocess.run(["freecadcmd", str(SCRIPT)], env=names, check=True, capture_output=True, timeout=600)
    told = json.loads((folder / "out.nc.json").read_text())
    text = (folder / "out.nc").read_text().replace(" K0.000000", "")  # K is no word of an arc in the XY plane
    read = read_program(text.encode())
    assert read.error is None, read.error
    motions = read.motions
    count = len(motions)
    column = np.zeros(count, np.int16)
    moves = Moves(
        motions.end.copy(),
        motions.centre[:, :2].copy(),
        motions.kind.copy(),
        np.full(count, Purpose.POCKET, np.uint8),
        column,
        column + 1,
        column.copy(),
        np.nan_to_num(motions.feed),
        motions.line.copy(),
    )
    return moves, told["seconds"], told["version"]


@pytest.mark.parametrize("percent", [50, 80])
@pytest.mark.parametrize("name", PARTS)
def test_pocket_against_freecad(name: str, percent: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path, diameter = PARTS[name]
    part = read_drawing(path.name, path.read_bytes(), None, ()).part
    job = Job(part, (Tool(1, diameter),), (PocketOperation(CutParameters(1, DEPTH, DEPTH)),))
    begin = time.perf_counter()
    program = compute(job)
    ours = figures(program, job, time.perf_counter() - begin)
    moves, seconds, version = by_freecad(program.regions, diameter, percent, tmp_path)
    theirs = figures(replace(program, moves=moves), job, seconds)
    with capsys.disabled():
        print(f"\n{name}, {diameter:g} mm: hitofude {ours}; FreeCAD {version} at {percent} %: {theirs}")
    assert ours.left == 0
    assert ours.lifts <= theirs.lifts
    # at its default stepover; metal that is left makes paths short
    assert percent > 50 or ours.length < theirs.length or theirs.left > 1
