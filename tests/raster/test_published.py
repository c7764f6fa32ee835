"""The fill as the text prints it goes wrong on many shapes, and where it does is counted; the settled one goes wrong
nowhere.
"""

import numpy as np

from app.raster.fill import draw, fill
from app.raster.frame import BitmapFrame, PixelCode
from app.raster.published import published_marks, published_scan, wrong_pixels
from tests.raster.oracle import wrong_pixels as wrongly_settled
from tests.raster.shapes import KINDS, polygon

SIZE = 120


def picture(plane: np.ndarray) -> list[str]:
    return ["".join(".12Ri"[code] for code in row) for row in plane.tolist()]


def test_it_is_right_where_lines_keep_apart() -> None:
    diamond = polygon([(4.5, 0.5), (8.5, 4.5), (4.5, 8.5), (0.5, 4.5)])
    frame = BitmapFrame(9, 9, 1.0)
    marked, chains = published_marks(draw(frame, [diamond])[0])
    assert len(chains) == 1
    assert picture(published_scan(marked)) == picture(fill(frame, [diamond]).plane)


def test_two_strands_side_by_side_count_once() -> None:
    slot = polygon([(2.5, 1.5), (3.5, 1.5), (3.5, 8.5), (2.5, 8.5)])
    frame = BitmapFrame(10, 12, 1.0)
    marked, _ = published_marks(draw(frame, [slot])[0])
    published, settled = published_scan(marked), fill(frame, [slot]).plane
    assert picture(published)[4] == "..22iiiiiiii"
    assert picture(settled)[4] == "..22........"
    assert wrong_pixels(published, settled).sum() == 8 * 6


def test_it_errs_where_the_findings_say_and_the_settled_one_nowhere() -> None:
    wrong = {}
    for number, (name, kind) in enumerate(KINDS.items()):
        wrong[name] = 0
        for seed in range(12):
            contours, frame = kind(np.random.default_rng([number, seed]), float(SIZE)), BitmapFrame(SIZE, SIZE, 1.0)
            settled = fill(frame, contours)
            assert not wrongly_settled(settled, contours)
            marked, _ = published_marks(draw(frame, contours)[0])
            assert set(np.unique(marked)) <= {PixelCode.EMPTY, PixelCode.CONTOUR, PixelCode.TRACED, PixelCode.R}
            wrong[name] += bool(wrong_pixels(published_scan(marked), settled.plane).any())
    assert wrong == WRONG_OF_12


WRONG_OF_12 = {
    "star": 10,
    "comb": 6,
    "slots": 9,
    "touching": 9,
    "spiral": 11,
    "rectilinear": 4,
    "tangled": 11,
    "arcs": 10,
    "circles": 10,
    "stadiums": 7,
    "beyond": 12,
}
"""Shapes of each kind that the published rules fill wrongly."""
