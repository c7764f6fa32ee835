"""Parallels of whole contours, against shapely's distances."""

import math
import random
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
import shapely

from app.core.errors import InputError
from app.drafting.commands.explode import exploded
from app.drafting.commands.offset_chain import chain_parallel
from app.drafting.curves.chains import CurveChain, chained
from app.drafting.document import Document
from app.formats.dxf.dxf import read_dxf
from app.geometry.sample import sample
from app.model.curves import Arc, Curve, Line, Point


def chains(*lines: str) -> list[CurveChain]:
    document = Document()
    for line in lines:
        document.run(line)
    return chained({e.id: e.curve for e in document.part.entities})


def points(curves: list[Curve] | tuple[Curve, ...]) -> np.ndarray:
    """Points along curves one after the other, arcs every 0.3 degrees."""
    found = [sample(c) if isinstance(c, Line) else _fine(c) for curve in curves for c in exploded(curve)]
    return np.vstack(found)


def _fine(curve: Arc) -> np.ndarray:
    turn = curve.start_angle + np.linspace(0, curve.sweep, 2 + math.ceil(abs(curve.sweep) / 5e-3))
    found = np.column_stack(
        [curve.centre[0] + curve.radius * np.cos(turn), curve.centre[1] + curve.radius * np.sin(turn)]
    )
    found[0], found[-1] = curve.start, curve.end
    return found


def area_within(curves: list[Curve]) -> shapely.Geometry:
    loops = chained(dict(enumerate(curves)))
    assert all(loop.closed for loop in loops)
    assert all(a.end == b.start for loop in loops for a, b in pairwise([*loop.curves, loop.curves[0]])), (
        "ends meet exactly"
    )
    polygons = [shapely.Polygon(points(loop.curves)) for loop in loops]
    assert all(polygon.is_valid for polygon in polygons)
    found = shapely.Polygon()
    for polygon in polygons:
        found = found.symmetric_difference(polygon)
    return found


def offset(contour: CurveChain, away: float, side: Point, rounded: bool = True) -> list[Curve]:
    return [curve for _, curve in chain_parallel(contour, away, side, rounded)]


def random_contour(seed: int) -> CurveChain:
    """A star-shaped contour of lines and arcs."""
    dice = random.Random(seed)
    count = dice.randint(3, 14)
    turns = sorted(dice.uniform(0, math.tau) for _ in range(count))
    corners = [(r * math.cos(t), r * math.sin(t)) for t in turns for r in [dice.uniform(8, 40)]]
    words = [f"polyline {corners[0][0]},{corners[0][1]}"]
    for a, b in pairwise([*corners, corners[0]]):
        if dice.random() < 0.4:
            bulge = dice.uniform(-0.25, 0.25)
            x, y = (a[0] + b[0]) / 2 - (b[1] - a[1]) * bulge, (a[1] + b[1]) / 2 + (b[0] - a[0]) * bulge
            words.append(f"arc {x},{y}")
        words.append(f"{b[0]},{b[1]}")
    return chains(" ".join(words))[0]


def sides(polygon: shapely.Geometry) -> tuple[Point, Point]:
    """A point just within and one just outside the middle of the longest side."""
    ring = np.array(polygon.exterior.coords)
    k = int(np.argmax(np.hypot(*np.diff(ring, axis=0).T)))
    (x, y), way = (ring[k] + ring[k + 1]) / 2, (ring[k + 1] - ring[k]) / 1e3
    a, b = (x - way[1], y + way[0]), (x + way[1], y - way[0])
    return (a, b) if polygon.contains(shapely.Point(a)) else (b, a)


def assert_bounds_what_is_far_enough(
    made: shapely.Geometry, polygon: shapely.Geometry, away: float, outward: bool
) -> None:
    """Check places all over: within the parallel are those that lie on its side of the contour and as far from it.

    Buffers of finely sampled arcs are no measure: they simplify what they take.
    """
    x0, y0, x1, y1 = polygon.buffer(2 * away).bounds
    x, y = (grid.ravel() for grid in np.meshgrid(np.linspace(x0, x1, 90), np.linspace(y0, y1, 90)))
    shapely.prepare([made, polygon])
    far = shapely.distance(shapely.points(x, y), polygon.boundary)
    within, held = shapely.contains_xy(polygon, x, y), shapely.contains_xy(made, x, y)
    wanted = within | (far < away) if outward else within & (far > away)
    assert not (held != wanted)[np.abs(far - away) > 2e-3].any()


SEEDS = [seed for seed in range(60) if shapely.Polygon(points(random_contour(seed).curves)).is_valid]
"""Contours whose arcs do not cross."""


@pytest.mark.parametrize("seed", SEEDS)
def test_parallels_of_closed_contours_bound_what_is_far_enough(seed: int) -> None:
    contour = random_contour(seed)
    polygon = shapely.Polygon(points(contour.curves))
    within, outside = sides(polygon)
    for away in (0.3, 2.0, 5.0):
        assert_bounds_what_is_far_enough(area_within(offset(contour, away, within)), polygon, away, outward=False)
        assert_bounds_what_is_far_enough(area_within(offset(contour, away, outside)), polygon, away, outward=True)


@pytest.mark.parametrize("seed", SEEDS)
def test_sharp_corners_only_add_where_corners_open(seed: int) -> None:
    contour = random_contour(seed)
    polygon = shapely.Polygon(points(contour.curves))
    within, outside = sides(polygon)
    for side, sign in ((within, -1), (outside, 1)):
        smooth, sharp = (area_within(offset(contour, 3, side, rounded)) for rounded in (True, False))
        gained = sharp.symmetric_difference(smooth)
        assert sharp.difference(smooth).area == pytest.approx(gained.area if sign > 0 else 0, abs=1e-2)
        assert polygon.boundary.distance(sharp.boundary) >= 3 - 5e-3


