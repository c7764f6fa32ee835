"""What the display memory shows after each step: the text's order, its codes, and pictures that were looked at."""

import time
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import cv2
import numpy as np
import pytest

from app.exhibits.stage_picture import keyed_png, png
from app.exhibits.stages import Variant, stages
from app.geometry.outlines import polygon_contour
from app.model.job import Job
from app.raster.border import borders_of
from app.raster.fill import fill
from app.raster.frame import BitmapFrame, PixelCode
from app.raster.peel import frame_pixels
from app.raster.steps import STEPS, StepState
from app.raster.trace import dashed
from app.usecases.making.bitmap_job import BitmapJob, drawn_job
from app.usecases.pixels.options import BitmapSize
from app.usecases.pixels.way import BitmapProgram, compute_on_bitmap
from tests.conftest import ROOT
from tests.part_shapes import fig2
from tests.raster.peeling import frame_distance, shrink
from tests.usecases.test_bitmap_way import job_of

SNAPSHOTS = ROOT / "tests" / "data" / "stages"
Walk = tuple[BitmapJob, BitmapProgram, list[StepState]]


def walked(job: Job, points: int, variant: Variant = Variant.SETTLED) -> Walk:
    ready = drawn_job(job, BitmapSize(points))
    made = compute_on_bitmap(ready.job, ready.part)
    return ready, made, list(stages(ready.job, ready.part, made.paths, variant))


@pytest.fixture(scope="module")
def walk() -> Walk:
    return walked(job_of(fig2(), 3.0, 6.0), 400)


def last(walk: Walk, number: int) -> StepState:
    return [stage for stage in walk[2] if stage.number == number][-1]


def test_steps_come_in_the_text_s_order_region_by_region(walk: Walk) -> None:
    numbers = [stage.number for stage in walk[2]]
    assert list(dict.fromkeys(numbers)) == list(STEPS)
    regions = [stage.region for stage in walk[2] if stage.number in (307, 142, 143)]
    assert regions == [1, 1, 1, 2, 2, 2], "frames of one region after the other"
    assert numbers.index(144) > max(k for k, number in enumerate(numbers) if number == 143)
    assert numbers.index(145) > numbers.index(144), "all frames before the first inner path"
    peels = [stage.turn for stage in walk[2] if stage.number == 304 and stage.region == 1]
    assert peels == list(range(1, int(3.0 / walk[0].part.frame.pitch) + 1)), "as many peels as the radius has pixels"


def test_every_stage_is_whole_and_says_what_it_is(walk: Walk) -> None:
    for stage in walk[2]:
        assert stage.plane.dtype == np.uint8
        assert stage.plane.shape == (400, 400)
        assert not stage.plane.flags.writeable
        assert stage.plane.max() <= max(PixelCode)
        assert stage.name and stage.sentence.endswith(".")
        for chain in stage.chains:
            assert np.all(stage.plane[tuple(chain.pixels().T)] != PixelCode.EMPTY)


def test_the_offset_s_contours_fill_to_the_area_itself(walk: Walk) -> None:
    area = walk[1].paths[0].area
    assert np.array_equal(last(walk, 130).plane == PixelCode.CONTOUR, area)
    assert np.array_equal(last(walk, 120).plane == PixelCode.CONTOUR, frame_pixels(area))
    assert {chain.text() for chain in last(walk, 120).chains} == {border.chain.text() for border in borders_of(area)}
    assert len(last(walk, 203).chains) == 3
    assert set(np.unique(last(walk, 206).plane)) == {PixelCode.EMPTY, PixelCode.TRACED, PixelCode.R}
    assert set(np.unique(last(walk, 208).plane)) == {PixelCode.EMPTY, PixelCode.TRACED, PixelCode.R, PixelCode.INSIDE}


def test_the_outermost_frame_is_what_the_peels_and_circles_leave(walk: Walk) -> None:
    pocket = walk[1].paths[0]
    left = shrink(pocket.area, 3.0 / walk[0].part.frame.pitch)
    assert np.array_equal(pocket.pixels >= 1, left)
    second = walk[0].part.label == 2
    assert np.array_equal((last(walk, 307).plane == PixelCode.CONTOUR) & second, left & second)
    assert np.array_equal(last(walk, 144).plane == PixelCode.FRAME, frame_pixels(left))


