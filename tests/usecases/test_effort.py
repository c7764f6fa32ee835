"""Cuts, scenes and smoothing that take long are announced before they are begun, in reckonings that hold."""

from __future__ import annotations

import math
import re
import time
from collections.abc import Callable

import numpy as np
import pytest

from app.core.effort import Reckoning
from app.core.progress import Progress
from app.formats.scene.toml import read_scene, sources_of
from app.gcode.interpreter.reader import read_program
from app.model.curves import Curve
from app.model.stock_box import StockBox
from app.model.tool import Tool
from app.simulation.field.workpiece import BoxStock
from app.surfaces.passes.facet_crossings import facet_crossings
from app.surfaces.patches.facets import SurfaceFacets
from app.surfaces.sections.compound import CuttingPlanes
from app.usecases.cutting.cut import CutOptions, CutSetup, cut, cut_effort
from app.usecases.making.bitmap_job import BitmapJob, drawn_job
from app.usecases.making.make import finish
from app.usecases.pixels.options import BitmapSize
from app.usecases.pixels.way import compute_on_bitmap
from app.usecases.scene.compute import compute
from app.usecases.smoothing.result import OutputForm, SmoothOptions
from app.usecases.smoothing.smooth import smooth, smooth_effort
from tests.conftest import ROOT
from tests.operations.test_reckoning import holes, job_of, square, wavy

SAMPLES = ROOT / "resources" / "samples"
NO_FILES = sources_of(lambda name: b"")
WITHIN = 3.0


class HeardError(Exception):
    """Ends a job at its first word."""


def stop(sentence: str) -> None:
    raise HeardError(sentence)


def strokes(count: int) -> bytes:
    lines = (f"G1 X{300 if k % 2 else 0} Y{k % 300}" for k in range(count))
    return "\n".join(["G21 G90", "T1 M6", "S1000 M3", "G0 X0 Y0 Z5", "G1 Z-1 F300", *lines, "G0 Z5", "M2", ""]).encode()


def spheres(pitch: float) -> bytes:
    text = (SAMPLES / "spheres.toml").read_text()
    return re.sub(r"^pitch = .*$", f"pitch = {pitch}", text, flags=re.MULTILINE).encode()


def waves(count: int) -> bytes:
    at = np.arange(count) * 0.002
    radius = 100 + 6 * np.sin(7 * at)
    lines = [
        f"G1 X{x:.4f} Y{y:.4f}"
        for x, y in zip((radius * np.cos(at)).tolist(), (radius * np.sin(at)).tolist(), strict=True)
    ]
    return "\n".join(["G21 G90 G17", "S1000 M3", "G0 X106 Y0 Z5", "G1 Z-1 F300", *lines, "G0 Z5", "M2", ""]).encode()


def test_a_long_cut_is_announced() -> None:
    program = read_program(strokes(250_000))
    setup = CutSetup((program,), {1: Tool(1, 6.0)}, BoxStock(StockBox(0.0, 0.0, -10.0, 300.0, 300.0, 0.0)))
    with pytest.raises(HeardError, match=r"about \d+ seconds: 250,003 motions in cells of 0.293 mm. .*--grid"):
        cut(setup, CutOptions(), Progress(remarks=stop))


def test_a_long_scene_is_announced() -> None:
    with pytest.raises(HeardError, match=r"about \d+ minutes: .* passes over .* facets"):
        compute(read_scene("a.toml", spheres(0.005)), NO_FILES, Progress(remarks=stop))


def test_a_long_smoothing_is_announced() -> None:
    with pytest.raises(HeardError, match=r"about \d+ seconds: 110,001 moves in 1 stretch"):
        smooth("a.ngc", waves(110_000), SmoothOptions(form=OutputForm.NURBS), Progress(remarks=stop))


def test_short_ones_say_nothing() -> None:
    smooth("a.ngc", waves(200), SmoothOptions(), Progress(remarks=stop))
    setup = CutSetup((read_program(strokes(9)),), {1: Tool(1, 6.0)}, BoxStock(StockBox(0, 0, -10, 300, 300, 0)))
    cut(setup, CutOptions(64), Progress(remarks=stop))


