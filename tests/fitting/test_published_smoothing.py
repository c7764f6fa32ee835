"""Smoothing as the text of 1986 has it: found on shapes whose pieces are known, and held against closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest

from app.core.errors import GeometryError
from app.fitting.corner_smoothing.published import average_angles, published_smoothing
from app.fitting.corner_smoothing.smoothed_path import PieceKind
from app.raster.border import borders_of

ROWS, COLS = np.mgrid[0:200, 0:200]


def line_of(area: np.ndarray) -> np.ndarray:
    [border] = borders_of(area)
    pixels = border.chain.pixels()[:-1]
    return np.column_stack([pixels[:, 1], -pixels[:, 0]]).astype(float)


def test_a_circle_is_one_circle_about_its_centre() -> None:
    found = published_smoothing(line_of((COLS - 100) ** 2 + (ROWS - 90) ** 2 < 80**2), 60.0)
    [piece] = found.pieces
    assert piece.kind is PieceKind.CIRCLE and found.spread < 0.2 and found.vertices == ()
    centre = (piece.places.max(axis=0) + piece.places.min(axis=0)) / 2
    assert np.allclose(centre, [100, -90], atol=1.0)
    assert piece.sa < 0.75 and piece.off < 1.5


def test_a_rectangle_has_its_long_lines_first_and_short_ones_between() -> None:
    found = published_smoothing(line_of((abs(COLS - 100) < 80) & (abs(ROWS - 100) < 40)), 100.0)
    assert found.counted(PieceKind.LONG_LINE) == 2 and found.counted(PieceKind.SHORT_LINE) >= 2
    for piece in found.pieces:
        if piece.kind is PieceKind.LONG_LINE:
            assert math.dist(*piece.places) > 140 and piece.off == 0.0


def test_every_pixel_is_in_a_piece() -> None:
    line = line_of((COLS - 100) ** 2 / 90**2 + (ROWS - 100) ** 2 / 50**2 < 1)
    found = published_smoothing(line, 60.0)
    seen = np.zeros(len(line), bool)
    for piece in found.pieces:
        seen[np.arange(piece.first, piece.last + 1) % len(line)] = True
    assert seen.all() and found.counted(PieceKind.SPLINE) >= 1
    assert found.off < 2.0


def test_an_arccos_cannot_tell_left_from_right() -> None:
    cross = ((abs(COLS - 100) < 20) & (abs(ROWS - 100) < 60)) | ((abs(COLS - 100) < 60) & (abs(ROWS - 100) < 20))
    arccos, signed = average_angles(line_of(cross))
    assert np.allclose(arccos, np.abs(signed)) and arccos.max() <= math.pi
    left, right = np.sum(signed > math.pi / 3), np.sum(signed < -math.pi / 3)
    assert left > 0 and right > 0


def test_a_speck_is_refused() -> None:
    with pytest.raises(GeometryError, match="eight"):
        published_smoothing(np.zeros((5, 2)), 10.0)
