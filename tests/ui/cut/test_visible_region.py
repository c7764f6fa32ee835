"""Which part of the stock a view asks for, from any side."""

import numpy as np
import pytest

from app.ui.views.cut.camera import Camera, StandardView
from app.ui.views.cut.cell_picking import SectionPlane, pick, pick_finest
from app.ui.views.cut.cut_picture import CutPicture
from app.ui.views.cut.visible_region import GAIN, LEAST_PITCH, RegionQuery, region_to_refine, serves

SIZE, CELLS = (600, 400), 200


def waves(cells=CELLS, box=(0.0, 0.0, 20.0, 20.0)):
    """Heights of a wavy top with a pocket in it, over a rectangle."""
    pitch = (box[2] - box[0]) / cells
    x, y = (box[k] + (np.arange(cells) + 0.5) * pitch for k in (0, 1))
    heights = np.sin(x)[None] * np.cos(y)[:, None] - 1.5
    heights[(np.abs(x - 12) < 3)[None] & (np.abs(y - 8) < 2)[:, None]] = -6.0
    return CutPicture(heights.astype(np.float32), box[0], box[1], pitch, -10.0, 0.0)


def zoomed(factor, at=(250.0, 210.0), yaw=0.5, pitch=0.9):
    picture = waves()
    return Camera(yaw=yaw, pitch=pitch).fitted(picture.low, picture.high, SIZE).zoomed(factor, at, SIZE)


def test_the_whole_needs_no_finer_look():
    assert region_to_refine(RegionQuery(waves(), None, zoomed(1.0), SIZE, None), CELLS) is None


def test_from_above_the_part_is_what_the_view_shows():
    camera = zoomed(1.0, pitch=np.pi / 2, yaw=0.0).zoomed(8.0, (250.0, 210.0), SIZE)
    window = region_to_refine(RegionQuery(waves(), None, camera, SIZE, None), CELLS)
    corners = [camera.ray(at, SIZE).origin[:2] for at in ((0.5, SIZE[1] - 0.5), (SIZE[0] - 0.5, 0.5))]
    wide = corners[1] - corners[0]
    assert np.all(np.array(window[:2]) <= corners[0]) and np.all(np.array(window[2:]) >= corners[1])
    assert np.all(np.subtract(window[2:], window[:2]) < 1.15 * wide)


@pytest.mark.parametrize(("yaw", "pitch"), [(0.3, 0.4), (-2.0, 0.7), (1.2, 1.3)])
@pytest.mark.parametrize("section", [None, SectionPlane((1.0, 0.0), 11.0)])
def test_all_metal_that_is_seen_lies_in_the_part(yaw, pitch, section):
    camera = zoomed(7.0, yaw=yaw, pitch=pitch)
    picture = waves()
    x0, y0, x1, y1 = region_to_refine(RegionQuery(picture, None, camera, SIZE, section), CELLS)
    met = [
        pick(picture, camera.ray(at, SIZE), section) for at in np.random.default_rng(3).uniform((0, 0), SIZE, (150, 2))
    ]
    places = np.array([hit.place for hit in met if hit is not None])
    assert len(places) > 30
    assert np.mean((places[:, 0] >= x0) & (places[:, 0] <= x1) & (places[:, 1] >= y0) & (places[:, 1] <= y1)) > 0.97
    assert max(x1 - x0, y1 - y0) <= GAIN * 20.0


def test_cells_are_never_finer_than_a_micrometre_and_the_part_never_leaves_the_stock():
    camera = zoomed(1.0, pitch=np.pi / 2, yaw=0.0).zoomed(1e5, (300.0, 200.0), SIZE)
    window = region_to_refine(RegionQuery(waves(), None, camera, SIZE, None), CELLS)
    assert max(window[2] - window[0], window[3] - window[1]) == pytest.approx(LEAST_PITCH * CELLS)
    corner = zoomed(1.0, pitch=np.pi / 2, yaw=0.0)
    at = corner.project(np.zeros((1, 3)), SIZE)[0]
    window = region_to_refine(RegionQuery(waves(), None, corner.zoomed(5.0, (at[0], at[1]), SIZE), SIZE, None), CELLS)
    assert window[:2] == (0.0, 0.0)


def test_a_wall_seen_from_the_side_is_a_slim_part():
    picture = waves()
    camera = (
        Camera().seen_from(StandardView.FRONT).fitted(picture.low, picture.high, SIZE).zoomed(8.0, (300.0, 250.0), SIZE)
    )
    x0, y0, x1, y1 = region_to_refine(RegionQuery(picture, None, camera, SIZE, None), CELLS)
    assert y0 == 0.0 and 0 < y1 - y0 < x1 - x0


def test_beside_the_stock_nothing_is_wanted():
    assert region_to_refine(RegionQuery(waves(), None, zoomed(1.0).panned(5000, 0), SIZE, None), CELLS) is None


def test_a_part_serves_until_it_is_left_or_grows_too_coarse():
    detail = waves(CELLS, (4.0, 4.0, 6.0, 6.0))
    assert serves((4.1, 4.1, 5.9, 5.9), detail)
    assert not serves((4.1, 4.1, 6.4, 5.9), detail)
    assert not serves((4.8, 4.8, 5.2, 5.2), detail)
    assert not serves((4.1, 4.1, 5.9, 5.9), None)


def test_finer_cells_are_picked_where_there_are_some():
    whole = CutPicture(np.full((20, 20), -1.0, np.float32), 0.0, 0.0, 1.0, -10.0, 0.0)
    detail = CutPicture(np.full((40, 40), -3.0, np.float32), 5.0, 5.0, 0.1, -10.0, 0.0)
    camera = Camera((7.0, 7.0, -1.0), 0.0, 1.2, 20.0)
    hit = pick_finest(whole, detail, camera.ray((300.0, 200.0), SIZE))
    assert hit.picture is detail and hit.height == -3.0
    far = pick_finest(whole, detail, camera.ray((520.0, 200.0), SIZE))
    assert far.picture is whole and far.height == -1.0
    assert pick_finest(whole, None, camera.ray((300.0, 200.0), SIZE)).picture is whole
