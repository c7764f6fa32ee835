"""Curves over surfaces that cannot gouge, in one tolerance a surface; passes over polyhedra that go by their facets."""

from __future__ import annotations

import math
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from app.core.errors import InputError
from app.fitting.point_curves.space_curve import curve_of_motions, curve_of_points
from app.formats.scene.toml import read_scene, sources_of
from app.gcode.interpreter.options import ReadOptions
from app.gcode.interpreter.reader import read_program
from app.model.motion import Floats, MotionKind
from app.usecases.better.result import BetterOptions
from app.usecases.scene.compute import compute
from app.usecases.scene_program.nc import write_scene_nc
from app.usecases.scene_program.smooth import CurvesOverSurfaces, chords_of, smooth_scene
from app.usecases.smoothing.result import OutputForm
from app.usecases.surface_files import MadeScene, SceneOutputs, scene_files

BALL, MAJOR, MINOR, T = 3.0, 20.0, 10.0, 0.02
OUT = Path("o.ngc")
SCENE = b"""name = "ring"
[stock]
box = [0, 12, -2, 34, 28, 10.5]
[[tool]]
number = 1
diameter = 6.0
kind = "ball"
[[surface]]
name = "ring"
shape = { kind = "torus", centre = [0, 0, 0], major = 20, minor = 10 }
[[passes]]
name = "finishing"
tool = 1
pitch = 2
chord_tolerance = 0.004
boundary = [{ rectangle = [4, 15, 20, 24] }]
"""
R, SIDES, WIDE = 40.0, 14, 12.0


def no_file(name: str) -> bytes:
    raise AssertionError(name)


@cache
def ring(form: OutputForm = OutputForm.ARCS) -> MadeScene:
    return scene_files("ring.toml", SCENE, no_file, SceneOutputs(OUT, curves=CurvesOverSurfaces(T, form)))


def fed(data: bytes, count: int = 400) -> Floats:
    """Places along all fed moves of a text, very densely."""
    motions = read_program(data, ReadOptions()).motions
    rows = np.flatnonzero(motions.kind != MotionKind.RAPID).tolist()
    curves = [curve_of_motions(motions, row, row + 1) for row in rows]
    return np.concatenate([curve.at(np.linspace(0, len(curve) - 1e-9, count)) for curve in curves])


def clearance(places: Floats) -> Floats:
    """From the ball to the torus, mm, by nothing but the distance of its centre from a circle; of places at work."""
    out = np.hypot(places[:, 0], places[:, 1]) - MAJOR
    off = np.hypot(out, places[:, 2] + BALL) - MINOR - BALL
    return off[(places[:, 0] > 4.001) & (places[:, 0] < 19.999)]  # not on the way down


@pytest.mark.parametrize("form", [OutputForm.ARCS, OutputForm.NURBS])
def test_no_curve_goes_into_a_surface_and_none_is_farther_off_than_the_tolerance(form: OutputForm) -> None:
    made = ring(form)
    off = clearance(fed(made.files[OUT]))
    assert off.min() >= -1e-4 and off.max() <= T and len(off) > 2000
    assert made.curves is not None and not len(made.curves.gouging) and made.curves.chords > 500
    before, after = (sum(piece.blocks[k] for piece in made.curves.done[0].pieces) for k in (0, 1))
    assert after < 0.4 * before


def test_the_freedom_lies_on_the_open_side_and_is_used() -> None:
    """Curves swing by more than half of the tube's width, all of it above the surface."""
    off = clearance(fed(ring().files[OUT]))
    assert np.ptp(off) > ring().curves.tube  # type: ignore[union-attr]


def test_the_budget_is_stated_spent_and_kept_for_each_surface() -> None:
    made = ring()
    assert made.curves is not None
    budget = made.curves.budgets["ring"]
    assert budget.kept and budget.proven and budget.allowed_mm <= T + 1e-12
    assert {share.name for share in budget.shares} == {"facets", "chords", "smoothing", "digits", "cells"}
    off = clearance(fed(made.files[OUT]))
    assert off.max() <= budget.spent_mm <= T
    assert made.report.data["curves"]["surfaces"]["ring"]["spent_mm"] == budget.spent_mm
    assert any("ring: together" in line for line in made.lines)


