"""Slots as a whole: from the drawing to the proven text, on every control, read by LinuxCNC itself."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from app.core.resources import resource
from app.formats.job.toml import read_job
from app.gcode.posts import post_names
from app.operations.compute import compute
from app.usecases.job.options import MakeOptions
from app.usecases.making.make import MakeResult, finish, make
from tests.usecases.test_holes_program import assert_same_cuts, made_of, report_of

SLOT = '[[operation]]\nkind = "slot"\ntool = 1\ndepth = 4\nstepdown = 2\n'
WIDE = SLOT + "slot_width = 9\n"
FORMS = {
    "line": ("line 0,0 50,0\n", WIDE, 50 * 9 + math.pi * 4.5**2),
    "arc": ("arc 30,10 20,20 10,10\n", WIDE, math.pi * 10 * 9 + math.pi * 4.5**2),
    "ring": ("circle 20,20 15\n", WIDE, math.tau * 15 * 9),
    "as wide as the tool": ("line 0,0 50,0\n", SLOT, 50 * 6 + math.pi * 9),
    "trochoidal": ("line 0,0 50,0\n", WIDE + "trochoidal = true\n", 50 * 9 + math.pi * 4.5**2),
}


@pytest.fixture(scope="module", params=FORMS)
def one(request: pytest.FixtureRequest) -> tuple[MakeResult, float]:
    drawing, operations, area = FORMS[request.param]
    return made_of(operations, drawing), area


def test_it_removes_what_it_should_and_nothing_else(one: tuple[MakeResult, float]) -> None:
    made, area = one
    report = report_of(made)
    assert made.clean and report["gouge"]["max_mm"] < 1e-3 and report["cut"]["gouged_places"] == 0
    assert report["cut"]["removed_mm3"] == pytest.approx(4 * area, rel=5e-3)  # cells count by their centres


def test_linuxcnc_reads_the_same_motion(one: tuple[MakeResult, float]) -> None:
    assert_same_cuts(one[0])


@pytest.mark.parametrize("operations", [SLOT, WIDE])
@pytest.mark.parametrize("off", [0.05, -0.05])
def test_a_slot_beside_its_line_is_found_both_ways(operations: str, off: float) -> None:
    right = made_of(operations, "line 0,0 50,0\n")
    program = compute(right.job)
    end, centre = program.moves.end + (0.0, off, 0.0), program.moves.centre + (0.0, off)
    made = finish(replace(program, moves=replace(program.moves, end=end, centre=centre)), right.job)
    report = report_of(made)
    assert not made.clean
    assert report["gouge"]["max_mm"] == pytest.approx(0.05, abs=2e-3)
    assert report["left"]["reachable_mm2"] > 1.0


@pytest.mark.exhaustive
@pytest.mark.parametrize("post", post_names())
def test_every_control_gets_the_sample(post: str) -> None:
    text = resource("samples/slots.toml").read_text("utf-8").replace('"linuxcnc"', f'"{post}"')
    text = text.replace("trochoidal = true\nmost_engaged_deg = 70.0\n", "")
    drawing = resource("samples/slots.draw").read_bytes()
    made = make("slots.draw", drawing, MakeOptions(job=read_job("job", text.encode()).job))
    assert made.clean