@pytest.mark.parametrize("stepover", [None, 1.5, 3.0, 4.5])
def test_the_overlap_is_marked_at_any_stepover_up_to_the_next_path(stepover: float | None) -> None:
    job = job_of(fig2(), 3.0, 6.0)
    pocket = replace(job.operations[0], stepover=stepover)
    walk = walked(replace(job, operations=(pocket, *job.operations[1:])), 400)
    paths = walk[1].paths[0]
    frame, marked = last(walk, 142).plane, last(walk, 143).plane
    changed = frame != marked
    assert np.all(frame[changed] == PixelCode.CONTOUR) and np.all(marked[changed] == PixelCode.PROCESSED)
    second = walk[0].part.label == 2
    assert (
        np.array_equal(changed, second & (paths.pixels == 1) & (frame != PixelCode.FRAME))
        and np.count_nonzero(changed) > 100
    )
    assert np.array_equal(marked == PixelCode.CONTOUR, paths.pixels >= 2), (
        "what is left begins with the next path's pixels"
    )
    rings = [stage for stage in walk[2] if stage.number in (145, 146, 147)]
    for before, after in pairwise(rings):
        assert not np.array_equal(before.plane, after.plane), (before.number, before.turn)
    next_path = next(stage for stage in rings if stage.number == 146)
    field = frame_distance(paths.area)[next_path.plane == PixelCode.RING]
    assert np.all(field >= paths.steps.first + paths.steps.step - paths.steps.early)


def test_every_region_s_frame_comes_together_in_144(walk: Walk) -> None:
    frames = [chain for stage in walk[2] if stage.number == 142 for chain in stage.chains]
    together = last(walk, 144)
    assert sorted(chain.text() for chain in together.chains) == sorted(chain.text() for chain in frames)
    assert len(frames) == 3 and len(together.rows) == sum(len(stage.rows) for stage in walk[2] if stage.number == 142)


def test_at_the_end_every_pixel_is_processed_or_a_path(walk: Walk) -> None:
    plane = last(walk, 148).plane
    assert set(np.unique(plane)) == {PixelCode.EMPTY, PixelCode.PROCESSED, PixelCode.FRAME, PixelCode.RING}
    assert np.array_equal(plane != PixelCode.EMPTY, walk[1].paths[0].area)
    rings = [stage for stage in walk[2] if stage.number == 146]
    assert len(rings) == len(walk[1].paths[0].levels) - 1
    assert all(len(stage.rows) for stage in rings)


def test_smoothing_names_every_pixel_of_a_path(walk: Walk) -> None:
    plane = last(walk, 407).plane
    kinds = {PixelCode.CIRCLE, PixelCode.LONG_LINE, PixelCode.SHORT_LINE, PixelCode.VERTEX, PixelCode.ARC}
    assert kinds <= {PixelCode(int(code)) for code in np.unique(plane)}
    assert PixelCode.CONTOUR not in np.unique(plane)
    lengths = [len(last(walk, number).rows) for number in (401, 403, 405, 406, 407)]
    assert lengths == sorted(lengths)
    assert lengths[0] == 2, "the hole's two circles"


def test_more_than_thirty_stages_a_second(walk: Walk) -> None:
    began = time.process_time()
    count = sum(1 for _ in stages(walk[0].job, walk[0].part, walk[1].paths))
    assert count / (time.process_time() - began) > 30


def test_the_published_variant_marks_what_it_gets_wrong() -> None:
    """A comb: in its teeth the strands of the offset merge."""
    teeth = [
        point for k in range(9, -1, -1) for point in ((6 * k + 3.2, 8), (6 * k + 3.2, 30), (6 * k, 30), (6 * k, 8))
    ]
    comb = [(0, 0), (60, 0), (60, 8), *teeth]
    walk = walked(
        job_of([polygon_contour([point for k, point in enumerate(comb) if k == 0 or point != comb[k - 1]])], 2.0, 3.0),
        120,
        Variant.PUBLISHED,
    )
    fill = [stage for stage in walk[2] if stage.number in (208, 130)]
    assert all(stage.wrong is not None for stage in fill)
    settled = next(stage for stage in stages(walk[0].job, walk[0].part, walk[1].paths) if stage.number == 208)
    assert settled.wrong is None
    assert np.array_equal(fill[0].wrong, (fill[0].plane != 0) != (settled.plane != 0))
    if fill[0].wrong.any():
        assert f"err in {int(fill[0].wrong.sum())} pixels" in fill[0].sentence


def test_a_contour_alone_and_a_pocket_alone_have_their_own_steps() -> None:
    job = job_of(fig2(), 3.0, 6.0)
    alone = walked(Job(job.part, job.tools, job.operations[1:]), 200)
    assert 142 not in {stage.number for stage in alone[2]}
    assert last(alone, 407) is not None
    pocket = walked(Job(job.part, job.tools, job.operations[:1]), 200)
    assert {142, 146, 407} <= {stage.number for stage in pocket[2]}
    assert np.array_equal(last(pocket, 130).plane == 1, pocket[0].part.free), (
        "without a contour tool the area is filled up to its walls"
    )


FIGURES = {"figure_2a": 110, "figure_2b": 130, "figure_2c": 140, "frames": 143, "smoothed": 407}


