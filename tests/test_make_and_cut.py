"""`make` and `cut --against` say the same of the same program: whether it is good, and how much is out of reach."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import ezdxf
import pytest

from app.cli.main import main

Corners = list[tuple[float, float]]
Drawn = tuple[str, Corners | tuple[float, float, float]]
"""A layer, and a closed outline on it: its corners, or centre and radius of a circle."""


def box(layer: str, x: float, y: float, width: float, height: float) -> Drawn:
    return layer, [(x, y), (x + width, y), (x + width, y + height), (x, y + height)]


def hole(x: float, y: float, radius: float, layer: str = "0") -> Drawn:
    return layer, (x, y, radius)


def draw(path: Path, outlines: Sequence[Drawn]) -> Path:
    document = ezdxf.new()
    document.header["$INSUNITS"] = 4
    for layer, outline in outlines:
        if isinstance(outline, tuple):
            document.modelspace().add_circle(outline[:2], outline[2], dxfattribs={"layer": layer})
        else:
            document.modelspace().add_lwpolyline(outline, close=True, dxfattribs={"layer": layer})
    document.saveas(path)
    return path


@dataclass(frozen=True)
class Case:
    """A drawing and how it is made; what both commands are to say.

    Attributes:
        outlines: of the drawing.
        options: of `make`.
        operations: (kind, keys) of a job file; none = the options alone.
        status: of both.
        unreachable: mm2; None = whatever it is.
        kinds: of the findings that count.
    """

    outlines: Sequence[Drawn]
    options: Sequence[str] = ()
    operations: Sequence[dict[str, Any]] = ()
    status: int = 0
    unreachable: float | None = None
    kinds: frozenset[str] = frozenset()


def missed(outlines: Sequence[Drawn], *options: str, kind: str, unreachable: float | None = None) -> Case:
    return Case(outlines, options, status=1, unreachable=unreachable, kinds=frozenset({kind}))


PLATE, CLAMP = box("0", 0, 0, 40, 30), ("--keep-out", "K")
COMB: Drawn = "0", [(0, 0), (40, 0), (40, 30), (25, 30), (25, 10), (22, 10), (22, 30), (0, 30)]
NECK: Drawn = (
    "0",
    [(0, 0), (20, 0), (20, 9), (30, 9), (30, 0), (50, 0), (50, 20), (30, 20), (30, 11), (20, 11), (20, 20), (0, 20)],
)
LAYERS = (box("A", 0, 0, 60, 40), box("B", 10, 10, 20, 20), hole(45, 20, 2.5, "H"))
OUTSIDE, POCKET = ("--side", "outside", "--contour-tool", "4"), ("--contour-tool", "4", "--pocket-tool", "6")
DRILLED = ("--drill", "6", "--contour-tool", "3", "--pocket-tool", "6")

CASES = {
    "slot outside": missed([COMB], *OUTSIDE, kind="neck_too_narrow", unreachable=58.588),
    "gap between parts": missed(
        [box("0", 0, 0, 20, 20), box("0", 22, 0, 20, 20)], *OUTSIDE, kind="neck_too_narrow", unreachable=39.273
    ),
    "hole in a part": missed([PLATE, hole(20, 15, 1.5)], *OUTSIDE, kind="region_too_small", unreachable=7.06),
    "pocket too small": missed([PLATE, box("0", 50, 0, 2, 2)], *POCKET, kind="region_too_small", unreachable=7.431),
    "neck inside": Case([NECK], POCKET, unreachable=26.136),
    "clamp on a pocket's wall": missed([PLATE, box("K", -5, 10, 8, 8)], *CLAMP, *POCKET, kind="left_out"),
    "clamp on a pocket's floor": missed([PLATE, box("K", 15, 10, 8, 8)], *CLAMP, *POCKET, kind="left_out"),
    "clamp on a wall outside": missed([PLATE, box("K", -8, 10, 10, 8)], *CLAMP, *OUTSIDE, kind="left_out"),
    "clamp on a line": missed(
        [PLATE, box("K", -8, 10, 10, 8)], *CLAMP, "--side", "on", "--contour-tool", "2", kind="left_out"
    ),
    "clamp on a hole": missed([PLATE, hole(20, 15, 3), box("K", 15, 10, 8, 8)], *CLAMP, *DRILLED, kind="left_out"),
    "crossing holes": Case([PLATE, hole(10, 10, 3), hole(14, 10, 3)], DRILLED, unreachable=1.929),
    "crossing holes alone": Case([hole(10, 10, 3), hole(14, 10, 3)], DRILLED, unreachable=0.0),
    "hole across a wall": Case([PLATE, hole(40, 15, 3)], DRILLED, unreachable=1.929),
    "small hole across a wall": Case([PLATE, hole(41, 15, 1.5)], ("--drill", "3", *POCKET), unreachable=3.431),
    "hole in a floor": Case([PLATE, hole(20, 15, 1.5)], ("--drill", "3", *POCKET), unreachable=3.431),
    "pocket in a pocket": Case(
        LAYERS,
        operations=(
            {"kind": "drill", "tool": 3, "depth": 8.0, "layers": ["H"]},
            {"kind": "pocket", "tool": 1, "depth": 2.0, "layers": ["A"]},
            {"kind": "contour", "tool": 2, "depth": 2.0, "layers": ["A"]},
            {"kind": "pocket", "tool": 1, "depth": 5.0, "layers": ["B"]},
            {"kind": "contour", "tool": 2, "depth": 5.0, "layers": ["B"]},
        ),
        unreachable=3.858,
    ),
    "hole less deep than the pocket over it": Case(
        LAYERS,
        operations=(
            {"kind": "drill", "tool": 3, "depth": 1.0, "layers": ["H"]},
            {"kind": "pocket", "tool": 1, "depth": 4.0, "layers": ["A"]},
        ),
        unreachable=7.722,
    ),
    "pocket, hole and outline": Case(
        LAYERS,
        operations=(
            {"kind": "drill", "tool": 3, "depth": 7.0, "layers": ["H"]},
            {"kind": "pocket", "tool": 1, "depth": 3.0, "layers": ["B"]},
            {"kind": "contour", "tool": 2, "side": "outside", "depth": 6.0, "layers": ["A"]},
        ),
        unreachable=7.722,
    ),
    "stock left": Case(
        LAYERS,
        operations=(
            {"kind": "pocket", "tool": 1, "depth": 4.0, "stock_to_leave": 0.3, "floor_to_leave": 0.2, "layers": ["B"]},
            {"kind": "contour", "tool": 2, "depth": 4.0, "layers": ["B"]},
        ),
        unreachable=2.092,
    ),
    "a drill that drills nothing": Case(
        LAYERS,
        operations=(
            {"kind": "drill", "tool": 3, "depth": 8.0, "layers": ["H"], "least": 6.0, "most": 9.0},
            {"kind": "pocket", "tool": 1, "depth": 2.0, "layers": ["B"]},
        ),
        status=1,
        kinds=frozenset({"left_out"}),
    ),
    "a pocket tool without room": Case([box("0", 0, 0, 5, 30)], POCKET, unreachable=3.431),
    "a pocket tool without room, no tool named": Case(
        [box("0", 0, 0, 5, 30)], (*POCKET, "--post", "grbl"), unreachable=3.431
    ),
    "outlines at two depths": Case(
        LAYERS,
        operations=(
            {"kind": "contour", "tool": 1, "side": "outside", "depth": 2.0, "layers": ["B"]},
            {"kind": "contour", "tool": 1, "side": "outside", "depth": 5.0, "layers": ["A"]},
        ),
        unreachable=0.0,
    ),
}

TOOLS = """\
[[tool]]
number = 1
diameter = 6.0
[[tool]]
number = 2
diameter = 3.0
[[tool]]
number = 3
diameter = 5.0
kind = "drill"
tip_angle = 118.0
"""


def job_file(path: Path, operations: Sequence[dict[str, Any]]) -> Path:
    tables = (
        "[[operation]]\n" + "".join(f"{key} = {json.dumps(value)}\n" for key, value in each.items())
        for each in operations
    )
    path.write_text(TOOLS + "".join(tables))
    return path


def said(case: Case, tmp_path: Path, *options: str) -> tuple[tuple[int, dict[str, Any]], tuple[int, dict[str, Any]]]:
    """Return (status, report) of `make` and of `cut --against`."""
    drawing, program = draw(tmp_path / "part.dxf", case.outlines), tmp_path / "part.ngc"
    job = ["--job", str(job_file(tmp_path / "job.toml", case.operations))] if case.operations else []
    reports = [tmp_path / "make.json", tmp_path / "cut.json"]
    made = main(
        [
            "make",
            str(drawing),
            "-o",
            str(program),
            "--quiet",
            "--report",
            str(reports[0]),
            *case.options,
            *job,
            *options,
        ]
    )
    cut = main(["cut", str(program), "--against", str(drawing), "--quiet", "--report", str(reports[1])])
    first, second = (json.loads(path.read_text()) for path in reports)
    return (made, first), (cut, second)


@pytest.mark.parametrize("name", CASES)
def test_make_and_cut_say_the_same(name: str, tmp_path: Path) -> None:
    case = CASES[name]
    for status, report in said(case, tmp_path):
        assert status == case.status
        assert {finding["kind"] for finding in report["findings"] if finding["counts"]} == case.kinds
        assert report["gouge"]["max_mm"] <= 0.002 and report["left"]["reachable_mm2"] == 0
        if case.unreachable is not None:
            assert report["left"]["unreachable_mm2"] == pytest.approx(case.unreachable, abs=0.02)
