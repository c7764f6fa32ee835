"""Paths made from pixels: as near to the walls as pixels allow, never nearer; what that costs is measured, and the
limits are told.
"""

import math
import time
from dataclasses import replace

import numpy as np
import pytest

from app.core.errors import GeometryError, ParameterError
from app.fitting.corner_smoothing.smooth import CornerSmoothingOptions
from app.geometry.distance import DistanceField
from app.geometry.primitives import curve_rows, points_at
from app.model.contour_operation import ContourOperation
from app.model.curves import Arc
from app.model.finding import FindingKind
from app.model.job import Job
from app.model.moves import Moves, Purpose
from app.model.operation import CutParameters, Direction, Order, PocketOperation
from app.model.part import Contour, Part
from app.raster.border import borders_of
from app.raster.frame import BitmapFrame
from app.raster.levels import offset_area
from app.raster.walls import free_pixels, wall_rows
from app.toolpath.coverage.areas import move_rows
from app.toolpath.coverage.coverage import coverage_findings, measure
from app.usecases.making.bitmap_job import drawn_job
from app.usecases.making.make import finish
from app.usecases.pixels.options import BitmapSize
from app.usecases.pixels.path import TOLERANCE_PX, WallLimits, chain_points, clearance, pixel_path
from tests.part_shapes import circle, fig2, square
from tests.plain_distance import distance
from tests.raster.shapes import KINDS
from tests.usecases.test_bitmap_way import job_of, made

FRAME = BitmapFrame(200, 200, 0.5)


def kept(contours: list[Contour], radius: float) -> tuple[WallLimits, list[np.ndarray]]:
    """What paths of a tool have to keep, and the chains to make them from."""
    free = free_pixels(FRAME, contours)
    field = DistanceField.of(wall_rows(FRAME, free))
    chains = [border.chain for border in borders_of(offset_area(free, radius / FRAME.pitch, TOLERANCE_PX))]
    return WallLimits(radius, radius, field, FRAME, free), [chain_points(FRAME, chain) for chain in chains]


@pytest.mark.parametrize("kind", [kind for kind in KINDS if kind != "beyond"])
def test_no_path_is_nearer_to_the_squares_than_asked(kind: str) -> None:
    for seed in range(6):
        contours = KINDS[kind](np.random.default_rng(seed), 98.0)
        if not free_pixels(FRAME, contours).any():
            continue
        keep, chains = kept(contours, 1.6)
        for points in chains:
            rows = pixel_path(points, keep, CornerSmoothingOptions(TOLERANCE_PX * FRAME.pitch)).rows
            dense = points_at(np.repeat(rows, 200, axis=0), np.tile(np.linspace(0, 1, 200), len(rows)))
            assert keep.field.nearest(dense)[0].min() >= 1.6 - 1e-6
            col, row = np.floor(FRAME.to_px(dense)).astype(int).T
            assert keep.free[row, col].all()


def test_a_straight_wall_is_followed_as_near_as_its_squares_allow() -> None:
    keep, (points,) = kept([square(80)], 3.0)
    path = pixel_path(points, keep, CornerSmoothingOptions(TOLERANCE_PX * FRAME.pitch))
    assert len(path.rows) == 4
    assert np.allclose(np.sort(path.rows[:, :2].ravel()), [3] * 4 + [77] * 4, atol=0.03 * FRAME.pitch)


def test_a_round_wall_gives_one_circle() -> None:
    keep, (points,) = kept([circle(40, 50.1, 49.8)], 5.0)
    path = pixel_path(points, keep, CornerSmoothingOptions(TOLERANCE_PX * FRAME.pitch))
    assert len(path.rows) == 1
    assert 35 - 2 * FRAME.pitch < path.rows[0, 6] <= 35
    assert math.dist(path.rows[0, 4:6], (50.1, 49.8)) < 0.5 * FRAME.pitch