@pytest.mark.parametrize(("name", "number"), FIGURES.items())
def test_figures_of_the_text_look_as_they_did_when_they_were_looked_at(
    walk: Walk, name: str, number: int, tmp_path: Path
) -> None:
    expected = cv2.imread(str(SNAPSHOTS / f"{name}.png"))
    got = cv2.imdecode(np.frombuffer(png(last(walk, number)), np.uint8), cv2.IMREAD_COLOR)
    if not np.array_equal(got, expected):
        cv2.imwrite(str(tmp_path / "got.png"), got)
        pytest.fail(f"step {number} looks otherwise: {tmp_path}/got.png")


def test_figure_5_in_codes() -> None:
    """Figures 5a-5d: a small shape with vertices that must not count: its contour, R marked, counted, filled."""
    shape = polygon_contour([(1.5, 1.5), (11.5, 1.5), (11.5, 7.5), (8.5, 4.5), (5.5, 8.5), (1.5, 8.5)])
    seen: dict[int, np.ndarray] = {}
    fill(BitmapFrame(10, 13, 1.0), [shape], seen.__setitem__)
    rows = [
        ["".join(".12RI"[code] for code in row) for row in seen[number].tolist()] for number in (201, 206, 208, 130)
    ]
    assert [" ".join(each) for each in zip(*rows, strict=True)] == [
        "............. ............. ............. .............",
        ".11111....... .RRRRR....... .RRRRR....... .11111.......",
        ".1....1....1. .2....2....R. .2IIII2....R. .111111....1.",
        ".1.....1..11. .2.....2..22. .2IIIII2..22. .1111111..11.",
        ".1.....1.1.1. .2.....2.2.2. .2IIIII2.2I2. .1111111.111.",
        ".1......1..1. .2......R..2. .2IIIIIIRII2. .11111111111.",
        ".1.........1. .2.........2. .2IIIIIIIII2. .11111111111.",
        ".1.........1. .2.........2. .2IIIIIIIII2. .11111111111.",
        ".11111111111. .2RRRRRRRRR2. .2RRRRRRRRR2. .11111111111.",
        "............. ............. ............. .............",
    ]


def test_the_contour_tool_s_path_is_dashed_and_start_pixels_are_ringed(walk: Walk) -> None:
    """As in figure 2c; a pixel alone cannot be seen."""
    chains = last(walk, 120).chains
    made = dashed(last(walk, 140).plane, chains)
    along = np.concatenate([made[tuple(chain.pixels().T)] for chain in chains])
    assert 0.6 < np.mean(along == PixelCode.CONTOUR) < 0.72
    assert np.array_equal(made != last(walk, 140).plane, (last(walk, 140).plane == PixelCode.CONTOUR) & (made == 0))
    pitch = walk[0].part.frame.pitch
    plain, keyed = (
        cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_COLOR)
        for data in (png(last(walk, 202)), keyed_png(last(walk, 202), pitch))
    )
    rows = np.flatnonzero(np.any(keyed[: len(plain), : plain.shape[1]] != plain, axis=(1, 2)))
    starts = 2 * np.argwhere(last(walk, 202).plane == PixelCode.TRACED)[:, 0] + 1
    assert len(starts) == 3 and np.abs(rows[:, None] - starts).min(axis=1).max() <= 8


def test_the_key_of_a_narrow_picture_is_whole(walk: Walk) -> None:
    stage = last(walk, 202)
    narrow = replace(stage, plane=np.ascontiguousarray(stage.plane[:, 60:70]))
    data = keyed_png(narrow, walk[0].part.frame.pitch)
    keyed = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_COLOR)
    assert (keyed[:, -1] == keyed[-1, -1]).all(axis=1).sum() >= len(keyed) - 1, "paper to the right of all words"


def test_the_published_rules_stand_beside_the_settled_ones_with_what_they_come_to() -> None:
    from app.core.resources import resource
    from app.exhibits.stage_files import run_stages
    from app.usecases.job.options import MakeOptions
    from app.usecases.pixels.options import BitmapOptions, BitmapSize

    data = resource("samples", "fig2.dxf").read_bytes()
    options = MakeOptions(bitmap=BitmapOptions(BitmapSize(160)))
    runs = {
        variant: {stage.number: stage for stage in run_stages("fig2.dxf", data, (options, variant)).last}
        for variant in Variant
    }
    for number in (301, 304, 307, 401, 403, 404, 405, 406, 407):
        assert runs[Variant.PUBLISHED][number].beside and not runs[Variant.SETTLED][number].beside
        assert runs[Variant.PUBLISHED][number].beside in runs[Variant.PUBLISHED][number].sentence
    assert "px" in runs[Variant.PUBLISHED][406].beside and "formula II" in runs[Variant.PUBLISHED][401].beside
    assert len(runs[Variant.PUBLISHED][407].rows) > 0
