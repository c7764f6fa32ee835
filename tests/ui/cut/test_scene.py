"""What the renderer paints, against what a few lines of numpy say that it should."""

import math
from dataclasses import replace

import numpy as np
import pytest

from app.ui.views.cut.camera import Camera, StandardView
from app.ui.views.cut.cell_colours import CutColourBy, cell_colours
from app.ui.views.cut.cell_picking import SectionPlane
from app.ui.views.cut.cut_picture import CutMoves, CutPaths
from app.ui.views.cut.rendering.cut_frame import CutFrame
from app.ui.views.cut.rendering.cut_scene import CutScene
from app.ui.views.cut.rendering.path_ribbons import rows_of, thinned
from app.ui.views.cut.rendering.stock_textures import BLOCK, block_heights
from app.ui.views.nc.motion_shapes import MotionLineStyle
from tests.ui.cut import pictures
from tests.ui.cut.pictures import (
    AMBIENT,
    CANVAS,
    DIRECT,
    INKS,
    LIGHT,
    LOOK,
    METAL,
    SIZE,
    STOCK,
    brightness,
    flat_picture,
    painted,
    places_of_pixels,
    seen,
)

N = 64
GROUND = np.round(np.array(CANVAS) * 255).astype(np.uint8)


def cells(n=N):
    """X and Y of the cells' centres on a square of 10 mm."""
    at = (np.arange(n) + 0.5) * 10.0 / n
    return np.meshgrid(at, at)


def from_above(context, heights, tmp_path, name, slopes, colour=METAL):
    """Compare a picture from above with the brightness that the formula gives for slopes (x, y functions)."""
    picture = flat_picture(heights)
    camera = seen(picture, StandardView.TOP)
    x, y = places_of_pixels(camera, 0.0)
    lit = brightness(camera, *slopes(x, y))[..., None] * np.array(colour)
    inside = ((x >= 0) & (x <= 10) & (y >= 0) & (y <= 10))[..., None]
    expected = np.where(inside, np.clip(lit, 0, 255), GROUND).round().astype(np.uint8)
    got = painted(context, picture, camera)
    pictures.assert_alike(got, expected, name, tmp_path, share=0.03, most=5)


def test_a_plane_is_as_bright_as_its_normal_says_and_fills_its_square(context, tmp_path):
    from_above(context, np.full((N, N), -1.0), tmp_path, "plane", lambda x, y: (0 * x, 0 * y))


def test_stock_that_nobody_cut_has_its_own_colour(context, tmp_path):
    from_above(context, np.zeros((N, N)), tmp_path, "stock", lambda x, y: (0 * x, 0 * y), STOCK)


@pytest.mark.parametrize("slope", [(0.3, 0.0), (0.0, -0.5), (0.05, 0.02)])
def test_a_slope_is_lit_by_the_side_that_it_faces(context, tmp_path, slope):
    x, y = cells()
    heights = -5.0 + slope[0] * (x - 5) + slope[1] * (y - 5)
    from_above(context, heights, tmp_path, "slope", lambda x, y: (slope[0] + 0 * x, slope[1] + 0 * y))


def test_a_sphere_is_shaded_pixel_by_pixel(context, tmp_path):
    x, y = cells(256)
    radius = 9.0
    heights = -1.0 - radius + np.sqrt(radius**2 - (x - 5) ** 2 - (y - 5) ** 2)

    def slopes(x, y):
        z = np.sqrt(np.maximum(radius**2 - (x - 5) ** 2 - (y - 5) ** 2, 1.0))
        return -(x - 5) / z, -(y - 5) / z

    from_above(context, heights, tmp_path, "sphere", slopes)


