"""Chamfers beside open lines: ways by closed form, what is proven of them, neighbours, and what is refused."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
import shapely

from app.core.errors import GeometryError
from app.core.tolerances import WELD
from app.formats.job.toml import read_job
from app.geometry.distance import DistanceField
from app.geometry.outlines import polygon_contour
from app.geometry.primitives import contour_rows, lengths, sample
from app.model.chamfer_operation import ChamferBall
from app.model.curves import Line
from app.model.finding import FindingKind
from app.model.moves import Purpose
from app.model.operation import SideStrip
from app.model.part import Contour
from app.operations.compute import compute
from app.toolpath.open_strips import strips
from app.usecases.job.options import MakeOptions
from app.usecases.making.make import MakeResult, finish, make
from tests.examples import examples

CONE = 'kind = "v"\ndiameter = 12.0\ntip_angle = 90.0\n'
BALL = 'kind = "ball"\ndiameter = 6.0\n'
BEND = "line 0,0 40,0\nline 40,0 40,30\n"
SPIRAL = "polyline 20,-2 70,-2 70,3 -5,3 -5,-0.9 60,-0.9\n"
"""What is air beside its one winding is metal behind the next."""


def made_of(lines: str, side: str, tool: str = CONE, *operations: str) -> MakeResult:
    head = f"[stock]\nthickness = 10.0\nmargin = 10.0\n[[tool]]\nnumber = 1\n{tool}"
    chamfer = '[[operation]]\nkind = "chamfer"\ntool = 1\nwidth = 0.5\ntip_offset = 0.3\nopen_side = "{}"\n{}'
    each = [chamfer.format(side, more) for more in operations or ("",)]
    job = read_job("job", "\n".join([head, *each]).encode()).job
    return make("part.draw", lines.encode(), MakeOptions(job=job))


def along_edge(made: MakeResult) -> np.ndarray:
    moves = made.program.moves
    return moves.end[moves.purpose == Purpose.CONTOUR]


@pytest.mark.parametrize("direction", ["climb", "conventional"])
def test_it_goes_from_the_foot_of_one_end_to_that_of_the_other(direction: str) -> None:
    """Round an outer corner on an arc; into an inner one up to the point where the cone touches both walls."""
    outer = made_of(BEND, "right", CONE, f'direction = "{direction}"\n')
    moves = outer.program.moves
    level = moves.purpose == Purpose.CONTOUR
    ends = [moves.start[level][0], moves.end[level][-1]]
    feet = [(0.0, -0.3, -0.8), (40.3, 30.0, -0.8)]
    # climb keeps the part, which is on the left, at the right of the way
    assert np.allclose(ends, feet[::-1] if direction == "climb" else feet)
    assert moves.lengths()[level].sum() == pytest.approx(40 + 30 + 0.3 * math.pi / 2)
    inner = along_edge(made_of(BEND, "left", CONE, f'direction = "{direction}"\n'))
    assert np.allclose(inner[np.argmax(inner[:, 2])], (40, 0, -0.5))
    for made in (outer, made_of(BEND, "left")):
        assert made.clean and json.loads(made.report.text())["operations"][0]["carved"]["places_left"] == 0


@pytest.mark.parametrize("side", ["inside", "outside"])
def test_part_of_a_closed_contour_gets_part_of_its_way(side: str) -> None:
    """Three sides of a square, counter-clockwise: on the left inside, on the right outside."""
    three = "line 20,0 20,20\nline 20,20 0,20\nline 0,20 0,0\n"
    made = made_of(three, "left" if side == "inside" else "right")
    off = -0.3 if side == "inside" else 0.3
    low, high = -off, 20 + off
    whole = contour_rows(polygon_contour([(low, low), (high, low), (high, high), (low, high)]))
    ends = along_edge(made)[:, :2]
    away = DistanceField.of(whole).nearest(ends)[0]
    corners = np.min([np.hypot(*(ends - corner).T) for corner in ((0, 0), (20, 0), (20, 20), (0, 20))], axis=0)
    assert ((away < 1e-6) | (corners < 0.3 + 1e-6)).all()
    assert made.clean


@pytest.mark.parametrize("side", ["left", "right"])
@pytest.mark.parametrize("tool", [CONE, BALL, CONE + "tip_diameter = 0.4\n"], ids=["cone", "ball", "blunt"])
def test_bent_lines_are_proven_on_both_sides(side: str, tool: str) -> None:
    made = made_of("arc 0,0 15,6 30,0\narc 30,0 45,-6 60,0\n", side, tool)
    assert made.clean and not made.findings
    (carved,) = (each["carved"] for each in json.loads(made.report.text())["operations"])
    assert carved["places"] > 1000 and carved["left_mm"] < 0.005


def test_a_flat_tip_tells_of_the_corner_that_it_does_not_fit_into() -> None:
    """A tip of 0.3 mm radius keeps off the inner corner of a right angle, on 0.3 mm of both walls; off no outer one."""
    blunt = CONE + "tip_diameter = 0.6\n"
    for side, lost in (("left", 0.6), ("right", 0.0)):
        made = made_of(BEND, side, blunt)
        (carved,) = (each["carved"] for each in json.loads(made.report.text())["operations"])
        assert carved["too_blunt_mm"] == pytest.approx(lost, abs=0.06)
        told = [each for each in made.findings if each.kind is FindingKind.LEFT_UNREACHABLE]
        assert made.clean and len(told) == (lost > 0)


@pytest.mark.parametrize("reach", [1.5, 2.6, 5.0])
def test_areas_beside_random_lines_have_no_line_without_length(reach: float) -> None:
    """Two ways across a round end meet its corners, within 1e-16 mm."""
    rng, made = np.random.default_rng(round(10 * reach)), 0
    for _ in range(150):
        points = np.cumsum(rng.uniform(-8, 8, (int(rng.integers(2, 4)), 2)), axis=0).round(3).tolist()
        line = Contour(tuple(Line(tuple(a), tuple(b)) for a, b in pairwise(points)), False)
        try:
            areas = strips([line], SideStrip(bool(rng.random() < 0.5), reach)).contours
        except GeometryError:
            continue
        made += 1
        assert all(lengths(contour_rows(area)).min() > WELD for area in areas)
    assert made > 140


def polyline(points: np.ndarray, number: int) -> Contour:
    lines = tuple(Line(tuple(a), tuple(b)) for a, b in pairwise(points.tolist()))
    return Contour(lines, False, entity_ids=(number,))


def crooked_lines(rng: np.random.Generator) -> list[np.ndarray]:
    """Return up to three lines of up to three pieces that cross neither themselves nor one another."""
    while True:
        drawn = [
            np.cumsum(rng.uniform(-8, 8, (int(rng.integers(2, 5)), 2)), axis=0).round(3)
            for _ in range(int(rng.integers(1, 4)))
        ]
        shapes = [shapely.LineString(points) for points in drawn]
        apart = all(one.distance(other) > 0.1 for k, one in enumerate(shapes) for other in shapes[:k])
        if apart and all(shape.is_simple for shape in shapes):
            return drawn


@pytest.mark.parametrize("left", [True, False])
def test_beside_lines_that_bend_back_or_come_near_is_air_on_one_side_and_metal_on_the_other(left: bool) -> None:
    """At 0.1 um from all places of all lines but for corners; whichever line is not there is told."""
    rng, told = np.random.default_rng(27), 0
    for _ in range(examples(60)):
        drawn = crooked_lines(rng)
        try:
            made = strips([polyline(points, k) for k, points in enumerate(drawn)], SideStrip(left, 3.0))
        except GeometryError:
            told += len(drawn)
            continue
        area = shapely.Polygon()
        for contour in made.contours:
            area = area.symmetric_difference(shapely.Polygon(sample(contour_rows(contour), 1e-3)))
        there = {number for contour in made.contours for number in contour.entity_ids}
        assert len(there) + len(made.findings) == len(drawn)
        told += len(made.findings)
        for a, b in (ends for number in there for ends in pairwise(drawn[number])):
            away = np.array([a[1] - b[1], b[0] - a[0]]) / np.hypot(*(b - a)) * (1e-4 if left else -1e-4)
            places = a + np.outer(np.linspace(0.01, 0.99, 50), b - a)
            assert shapely.contains_xy(area, places + away).all()
            assert not shapely.contains_xy(area, places - away).any()
    assert told < 25


def test_a_bent_back_edge_and_two_that_face_each_other_are_cut_and_proven() -> None:
    """A finger of metal 3 mm wide, a tip of 20 degrees, both sides of a groove; the reach is 2.6 mm."""
    finger = "line 0,0 20,0\nline 20,0 20,3\nline 20,3 0,3\n"
    tip = "line 0,0 20,0\nline 20,0 1.2,6.8\n"
    groove = "line 0,0 20,0\nline 20,2 0,2\n"
    for lines, side, length in ((finger, "right", 43.0), (tip, "right", 40.0), (groove, "left", 40.0)):
        made = made_of(lines, side)
        assert made.clean and not made.findings
        (carved,) = (each["carved"] for each in json.loads(made.report.text())["operations"])
        moves = made.program.moves
        assert carved["places"] > 300 and carved["left_mm"] < 0.005
        assert moves.lengths()[moves.purpose == Purpose.CONTOUR].sum() == pytest.approx(length, abs=1.0)


def test_lines_that_end_on_one_another_have_areas_that_close_or_none() -> None:
    """The second begins on the first: a ring round the area began with one line and came back to another."""
    one = np.array([(-4.922, -4.219), (-6.183, -7.563), (-0.88, -6.708), (-5.398, -6.857)])
    other = np.array([(-5.5525, -5.891), (0.624, -2.969)])
    with pytest.raises(GeometryError, match="comes within"):
        strips([polyline(one, 1), polyline(other, 2)], SideStrip(True, 2.6))


def test_of_lines_that_contradict_one_another_one_is_cut_and_the_other_told() -> None:
    """Metal is above the first, air below the second, which is 1 mm above the first."""
    made = made_of("line 0,0 60,0\nline 0,1 60,1\n", "right")
    (told,) = [each for each in made.findings if each.counts]
    assert told.kind is FindingKind.LEFT_OUT and "begins at (0.000, 1.000)" in told.text
    assert np.allclose(along_edge(made)[:, 1], -0.3)


@pytest.mark.parametrize(("off", "kind"), [(-0.02, FindingKind.GOUGE), (0.02, FindingKind.LEFT_REACHABLE)])
def test_a_path_that_is_off_is_found(off: float, kind: FindingKind) -> None:
    made = made_of("arc 0,0 15,6 30,0\n", "left")
    program = compute(made.job)
    end = program.moves.end.copy()
    end[end[:, 2] < 0, 2] += off
    broken = finish(replace(program, moves=replace(program.moves, end=end)), made.job)
    assert kind in {each.kind for each in broken.findings if each.counts}


def test_a_neighbour_stops_it_short_whether_closed_or_the_open_edge_of_another_operation() -> None:
    hole = made_of("line 0,0 60,0\ncircle 30,1.2 0.5\n", "left")
    (short,) = [each for each in hole.findings if each.kind is FindingKind.LEFT_OUT]
    # the cone is 0.8 mm wide at the top, its axis 0.9 mm from the centre of the hole
    assert short.amount == pytest.approx(2 * math.sqrt(1.3**2 - 0.9**2), abs=0.02)
    one, other = 'curves = ["#1"]\n', 'curves = ["#2"]\nenabled = {}\n'
    lines = "line 0,0 60,0\nline 20,1 40,1\n"
    both = made_of(lines, "left", CONE, one, other.format("true"))
    assert [each.kind for each in both.findings if each.counts and "stops short" in each.text] == [FindingKind.LEFT_OUT]
    assert not any(
        "stops short" in each.text for each in made_of(lines, "left", CONE, one, other.format("false")).findings
    )


def test_it_stops_short_of_the_metal_behind_the_end_of_a_line() -> None:
    """A wedge of 40 degrees: beside the long edge the ball comes by the end of the short one, 4 mm from the corner, and
    keeps off the metal that no chamfer takes off behind that end.
    """
    made = made_of("polyline 20,0 0,0 3.06,2.57\n", "right", BALL)
    (short,) = [each for each in made.findings if each.kind is FindingKind.LEFT_OUT]
    assert not any(each.kind is FindingKind.GOUGE for each in made.findings)
    (begin,) = {
        tuple(each) for each in made.program.moves.start[made.program.moves.purpose == Purpose.CONTOUR].tolist()
    }
    end, ahead = np.array([3.06, 2.57]), np.array([3.06, 2.57]) / np.hypot(3.06, 2.57)
    corner = end + 0.5 * np.array([-ahead[1], ahead[0]])
    ball = ChamferBall.of(3.0, 0.5, 0.5)
    assert np.hypot(*(begin[:2] - corner)) == pytest.approx(ball.off + 0.5, abs=2e-3)
    assert np.hypot(short.x - begin[0], short.y - begin[1]) < 0.1


def test_it_stops_short_of_the_metal_behind_another_line_that_is_near_its_end() -> None:
    """At an end the chamfer takes off some of the metal behind its own line: of that behind another one nothing."""
    made = made_of("polyline 7.79,7.35 3.32,7.16 -2.1,11.61\nline -4.6,9.75 -1.46,10.74\n", "right")
    assert not [each for each in made.findings if each.kind is FindingKind.GOUGE]
    assert [each for each in made.findings if each.kind is FindingKind.LEFT_OUT and "stops short" in each.text]


def test_of_a_way_into_a_corner_the_part_that_keeps_off_is_cut() -> None:
    """In a wedge that is 0.5 mm wide at the end of its short edge the cone goes as far as that lets it."""
    made = made_of("polyline 20,0 0,0 8,0.5\n", "right")
    carved = made.program.moves
    deep = carved.end[:, 2] < 0
    (short,) = [each for each in made.findings if each.kind is FindingKind.LEFT_OUT]
    assert carved.end[deep, 0].min() < 0.1 and 0 < short.amount < 2.0 and len(carved.end[deep]) < 30
    assert not any(each.kind is FindingKind.GOUGE for each in made.findings)


@pytest.mark.parametrize(
    ("lines", "words"),
    [
        (f"line 0,-1 40,-1\n{SPIRAL}", "of another open line of the same operation"),
        (SPIRAL, "of itself"),
        ("rect 0,0 60,40\n", "takes open lines alone, and none is chosen"),
    ],
)
def test_what_has_no_side_that_could_be_told_is_refused(lines: str, words: str) -> None:
    with pytest.raises(GeometryError, match=words):
        made_of(lines, "right")