def test_clearance_is_a_bound_along_the_whole_row() -> None:
    walls = np.zeros((1, 8))
    walls[0, :4] = (10, 0, 10, 5)
    rows = np.array([[0, 5.5, 20, 5.5, 0, 0, 0, 0], [0, 5, 8, 5, 4, 5, 4, 1], [13.0, 2, 13, 2, 15, 2, 2, 1]])
    bound = clearance(rows, DistanceField.of(walls), 0.1, 50.0)
    assert np.all(bound <= [0.5, 2.0, 3.0])
    assert np.allclose(bound, [0.5, 2.0, 3.0], atol=0.01)


def test_a_pixel_alone_is_cut_as_a_spot() -> None:
    keep, _ = kept([square(80)], 3.0)
    rows = pixel_path(np.array([[40.25, 40.25]]), keep, CornerSmoothingOptions(0.5)).rows
    assert len(rows) == 2
    assert np.array_equal(rows[0, :2], rows[1, 2:4])
    assert 0 < math.dist(rows[0, :2], rows[0, 2:4]) < FRAME.pitch


def test_strokes_are_as_few_as_areas() -> None:
    result = made(job_of(fig2(), 1.0, 2.0))
    assert result.program.strokes == 2
    assert np.any(result.program.moves.purpose == Purpose.LINK)
    assert result.unsmoothed <= 1


def test_what_is_given_up_is_measured_from_the_drawing() -> None:
    result = made(job_of(fig2(), 3.0, 6.0))
    walls = [contour for region in result.program.regions for contour in region.contours]
    chosen = result.program.moves.purpose == Purpose.CONTOUR
    rows = move_rows(result.program.moves)[chosen]
    points = np.concatenate([points_at(rows, np.full(len(rows), part)) for part in np.linspace(0, 1, 400)])
    over = distance(points, walls) - 1.5
    assert chosen.any()
    assert over.max() <= result.given_up.most_mm + 0.1
    pixel = result.program.pitch_mm
    assert 0 < result.given_up.mean_mm < 1.5 * pixel
    finer = made(job_of(fig2(), 3.0, 6.0), 800)
    assert finer.given_up.mean_mm < 0.6 * result.given_up.mean_mm
    told = [finding for finding in result.program.findings if finding.kind is FindingKind.TOLERANCE]
    assert [finding.counts for finding in told] == [False]
    assert f"{result.given_up.most_mm:.3f} mm" in told[0].text


def test_metal_is_left_along_the_walls_alone() -> None:
    job = job_of([square(60), circle(8, 30, 30)], 3.0, 6.0)
    result = made(job, 600)
    done = finish(result.program, job)
    strip = (240 + 2 * math.pi * 8) * result.given_up.most_mm
    assert done.coverage.reachable_left_mm2 == 0
    assert 0 < done.coverage.given_up_mm2 < strip
    for place in done.coverage.given_up:
        assert place.disc_mm < 3 * result.program.pitch_mm
    assert done.clean
    assert done.report.data["left"]["given_up_mm2"] == done.coverage.given_up_mm2
    (told,) = [finding for finding in done.findings if finding.text.startswith(f"{done.coverage.given_up_mm2:.3f} mm2")]
    assert not told.counts
    assert told.kind is FindingKind.SKIN
    assert f"up to about {result.program.allowance_mm:.3f} mm" in told.text


def test_metal_left_away_from_the_walls_still_counts() -> None:
    job = job_of([square(60), circle(8, 30, 30)], 3.0, 6.0)
    program = made(job, 400).program
    chosen = program.moves.purpose != Purpose.POCKET
    moves = Moves(**{name: column[chosen] for name, column in program.moves.columns().items()})
    left = measure(replace(program, moves=moves), job)
    assert left.reachable_left_mm2 > 100
    assert 0 < left.given_up_mm2 < 20
    exact = measure(replace(program, moves=moves, allowance_mm=0.0), job)
    assert exact.given_up == ()
    assert math.isclose(exact.reachable_left_mm2, left.reachable_left_mm2 + left.given_up_mm2, abs_tol=0.5)
    assert any(finding.kind is FindingKind.LEFT_REACHABLE and finding.counts for finding in coverage_findings(left))


