"""Inlays: pocket and plug fit by closed forms and by the cut; a plug that is off is found, both ways."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import pytest

from app.cli.main import main
from app.core.errors import ParameterError
from app.core.resources import resource
from app.formats.job.toml import read_job
from app.usecases.inlay import InlayFit, InlayJobs, InlayOptions, InlayPair, fit_of, inlay, inlay_jobs
from app.usecases.job.options import MakeOptions
from app.usecases.job.plausible import read_for
from app.usecases.making.make import export, job_from_drawing

JOB = """
[stock]
thickness = 12.0
[[tool]]
number = 1
diameter = 2.0
[[tool]]
number = 2
kind = "v"
diameter = 12.0
tip_angle = {angle}
tip_diameter = {tip}
[[operation]]
kind = "vcarve"
tool = 2
depth = 3.0
stepdown = 3.0
flat_tool = 1
"""
SQUARE = "rectangle 0,0 20,14\n"
WISHED = InlayOptions(0.4, 0.0, 1.0)


def options(angle: float = 90.0, tip: float = 0.0, text: str = JOB) -> MakeOptions:
    return MakeOptions(job=read_job("j", text.format(angle=angle, tip=tip).encode()).job)


def pair_of(drawing: str, wished: InlayOptions = WISHED, angle: float = 90.0, tip: float = 0.0) -> InlayPair:
    return inlay("part.draw", drawing.encode(), options(angle, tip), wished)


def jobs_of(drawing: str, wished: InlayOptions = WISHED) -> InlayJobs:
    given = options()
    return inlay_jobs(job_from_drawing(read_for("part.draw", drawing.encode(), given), given), wished)


def fitted(jobs: InlayJobs, wished: InlayOptions = WISHED) -> InlayFit:
    return fit_of(export(jobs.pocket), export(jobs.plug), jobs, wished)


@pytest.fixture(scope="module")
def square() -> InlayPair:
    return pair_of(SQUARE)


def test_a_square_fits(square: InlayPair) -> None:
    fit = square.fit
    assert square.clean and fit.overlap < 1e-3 and abs(fit.walls) < 1e-3
    assert fit.floor == pytest.approx(0.4, abs=0.15) and fit.bound < 0.15


def test_the_plug_has_its_volume(square: InlayPair) -> None:
    """What stands of the plug down to where it is sawn off: a frustum, as deep as the pocket but for the glue."""
    report = json.loads(square.report())
    high, (w, h) = 2.6 + 1.0, (20 + 2.0, 14 + 2.0)  # at its foot it is the line and a millimetre more all round
    top = (w - 2 * high) * (h - 2 * high)
    foot, middle = w * h, (w - high) * (h - high)
    stands = high / 6 * (top + 4 * middle + foot) - high * (4 - math.pi) * 1.0 / 3  # its foot's corners are round
    x = square.plug.job.part.entities[-4:]
    block = abs(x[0].curve.end[0] - x[0].curve.start[0]) * abs(x[1].curve.end[1] - x[1].curve.start[1])
    assert report["plug"]["cut"]["removed_mm3"] == pytest.approx(block * high - stands, rel=2e-3)


@pytest.mark.exhaustive
@pytest.mark.parametrize("angle", [60.0, 90.0])
@pytest.mark.parametrize(
    "drawing",
    [
        "polyline 0,0 30,0 30,12 18,12 18,25 0,25 close\n",  # an inner corner
        "circle 0,0 12\ncircle 0,0 7\n",  # a ring whose middle the plug leaves open
        "polyline 0,0 30,0 15,4 close\n",  # sharp, and too narrow for the flat tool
    ],
    ids=["L", "ring", "sharp"],
)
def test_shapes_fit(drawing: str, angle: float) -> None:
    pair = pair_of(drawing, angle=angle)
    assert pair.fit.overlap < 5e-3 / math.tan(math.radians(angle / 2)) and not pair.findings


def test_a_gap_is_between_the_walls_and_lets_a_flat_tip_in() -> None:
    pair = pair_of(SQUARE, InlayOptions(0.4, 0.1, 1.0), tip=0.2)
    assert not pair.findings and abs(pair.fit.walls) < 0.11
    with pytest.raises(ParameterError, match=r"give it a gap of 0\.1 mm or more"):
        pair_of(SQUARE, tip=0.2)


def test_what_stands_between_walls_round_the_plug_is_found() -> None:
    """An island like a keyhole: no flat tool goes into its slot of 1.8 mm, and between the ways of the pointed one
    along its walls a ridge stands on the plug, as high as a cone of 15 degrees is where it is 0.9 mm wide.
    """
    keyhole = "rect 0,0 36,20\npolyline 8,7 14,7 14,9.1 24,9.1 24,10.9 14,10.9 14,13 8,13 close\n"
    pair = pair_of(keyhole, InlayOptions(0.4, 0.0, 1.0), angle=30.0)
    rate = math.tan(math.radians(15))
    ridge = (0.9 - rate * 1.0) / rate - 1.0  # above the surface that the island has
    assert pair.fit.overlap == pytest.approx(ridge, rel=0.05)
    assert not pair.clean and any("narrow places round the plug" in each.text for each in pair.findings)


def test_what_is_drawn_beside_the_curves_that_are_inlaid_says_nothing_of_the_fit() -> None:
    """Each contour of the drawing counted as a wall of the pocket, and the inlay was called loose."""
    chosen = JOB.replace("flat_tool = 1", 'flat_tool = 1\ncurves = ["layer:heart"]')
    drawing = f"rect -20,-20 40,30\nlayer heart\n{SQUARE}"
    pair = inlay("part.draw", drawing.encode(), options(text=chosen), WISHED)
    assert pair.clean and abs(pair.fit.walls) < 0.11


@pytest.mark.parametrize("off", [0.05, -0.05])
def test_a_plug_that_is_off_is_found(off: float) -> None:
    """The chamfer on purpose too narrow, so that the plug is too wide, or too wide."""
    jobs = jobs_of(SQUARE)
    pocket, walls = jobs.plug.operations
    wrong = replace(jobs, plug=replace(jobs.plug, operations=(pocket, replace(walls, width=walls.width - off))))
    fit = fitted(wrong)
    if off > 0:
        assert fit.overlap == pytest.approx(off, rel=0.05)
    else:
        assert fit.walls == pytest.approx(-off, rel=0.05)


def test_what_makes_no_inlay_is_refused() -> None:
    for wished, word in (
        (InlayOptions(3.0), "less than the pocket"),
        (InlayOptions(0.3, 1.0, 1.0), "let it stand out more"),
    ):
        with pytest.raises(ParameterError, match=word):
            jobs_of(SQUARE, wished)
    with pytest.raises(ParameterError, match="a vcarve with its flat_tool"):
        inlay("part.draw", SQUARE.encode(), options(text=JOB.replace("flat_tool = 1\n", "")), WISHED)


def test_the_command_writes_both_and_says_how_they_fit(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    drawing, job = tmp_path / "part.draw", tmp_path / "j.toml"
    drawing.write_text(SQUARE)
    job.write_text(JOB.format(angle=90, tip=0))
    told = ["inlay", str(drawing), "--job", str(job), "-o", str(tmp_path / "in"), "--report", str(tmp_path / "r.json")]
    assert main([*told, "--glue", "0.4"]) == 0
    assert {path.name for path in tmp_path.iterdir()} >= {"in_pocket.ngc", "in_plug.ngc", "r.json"}
    assert "plug in pocket: 0.0000 mm overlap" in capsys.readouterr().out
    assert json.loads((tmp_path / "r.json").read_text())["fit"]["overlap_mm"] < 1e-3


@pytest.mark.exhaustive
def test_the_sample_fits() -> None:
    job = read_job("inlay.toml", resource("samples", "inlay.toml").read_bytes()).job
    drawing = resource("samples", "inlay.draw").read_bytes()
    assert inlay("inlay.draw", drawing, MakeOptions(job=job), InlayOptions()).clean


@pytest.mark.parametrize("drawing", ["rectangle 0,0 9.003,14\n", "rectangle 0,0 14,9.003\n"])
def test_cells_lie_upon_their_mirror_image_where_they_do_not_go_into_the_shorter_side(drawing: str) -> None:
    """By as much as half a cell, 0.01 mm, walls would else seem to overlap, or to be open."""
    fit = pair_of(drawing).fit
    assert fit.overlap < 1e-3 and abs(fit.walls) < 1e-3
