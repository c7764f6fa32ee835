"""What is proposed for a plate that a stranger draws: cut by a second hand, the part stands, its holes and pockets are
cut, it comes out of its stock, and the frame of the stock stays.
"""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shapely

from app.cli.main import main
from app.gcode.posts import post_names
from app.model.finding import FindingKind
from tests.fuzz.any_plate import ROUND, Plate, any_plate
from tests.fuzz.dense_heights import DenseHeights, Shape
from tests.fuzz.plain_nc import PlainReader

PITCH = 0.31
DOUBT = 0.03
"""mm; nearer to an outline a point decides nothing: chords of circles, ends that miss one another, digits."""
SLACK = 0.012
"""mm of height."""
MARGIN = 9.0
"""mm of stock that are looked at round the outline."""
HELD = 12.0
"""mm about the middle of a tab that its tool goes up and down in."""
FRAME = 8.3
"""mm beside the outline from which on the stock stays: the margin that is proposed."""
THICK = 10.0
LEFT = {
    kind.value
    for kind in (
        FindingKind.LEFT_REACHABLE,
        FindingKind.SKIN,
        FindingKind.REGION_TOO_SMALL,
        FindingKind.NECK_TOO_NARROW,
    )
}


def proposed(plate: Plate, control: str, folder: Path) -> dict[str, Any]:
    """Write what is proposed for a plate into a folder, and return the report."""
    (folder / "plate.draw").write_text(plate.drawing)
    report = folder / "report.json"
    nc = str(folder / "plate.nc")
    status = main(
        [
            "make",
            str(folder / "plate.draw"),
            "-o",
            nc,
            "--propose",
            "--post",
            control,
            "--report",
            str(report),
            "--quiet",
        ]
    )
    assert status in (0, 1)
    told: dict[str, Any] = json.loads(report.read_text())
    return told


def shapes_of(report: dict[str, Any]) -> dict[int, Shape]:
    """Return the shapes of the tools by their numbers; a proposal takes end mills and drills."""
    kinds = {tool["kind"] for tool in report["tools"]}
    assert kinds <= {"flat", "drill"}
    return {
        tool["number"]: Shape(
            tool["diameter_mm"] / 2, 1 / math.tan(math.radians(59)) if tool["kind"] == "drill" else 0.0
        )
        for tool in report["tools"]
    }


def stock_of(plate: Plate, control: str, folder: Path, shapes: dict[int, Shape]) -> DenseHeights:
    """Return what stands after all programs in a folder; grbl has one a tool, whose number is in its name."""
    west, south, east, north = plate.outline.area.bounds
    heights = DenseHeights((west - MARGIN, south - MARGIN, east + MARGIN, north + MARGIN), PITCH)
    for path in folder.glob("*.nc"):
        number = path.stem.rpartition("T")[2]
        tool = int(number) if number.isdigit() else next(iter(shapes))
        heights.cut(PlainReader(control, tool).read(path.read_text()), shapes)
    return heights


def faults(plate: Plate, report: dict[str, Any], heights: DenseHeights, shapes: dict[int, Shape]) -> list[str]:
    """Return what is wrong with what stands, or with what is said of it."""
    x, y = heights.points()
    counted = {finding["kind"] for finding in report["findings"] if finding["counts"]}
    clearing = {each["tool"] for each in report["proposal"]["operations"] if each["kind"] in ("pocket", "rest")}
    mill = min((shapes[number].radius for number in clearing), default=0.0)
    found = []

    def fault(what: str, wrong: np.ndarray) -> None:
        if wrong.any():
            row, column = np.argwhere(wrong)[0]
            found.append(f"{what}: {int(wrong.sum())} points, ({x[row, column]:.2f}, {y[row, column]:.2f})")

    low = shapely.contains_xy(plate.stands(DOUBT), x, y) & (heights.z < -SLACK)
    if FindingKind.GOUGE.value in counted:
        found.append("" if low.any() else "a false alarm: gouge")
    else:
        fault("cut into the part", low)
    for inner in plate.inner:
        reached = 0.0 if inner.is_circle and not inner.islands else mill + 1e-3  # a drill's hole, or an arc that fits
        open_to = inner.cut.buffer(-reached, ROUND).buffer(reached, ROUND).buffer(-DOUBT)
        if not counted & LEFT:
            fault("left standing", shapely.contains_xy(open_to, x, y) & (heights.z > -0.25))
    fault("the frame is cut", ~shapely.contains_xy(plate.outline.area.buffer(FRAME), x, y) & (heights.z < -SLACK))
    outside = [each for each in report["proposal"]["operations"] if each["curves"] == ["outer"]]
    assert len(outside) == 1
    radius = shapes[outside[0]["tool"]].radius
    swept = plate.outline.area.buffer(radius, ROUND).boundary.buffer(radius - DOUBT, ROUND) - plate.outline.area
    tabs = [shapely.Point(tab["x"], tab["y"]).buffer(HELD) for tab in report["tabs"]]
    around = shapely.contains_xy(swept - shapely.union_all(tabs), x, y)
    fault("not cut through", around & (heights.z > -THICK + SLACK))
    return [each for each in found if each]


SEEDS = [1, *(pytest.param(seed, marks=pytest.mark.exhaustive) for seed in range(2, 12))]


@pytest.mark.parametrize("seed", SEEDS)
def test_what_is_proposed_for_a_random_plate_makes_it(seed: int, tmp_path: Path) -> None:
    plate, control = any_plate(seed), list(post_names())[seed % len(list(post_names()))]
    report = proposed(plate, control, tmp_path)
    shapes = shapes_of(report)
    assert faults(plate, report, stock_of(plate, control, tmp_path, shapes), shapes) == [], plate.drawing


def test_the_judge_sees_tools_of_another_size(tmp_path: Path) -> None:
    plate = any_plate(1)
    report = proposed(plate, "linuxcnc", tmp_path)
    for more, what in ((0.05, "cut into the part"), (-0.2, "not cut through")):
        shapes = {number: Shape(shape.radius + more, shape.fall) for number, shape in shapes_of(report).items()}
        heights = stock_of(plate, "linuxcnc", tmp_path, shapes)
        assert what in " ".join(faults(plate, report, heights, shapes_of(report)))