def test_climb_and_conventional_go_opposite_ways() -> None:
    areas = []
    for direction in Direction:
        base = job_of([square(40)], 3.0, 6.0)
        job = Job(base.part, base.tools, (ContourOperation(CutParameters(2, direction=direction)),))
        end = made(job, 200).program.moves
        path = end.end[end.purpose == Purpose.CONTOUR][:, :2]
        areas.append(float(np.sum(path[:, 0] * np.roll(path[:, 1], -1) - path[:, 1] * np.roll(path[:, 0], -1))))
    assert areas[0] > 0 > areas[1]


def test_the_order_of_1986_cuts_contours_first() -> None:
    base = job_of([square(40)], 3.0, 6.0)
    result = made(Job(base.part, base.tools, base.operations, order=Order.PATENT_1986), 200)
    assert result.program.moves.tool[0] == 2
    assert FindingKind.ENGAGEMENT in {finding.kind for finding in result.program.findings}


def test_a_region_too_small_on_pixels_is_told() -> None:
    result = made(job_of([square(40), circle(2.2, 60, 20)], 4.0, 6.0), 200)
    told = [finding for finding in result.program.findings if finding.kind is FindingKind.REGION_TOO_SMALL]
    assert sorted(finding.counts for finding in told) == [False, True]
    assert all("Region 2" in finding.text and "larger bitmap" in finding.text for finding in told)


@pytest.mark.parametrize(
    ("job", "words"),
    [
        (job_of([square(40)], 0.2, 6.0), "T2 of 0.2 mm is not wider than two pixels"),
        (job_of([square(40)], 3.0, 6.0, 0.01), "stepover of 0.01 mm is less than a pixel"),
        (
            Job(job_of([square(40)]).part, operations=(PocketOperation(CutParameters(1), 7.0),)),
            "more than the diameter",
        ),
    ],
)
def test_what_pixels_cannot_do_is_refused(job: Job, words: str) -> None:
    with pytest.raises(ParameterError, match=words):
        made(job)


def test_a_drawing_that_no_bitmap_shows_is_refused() -> None:
    with pytest.raises(GeometryError, match="no closed contour"):
        drawn_job(Job(Part()), BitmapSize())
    with pytest.raises(ParameterError, match="as wide as a pixel"):
        drawn_job(job_of([circle(0.01, 0, 0), circle(0.01, 90, 90)]), BitmapSize(16))


def test_a_bitmap_of_a_given_pitch_lies_on_whole_pixels() -> None:
    frame = BitmapSize(16, 0.3).frame((1.0, 2.0, 40.0, 12.0))
    assert frame.pitch == 0.3
    assert (frame.x0 / 0.3) % 1 == pytest.approx(0, abs=1e-9)
    x0, y0, x1, y1 = frame.extent
    assert x0 <= 1 - 0.6 and y0 <= 2 - 0.6 and x1 >= 40 + 0.6 and y1 >= 12.6
    with pytest.raises(ParameterError, match="8192 px are the most"):
        BitmapSize(16, 0.001).frame((0, 0, 100, 100))


def test_an_arc_of_a_kilometre_is_measured_in_a_moment_and_no_more_is_promised_than_it_keeps() -> None:
    """A path that was moved too far has had one: at a hundredth of a millimetre that are 10^8 places."""
    field = DistanceField.of(np.array([[1000.0, -1.0, 1000.0, 1.0, 0, 0, 0, 0]]))
    radius = 1e6 / (2 * math.pi)
    arc = curve_rows(Arc((0.0, 0.0), (0.0, 1e-3), (-radius, 5e-4)))
    began = time.process_time()
    (told,) = clearance(np.array(arc), field, 0.01, 2000.0)
    assert time.process_time() - began < 2.0
    assert 1000.0 - 25.0 <= told <= 1000.0
