"""The picture as PNG, drawn with anti-aliased lines."""

from __future__ import annotations

from collections.abc import Sequence

import cv2
import numpy as np
from numpy.typing import NDArray

from ...geometry.primitives import Rows, sample
from .flat import dashes
from .picture import (
    AREA,
    INK,
    LEFT,
    LEGEND,
    MARGIN,
    MUTED,
    PAPER,
    PART,
    PLUNGE,
    UNREACHABLE,
    WIDTH,
    PathPicture,
    PictureLayout,
    PicturePathStyle,
    Points,
    layout,
    legend_rows,
)

Pixels = NDArray[np.uint8]

_FINE = 2
"""Times finer than the picture's pixels that everything is drawn, then averaged."""

_SHIFT = 4
"""Binary digits of a pixel that positions keep."""

_CHORD = 0.2
"""Pixels by which an arc's chords may leave it."""


def png(picture: PathPicture) -> bytes:
    """Return the picture as PNG bytes, WIDTH pixels wide."""
    place = layout(picture)
    fine = PictureLayout(place.scale * _FINE, place.left * _FINE, place.top * _FINE, place.height * _FINE)
    image = np.full((fine.height, WIDTH * _FINE, 3), _bgr(PAPER), np.uint8)
    _fill(image, [_points(rows, fine) for rows in picture.contours], AREA)
    _fill(image, [fine.pixels(outline) for outline in picture.unreachable], UNREACHABLE)
    _fill(image, [fine.pixels(outline) for outline in picture.left], LEFT)
    for style, rows in picture.paths:
        _draw(image, _points(rows, fine), style)
    for rows in picture.contours:
        _draw(image, _points(rows, fine), PART)
    for x, y in fine.pixels(picture.plunges.reshape(-1, 2)):
        cv2.circle(image, (round(x), round(y)), 4 * _FINE, _bgr(PLUNGE), _FINE, cv2.LINE_AA)
    _legend(image, picture)
    image = np.asarray(cv2.resize(image, (WIDTH, place.height), interpolation=cv2.INTER_AREA), dtype=np.uint8)
    return bytes(cv2.imencode(".png", image)[1].tobytes())


def _bgr(colour: str) -> tuple[int, int, int]:
    return int(colour[5:7], 16), int(colour[3:5], 16), int(colour[1:3], 16)


def _points(rows: Rows, place: PictureLayout) -> Points:
    """Return the pixel positions along connected rows, the last end included."""
    if not len(rows):
        return np.zeros((0, 2))
    return place.pixels(np.concatenate([sample(rows, _CHORD / place.scale), rows[-1:, 2:4]]))


def _fixed(points: Points) -> NDArray[np.int32]:
    return np.asarray(np.round(points * 2**_SHIFT), dtype=np.int32)


def _fill(image: Pixels, rings: Sequence[Points], colour: str) -> None:
    """Fill rings by the even-odd rule."""
    if rings:
        cv2.fillPoly(image, [_fixed(ring) for ring in rings if len(ring) > 2], _bgr(colour), cv2.LINE_AA, _SHIFT)


def _draw(image: Pixels, points: Points, style: PicturePathStyle) -> None:
    """Draw a path in its style."""
    pieces = [points] if not style.dash else list(dashes(points, [length * _FINE for length in style.dash]))
    width = max(1, round(style.width * _FINE))
    cv2.polylines(
        image,
        [_fixed(piece) for piece in pieces if len(piece) > 1],
        False,
        _bgr(style.colour),
        width,
        cv2.LINE_AA,
        _SHIFT,
    )


def _legend(image: Pixels, picture: PathPicture) -> None:
    x, y = (WIDTH - LEGEND) * _FINE, (MARGIN + 14) * _FINE
    _text(image, picture.title, (x, y), INK)
    for number, (label, colour, style) in enumerate(legend_rows(picture), 1):
        at = y + 26 * number * _FINE
        middle = at - 4 * _FINE
        if style is None:
            cv2.circle(image, (x + 17 * _FINE, middle), 5 * _FINE, _bgr(colour), -1, cv2.LINE_AA)
        else:
            _draw(image, np.array([[x, middle], [x + 34 * _FINE, middle]], float), style)
        _text(image, label, (x + 46 * _FINE, at), MUTED)


def _text(image: Pixels, text: str, at: tuple[int, int], colour: str) -> None:
    shown = text.encode("ascii", "replace").decode()
    cv2.putText(image, shown, at, cv2.FONT_HERSHEY_SIMPLEX, 0.47 * _FINE, _bgr(colour), max(1, _FINE // 2), cv2.LINE_AA)