def test_coarse_chords_take_no_more_than_a_fifth_of_the_tolerance_from_the_curves() -> None:
    """Half of it left curves a tube of 0.0049 mm and half as many blocks again."""
    coarse = scene_files(
        "ring.toml",
        SCENE.replace(b"chord_tolerance = 0.004", b"chord_tolerance = 0.01"),
        no_file,
        SceneOutputs(OUT, curves=CurvesOverSurfaces(T)),
    )
    assert coarse.curves is not None and coarse.curves.tube == pytest.approx((0.8 * T - 2e-4) / 2)
    shares = {each.name: each for each in coarse.curves.budgets["ring"].shares}
    assert shares["chords"].spent_mm == pytest.approx(T / 5)
    assert coarse.files[OUT].count(b"\n") == pytest.approx(ring().files[OUT].count(b"\n"), abs=2)
    off = clearance(fed(coarse.files[OUT]))
    assert off.min() >= -1e-4 and off.max() <= T


def test_without_standing_off_curves_gouge_and_that_is_seen() -> None:
    """The same tube about passes that lie on the surface: the second look finds what the first promise lacks."""
    how = CurvesOverSurfaces(T)
    scene = read_scene("ring.toml", SCENE)
    written = write_scene_nc(compute(scene, sources_of(no_file)))
    wrong = smooth_scene(scene, written, how)
    assert len(wrong.gouging) and any(found.counts for found in wrong.findings())
    assert clearance(fed(wrong.done[0].data)).min() < -1e-3


def valley_scene(random: np.random.Generator, box: tuple[float, float, float, float]) -> tuple[bytes, Floats]:
    """A scene of two spheres that cross under a box x, y, width, height, and these as rows centre, radius, mm."""
    radius, pitch = random.uniform(15, 30), random.uniform(0.7, 2)
    spheres = np.array([[0, 0, 0, radius], [1.3 * radius, 3, -2, radius]])
    shapes = "".join(
        f'[[surface]]\nname = "{k}"\nshape = {{ kind = "sphere", centre = {row[:3].tolist()}, radius = {row[3]} }}\n'
        for k, row in enumerate(spheres)
    )
    x, y, wide, high = box[0] + 0.65 * radius, *box[1:]
    text = (
        f'name = "valley"\n[stock]\nbox = [-60, -60, -30, 60, 60, 80]\n[[tool]]\nnumber = 1\ndiameter = {2 * BALL}\n'
        f'kind = "ball"\n{shapes}[[passes]]\nname = "f"\ntool = 1\npitch = {pitch}\nchord_tolerance = {0.2 * T}\n'
        f"angle_deg = {random.choice([0, 90, 30.0, -72.5])}\n"
        f"boundary = [{{ rectangle = [{x}, {y}, {x + wide}, {y + high}] }}]\n"
    )
    return text.encode(), spheres


@pytest.mark.exhaustive
@pytest.mark.parametrize("seed", range(9))
def test_no_curve_goes_into_one_of_two_surfaces_that_cross(seed: int) -> None:
    """By nothing but the distances of the ball's centre from both spheres' centres, along what was written."""
    random, form = np.random.default_rng(seed), list(OutputForm)[seed % 3]
    text, spheres = valley_scene(random, (-4.0, 3.0, 8.0, 3.0))
    how = CurvesOverSurfaces(T, form)
    made = scene_files("valley.toml", text, no_file, SceneOutputs(OUT, curves=how))
    centre = fed(made.files[OUT]) + [0, 0, BALL]
    off = np.min([np.linalg.norm(centre - row[:3], axis=1) - row[3] - BALL for row in spheres], axis=0)
    assert off.min() >= -1e-4
    assert made.curves is not None and not len(made.curves.gouging)
    spent = max(budget.spent_mm for budget in made.curves.budgets.values())
    assert off[off < 3 * T].max() <= spent <= T


