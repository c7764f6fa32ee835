"""A program of passes over a polyhedron becomes a better one: nearer to the true shape, in far fewer blocks, and its
cut is that of the old one within the tolerance, as a second way of cutting says."""

from __future__ import annotations

import math
from functools import cache
from pathlib import Path

import cv2
import numpy as np
import pytest

from app.core.errors import InputError
from app.core.progress import Progress
from app.fitting.point_surfaces.facet_corners import ShapePlace, facet_corners
from app.fitting.point_surfaces.height_spline import Box, HoldingPoints, fit_heights, rough_heights
from app.formats.scene.toml import read_scene
from app.formats.scene.write import scene_text
from app.gcode.interpreter.options import ReadOptions
from app.gcode.interpreter.reader import read_program
from app.model.motion import Floats, MotionKind
from app.usecases.better.improve import better
from app.usecases.better.picture import stock_picture, streaks
from app.usecases.better.raster import raster_of
from app.usecases.better.report import findings, gains, lines, report
from app.usecases.better.result import BetterOptions, BetterProgram
from tests import raster_program as made

SAMPLES = Path(__file__).parents[2] / "resources/samples"


def result(text: str, tolerance: float = 0.05, **more: object) -> BetterProgram:
    return better("raster.ngc", text.encode(), BetterOptions(tolerance, cells=160, **more))  # type: ignore[arg-type]


@cache
def small() -> BetterProgram:
    """Of the sample's passes a part."""
    return result(made.text(made.rows(wide=12.0, deep=8.0)))


def driven(data: bytes, step: float) -> Floats:
    """Places of the tip along all fed moves below the top, by chords of the text's own words: arcs in ZX or XY."""
    from app.fitting.point_curves.space_curve import curve_of_motions

    motions = read_program(data, ReadOptions()).motions
    found = []
    for row in np.flatnonzero(motions.kind != MotionKind.RAPID).tolist():
        curve = curve_of_motions(motions, row, row + 1)
        size = float(np.linalg.norm(np.diff(curve.at(np.linspace(0, len(curve), 9)), axis=0), axis=1).sum())
        found.append(curve.at(np.linspace(0, len(curve), max(2, math.ceil(size / step)))))
    return np.concatenate(found)


def brute(path: Floats, places: Floats, radius: float) -> Floats:
    """Heights that a ball leaves whose tip has been at places, by nothing but the ball's own equation."""
    heights = np.full(len(places), np.inf)
    for k, place in enumerate(places):
        square = (path[:, 0] - place[0]) ** 2 + (path[:, 1] - place[1]) ** 2
        near = square < radius**2
        if near.any():
            heights[k] = (path[near, 2] + radius - np.sqrt(radius**2 - square[near])).min()
    return heights


def test_the_sample_is_what_it_says() -> None:
    assert (SAMPLES / "raster.ngc").read_text() == made.sample()


def test_corners_of_facets_lie_on_the_true_shape_where_points_do_not() -> None:
    rows = made.rows()
    corners = facet_corners(rows, 0.001)
    points, inner = np.concatenate(rows), corners.places
    inner = inner[(inner[:, 0] > 2) & (inner[:, 0] < 22) & (inner[:, 1] > 2) & (inner[:, 1] < 14)]
    off, old = np.abs(made.square_off(inner)), np.abs(made.square_off(points))
    assert corners.kind is ShapePlace.CORNER and len(inner) > 40
    assert np.median(off) < 2e-4 and np.percentile(off, 90) < 0.1 * old.max() and old.max() > 0.03


def test_passes_over_a_profile_have_no_corners_but_edges() -> None:
    """Strips meet in lines, which lie on the shape: where passes cross these, whether there is a point or not."""
    x = np.linspace(-20, 20, 81)
    at = 40 * np.sin(np.linspace(-math.pi / 5, math.pi / 5, 11))
    z = np.interp(x, at, np.sqrt(1600 - at**2))
    corners = facet_corners([np.column_stack([x, np.full(81, y), z]) for y in np.arange(0, 8, 0.5)], 0.001)
    off = np.abs(np.hypot(corners.places[:, 0], corners.places[:, 2]) - 40)
    assert corners.kind is ShapePlace.EDGE and len(corners.places) >= 9 * 16 and np.percentile(off, 95) < 1e-3 < 0.05


