"""Surfaces as an image, without a window: soft outlines, and the hue that the legend shows."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from app.ui.views.cut.camera import Camera, StandardView
from app.ui.views.surfaces.scene_raster import SURFACE_STRENGTH, SceneColours, SceneStyle, raster
from app.ui.views.surfaces.shown_scene import ScenePicture

GROUND, INK = (250, 248, 240), (0, 158, 115)
SIZE = (120, 90)


def picture(triangles):
    """A picture of bare triangles, and of another surface hidden just below them, of which it is told apart."""
    none = np.zeros((0, 3))
    triangles = np.array(triangles, np.float64)
    both, owner = np.concatenate([triangles, triangles - (0, 0, 1)]), np.repeat([0, 1], len(triangles))
    return ScenePicture((), none, (), both, owner, none[:, :2], none[:, :2])


def painted(triangles, coarse=False, alone=False):
    made = picture(triangles)
    if alone:
        made = replace(made, owner=np.zeros_like(made.owner))
    camera = Camera().seen_from(StandardView.TOP).fitted(*made.box, SIZE)
    colours = SceneColours(GROUND, (0, 0, 0), (90, 90, 90), (200, 90, 0), [INK, INK])
    return raster(made, SceneStyle(camera, colours, coarse=coarse), SIZE)


SLANTED = [[(0, 0, 0), (40, 7, 0), (0, 30, 0)]]


def shares(made):
    """How much of each pixel is the surface's, by its red: of ground 250, of the surface where it is whole less."""
    red = made.pixels[:, :, 2].astype(float)
    return (GROUND[0] - red) / (GROUND[0] - red.min())


def test_outlines_are_soft_and_cover_what_the_surface_covers():
    fine, coarse = painted(SLANTED), painted(SLANTED, coarse=True)
    between = (shares(fine) > 0.1) & (shares(fine) < 0.9)
    assert between.sum() > 40
    assert not ((shares(coarse) > 0.1) & (shares(coarse) < 0.9)).any()
    scale = (coarse.owners >= 0).sum()
    assert shares(fine).sum() == pytest.approx(scale, rel=0.01)


def test_a_surface_has_the_hue_of_its_colour_however_it_lies():
    flat = painted(SLANTED)
    steep = painted([[(0, 0, 0), (40, 0, 60), (0, 30, 0)]])
    full = np.array(GROUND) * (1 - SURFACE_STRENGTH) + np.array(INK) * SURFACE_STRENGTH
    for made in (flat, steep):
        seen = made.pixels[made.owners >= 0][:, 2::-1].astype(float)
        inside = seen[np.abs(seen - np.median(seen, axis=0)).max(axis=1) < 2]
        ratio = np.median(inside, axis=0) / full
        assert ratio.max() - ratio.min() < 0.02
        assert 0.55 < ratio.mean() <= 1.01


def test_a_surface_alone_is_grey_so_that_its_paths_are_seen_on_it():
    made = painted(SLANTED, alone=True)
    seen = made.pixels[made.owners >= 0][:, :3].astype(float)
    assert np.ptp(np.median(seen, axis=0)) < 8
