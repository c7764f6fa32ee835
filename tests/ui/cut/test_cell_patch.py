"""Cells that have changed: what is shown is what showing everything anew would show."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.ui.views.cut.camera import Camera
from app.ui.views.cut.cell_colours import CutColourBy, cell_colours, values_of
from app.ui.views.cut.cell_patch import CellPatch, patch_of
from app.ui.views.cut.cut_picture import CutPicture
from app.ui.views.cut.relief import REACH, relief, relief_part
from app.ui.views.cut.rendering.cut_frame import CutFrame
from app.ui.views.cut.rendering.cut_scene import CutScene
from tests.examples import examples
from tests.ui.cut.pictures import INKS, LOOK, SIZE

CHANGED = (slice(90, 150), slice(40, 200))


def wavy(rows=240, columns=280, seed=1):
    """Heights of all sorts: waves, steps, noise."""
    noise = np.random.default_rng(seed)
    x, y = np.meshgrid(np.arange(columns) / 9.0, np.arange(rows) / 7.0)
    heights = -4.0 + np.sin(x) * np.cos(y) + noise.normal(0, 0.02, x.shape)
    heights[rows // 4 : rows // 3] -= 3.0
    return heights.astype(np.float32)


def of(heights):
    return CutPicture(heights, 0.0, 0.0, 10.0 / heights.shape[1], -10.0, 0.0)


def cut_deeper(heights, floor=-7.5):
    """The heights with a groove, a step in its middle, in the changed rectangle."""
    after = heights.copy()
    part = after[CHANGED]
    np.minimum(part, np.float32(floor), out=part)
    part[:, 80:] = np.float32(-1.0)
    return after


@settings(max_examples=examples(60), deadline=None)
@given(st.integers(1, 90), st.integers(1, 90), st.data())
def test_the_relief_of_a_part_is_that_of_the_whole(rows, columns, data):
    heights = wavy(rows, columns)
    cuts = [
        slice(*sorted(data.draw(st.lists(st.integers(0, count), min_size=2, max_size=2, unique=True))))
        for count in heights.shape
    ]
    assert np.array_equal(relief_part(heights, 0.1, *cuts), relief(heights, 0.1)[cuts[0], cuts[1]])


def test_a_height_changes_no_relief_farther_away_than_a_patch_reaches():
    before = wavy()
    for row, col in ((120, 140), (0, 0), (239, 100), (61, 279)):
        after = before.copy()
        after[row, col] -= 60.0
        other = np.argwhere(np.any(relief(after, 0.1) != relief(before, 0.1), axis=2))
        assert 20 < np.abs(other - (row, col)).max() <= REACH


def painted(context, frames, picture, patches=(), colour=CutColourBy.DEPTH):
    """What a scene paints of a picture that was shown whole, and then patched."""
    with context:
        scene = CutScene(context)
        scene.show_picture(picture)
        scene.show_colours(cell_colours(picture, colour, INKS, of(wavy()).span))
        scene.draw(frames[0])
        for patch in patches:
            scene.patch(patch)
        made = []
        for frame in frames:
            scene.draw(frame)
            made.append(scene.pixels().copy())
        scene.release()
    return made


def frames(budget=0):
    """Whole and near, larger and smaller than a pixel a cell, from above and from below."""
    low, high = np.array([0.0, 0.0, -10.0]), np.array([10.0, 8.6, 0.0])
    whole = Camera().fitted(low, high, SIZE)
    cameras = (
        whole,
        whole.zoomed(0.3, (160, 120), SIZE),
        whole.zoomed(6.0, (160, 120), SIZE),
        replace(whole, pitch=-0.7),
    )
    return [CutFrame(camera, SIZE, LOOK, budget) for camera in cameras]


@pytest.mark.parametrize("floor", [-7.5, -11.0])
def test_a_patched_scene_at_rest_is_a_freshly_filled_one_pixel_for_pixel(context, floor):
    before = wavy()
    after = cut_deeper(before, floor)
    fresh = of(after)
    patch = patch_of(after, values_of(fresh, CutColourBy.DEPTH, of(before).span), fresh.pitch, CHANGED)
    patched = painted(context, frames(), of(before), [patch])
    filled, old = (painted(context, frames(), picture) for picture in (fresh, of(before)))
    for frame, got, expected, was in zip(frames(), patched, filled, old, strict=True):
        hidden = frame.camera.pitch < 0 and floor > fresh.floor  # from below a groove is seen where it goes through
        assert np.array_equal(got, expected) and np.array_equal(got, was) == hidden


def test_while_it_moves_a_patch_is_seen_too_and_differs_only_where_pixels_hold_many_cells(context):
    before = wavy()
    after = cut_deeper(before)
    fresh = of(after)
    patch = patch_of(after, values_of(fresh, CutColourBy.DEPTH, of(before).span), fresh.pitch, CHANGED)
    patched, filled = painted(context, frames(1 << 14), of(before), [patch]), painted(context, frames(1 << 14), fresh)
    assert np.array_equal(patched[2], filled[2])
    assert all(
        np.abs(got.astype(int) - expected.astype(int)).mean() < 2.0
        for got, expected in zip(patched, filled, strict=True)
    )


def test_metal_that_comes_back_is_not_left_out_of_sight(context):
    low = np.full((64, 64), -9.5, np.float32)
    full = np.full((64, 64), -0.0, np.float32)
    camera = (
        Camera(pitch=0.5)
        .fitted(np.array([0.0, 0.0, -10.0]), np.array([10.0, 10.0, 0.0]), SIZE)
        .zoomed(5.0, (160, 40), SIZE)
    )
    frame, values = [CutFrame(camera, SIZE, LOOK)], np.zeros((64, 64), np.uint8)
    (got,) = painted(
        context, frame, of(low), [patch_of(full, values, 10 / 64, (slice(0, 64), slice(0, 64)))], CutColourBy.METAL
    )
    (expected,) = painted(
        context, frame, of(full), [CellPatch(0, 0, full, values, relief(full, 10 / 64))], CutColourBy.METAL
    )
    assert np.array_equal(got, expected)


def test_the_picture_follows_in_place():
    before, colour = wavy(), CutColourBy.DEPTH
    after = cut_deeper(before, -11.0)
    picture = of(before.copy())
    span, kept = picture.span, (picture.heights, picture.relief, picture.lowest, picture.highest)
    values_of(picture, colour, span)
    values_of(picture, CutColourBy.METAL, span)
    new = values_of(of(after), colour, span)
    patch_of(after, new, picture.pitch, CHANGED).write_to(picture, colour)
    assert picture.heights is kept[0] and np.array_equal(picture.heights, after)
    assert np.array_equal(picture.relief, relief(after, picture.pitch))
    assert (picture.lowest, picture.highest) == (after.min(), after.max()) != kept[2:]
    assert np.array_equal(picture.values[colour], new) and CutColourBy.METAL not in picture.values


def test_a_patch_keeps_what_the_cells_were():
    heights, values = wavy(), np.zeros((240, 280), np.uint8)
    patch = patch_of(heights, values, 0.1, CHANGED)
    kept = patch.heights.copy()
    heights -= 1.0
    values += 1
    assert np.array_equal(patch.heights, kept) and not patch.values.any()
    assert (patch.rows, patch.columns) == (slice(90 - REACH, 150 + REACH), slice(0, 200 + REACH))