def test_a_tolerance_that_chords_use_up_is_refused_with_what_helps() -> None:
    with pytest.raises(InputError, match="use more than"):
        scene_files("ring.toml", SCENE, no_file, SceneOutputs(OUT, curves=CurvesOverSurfaces(0.001)))


def test_chords_keep_to_their_curve() -> None:
    rng = np.random.default_rng(2)
    motions = read_program(
        b"G21 G90 G17\nG0 X0 Y0 Z0\nG3 X10 Y10 I0 J10 F100\nG2 X20 Y0 Z3 R10\nM2\n", ReadOptions()
    ).motions
    curve = curve_of_motions(motions, 1, len(motions))
    chords = chords_of(curve, 2e-5)
    places = curve.at(rng.uniform(0, len(curve), 2000))
    starts, ways = chords[:-1], np.diff(chords, axis=0)
    share = np.clip(np.einsum("ijk,jk->ij", places[:, None] - starts, ways) / (ways**2).sum(axis=1), 0, 1)
    off = np.linalg.norm(places[:, None] - starts - share[:, :, None] * ways, axis=2).min(axis=1)
    assert 1e-6 < off.max() <= 2e-5
    assert len(chords_of(curve_of_points(np.array([[0, 0, 0], [5.0, 0, 0]])), 2e-5)) == 2


def polygon() -> bytes:
    """A cylinder's strips as STL: their edges lie on the cylinder."""
    angle = np.linspace(0.75 * math.pi, 0.25 * math.pi, SIDES + 1)
    x, z = R * np.cos(angle), R * np.sin(angle) - R
    triangles = []
    for k in range(SIDES):
        a, b, c, d = ((x[i], y, z[i]) for i, y in ((k, 0), (k + 1, 0), (k + 1, WIDE), (k, WIDE)))
        triangles += [(a, b, c), (a, c, d)]
    rows = np.zeros(len(triangles), np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("more", "<u2")]))
    rows["corners"] = np.array(triangles)
    return bytes(80) + np.uint32(len(rows)).tobytes() + rows.tobytes()


STRIPS = b"""name = "strips"
[stock]
box = [-28, -1, -14, 28, 13, 0.5]
[[tool]]
number = 1
diameter = 6.0
kind = "ball"
[[surface]]
name = "strips"
shape = { kind = "mesh", file = "strips.stl" }
[[passes]]
tool = 1
pitch = 1.0
overrun = 0
chord_tolerance = 0.002
"""


@pytest.mark.exhaustive
def test_passes_over_a_polyhedron_go_by_its_facets() -> None:
    """Nearer to the cylinder than the passes over the strips are, in fewer blocks, and within what was allowed."""
    told = SceneOutputs(OUT, facets=BetterOptions(0.1, cells=200))
    made = scene_files("strips.toml", STRIPS, lambda name: polygon(), told)
    plain = scene_files("strips.toml", STRIPS, lambda name: polygon(), SceneOutputs(OUT))
    off = []
    for each in (made, plain):
        places = fed(each.files[OUT], 50)
        places = places[(np.abs(places[:, 0]) < 22) & (places[:, 2] < 0.4)]
        off.append(np.abs(np.hypot(places[:, 0], places[:, 2] + BALL + R) - R - BALL))
    rms = [float(np.sqrt(np.mean(each**2))) for each in off]
    assert rms[0] < 0.37 * rms[1] and off[0].max() < 0.5 * off[1].max() and off[1].max() > 0.05
    assert made.better is not None and made.better.comparison.farthest_mm <= 0.1
    assert made.better.new.blocks < 0.2 * made.better.old.blocks
    assert made.report.data["facets"]["budget"]["kept"]


def test_facets_of_a_scene_of_two_tools_are_refused() -> None:
    two = STRIPS + b'\n[[tool]]\nnumber = 2\ndiameter = 4.0\nkind = "ball"\n[[passes]]\ntool = 2\npitch = 4.0\n'
    with pytest.raises(InputError, match="2 tools cut"):
        scene_files("two.toml", two, lambda name: polygon(), SceneOutputs(OUT, facets=BetterOptions(0.1)))
