"""A finer look at a part of the cut stands in its place in the picture, and the whole round it."""

from dataclasses import replace

import numpy as np
import pytest

from app.ui.views.cut.camera import Camera, StandardView
from app.ui.views.cut.cell_colours import CutColourBy, cell_colours, values_of
from app.ui.views.cut.cell_picking import SectionPlane
from app.ui.views.cut.cut_picture import CutPicture
from app.ui.views.cut.rendering.cut_frame import CutFrame
from app.ui.views.cut.rendering.cut_scene import CutScene
from tests.ui.cut import pictures
from tests.ui.cut.pictures import INKS, LOOK, SIZE, flat_picture, seen


def wave(cells, corner=(0.0, 0.0), side=10.0):
    """Heights of one and the same wave on a square, in as many cells as wanted."""
    x, y = (low + (np.arange(cells) + 0.5) * side / cells for low in corner)
    return CutPicture(
        (-3.0 + np.sin(x)[None] * np.cos(y)[:, None]).astype(np.float32), *corner, side / cells, -10.0, 0.0
    )


def painted(context, picture, camera, detail=None, colour=CutColourBy.DEPTH, **more):
    with context:
        scene = CutScene(context)
        scene.show_picture(picture)
        scene.show_colours(cell_colours(picture, colour, INKS))
        scene.show_detail(detail, values_of(detail, colour, picture.span) if detail is not None else None)
        scene.draw(CutFrame(camera, SIZE, LOOK, **more))
        pixels = scene.pixels().astype(int)
        scene.release()
    return pixels


@pytest.mark.parametrize(("yaw", "pitch"), [(0.0, np.pi / 2), (0.7, 0.6), (-2.2, 0.9)])
@pytest.mark.parametrize("section", [None, SectionPlane((1.0, 0.0), 5.2)])
def test_the_same_metal_looks_the_same_with_and_without_it(context, yaw, pitch, section):
    whole, detail = wave(400), wave(400, (3.0, 4.0), 3.5)
    camera = Camera(yaw=yaw, pitch=pitch).fitted(whole.low, whole.high, SIZE)
    with_it, without = (painted(context, whole, camera, each, section=section) for each in (detail, None))
    different = np.abs(with_it - without).max(axis=2) > 12
    assert different.mean() < 0.01
    ground = np.round(np.array(LOOK.canvas) * 255)
    assert np.array_equal(np.all(with_it == ground, axis=2), np.all(without == ground, axis=2))


def test_only_in_its_place_the_part_is_what_is_seen(context):
    whole = flat_picture(np.full((64, 64), -1.0))
    deep = replace(whole, heights=np.full((64, 64), -8.0, np.float32), x0=2.0, y0=5.0, pitch=3.0 / 64, values={})
    camera = seen(whole, StandardView.TOP)
    x, y = pictures.places_of_pixels(camera, 0.0)
    inside = (x > 2.05) & (x < 4.95) & (y > 5.05) & (y < 7.95)
    outside = (x > 0.05) & (x < 9.95) & (y > 0.05) & (y < 9.95) & ~((x > 1.95) & (x < 5.05) & (y > 4.95) & (y < 8.05))
    whole_span = replace(whole, heights=np.where(np.arange(64) < 1, np.float32(-9.0), whole.heights), values={})
    got = painted(context, whole_span, camera, deep)
    assert got[inside].mean() < got[outside & (x > 0.5)].mean() - 60


def test_sides_of_the_stock_within_the_part_are_its_own(context):
    whole = flat_picture(np.full((64, 64), -1.0))
    deep = replace(whole, heights=np.full((64, 64), -8.0, np.float32), x0=4.0, y0=0.0, pitch=2.0 / 64, values={})
    camera = seen(whole, StandardView.FRONT)
    got = painted(context, whole, camera, deep, CutColourBy.METAL)
    at = camera.project(np.array([[5.0, 0.0, -4.0], [2.0, 0.0, -4.0], [5.0, 0.0, -9.0]]), SIZE)[:, :2].astype(int)
    above, side, foot = (got[row, column].tolist() for column, row in at)
    assert foot == side != above