def test_a_surface_of_heights_is_as_coarse_as_its_places_allow() -> None:
    random = np.random.default_rng(5)
    places = np.column_stack([random.uniform(0, 20, 300), random.uniform(0, 10, 300), np.zeros(300)])
    places[:, 2] = 0.01 * places[:, 0] ** 3 / 20 - 0.3 * places[:, 1]
    fitted = fit_heights(places, np.ones(300), HoldingPoints(places[:5]), Box(0, 20, 0, 10))
    asked = np.column_stack([random.uniform(0, 20, 50), random.uniform(0, 10, 50)])
    assert np.abs(fitted.spline.heights(asked) - (0.01 * asked[:, 0] ** 3 / 20 - 0.3 * asked[:, 1])).max() < 1e-4
    slopes = fitted.spline.slopes(asked)
    assert np.abs(slopes - np.column_stack([0.03 * asked[:, 0] ** 2 / 20, np.full(50, -0.3)])).max() < 1e-3
    assert fitted.left_out_mm < 1e-4


def test_a_rough_surface_is_near_to_all_of_its_places() -> None:
    random = np.random.default_rng(6)
    places = np.column_stack([random.uniform(0, 20, 900), random.uniform(0, 10, 900), np.zeros(900)])
    places[:, 2] = np.sin(places[:, 0] / 4) * np.cos(places[:, 1] / 3)
    rough = rough_heights(places, Box(-0.1, 20.1, -0.1, 10.1))
    assert np.abs(rough.heights(places) - places[:, 2]).max() < 5e-3


def test_a_place_that_is_no_corner_is_left_out() -> None:
    u, v = (each.ravel() for each in np.meshgrid(np.linspace(0, 20, 12), np.linspace(0, 10, 8)))
    places = np.column_stack([u, v, 0.01 * u**2])
    places[40, 2] += 0.5
    places[:, 2] += 1e-3 * np.sin(7 * u + 5 * v)
    fitted = fit_heights(places, np.ones(len(u)), HoldingPoints(places[:1]), Box(0, 20, 0, 10))
    assert not fitted.used[40] and np.sum(~fitted.used) <= 2


def test_passes_are_told_from_the_way_between_them_whatever_their_direction() -> None:
    for angle in (0.0, 0.6, math.pi / 2):
        program = read_program(made.text(made.rows(deep=4.0), angle=angle).encode(), ReadOptions())
        raster = raster_of("r", program)
        assert len(raster.rows) == 9 and raster.zigzag and raster.feed == 600.0
        assert abs(raster.pitch - 0.5) < 1e-3 and abs(math.sin(raster.frame.angle - angle)) < 1e-3


def test_the_new_program_is_better_and_its_cut_within_the_tolerance() -> None:
    done = small()
    assert done.new.blocks < 0.15 * done.old.blocks and done.new.bend < 0.7 * done.old.bend
    assert done.budget.kept and done.comparison.farthest_mm <= 0.05 and not [f for f in findings(done) if f.counts]
    assert done.budget.spent_mm <= done.budget.tolerance_mm == 0.05
    told = report(done)
    assert told["cut_again"]["above_mm"] <= 0.05 and told["new"]["blocks"] == done.new.blocks
    assert gains(done)["blocks"] > 0.85 and any("cut again" in line for line in lines(done))


def test_the_new_program_is_nearer_to_the_true_shape() -> None:
    """Away from the rim, where no facets meet."""
    done = small()
    places = driven(done.data, 0.05)
    old = np.concatenate(list(done.smoothed.area.lines))
    inner = [p[(np.abs(p[:, 0] - 6) < 4) & (np.abs(p[:, 1] - 4) < 2)] for p in (places, old)]
    inner[0] = inner[0][inner[0][:, 2] < 0.5]
    new, before = (np.sqrt(np.mean(made.square_off(p) ** 2)) for p in inner)
    assert new < 0.5 * before


def test_both_cuts_are_alike_by_another_way_of_cutting() -> None:
    done = small()
    text = made.text(made.rows(wide=12.0, deep=8.0))
    random = np.random.default_rng(1)
    places = np.column_stack([random.uniform(0, 12, 80), random.uniform(0, 8, 80)])
    old, new = (brute(driven(data, 0.02), places, 3.0) for data in (text.encode(), done.data))
    slopes = done.smoothed.fitted.spline.slopes(places)
    assert (np.abs(new - old) / np.sqrt(1 + (slopes**2).sum(axis=1))).max() <= 0.05
    grid = done.old_cut.cut.workpiece.grid
    cells = np.floor((places - [grid.x0, grid.y0]) / grid.pitch).astype(int)
    centres = (cells + 0.5) * grid.pitch + [grid.x0, grid.y0]
    heights = done.new_cut.cut.heights[cells[:, 1], cells[:, 0]]
    assert np.abs(brute(driven(done.data, 0.005), centres, 3.0) - heights).max() < 1e-5


def test_the_surface_is_a_scene_that_reads_back() -> None:
    done = small()
    assert read_scene("s.toml", scene_text(done.scene).encode()) == done.scene


@pytest.mark.parametrize("name", ["compound", "die", "spheres", "torus"])
def test_every_scene_is_written_as_it_is_read(name: str) -> None:
    scene = read_scene(name, (SAMPLES / f"{name}.toml").read_bytes())
    assert read_scene("again.toml", scene_text(scene).encode()) == scene


