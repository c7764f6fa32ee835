"""8-connected vector tracing: chain codes that walk all contour lines and end where they began."""

import numpy as np
import pytest

from app.raster.fill import draw
from app.raster.frame import BitmapFrame, PixelCode
from app.raster.trace import trace
from tests.raster.shapes import KINDS


def plane_of(*rows: str) -> np.ndarray:
    return np.array([[int(cell != ".") for cell in row] for row in rows], np.uint8)


def test_a_square_goes_round_counter_clockwise() -> None:
    (chain,), traced = trace(plane_of(".....", ".xxx.", ".x.x.", ".xxx.", "....."))
    assert chain.text() == "1 1: 66002244."
    assert set(np.unique(traced)) == {0, 2}


def test_a_pixel_alone_has_no_directions() -> None:
    (chain,), _ = trace(plane_of("...", ".x.", "..."))
    assert chain.text() == "1 1: ."
    assert chain.pixels().tolist() == [[1, 1]]


def test_an_overlap_line_is_walked_there_and_back() -> None:
    (chain,), _ = trace(plane_of("......", ".xxxx.", "......"))
    assert chain.text() == "1 1: 000444."


def test_regions_apart_have_chains_of_their_own_in_raster_order() -> None:
    chains, _ = trace(plane_of("...xx", "x..xx", "x....", "....."))
    assert [chain.start for chain in chains] == [(0, 3), (1, 0)]


def test_every_line_of_a_ring_is_found() -> None:
    thick = np.ones((9, 9), np.uint8)
    thick[3:6, 3:6] = 0
    thick = np.pad(thick, 1)
    chains, _ = trace(thick)
    assert [chain.start for chain in chains] == [(1, 1), (4, 7)]
    rows, cols = chains[1].pixels().T
    turns = np.sum(cols[:-1] * rows[1:] - cols[1:] * rows[:-1])
    assert turns > 0, "a hole's border runs clockwise on the screen"


def test_the_picture_s_edge_is_empty_space() -> None:
    (chain,), _ = trace(np.ones((3, 3), np.uint8))
    assert chain.text() == "0 0: 66002244."


@pytest.mark.parametrize("kind", [kind for kind in KINDS if kind != "beyond"])
def test_chains_close_and_stay_on_the_drawn_pixels(kind: str) -> None:
    for seed in range(10):
        plane, _ = draw(BitmapFrame(60, 60, 1.0), KINDS[kind](np.random.default_rng(seed), 60.0))
        chains, traced = trace(plane)
        assert np.array_equal(traced != 0, plane != 0)
        walked = np.zeros_like(plane)
        for chain in chains:
            pixels = chain.pixels()
            assert pixels[-1].tolist() == list(chain.start)
            walked[tuple(pixels.T)] = PixelCode.TRACED
        assert np.array_equal(walked, np.where(traced == PixelCode.TRACED, traced, 0))
