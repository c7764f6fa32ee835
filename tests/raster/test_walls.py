"""The squares of pixels that are not free hold every contour, and their edges are the walls."""

import numpy as np
import pytest

from app.geometry.distance import DistanceField
from app.geometry.outlines import nest
from app.geometry.primitives import contour_rows, points_at, signed_area
from app.raster.border import borders_of
from app.raster.frame import BitmapFrame
from app.raster.levels import offset_area
from app.raster.trace import chain_rows
from app.raster.walls import free_contours, free_pixels, outline_px, wall_rows
from tests.raster.oracle import even_odd
from tests.raster.shapes import KINDS, polygon

FRAME = BitmapFrame(64, 64, 1.0, -2.0, -2.0)


def in_wall_square(free: np.ndarray, px: np.ndarray) -> np.ndarray:
    """Whether points (column, row) lie in the closed square of a pixel that is not free."""
    found = np.zeros(len(px), bool)
    for nudge in np.array([[-1, -1], [-1, 1], [1, -1], [1, 1]]) * 1e-6:
        col, row = np.floor(px + nudge).astype(int).T
        seen = (col >= 0) & (col < free.shape[1]) & (row >= 0) & (row < free.shape[0])
        found |= ~seen
        found[seen] |= ~free[row[seen], col[seen]]
    return found


@pytest.mark.parametrize("kind", KINDS)
def test_contours_pass_through_no_free_pixel(kind: str) -> None:
    for seed in range(40):
        contours = KINDS[kind](np.random.default_rng(seed), 60.0)
        free = free_pixels(FRAME, contours)
        assert not np.any(free & ~even_odd(FRAME, contours)), "what is free is inside"
        for contour in contours:
            rows = contour_rows(contour)
            part = np.linspace(0, 1, 400)
            points = points_at(np.repeat(rows, len(part), axis=0), np.tile(part, len(rows)))
            assert in_wall_square(free, FRAME.to_px(points)).all()


def test_pixels_that_no_contour_passes_are_free_where_they_are_inside() -> None:
    triangle = polygon([(3.2, 3.3), (50.1, 9.4), (20.7, 55.6)])
    free, inside = free_pixels(FRAME, [triangle]), even_odd(FRAME, [triangle])
    rows = contour_rows(triangle)
    points = points_at(np.repeat(rows, 5000, axis=0), np.tile(np.linspace(0, 1, 5000), len(rows)))
    col, row = np.floor(FRAME.to_px(points)).astype(int).T
    passed = np.zeros_like(free)
    passed[row, col] = True
    assert np.array_equal(free, inside & ~passed)


def test_walls_on_the_grid_s_lines_take_no_pixel() -> None:
    square = polygon([(10.0, 10.0), (30.0, 10.0), (30.0, 20.0), (10.0, 20.0)])
    assert free_pixels(FRAME, [square]).sum() == 200
    halves = [polygon([(x, 10.0), (x + 10, 10.0), (x + 10, 20.0), (x, 20.0)]) for x in (10.0, 20.0)]
    assert free_pixels(FRAME, halves).sum() == 190, "but two areas that share a line stay apart"


@pytest.mark.parametrize("seed", range(20))
def test_the_edges_of_free_pixels_are_closed_contours_round_them(seed: int) -> None:
    free = np.random.default_rng(seed).random((12, 14)) < 0.6
    frame = BitmapFrame(12, 14, 0.5, 3.0, -1.0)
    contours = free_contours(frame, free)
    areas = [signed_area(contour_rows(contour)) for contour in contours]
    assert sum(areas) == pytest.approx(free.sum() * 0.25)
    assert np.array_equal(even_odd(frame, list(contours)), free)
    regions = nest(contours)
    assert sum(len(region.contours) for region in regions) == len(contours)
    assert len(outline_px(free)) == sum(len(contour.primitives) for contour in contours)
    lengths = np.hypot(*(wall_rows(frame, free)[:, 2:4] - wall_rows(frame, free)[:, :2]).T)
    across, down = np.diff(np.pad(free, 1).astype(int), axis=0), np.diff(np.pad(free, 1).astype(int), axis=1)
    assert lengths.sum() == pytest.approx(0.5 * (np.abs(across).sum() + np.abs(down).sum()))


@pytest.mark.parametrize("turned", [False, True])
def test_a_contour_through_pixels_corners_takes_both_pixels_there(turned: bool) -> None:
    corners = [(10.5, 10.5), (30.5, 30.5), (10.5, 50.5)]
    triangle = polygon([(60 - x, y) for x, y in corners] if turned else corners)
    free = free_pixels(FRAME, [triangle])
    taken = even_odd(FRAME, [triangle]) & ~free
    on_slants = {(row, col) for row, col in np.argwhere(taken).tolist() if col not in (12, 47)}
    assert len(on_slants) >= 38, "each pixel along both slants whose centre is inside or on them, and no other"
    assert not free[
        FRAME.rows - 1 - np.arange(14, 30), (59 - np.arange(14, 30) + 3) if turned else np.arange(14, 30)
    ].any()


@pytest.mark.parametrize("radius", [2.0, 3.5, 11.0])
@pytest.mark.parametrize("kind", ["star", "arcs", "circles", "rectilinear"])
def test_a_path_through_the_pixels_of_an_offset_keeps_its_radius_and_more(kind: str, radius: float) -> None:
    for seed in range(10):
        free = free_pixels(FRAME, KINDS[kind](np.random.default_rng(seed), 60.0))
        if not free.any():
            continue
        field = DistanceField.of(wall_rows(FRAME, free))
        for border in borders_of(offset_area(free, radius, 0.75)):
            rows = chain_rows(FRAME, [border.chain])
            points = points_at(np.repeat(rows, 9, axis=0), np.tile(np.linspace(0, 1, 9), len(rows)))
            assert field.nearest(points)[0].min() >= radius + 0.75
