"""V-carving as a whole: from the drawing to the proven text, read back here and by LinuxCNC itself."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest

from app.core.resources import resource
from app.formats.job.toml import read_job
from app.model.finding import FindingKind
from app.operations.compute import compute
from app.usecases.make import MakeResult, finish, make
from app.usecases.options import MakeOptions
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


@pytest.mark.exhaustive
def test_the_sample_is_clean() -> None:
    options = MakeOptions(job=read_job("vcarve.toml", resource("samples", "vcarve.toml").read_bytes()).job)
    made = make("fig2.dxf", resource("samples", "fig2.dxf").read_bytes(), options)
    assert made.clean and json.loads(made.report.text())["operations"][1]["carved"]["left_mm"] < 5e-3
