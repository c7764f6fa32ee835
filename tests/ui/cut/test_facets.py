"""The facets of a sweep in the picture, against the projection of their corners."""

from dataclasses import replace

import numpy as np
import pytest

from app.simulation.gpu.wedges_picture import WedgesPicture
from app.ui.views.cut.camera import Camera
from app.ui.views.cut.cell_colours import CutColourBy, cell_colours
from app.ui.views.cut.rendering.cut_frame import CutFrame
from app.ui.views.cut.rendering.cut_scene import CutScene
from tests.ui.cut.pictures import INKS, LOOK, SIZE, flat_picture

CAMERA = Camera(target=(5.0, 5.0, 0.0), pitch=1.1, scale=18.0)
METAL = flat_picture(np.full((32, 32), -6.0))


def trough(kind=(0, 1), z=0.0, across=6, along=5):
    """Facets of the lower half of a cylinder of radius 2 along X, half of each kind."""
    x, a = np.linspace(2.0, 8.0, along + 1), np.linspace(-np.pi / 2, np.pi / 2, across + 1)
    ring = np.column_stack([5.0 + 2.0 * np.sin(a), z - 2.0 * np.cos(a)])
    quads, kinds = [], []
    for k in range(along):
        for j in range(across):
            corners = [(x[k], *ring[j]), (x[k + 1], *ring[j]), (x[k + 1], *ring[j + 1]), (x[k], *ring[j + 1])]
            quads.append(corners)
            kinds.append(kind[2 * k // along])
    return WedgesPicture(np.array(quads, np.float32), np.array(kinds, np.uint8), 0.5)


def painted(context, *shown, camera=CAMERA, **more):
    with context:
        scene = CutScene(context)
        scene.show_picture(METAL)
        scene.show_colours(cell_colours(METAL, CutColourBy.METAL, INKS))
        made = []
        for wedges in shown:
            scene.show_wedges(wedges)
            scene.draw(CutFrame(camera, SIZE, LOOK, **more))
            made.append(scene.pixels().astype(int))
        scene.release()
    return made


@pytest.mark.parametrize("budget", [0, 4096])
def test_facets_lie_where_their_corners_do_and_nowhere_else(context, budget):
    import cv2

    wedges = trough()
    got, bare = painted(context, wedges, None, budget=budget)
    mask = np.zeros((SIZE[1], SIZE[0]), np.uint8)
    lifted = CAMERA.axes[2] * 3.0 / CAMERA.scale
    for quad in wedges.quads:
        cv2.fillPoly(
            mask,
            [np.round((CAMERA.project(quad + lifted, SIZE)[:, :2] - 0.5) * 16).astype(np.int32)],
            255,
            cv2.LINE_8,
            4,
        )
    seen, rim = np.abs(got - bare).max(axis=2) > 6, np.ones((3, 3), np.uint8)
    assert np.mean(seen[cv2.erode(mask, rim) > 0]) > 0.995 and not np.any(seen[cv2.dilate(mask, rim) == 0])


def test_cylinders_and_wedges_have_hues_of_their_own_and_the_metal_shines_through(context):
    blue, orange, bare = painted(context, trough((0, 0)), trough((1, 1)), None)
    seen = np.abs(blue - bare).max(axis=2) > 6
    assert np.median((blue - orange)[seen][:, 2]) > 60 and np.median((orange - blue)[seen][:, 0]) > 40
    (both,) = painted(context, trough((0, 1)))
    left, right = (CAMERA.project(np.array([[x, 5.0, -2.0]]), SIZE)[0] for x in (2.6, 7.4))
    assert np.array_equal(both[round(left[1]), round(left[0])], blue[round(left[1]), round(left[0])])
    assert np.array_equal(both[round(right[1]), round(right[0])], orange[round(right[1]), round(right[0])])


def test_edges_are_dark_and_go_where_they_would_cover_everything(context):
    near, bare = painted(context, trough((0, 0)), None)

    def dark(image, ground):
        seen = np.abs(image - ground).max(axis=2) > 6
        return (image[seen].max(axis=1) < 110).mean()

    assert 0.05 < dark(near, bare) < 0.4
    far = Camera(target=(5.0, 5.0, 0.0), pitch=1.1, scale=4.0)
    small, ground = painted(context, trough((0, 0), across=30, along=30), None, camera=far)
    assert dark(small, ground) < 0.02


def test_facets_under_metal_show_faintly_and_far_off_ones_are_seen(context):
    under, bare = painted(context, trough(z=-9.0), None)
    assert 0 < np.abs(under - bare).max() < 40
    wedges = trough()
    off = replace(wedges, quads=(wedges.quads + 300.0 * CAMERA.axes[2]).astype(np.float32))
    (high,) = painted(context, off)
    assert (np.abs(high - bare).max(axis=2) > 6).sum() > 3000