@pytest.mark.parametrize("seed", range(30))
def test_parallels_of_open_chains_keep_the_distance_and_the_side(seed: int) -> None:
    dice = random.Random(seed)
    way = [(float(k * 6), dice.uniform(0, 25)) for k in range(9)]
    (contour,) = chains("line " + " ".join(f"{x},{y}" for x, y in way))
    source = shapely.LineString(way)
    for away in (0.5, 2.0, 4.0):
        made = offset(contour, away, (24.0, 200.0))
        want = source.offset_curve(away, quad_segs=256, join_style="round")
        got = shapely.unary_union([shapely.LineString(points([curve])) for curve in made])
        assert source.distance(got) >= away - 1e-3
        assert got.hausdorff_distance(want) < 0.02


def test_corners_meet_or_stay_round() -> None:
    (square,) = chains("rect 0,0 60,40")
    assert offset(square, 5, (-10, 20), rounded=False) == [
        Line((-5, -5), (65, -5)),
        Line((65, -5), (65, 45)),
        Line((65, 45), (-5, 45)),
        Line((-5, 45), (-5, -5)),
    ]
    assert [type(c) for c in offset(square, 5, (-10, 20))].count(Arc) == 4
    assert offset(square, 5, (30, 20), rounded=False)[0] == Line((5, 5), (55, 5))


def test_a_needle_stays_round_for_its_tip_would_lie_too_far() -> None:
    (needle,) = chains("line 0,0 100,2 0,4 close")
    assert any(isinstance(c, Arc) for c in offset(needle, 1, (120, 2), rounded=False))


def test_arcs_stay_arcs_and_vanish_where_they_are_as_narrow_as_that() -> None:
    (plate,) = chains("rect 0,0 60,40 round 6")
    arcs = [c for c in offset(plate, 2, (30, 20), rounded=False) if isinstance(c, Arc)]
    assert [arc.radius for arc in arcs] == pytest.approx([4] * 4)
    assert [type(c) for c in offset(plate, 6, (30, 20), rounded=False)] == [Line] * 4
    assert [type(c) for c in offset(plate, 9, (30, 20), rounded=False)] == [Line] * 4


def test_a_waist_parts_and_what_vanishes_is_gone() -> None:
    (dumbbell,) = chains("line 0,0 20,0 20,8 40,8 40,0 60,0 60,20 40,20 40,12 20,12 20,20 0,20 close")
    assert len(chained(dict(enumerate(offset(dumbbell, 3, (10, 10)))))) == 2
    (square,) = chains("rect 0,0 60,40")
    assert offset(square, 20, (30, 20)) == [] and offset(square, 25, (30, 20)) == []


def test_the_command_takes_chains_as_one_and_single_curves_by_themselves() -> None:
    document = Document()
    document.run_script("rect 0,0 60,40\ncircle 30,20 5\nellipse 200,0 250,0 20\n")
    assert document.run("offset 2 30,20 1-5") == "5 drawn."
    with pytest.raises(InputError, match="use less"):
        document.run("offset 21 30,20 1-4")
    document.run("select 6")
    document.run("offset 3 300,0")
    document.run("select 1-4")
    assert document.run("offset 3 -10,20 round") == "8 drawn."
    document.undo()
    assert document.run("offset 3 -10,20") == "4 drawn."


@pytest.mark.parametrize(("name", "away"), [("gear.dxf", 0.2), ("apu-mount.dxf", 1.0), ("genshi.dxf", 0.05)])
def test_parallels_of_real_contours_bound_what_is_far_enough(data: Path, name: str, away: float) -> None:
    part = read_dxf((data / "dxf" / name).read_bytes()).part
    loops = [c for c in chained({e.id: e.curve for e in part.entities}) if c.closed and len(c.curves) > 3][:8]
    assert loops
    for contour in loops:
        polygon = shapely.Polygon(points(contour.curves))
        if not polygon.is_valid:
            continue
        within, outside = sides(polygon)
        assert_bounds_what_is_far_enough(area_within(offset(contour, away, within)), polygon, away, outward=False)
        assert_bounds_what_is_far_enough(area_within(offset(contour, away, outside)), polygon, away, outward=True)


@pytest.mark.parametrize("off", [0.0, 500.0])
@pytest.mark.parametrize("angle", [17.0, 30.0])
@pytest.mark.parametrize("spare", [0.01, 0.0, -0.01])
def test_half_as_far_as_a_slot_is_wide_nothing_is_left_whatever_digits_it_was_drawn_with(
    angle: float, off: float, spare: float
) -> None:
    turn = np.exp(1j * math.radians(angle))
    at = [
        np.round([z.real + off, z.imag + off], 4)
        for z in turn * np.array([-10 - 1.5875j, 10 - 1.5875j, 10 + 1.5875j, -10 + 1.5875j])
    ]
    text = " ".join(f"{x!r},{y!r}" for x, y in (each.tolist() for each in [*at, at[0]]))
    (contour,) = chains(f"line {text}")
    pieces = chain_parallel(contour, 1.5875 - spare, (off, off))
    assert bool(pieces) is (spare > 0)
    if pieces:
        assert area_within([curve for _, curve in pieces]).area == pytest.approx(
            0.02 * (20 - 2 * 1.5875 + 0.02), abs=0.003
        )
