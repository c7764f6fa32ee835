"""Painting without a screen, and comparing what was painted with what should have been."""

from pathlib import Path

import numpy as np
import pytest

from app.core.errors import HitofudeError
from app.ui.views.cut.camera import Camera
from app.ui.views.cut.cell_colours import Colormap, CutColourBy, cell_colours
from app.ui.views.cut.cut_picture import CutPicture
from app.ui.views.cut.relief import GAIN, LIMIT
from app.ui.views.cut.rendering.cut_frame import CutFrame
from app.ui.views.cut.rendering.cut_scene import CutScene
from app.ui.views.cut.rendering.render_target import RenderStyle

CANVAS, STOCK, METAL = (0.0, 0.0, 0.25), (100, 100, 100), (200, 200, 200)
LIGHT = np.array([-0.45, 0.62, 0.64]) / np.linalg.norm([-0.45, 0.62, 0.64])
AMBIENT, DIRECT = 0.4, 0.5
LOOK = RenderStyle(
    CANVAS,
    tuple(v / 255 for v in STOCK),
    (1.0, 0.0, 0.0),
    ((0.0, 0.0, 1.0, 1.0), (0.0, 1.0, 0.0, 1.0), (1.0, 0.0, 1.0, 1.0), (1.0, 1.0, 0.0, 1.0)),
    strength=(AMBIENT, DIRECT, 0.0),
)
INKS = Colormap(
    METAL,
    ((255, 0, 0), (0, 255, 0), (0, 0, 255)),
    ((255, 0, 0), (0, 255, 0), (0, 0, 255)),
    ((255, 255, 255), (0, 0, 0)),
    ((0, 0, 0), (255, 255, 255)),
    (255, 0, 0),
    METAL,
    (0, 0, 255),
    (255, 0, 255),
    STOCK,
)
SIZE = (320, 240)


def without_a_screen():
    """An OpenGL context without a screen; where there is none the test is skipped, and says why."""
    from app.simulation.gpu.graphics import standalone_context

    try:
        context = standalone_context()
    except HitofudeError as reason:
        pytest.skip(str(reason))
    return context


def flat_picture(heights, **more):
    """A picture of heights over a square of 10 mm, floor at -10, top at 0."""
    heights = np.asarray(heights, np.float32)
    return CutPicture(heights, 0.0, 0.0, 10.0 / heights.shape[1], -10.0, 0.0, **more)


def painted(context, picture, camera, colour=CutColourBy.METAL, **more):
    """The picture of a cut as an array, (height, width, 3)."""
    with context:
        made = CutScene(context)
        made.show_picture(picture)
        made.show_colours(cell_colours(picture, colour, INKS))
        made.show_paths(picture.paths)
        made.draw(CutFrame(camera, SIZE, **({"look": LOOK} | more)))
        pixels = made.pixels().copy()
        made.release()
    return pixels


def seen(picture, view, size=SIZE):
    """The camera that shows a whole picture from a standard direction."""
    return Camera().seen_from(view).fitted(picture.low, picture.high, size)


def brightness(camera, slope_x, slope_y):
    """Share of a colour that the light leaves of it where metal has these slopes; steps of the formula, not of the
    shader.
    """
    square = slope_x**2 + slope_y**2
    gain = 1 + (GAIN - 1) / (1 + square / LIMIT**2)
    normal = np.stack([-gain * slope_x, -gain * slope_y, np.ones_like(square)]) / np.sqrt(1 + gain**2 * square)
    light = LIGHT @ camera.axes
    return AMBIENT + DIRECT * np.maximum(np.tensordot(light, normal, 1), 0.0)


def places_of_pixels(camera, z, size=SIZE):
    """X and Y of every pixel's middle on a level, for a camera that looks straight down."""
    columns, rows = np.meshgrid(np.arange(size[0]) + 0.5, np.arange(size[1]) + 0.5)
    x = camera.target[0] + (columns - size[0] / 2) / camera.scale
    y = camera.target[1] + (size[1] / 2 - rows) / camera.scale
    return x, y


def assert_alike(got, expected, name, folder, share=0.002, most=24):
    """Fail where more than a share of the pixels differ by more than `most`, leaving got, expected and difference
    behind.
    """
    import cv2

    difference = np.abs(got.astype(int) - expected.astype(int))
    if (difference.max(axis=2) > most).mean() > share:
        Path(folder).mkdir(parents=True, exist_ok=True)
        for kind, image in (("got", got), ("expected", expected), ("difference", np.minimum(difference * 4, 255))):
            cv2.imwrite(str(Path(folder) / f"{name}-{kind}.png"), image.astype(np.uint8)[..., ::-1])
        pytest.fail(f"{name}: {(difference.max(axis=2) > most).sum()} pixels differ; see {folder}")
