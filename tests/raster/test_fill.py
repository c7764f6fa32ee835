"""The fill is right for every shape: compared pixel by pixel with an oracle that knows nothing of it."""

import cv2
import numpy as np
import pytest

from app.geometry.primitives import contour_rows
from app.model.curves import Arc, Circle, Line
from app.model.part import Contour
from app.raster.fill import fill
from app.raster.frame import BitmapFrame, Codes, PixelCode, area_mm2
from tests.raster.oracle import strangers, wrong_pixels
from tests.raster.shapes import KINDS, polygon

SQUARE = polygon([(10.0, 10.0), (30.0, 10.0), (30.0, 30.0), (10.0, 30.0)])


def picture(codes: Codes) -> list[str]:
    return ["".join(".12Ri"[code] for code in row) for row in codes.plane.tolist()]


def check(kind: str, seed: int) -> None:
    rng = np.random.default_rng([list(KINDS).index(kind), seed])
    size = int(rng.choice([24, 60, 120, 400], p=[0.3, 0.4, 0.25, 0.05]))
    contours = KINDS[kind](rng, float(size))
    codes = fill(BitmapFrame(size, size, 1.0), contours)
    assert not wrong_pixels(codes, contours), f"{kind} {seed}"


@pytest.mark.parametrize("kind", KINDS)
def test_random_shapes_are_filled_right(kind: str) -> None:
    for seed in range(40):
        check(kind, seed)


@pytest.mark.exhaustive
@pytest.mark.parametrize("kind", KINDS)
def test_ten_thousand_random_shapes_are_filled_right(kind: str) -> None:
    for seed in range(10_000 // len(KINDS) + 1):
        check(kind, seed)


@pytest.mark.parametrize("kind", KINDS)
def test_only_pixels_that_the_contour_passes_are_drawn(kind: str) -> None:
    rng = np.random.default_rng(7)
    contours = KINDS[kind](rng, 40.0)
    assert not strangers(fill(BitmapFrame(40, 40, 1.0), contours), contours)


@pytest.mark.parametrize("kind", [kind for kind in KINDS if kind != "beyond"])
def test_each_contour_is_one_8_connected_line(kind: str) -> None:
    for contour in KINDS[kind](np.random.default_rng(3), 90.0):
        plane = fill(BitmapFrame(120, 120, 1.0, -15.0, -15.0), [contour]).plane
        drawn = ((plane == PixelCode.TRACED) | (plane == PixelCode.R)).astype(np.uint8)
        assert cv2.connectedComponents(drawn, connectivity=8)[0] == 2


def test_codes_of_a_diamond() -> None:
    diamond = polygon([(4.5, 0.5), (8.5, 4.5), (4.5, 8.5), (0.5, 4.5)])
    assert picture(fill(BitmapFrame(9, 9, 1.0), [diamond])) == [
        "....R....",
        "...2i2...",
        "..2iii2..",
        ".2iiiii2.",
        "2iiiiiii2",
        ".2iiiii2.",
        "..2iii2..",
        "...2i2...",
        "....R....",
    ]


def test_strands_that_merge_in_a_pixel_are_r() -> None:
    sliver = polygon([(2.1, 1.2), (2.4, 1.2), (2.4, 5.8), (2.1, 5.8)])
    assert picture(fill(BitmapFrame(7, 6, 1.0), [sliver])) == ["......"] + ["..R..."] * 5 + ["......"]


def test_a_contour_twice_leaves_only_its_own_pixels() -> None:
    codes = fill(BitmapFrame(40, 40, 1.0), [SQUARE, SQUARE])
    assert not np.any(codes.plane == PixelCode.INSIDE)
    assert np.count_nonzero(codes.plane == PixelCode.R) == np.count_nonzero(codes.filled)


def test_what_lies_left_of_the_frame_counts() -> None:
    codes = fill(BitmapFrame(10, 10, 1.0, 15.0, 15.0), [SQUARE])
    assert np.all(codes.plane == PixelCode.INSIDE)


def test_rows_of_an_offset_are_filled_like_contours() -> None:
    contours = KINDS["arcs"](np.random.default_rng(4), 60.0)
    rows = np.concatenate([contour_rows(contour) for contour in contours])
    assert np.array_equal(fill(BitmapFrame(60, 60, 1.0), rows).plane, fill(BitmapFrame(60, 60, 1.0), contours).plane)


def test_nothing_drawn_is_nothing_filled() -> None:
    assert not fill(BitmapFrame(), []).filled.any()


def test_a_speck_smaller_than_a_pixel_is_one_contour_pixel() -> None:
    codes = fill(BitmapFrame(5, 5, 1.0), [Contour((Circle((2.8, 2.8), 0.1),))])
    assert np.argwhere(codes.filled).tolist() == [[2, 2]]


@pytest.mark.parametrize("turned", [False, True])
def test_area_lies_within_its_bounds(turned: bool) -> None:
    disc = Contour((Circle((50.0, 50.0), 40.0, turned),))
    half = Contour((Arc((60.0, 50.0), (40.0, 50.0), (50.0, 50.0)), Line((40.0, 50.0), (60.0, 50.0))))
    area = area_mm2(fill(BitmapFrame.around((0, 0, 100, 100), 1000), [disc, half]))
    exact = np.pi * (1600 - 50)
    assert area.low < exact < area.high
    assert area.estimate == pytest.approx(exact, rel=2e-3)


def test_large_pictures_are_filled_in_bands_alike() -> None:
    contours = KINDS["star"](np.random.default_rng(5), 1100.0)
    codes = fill(BitmapFrame(1100, 1100, 1.0), contours)
    assert not wrong_pixels(codes, contours)


def test_observer_sees_the_steps_of_the_text() -> None:
    seen: dict[int, np.ndarray] = {}
    codes = fill(BitmapFrame(40, 40, 1.0), [SQUARE], seen.__setitem__)
    assert list(seen) == [201, 202, 203, 206, 208, 130]
    assert set(np.unique(seen[201])) == {0, 1}
    assert np.argwhere(seen[202] == PixelCode.TRACED).tolist()[0] == [10, 10]
    assert not np.any(seen[203] == PixelCode.CONTOUR)
    assert set(np.unique(seen[206])) == {0, 2, 3}
    assert np.array_equal(seen[208], codes.plane)
    assert np.array_equal(seen[130] == 1, codes.filled)