def test_a_quick_picture_takes_its_normals_from_every_cell(context):
    x, _ = cells(256)
    picture = flat_picture(-2.0 + 0.02 * np.sin(x * 12))
    camera = seen(picture, StandardView.TOP)
    fine, coarse = (painted(context, picture, camera, budget=budget).astype(int) for budget in (0, SIZE[0] * SIZE[1]))
    assert np.abs(fine - coarse).max(axis=2).mean() < 1.5
    assert fine[SIZE[1] // 2, 60:260, 0].std() > 10


def test_a_step_shows_a_wall_as_high_as_it_is(context):
    heights = np.zeros((N, N))
    heights[:, N // 2 :] = -6.0
    picture = flat_picture(heights)
    camera = seen(picture, StandardView.RIGHT)
    image = painted(context, picture, camera)
    ground = np.all(image == GROUND, axis=2)
    column = SIZE[0] // 2
    filled = np.flatnonzero(~ground[:, column])
    assert len(filled) == pytest.approx(10.0 * camera.scale, abs=1.5)
    wall = image[filled[0] : filled[0] + int(6.0 * camera.scale) - 3, column]
    front = image[filled[-1] - 10, column]
    lit = AMBIENT + DIRECT * max(float((LIGHT @ camera.axes)[0]), 0.0)
    assert np.all(wall[6:, 0] > 0.5 * lit * METAL[0])
    assert np.all(wall[6:20, 0] <= lit * METAL[0] + 6)
    assert front[0] == pytest.approx(lit * STOCK[0], abs=3)


def test_the_silhouette_from_the_front_is_the_highest_of_each_column(context):
    x, y = cells()
    heights = -8.0 + 6.0 * np.exp(-((x - 3) ** 2 + (y - 6) ** 2) / 4)
    picture = flat_picture(heights)
    camera = seen(picture, StandardView.FRONT)
    metal = ~np.all(painted(context, picture, camera) == GROUND, axis=2)
    for column in range(N // 8, N, N // 8):
        place = np.array([[(column + 0.5) * 10 / N, 0.0, heights[:, column].max()]])
        px, py, _ = camera.project(place, SIZE)[0]
        rows = np.flatnonzero(metal[:, round(px - 0.5)])
        assert rows[0] == pytest.approx(py, abs=1.6)


def test_a_hole_is_seen_through_from_both_sides(context):
    heights = np.zeros((N, N))
    heights[20:44, 20:44] = -10.0
    picture = flat_picture(heights)
    middle = (SIZE[1] // 2, SIZE[0] // 2)
    for pitch in (math.pi / 2, -math.pi / 2):
        camera = replace(seen(picture, StandardView.TOP), pitch=pitch)
        image = painted(context, picture, camera)
        assert np.array_equal(image[middle], GROUND)
        assert not np.array_equal(image[middle[0] - 80, middle[1]], GROUND)


def test_colours_of_a_palette_reach_the_screen_cell_by_cell(context):
    move = np.repeat(np.arange(4) - 1, N // 4)[None] * np.ones((N, 1), int)
    moves = CutMoves(np.arange(3, dtype=np.int32), np.array([7, 3, 9], np.int32), np.zeros(3, np.int32))
    picture = flat_picture(np.full((N, N), -1.0), move=move.astype(np.int32), moves=moves)
    camera = seen(picture, StandardView.TOP)
    image = painted(context, picture, camera, CutColourBy.TOOL)
    light = float(brightness(camera, np.zeros(1), np.zeros(1))[0])
    for quarter, colour in enumerate((STOCK, (255, 0, 0), (0, 255, 0), (0, 0, 255))):
        px, py, _ = camera.project(np.array([[1.25 + 2.5 * quarter, 5.0, -1.0]]), SIZE)[0]
        assert np.allclose(image[round(py), round(px)], np.array(colour) * light, atol=3)


def test_a_section_takes_away_what_lies_beyond_it_and_shows_a_hatched_face(context):
    picture = flat_picture(np.full((N, N), -2.0))
    camera = seen(picture, StandardView.FRONT)
    whole, open_ = (
        painted(context, picture, camera, section=section) for section in (None, SectionPlane((0.0, -1.0), -5.0))
    )
    silhouette = [~np.all(image == GROUND, axis=2) for image in (whole, open_)]
    assert np.array_equal(*silhouette)
    assert len(np.unique(whole[silhouette[0]], axis=0)) < 6
    face = open_[silhouette[1]].astype(int)
    share = np.mean((face[:, 0] - face[:, 1]) > 20)
    assert 0.08 < share < 0.25
    from_right = seen(picture, StandardView.RIGHT)
    both = (
        painted(context, picture, from_right),
        painted(context, picture, from_right, section=SectionPlane((0.0, -1.0), -5.0)),
    )
    widths = [np.any(~np.all(image == GROUND, axis=2), axis=0).sum() for image in both]
    assert widths[1] == pytest.approx(widths[0] / 2, abs=1.5)


@pytest.mark.parametrize(
    ("look", "period", "drawn"),
    [(MotionLineStyle.CONTOUR, 9.0, 5.5), (MotionLineStyle.RAPID, 5.0, 2.0), (MotionLineStyle.CUT, 0.0, 0.0)],
)
def test_contours_are_dashed_rapids_dotted_and_pockets_solid(context, look, period, drawn):
    paths = CutPaths(np.array([[0.5, 5.0, 1.0]]), np.array([[9.5, 5.0, 1.0]]), np.array([look], np.uint8))
    picture = flat_picture(np.full((N, N), -1.0), paths=paths)
    camera = seen(picture, StandardView.TOP)
    image = painted(context, picture, camera).astype(int)
    bare = painted(context, picture, camera, shown=frozenset()).astype(int)
    line = np.abs(image - bare).sum(axis=2).max(axis=0) > 60
    first, last = np.flatnonzero(line)[[0, -1]]
    assert last - first == pytest.approx(9.0 * camera.scale, abs=period + 2)
    starts = np.flatnonzero(np.diff(line[first:last].astype(int)) == 1)
    if period:
        assert np.diff(starts).mean() == pytest.approx(period, abs=0.3)
        assert line[first:last].mean() == pytest.approx(drawn / period, abs=0.16)
    else:
        assert not len(starts)


def test_paths_under_metal_are_hidden_and_those_on_it_are_not(context):
    def visible(z):
        paths = CutPaths(
            np.array([[1.0, 5.0, z]]), np.array([[9.0, 5.0, z]]), np.array([MotionLineStyle.CUT], np.uint8)
        )
        picture = flat_picture(np.full((N, N), -1.0), paths=paths)
        camera = seen(picture, StandardView.TOP)
        return bool(np.any(painted(context, picture, camera) != painted(context, picture, camera, shown=frozenset())))

    assert visible(-1.0)
    assert not visible(-4.0)


def test_painting_piece_by_piece_gives_the_same_and_shows_nothing_half_done(context):
    x, _ = cells(512)
    picture = flat_picture(-1.0 + 0.5 * np.sin(x))
    camera = Camera().fitted(picture.low, picture.high, (800, 600))
    whole = CutFrame(camera, (800, 600), LOOK)
    with context:
        scene = CutScene(context)
        scene.show_picture(picture)
        scene.draw(CutFrame(camera, (800, 600), LOOK, budget=256))
        coarse = scene.pixels().copy()
        steps = scene.draw_in_steps(whole)
        next(steps)
        assert np.array_equal(scene.pixels(), coarse)
        assert sum(1 for _ in steps) > 2
        in_pieces = scene.pixels().copy()
        scene.draw(whole)
        assert np.array_equal(scene.pixels(), in_pieces)
        scene.release()
    assert np.any(in_pieces != coarse)


def test_a_picture_at_rest_is_seen_at_once_with_a_line_of_sight_in_each_pixel(context):
    x, _ = cells(512)
    picture = flat_picture(-1.0 + 0.5 * np.sin(x))
    camera = Camera().fitted(picture.low, picture.high, (800, 600))
    with context:
        scene = CutScene(context)
        scene.show_picture(picture)
        scene.draw(CutFrame(camera, (800, 600), LOOK, budget=1 << 14))
        coarse = scene.pixels().astype(int)
        shown = [scene.pixels().astype(int) for new in scene.draw_in_steps(CutFrame(camera, (800, 600), LOOK)) if new]
        scene.release()
    first, last = shown

    def off(seen):
        return (np.abs(seen - last).max(axis=2) > 12).mean()

    assert 0 < 3 * off(first) < off(coarse), (off(first), off(coarse))


@pytest.mark.parametrize("view", [StandardView.TOP, StandardView.ISOMETRIC])
@pytest.mark.parametrize(("budget", "near"), [(0, 1.5), (1 << 12, 5.0)])
def test_metal_is_painted_right_up_to_its_outline(context, view, budget, near):
    picture = flat_picture(np.full((N, N), -1.0))
    camera = seen(picture, view).zoomed(0.5, (SIZE[0] / 2, SIZE[1] / 2), SIZE)
    corners = np.array(np.meshgrid(*zip(picture.low, (*picture.high[:2], -1.0), strict=True))).reshape(3, -1).T
    outline = camera.project(corners, SIZE)[:, :2]
    rows, columns = np.nonzero(np.any(painted(context, picture, camera, budget=budget) != GROUND, axis=2))
    assert np.abs(outline.min(axis=0) - (columns.min(), rows.min())).max() < near
    assert np.abs(outline.max(axis=0) - (columns.max() + 1, rows.max() + 1)).max() < near


def test_a_closer_look_has_no_gaps(context):
    x, y = cells(256)
    picture = flat_picture(-3.0 + np.sin(x * 3) * np.cos(y * 2))
    camera = Camera(pitch=0.9).fitted(picture.low, picture.high, SIZE).zoomed(6.0, (100.0, 120.0), SIZE)
    assert not np.any(np.all(painted(context, picture, camera) == GROUND, axis=2))


@pytest.mark.parametrize("shape", [(1, 1), (8, 9), (17, 40), (64, 7)])
def test_the_highest_of_a_block_is_the_highest_corner_of_its_squares(shape):
    heights = np.random.default_rng(3).normal(size=shape).astype(np.float32)
    counts = [size // BLOCK + 1 for size in shape]
    whole = block_heights(heights, *(slice(0, count) for count in counts))
    for row in range(counts[0]):
        for column in range(counts[1]):
            cells = (range(BLOCK * k - 1, BLOCK * (k + 1)) for k in (row, column))
            at = (np.clip(list(some), 0, size - 1) for some, size in zip(cells, shape, strict=True))
            assert whole[row, column] == heights[np.ix_(*at)].max()
    part = block_heights(heights, slice(counts[0] - 1, counts[0]), slice(0, counts[1]))
    assert np.array_equal(part, whole[-1:])


def test_few_lines_of_sight_while_things_move_and_four_in_a_pixel_at_rest():
    def rays(budget):
        return CutFrame(Camera(), (800, 600), LOOK, budget).rays

    assert rays(0) == (1600, 1200)
    assert rays(800 * 600) == rays(10**9) == (800, 600)
    assert rays(800 * 600 // 4) == (400, 300)
    assert rays(1) == (200, 150)


@pytest.mark.parametrize("turn", [0.1, 0.35, 0.7])
def test_an_upright_wall_stands_where_it_was_cut_and_not_where_cells_end(context, turn):
    """From above the rim of a half plane is straight to a quarter of a cell, at any angle to the cells."""
    x, y = cells(128)
    normal = np.array([math.cos(turn), math.sin(turn)])
    low = (x - 5) * normal[0] + (y - 5) * normal[1] > 0
    moves = CutMoves(np.array([1], np.int32), np.array([1], np.int32), np.zeros(1, np.int32))
    picture = flat_picture(np.where(low, -4.0, 0.0), move=low.astype(np.int32) - 1, moves=moves)
    size = (640, 640)
    camera = seen(picture, StandardView.TOP, size).zoomed(3.0, (320.0, 320.0), size)
    with context:
        scene = CutScene(context)
        scene.show_picture(picture)
        scene.show_colours(cell_colours(picture, CutColourBy.TOOL, INKS))
        scene.draw(CutFrame(camera, size, LOOK))
        image = scene.pixels().astype(float)
        scene.release()
    grey = image[..., 1] > 0.5 * image[..., 0]  # what was cut is red
    px, py = pictures.places_of_pixels(camera, 0.0, size)
    across = (px - 5) * normal[0] + (py - 5) * normal[1]
    edges = [0.5 * (across[row][grey[row]].max() + across[row][~grey[row]].min()) for row in range(0, 640, 7)]
    assert np.abs(edges).max() < 0.25 * picture.pitch


def test_a_long_path_is_thinned_within_its_unbroken_parts_alone():
    looks = np.array([MotionLineStyle.CUT] * 5 + [MotionLineStyle.CONTOUR] * 3 + [MotionLineStyle.CUT] * 2, np.uint8)
    places = np.arange(11.0)[:, None] * np.array([1.0, 0.0, 0.0])
    start, end = places[:-1].copy(), places[1:].copy()
    start[9] += 0.5
    rows = rows_of(CutPaths(start, end, looks))
    assert rows["gone"].tolist() == [0, 1, 2, 3, 4, 0, 1, 2, 0, 0]
    thin = thinned(rows, 2)
    pieces = [(a[0], b[0]) for a, b in zip(thin["from"], thin["to"], strict=True)]
    assert pieces == [(0, 2), (2, 4), (4, 5), (5, 7), (7, 8), (8, 9), (9.5, 10)]
    assert thin["gone"].tolist() == [0, 2, 4, 0, 2, 0, 0]


@pytest.mark.parametrize("budget", [0, 20_000], ids=["fine", "moving"])
def test_a_round_wall_has_no_stripes(context, budget):
    """Along a wall that turns, what the light leaves turns too: as a cylinder's normal says, whatever the cells."""
    x, y = cells(256)
    radius, depth = 3.5, 2.0
    picture = flat_picture(np.where(np.hypot(x - 5, y - 5) < radius, -depth, 0.0))
    camera = seen(picture, StandardView.ISOMETRIC)
    pixels = painted(context, picture, camera, budget=budget).astype(float)[..., 0]
    towards = camera.axes[2]
    away = math.atan2(-towards[1], -towards[0])
    angles = away + np.linspace(-0.9, 0.9, 60)
    middle = np.column_stack(
        [5 + radius * np.cos(angles), 5 + radius * np.sin(angles), np.full(len(angles), -depth / 2)]
    )
    column, row = camera.project(middle, SIZE)[:, :2].astype(int).T
    got = pixels[row, column]
    # the wall of a pocket faces inward; the corner's shade takes a share that changes slowly
    normals = np.column_stack([-np.cos(angles), -np.sin(angles), np.zeros(len(angles))])
    expected = METAL[0] * (AMBIENT + DIRECT * np.maximum(normals @ (LIGHT @ camera.axes), 0.0))
    share = got / expected
    assert np.ptp(share) < 0.25, share.round(2)
    assert np.std(np.diff(got)) < 8.0, got


def test_the_ground_is_darkest_at_the_foot_of_the_stock_and_untouched_far_from_it(context):
    heights = np.zeros((N, N))
    heights[:, N // 2 :] = -10.0  # cut away: that half throws no shadow
    picture = flat_picture(heights)
    camera = replace(seen(picture, StandardView.TOP), scale=10.0)
    look = replace(LOOK, canvas=(0.8, 0.8, 0.8), shadow=0.5)
    row = painted(context, picture, camera, look=look)[SIZE[1] // 2, :, 0].astype(int)
    left, cut = (round(SIZE[0] / 2 + 10.0 * (x - 5.0)) for x in (0.0, 5.0))
    assert np.all(np.diff(row[left - 8 : left - 1]) <= 0)
    assert row[left - 1] < 0.85 * 204
    assert row[left - 12] == row[0] == 204
    assert row[cut + 22] == 204  # a block of cells, and the reach of a shadow


def test_edges_are_unbroken_lines_though_a_cell_is_far_smaller_than_a_pixel(context):
    n = 512
    x, y = cells(n)
    heights = np.where(np.hypot(x - 5, y - 5) < 3.0, -4.0, 0.0)
    picture = flat_picture(heights)
    camera = replace(seen(picture, StandardView.ISOMETRIC), scale=16.0)
    look = replace(LOOK, edge=(1.0, 0.0, 0.0))
    image = painted(context, picture, camera, look=look).astype(int)
    angle = np.radians(np.arange(0, 360, 2.0))
    rim = camera.project(np.column_stack([5 + 3 * np.cos(angle), 5 + 3 * np.sin(angle), 0 * angle]), SIZE)
    redder = image[..., 0] - image[..., 1]
    along = [redder[round(v) - 2 : round(v) + 2, round(u) - 2 : round(u) + 2].max() for u, v, _ in rim]
    assert min(along) > 25
    flat = camera.project(np.array([[1.0, 1.0, 0.0], [5.0, 5.0, -4.0]]), SIZE)
    assert all(redder[round(v) - 3 : round(v) + 3, round(u) - 3 : round(u) + 3].max() < 3 for u, v, _ in flat)