@pytest.mark.exhaustive
def test_what_is_cut_deeper_later_is_no_part_of_the_surface() -> None:
    """Roughing passes of the same ball, half a millimetre higher, come first; their points are left out, no other."""
    rows = made.rows(wide=12.0, deep=8.0, pitch=1.0)
    rough = [row + [0, 0, 0.5] for row in rows[::2]]
    done = result(made.text([*rough, *rows]), 0.08)
    assert done.figures.cut_deeper in (
        count := sum(len(row) for row in rough),
        count + 1,
    )  # the plunge ends on one
    assert done.comparison.farthest_mm <= 0.08


@pytest.mark.exhaustive
def test_passes_with_a_gap_stay_out_of_it() -> None:
    rows = made.rows()
    cut = [part for r in rows for part in ((r,) if abs(r[0, 1] - 8) > 3 else (r[r[:, 0] <= 8], r[r[:, 0] >= 16]))]
    lifted = made.text(cut)
    texts = lifted.splitlines()
    out: list[str] = []
    for line in texts:  # between the parts of a pass the tool lifts
        words = {w[0]: float(w[1:]) for w in line.split() if w[0] in "XYZ" and line.startswith("X")}
        before = {w[0]: float(w[1:]) for w in (out[-1].split() if out else []) if w[0] in "XYZ"}
        if len(words) == 3 and len(before) == 3 and abs(words["X"] - before["X"]) > 7:
            out += ["G0 Z10.0", f"G0 X{words['X']:.4f} Y{words['Y']:.4f}", f"G1 Z{words['Z']:.4f} F200", "G1 F600"]
        else:
            out.append(line)
    done = result("\n".join(out) + "\n")
    assert done.comparison.farthest_mm <= 0.05
    places = driven(done.data, 0.1)
    low = places[places[:, 2] < 0.5]
    assert not np.any((np.abs(low[:, 0] - 12) < 3.5) & (np.abs(low[:, 1] - 8) < 2.5))


@pytest.mark.exhaustive
def test_a_turned_program_becomes_as_good() -> None:
    done = result(made.text(made.rows(), angle=0.5))
    assert not [f for f in findings(done) if f.counts] and done.new.blocks < 0.15 * done.old.blocks


@pytest.mark.parametrize(
    ("text", "tolerance", "said"),
    [
        (made.text(made.rows(wide=12.0, deep=8.0), tool="flat,6"), 0.01, "use --tolerance 0.0"),
        (made.text(made.rows(wide=12.0, deep=8.0)), 0.01, "use --tolerance 0.0"),
        ((SAMPLES / "facets.ngc").read_text().replace("T1 M6", "(hitofude: tool=1,ball,6)\nT1 M6"), 0.05, "Use smooth"),
    ],
)
def test_what_cannot_be_made_better_is_refused_with_advice(text: str, tolerance: float, said: str) -> None:
    """Before the old program is cut, which is dear."""
    begun = set[str]()
    progress = Progress(lambda _, doing: begun.add(doing.partition(" ")[0]))
    with pytest.raises(InputError, match=said):
        better("raster.ngc", text.encode(), BetterOptions(tolerance, cells=160), progress=progress)
    assert "Cutting" not in begun and "Cut" not in begun


def test_a_cut_that_differs_by_more_is_a_finding() -> None:
    from dataclasses import replace

    done = small()
    tight = replace(done, options=replace(done.options, tolerance=0.003))
    kinds = {found.kind.value for found in findings(tight) if found.counts}
    assert {"gouge", "left_reachable"} <= kinds
    same = replace(done, new=done.old)
    assert any("keep the old one" in found.text for found in findings(same))


@pytest.mark.exhaustive
def test_light_shows_fewer_facets() -> None:
    """Streaks across neighbouring passes: the slope of B's metal jumps at every edge of the old cut."""
    text = made.text(made.rows(wide=12.0, deep=8.0))
    done = better("raster.ngc", text.encode(), BetterOptions(cells=640))
    old, new = (streaks(each.cut.workpiece, done.smoothed.area) for each in (done.old_cut, done.new_cut))
    assert new < 0.7 * old and report(done)["slope_change_along_passes_deg"]["old"] == math.degrees(old)
    image = cv2.imdecode(np.frombuffer(picture_of(done), np.uint8), cv2.IMREAD_GRAYSCALE)
    rows, cols = done.old_cut.cut.heights.shape
    assert image.shape == (rows, 2 * cols + 8)


def picture_of(done: BetterProgram) -> bytes:
    return stock_picture(done.old_cut.cut.workpiece, done.new_cut.cut.workpiece, done.smoothed.area)
