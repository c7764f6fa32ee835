"""Facets of a size that is asked for: `cut --facet`, a deep zoom by the patent engine, `figure11` on an own program."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from app.cli.main import main
from app.simulation.cutter import Cutter
from app.simulation.field.workpiece import Grid
from app.simulation.gpu.depth_buffer import tessellation, usual
from app.simulation.gpu.polyhedron import circle_corners, facet_error, least_facet

PROGRAM = """G21 G90 G17 G94
T1 M6
S9000 M3
G0 X2 Y5 Z5
G1 Z-1 F100
G1 X10 Y6 Z-1.5 F400
X18 Y5 Z-1
Y9
X10 Y8 Z-1.6
X2 Y9 Z-1
G0 Z5
M30
"""
STOCK = ["--stock", "0,0,-5,20,14,0", "--tool", "1=ball:4"]


@pytest.fixture
def program(tmp_path: Path) -> Path:
    path = tmp_path / "waves.ngc"
    path.write_text(PROGRAM)
    return path


def cut(program: Path, *options: str, engine: str = "patent") -> tuple[np.ndarray, dict[str, object]]:
    heights, report = program.with_name("h.npy"), program.with_name("r.json")
    chosen = [] if "--facet" in options else ["--engine", engine]
    told = ["cut", str(program), *STOCK, *chosen, *options, "--heights", str(heights), "--report", str(report)]
    assert main([*told, "--quiet"]) in (0, 1)
    return np.load(heights), json.loads(report.read_text())


@pytest.mark.parametrize("size", [0.05, 0.4, 1.0])
def test_larger_facets_lie_farther_inside_and_the_report_says_how_far(program: Path, size: float) -> None:
    exact, _ = cut(program, "--grid", "160", engine="cpu")
    heights, told = cut(program, "--grid", "160", "--facet", str(size))
    if "processor" in str(told["engine"]) or str(told["engine"]).startswith("cpu"):
        pytest.skip("there is no OpenGL here")
    assert told["facet_mm"] == size and f"{size:g} mm" in str(told["engine"])
    inner = (slice(40, 60), slice(30, 130))
    off = (heights - exact)[inner]
    assert off.min() > -1e-4 and off.max() < 2.5 * facet_error(Cutter(2.0, 0.0, 2.0), size) + 1e-4


@pytest.mark.parametrize("wide", [0.2, 0.002])
def test_a_deep_zoom_works_with_the_patent_engine(program: Path, wide: float) -> None:
    window = ["--window", f"10,6,{10 + wide},{6 + wide}", "--grid", "64"]
    exact, _ = cut(program, *window, engine="cpu")
    heights, told = cut(program, *window)
    assert np.abs(heights - exact).max() < 1e-4
    if str(told["engine"]).startswith("patent"):
        assert float(str(told["facet_mm"])) >= least_facet(2.0) * (1 - 1e-9)


def test_facets_are_never_smaller_than_a_cutter_can_be_divided_in() -> None:
    ball = Cutter(3.0, 0.0, 3.0)
    for pitch in (1.0, 1e-2, 1e-4, 1e-8):
        grid = Grid(0.0, 0.0, pitch, 8, 8)
        how = tessellation(grid, [ball])
        assert circle_corners(3.0, how.facet) > 0 and how.facet >= usual(grid).facet
        assert how.facet == usual(grid).facet or how.facet == least_facet(3.0)
    assert tessellation(Grid(0.0, 0.0, 0.1, 8, 8), [ball], 0.7).facet == 0.7


def test_a_facet_of_another_engine_is_refused(program: Path, capsys: pytest.CaptureFixture[str]) -> None:
    try:
        status = main(["cut", str(program), *STOCK, "--facet", "1", "--engine", "cpu"])
    except SystemExit as left:
        status = int(str(left.code))
    assert status == 2 and "--facet is of the engine patent" in capsys.readouterr().err


def test_an_own_program_that_tells_no_tool_is_measured_by_the_advice_it_gets(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out, report = tmp_path / "own.ngc", tmp_path / "r.json"
    out.write_text("G21 G90\nT1 M6\nS9000 M3\nG0 X0 Y0 Z5\nG1 Z-2 F100\nX20 Z-3 F400\nX40 Y10\nG0 Z5\nM30\n")
    told = ["figure11", str(out), "--grid", "32", "--repeat", "1", "--report", str(report), "--quiet"]
    assert main(told) == 2 and "--tool 1=flat:6" in capsys.readouterr().err
    assert main(["figure11", "--tool", "1=flat:6"]) == 2 and "programs of your own" in capsys.readouterr().err
    assert main([*told, "--tool", "1=ball:6", "--stock", "-5,-5,-10,45,15,0"]) == 0
    assert json.loads(report.read_text())["programs"][0]["radius_mm"] == 3.0


def test_an_own_program_is_measured_in_every_way_and_with_several_facets(tmp_path: Path) -> None:
    from app.core.resources import resource

    out, report = tmp_path / "c.ngc", tmp_path / "r.json"
    assert main(["surface", str(resource("samples", "compound.toml")), "-o", str(out), "--quiet"]) == 0
    told = ["figure11", str(out), "--grid", "64", "--repeat", "1", "--facet", "1,4", "--report", str(report), "--quiet"]
    assert main(told) == 0
    [row] = json.loads(report.read_text())["programs"]
    assert row["program"] == "c.ngc" and row["radius_mm"] == 3.0 and row["moves"] > 1000
    assert row["seconds"]["record"] > 0 and row["apart_from_record_mm"]["plain"] < 1e-4
    if row["facets"]:
        assert [each["facet_mm"] for each in row["facets"]] == [1.0, 4.0]
        assert row["facets"][0]["polygons"] > row["facets"][1]["polygons"]
        assert row["facets"][0]["apart_from_record_mm"] < row["facets"][1]["apart_from_record_mm"]
