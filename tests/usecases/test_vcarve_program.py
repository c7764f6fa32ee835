"""V-carving as a whole: from the drawing to the proven text, read back here and by LinuxCNC itself."""

from __future__ import annotations

import json
import math
from dataclasses import replace

import pytest

from app.core.errors import ParameterError
from app.core.resources import resource
from app.formats.job.toml import read_job
from app.model.finding import FindingKind
from app.operations.compute import compute
from app.usecases.cutting.cut import CutOptions, cut
from app.usecases.job.options import MakeOptions
from app.usecases.making.make import MakeResult, finish, make
from tests.gcode.rs274_oracle import assert_same_motion

JOB = """
[stock]
thickness = 12.0
[[tool]]
number = 1
kind = "v"
diameter = 20.0
tip_angle = 90.0
[[operation]]
kind = "vcarve"
tool = 1
depth = 9.0
stepdown = 3.0
"""


def made_of(drawing: str, job: str = JOB) -> MakeResult:
    return make("part.draw", drawing.encode(), MakeOptions(job=read_job("job", job.encode()).job))


@pytest.fixture(scope="module")
def roof() -> MakeResult:
    return made_of("rectangle 0,0 20,10\n")


def test_a_roof_has_its_volume_and_its_proofs(roof: MakeResult) -> None:
    report = json.loads(roof.report.text())
    assert roof.clean and not roof.findings
    assert report["cut"]["removed_mm3"] == pytest.approx(10 * 25 + 10 * 10 * 5 / 3, rel=1e-4)
    assert report["gouge"]["max_mm"] < 1e-6 and report["cut"]["gouged_places"] == 0
    (operation,) = report["operations"]
    carving = operation["carved"]
    assert carving["left_mm"] < 1e-6 and carving["places_left"] == 0 and carving["between_places_mm"] < 0.1


def test_linuxcnc_reads_the_same_motion(roof: MakeResult) -> None:
    assert_same_motion(roof.program.moves, roof.nc, roof.job)


@pytest.mark.parametrize(
    ("off", "kind"), [(-0.01, FindingKind.GOUGE), (0.01, FindingKind.LEFT_REACHABLE)], ids=["deeper", "higher"]
)
def test_a_path_that_is_off_by_a_hundredth_is_found(roof: MakeResult, off: float, kind: FindingKind) -> None:
    """The path is broken on purpose: the verdict must see it."""
    program = compute(roof.job)
    end = program.moves.end.copy()
    end[end[:, 2] < -4.9, 2] += off
    made = finish(replace(program, moves=replace(program.moves, end=end)), roof.job)
    found = [each for each in made.findings if each.counts and each.kind is kind]
    assert found and found[0].amount == pytest.approx(0.01, rel=0.05)


@pytest.mark.parametrize(
    "drawing",
    ["ellipse 0,0 9,0 4\n", "circle 0,0 8\ncircle 1,0 3\n", "polyline 0,0 12,0 12,5 5,5 5,12 0,12 close\n"],
    ids=["fitted", "ring", "L"],
)
@pytest.mark.parametrize("post", ["linuxcnc", "fanuc"])
def test_shapes_are_carved_within_micrometres(drawing: str, post: str) -> None:
    made = made_of(drawing, JOB + f'[output]\npost = "{post}"\n')
    report = json.loads(made.report.text())
    assert made.clean and report["gouge"]["max_mm"] < 1e-3
    assert report["operations"][0]["carved"]["left_mm"] < 5e-3


# The flat floor, cleared first by a flat tool

FLAT = JOB.replace("depth = 9.0", "depth = 4.0\nflat_tool = 2") + "[[tool]]\nnumber = 2\ndiameter = 2.0\n"
SQUARE = "rectangle 0,0 30,30\n"


@pytest.fixture(scope="module")
def frustum() -> MakeResult:
    return made_of(SQUARE, FLAT)


