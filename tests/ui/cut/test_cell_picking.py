"""The cell under the mouse, against a search through all cells."""

import numpy as np
import pytest

from app.ui.views.cut.camera import Camera, SightRay, StandardView
from app.ui.views.cut.cell_picking import SectionPlane, pick
from app.ui.views.cut.cut_picture import CutPicture
from app.ui.views.cut.height_profile import height_profile

SIZE = (640, 480)


def rough(rows=19, columns=23, seed=5):
    heights = np.random.default_rng(seed).uniform(-9.0, 0.0, (rows, columns)).astype(np.float32)
    return CutPicture(heights, -3.0, 2.0, 0.7, -10.0, 0.0)


def by_search(picture, ray, section=None):
    """The first column of a cell that a ray enters, by the slabs of every box: slow and obviously right."""
    best = None
    for row in range(picture.rows):
        for column in range(picture.columns):
            corner = np.array([picture.x0 + column * picture.pitch, picture.y0 + row * picture.pitch])
            planes = [
                (np.eye(3)[k] * s, s * v) for k in (0, 1) for s, v in ((1, corner[k] + picture.pitch), (-1, corner[k]))
            ]
            planes += [
                (np.array([0, 0, 1.0]), float(picture.heights[row, column])),
                (np.array([0, 0, -1.0]), -picture.floor),
            ]
            if section is not None:
                planes.append((np.array([*section.normal, 0.0]), section.offset))
            begin, end = -np.inf, np.inf
            for normal, offset in planes:
                speed, ahead = normal @ ray.direction, offset - normal @ ray.origin
                if abs(speed) < 1e-12:
                    end = end if ahead >= 0 else -np.inf
                elif speed > 0:
                    end = min(end, ahead / speed)
                else:
                    begin = max(begin, ahead / speed)
            if begin < end and (best is None or begin < best[0]):
                best = (begin, row, column)
    return best


@pytest.mark.parametrize("section", [None, SectionPlane((0.0, -1.0), -7.0), SectionPlane((0.6, 0.8), 9.0)])
@pytest.mark.parametrize(("yaw", "pitch"), [(-0.7, 0.6), (2.5, 0.2), (0.3, 1.4), (1.1, -0.5)])
def test_the_cell_that_a_search_finds_is_picked(section, yaw, pitch):
    picture = rough()
    camera = Camera(yaw=yaw, pitch=pitch).fitted(picture.low, picture.high, SIZE)
    chosen = np.random.default_rng(3).uniform((0, 0), SIZE, (60, 2))
    met = 0
    for at in chosen:
        ray = camera.ray((at[0], at[1]), SIZE)
        found, hit = by_search(picture, ray, section), pick(picture, ray, section)
        assert (found is None) == (hit is None)
        if hit is not None:
            met += 1
            assert (hit.row, hit.column) == found[1:]
            assert np.allclose(hit.place, ray.origin + found[0] * ray.direction, atol=1e-9)
            assert hit.height == picture.heights[hit.row, hit.column]
    assert met >= 10


def test_straight_down_and_level_rays_are_picked_too():
    picture = rough()
    x, y = picture.x0 + 5.5 * picture.pitch, picture.y0 + 2.25 * picture.pitch
    down = pick(picture, SightRay(np.array([x, y, 50.0]), np.array([0.0, 0.0, -1.0])))
    assert (down.row, down.column) == (2, 5)
    assert down.place[2] == picture.heights[2, 5]
    level = pick(picture, SightRay(np.array([x, -50.0, -9.5]), np.array([0.0, 1.0, 0.0])))
    assert (level.row, level.column) == (0, 5)
    assert level.place[1] == pytest.approx(picture.y0)
    assert pick(picture, SightRay(np.array([x, -50.0, 0.5]), np.array([0.0, 1.0, 0.0]))) is None


def test_a_hole_is_not_metal():
    heights = np.zeros((8, 8), np.float32)
    heights[3:5, 3:5] = -10.0
    picture = CutPicture(heights, 0.0, 0.0, 1.0, -10.0, 0.0)
    assert pick(picture, SightRay(np.array([4.2, 4.2, 50.0]), np.array([0.0, 0.0, -1.0]))) is None


def test_a_point_is_seen_where_its_line_of_sight_says():
    camera = Camera((3.0, -2.0, 1.0), 0.4, 0.9, 7.0)
    points = np.random.default_rng(1).uniform(-20, 20, (30, 3))
    for point, (px, py, _) in zip(points, camera.project(points, SIZE), strict=True):
        ray = camera.ray((px, py), SIZE)
        assert np.linalg.norm(np.cross(point - ray.origin, ray.direction)) < 1e-9


def test_zoom_and_orbit_keep_what_is_held_in_its_place():
    camera = Camera((3.0, -2.0, 1.0), 0.4, 0.9, 7.0)
    at = (100.0, 377.0)
    held = camera.ray(at, SIZE).origin
    assert np.allclose(camera.zoomed(3.0, at, SIZE).project(held[None], SIZE)[0, :2], at)
    pivot = np.array([5.0, 6.0, -7.0])
    before = camera.project(pivot[None], SIZE)[0, :2]
    assert np.allclose(camera.orbited(0.5, -0.3, pivot).project(pivot[None], SIZE)[0, :2], before)


@pytest.mark.parametrize("view", StandardView)
def test_a_fitted_box_is_whole_in_the_picture_and_fills_it(view):
    low, high = np.array([-5.0, 10.0, -20.0]), np.array([45.0, 40.0, 0.0])
    camera = Camera().seen_from(view).fitted(low, high, SIZE)
    corners = np.array([[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])])
    seen = camera.project(corners, SIZE)[:, :2]
    assert np.all(seen >= 0) and np.all(seen <= SIZE)
    assert np.max(np.ptp(seen, axis=0) / SIZE) == pytest.approx(0.9)


def test_standard_views_look_along_the_axes():
    towards = {view: Camera().seen_from(view).axes[2] for view in StandardView}
    assert np.allclose(towards[StandardView.TOP], (0, 0, 1))
    assert np.allclose(towards[StandardView.FRONT], (0, -1, 0))
    assert np.allclose(towards[StandardView.RIGHT], (1, 0, 0))
    assert np.allclose(np.abs(towards[StandardView.ISOMETRIC]), 3**-0.5)


def test_a_profile_has_one_height_for_every_cell_that_its_line_crosses():
    picture = rough()
    row, length = 7, picture.columns * picture.pitch
    y = picture.y0 + (row + 0.5) * picture.pitch
    along = height_profile(picture, (picture.x0, y), (picture.x0 + length, y))
    assert np.array_equal(along.heights[np.diff(along.borders) > 1e-9], picture.heights[row])
    slanted = height_profile(picture, (-5.0, 1.0), (14.0, 16.0))
    assert slanted.borders[-1] == pytest.approx(np.hypot(19.0, 15.0))
    for at in np.linspace(0.01, 0.99, 40):
        x, y = -5.0 + 19.0 * at, 1.0 + 15.0 * at
        column, row = int(np.floor((x - picture.x0) / picture.pitch)), int(np.floor((y - picture.y0) / picture.pitch))
        inside = 0 <= column < picture.columns and 0 <= row < picture.rows
        piece = int(np.searchsorted(slanted.borders, at * slanted.borders[-1])) - 1
        assert slanted.heights[piece] == (picture.heights[row, column] if inside else picture.floor)