def test_planes_cross_facets_as_often_as_these_are_wide_across_them() -> None:
    """Two triangles that halve a square 10 mm wide, under planes 1 mm apart: each is crossed by all of them."""
    square = np.array([[[0, 0, 0], [10, 0, 0], [10, 10, 0]], [[0, 0, 0], [10, 10, 0], [0, 10, 0]]], float)
    none = np.zeros(2, np.int64)
    facets = SurfaceFacets(square, none, none, np.zeros((2, 3, 2)), np.zeros(2), np.zeros((2, 2)), ())
    found = facet_crossings(facets, CuttingPlanes((0.0, 0.0), 0.0, tuple(float(k) for k in range(10))))
    assert (found.planes, found.crossings) == (10, pytest.approx(20.0))
    turned = facet_crossings(facets, CuttingPlanes((0.0, 0.0), math.pi / 2, tuple(float(k) for k in range(10))))
    assert turned.crossings == pytest.approx(20.0)


def test_finer_cells_and_a_drawing_to_compare_with_make_a_cut_longer() -> None:
    program = read_program(strokes(100))
    plain, fine = (cut_effort((program,), {1: Tool(1, 6.0)}, pitch, False, False).seconds for pitch in (0.4, 0.1))
    judged = cut_effort((program,), {1: Tool(1, 6.0)}, 0.4, True, True).seconds
    assert 10 < fine / plain < 16 and judged > 3 * plain


def on_pixels(curves: list[Curve], points: int, diameter: float) -> BitmapJob:
    return drawn_job(job_of(curves, diameter), BitmapSize(points))


@pytest.mark.parametrize(
    ("ready", "words"),
    [
        (on_pixels(wavy(45.0, 300), 2048, 0.2), r"about \d+ seconds: [\d,]+ pixels of paths in 1 contour .* bitmap"),
        (on_pixels(holes(20), 1024, 3.0), r"about \d+ seconds: [\d,]+ pixels of paths in 400 contours .* layers"),
    ],
    ids=["paths", "contours"],
)
def test_a_long_job_on_pixels_is_announced_before_it_is_computed(ready: BitmapJob, words: str) -> None:
    with pytest.raises(HeardError, match=words):
        compute_on_bitmap(ready.job, ready.part, Progress(remarks=stop))


def test_a_short_job_on_pixels_says_nothing() -> None:
    ready = on_pixels(square(60.0), 400, 6.0)
    compute_on_bitmap(ready.job, ready.part, Progress(remarks=stop))


@pytest.mark.exhaustive
@pytest.mark.parametrize(
    ("curves", "points", "diameter"),
    [
        (square(100.0), 1024, 1.0),
        (wavy(45.0, 300), 1024, 2.0),
        (wavy(45.0, 1000), 4096, 3.0),
        (holes(10), 2048, 1.5),
        (holes(8), 1024, 2.0),
    ],
    ids=["square", "waves", "fine waves", "circles", "coarse circles"],
)
def test_what_is_said_of_jobs_on_pixels_is_within_a_factor_of_three(
    curves: list[Curve], points: int, diameter: float
) -> None:
    def made(ready: BitmapJob, heard: Callable[[str], None]) -> float:
        begun = time.process_time()
        finish(compute_on_bitmap(ready.job, ready.part, Progress(remarks=heard)).program, ready.job)
        return time.process_time() - begun

    made(on_pixels(square(50.0), 256, 6.0), stop)  # loads the code
    said: list[Reckoning] = []
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("app.usecases.pixels.way.announce", lambda effort, progress: said.append(effort))
        took = made(on_pixels(curves, points, diameter), stop)
    assert took / WITHIN < said[0].seconds < took * WITHIN, f"said {said[0].seconds:.1f} s, took {took:.1f} s"


@pytest.mark.exhaustive
def test_what_is_said_of_scenes_is_within_a_factor_of_three() -> None:
    said: list[str] = []
    begun = time.process_time()
    compute(read_scene("a.toml", spheres(0.1)), NO_FILES, Progress(remarks=said.append))
    took = time.process_time() - begun
    seconds = float(re.search(r"about (\d+) seconds", said[0])[1])  # type: ignore[index]
    assert took / WITHIN < seconds < took * WITHIN


@pytest.mark.exhaustive
@pytest.mark.parametrize("form", list(OutputForm))
def test_what_is_said_of_smoothing_is_within_a_factor_of_three(form: OutputForm) -> None:
    data, options = waves(40_000), SmoothOptions(form=form)
    smooth("a.ngc", waves(300), options)  # loads the code
    begun = time.process_time()
    done = smooth("a.ngc", data, options)
    took = time.process_time() - begun
    said = smooth_effort(done.found.stretches, form, None).seconds
    assert took / WITHIN < said < took * WITHIN