def test_a_flat_tool_clears_the_floor_and_the_cone_follows(frustum: MakeResult) -> None:
    report = json.loads(frustum.report.text())
    assert frustum.clean and report["cut"]["gouged_places"] == 0
    volume = 4 / 3 * (900 + 484 + math.sqrt(900 * 484))
    assert report["cut"]["removed_mm3"] == pytest.approx(volume, rel=1e-3)
    assert list(dict.fromkeys(frustum.program.moves.tool.tolist())) == [2, 1]
    assert [each.WORD for each in frustum.job.operations] == ["vcarve", "pocket"]
    assert frustum.job.operations[1].cut.stock_to_leave == pytest.approx(4.0)
    assert report["left"]["reachable_mm2"] == 0 and report["operations"][0]["carved"]["left_mm"] < 5e-3


def test_the_cone_follows_where_the_flat_tool_does_not_reach() -> None:
    """In the floor's corners, and all along a strip of floor that is narrower than the flat tool."""
    made = made_of("rectangle 0,0 30,9.5\n", FLAT)  # the floor is 22 x 1.5 mm, the tool 2 mm
    assert made.cut is not None
    again = cut(made.cut.setup, CutOptions(600, (4.5, 4.25, 25.5, 5.25), trace=False, judge=False))
    assert again.cut.heights.max() < -4 + 0.15 and again.cut.heights.min() == pytest.approx(-4.0, abs=5e-3)
    assert json.loads(made.report.text())["cut"]["gouged_places"] == 0
    (ridges,) = [each for each in made.findings if each.kind is FindingKind.RIDGE]
    assert "ridges of up to 0.1 mm" in ridges.text
    assert made.clean  # that the flat tool does not fit is a remark: the cone has gone over all of the floor
    (small,) = [each for each in made.findings if each.kind is FindingKind.REGION_TOO_SMALL]
    assert not small.counts


def test_no_flat_tool_is_asked_for_where_slanted_walls_meet() -> None:
    made = made_of("rectangle 0,0 30,7\n", FLAT)  # the walls meet 3.5 mm deep, the floor would be 4 mm deep
    assert made.clean
    assert not {FindingKind.REGION_TOO_SMALL, FindingKind.RIDGE} & {each.kind for each in made.findings}


def test_without_it_the_floor_is_a_finding_that_names_it() -> None:
    made = made_of(SQUARE, FLAT.replace("flat_tool = 2\n", ""))
    assert not made.clean and any("flat_tool" in each.text for each in made.findings if each.counts)


def test_a_pocket_that_is_there_is_not_made_twice(frustum: MakeResult) -> None:
    assert frustum.job.prepared() == frustum.job
    pocket = '[[operation]]\nkind = "pocket"\ntool = 2\ndepth = 4\nstepdown = 3\nstock_to_leave = 4.0\n'
    made = made_of(SQUARE, FLAT + pocket)
    assert made.clean and len(made.job.operations) == 2
    assert list(dict.fromkeys(made.program.moves.tool.tolist())) == [2, 1]


@pytest.mark.parametrize(("off", "kind"), [(-0.02, FindingKind.GOUGE), (0.02, FindingKind.LEFT_REACHABLE)])
def test_a_floor_that_is_off_is_found_both_ways(frustum: MakeResult, off: float, kind: FindingKind) -> None:
    program = compute(frustum.job)
    end = program.moves.end.copy()
    end[(program.moves.tool == 2) & (end[:, 2] < -3.9), 2] += off
    made = finish(replace(program, moves=replace(program.moves, end=end)), frustum.job)
    assert any(each.counts and each.kind is kind for each in made.findings)


def test_it_is_read_back_with_its_floor(frustum: MakeResult) -> None:
    assert_same_motion(frustum.program.moves, frustum.nc, frustum.job)
    header = [line for line in frustum.nc.text.splitlines() if "hitofude: operation=" in line]
    assert len(header) == 2 and "flat_tool=2" in header[0]


def test_a_flat_tool_that_the_job_lacks_is_refused() -> None:
    with pytest.raises(ParameterError, match="no tool T7"):
        made_of(SQUARE, FLAT.replace("flat_tool = 2", "flat_tool = 7"))


@pytest.mark.exhaustive
def test_the_sample_is_clean() -> None:
    options = MakeOptions(job=read_job("vcarve.toml", resource("samples", "vcarve.toml").read_bytes()).job)
    made = make("fig2.dxf", resource("samples", "fig2.dxf").read_bytes(), options)
    assert made.clean and json.loads(made.report.text())["operations"][1]["carved"]["left_mm"] < 5e-3
