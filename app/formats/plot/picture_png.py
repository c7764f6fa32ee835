"""The picture as PNG, drawn with anti-aliased lines."""

from __future__ import annotations

from collections.abc import Sequence

import cv2
import numpy as np

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
from .pixels import FINE, SHIFT, Pixels, averaged, bgr, fixed, sheet_of

_CHORD = 0.2
"""Pixels by which an arc's chords may leave it."""


def png(picture: PathPicture) -> bytes:
    """Return the picture as PNG bytes, WIDTH pixels wide."""
    place = layout(picture)
    fine = PictureLayout(place.scale * FINE, place.left * FINE, place.top * FINE, place.height * FINE)
    image = sheet_of(WIDTH, place.height, PAPER)
    _fill(image, [_points(rows, fine) for rows in picture.contours], AREA)
    _fill(image, [fine.pixels(outline) for outline in picture.unreachable], UNREACHABLE)
    _fill(image, [fine.pixels(outline) for outline in picture.left], LEFT)
    for style, rows in picture.paths:
        _draw(image, _points(rows, fine), style)
    for rows in picture.contours:
        _draw(image, _points(rows, fine), PART)
    for x, y in fine.pixels(picture.plunges.reshape(-1, 2)):
        cv2.circle(image, (round(x), round(y)), 4 * FINE, bgr(PLUNGE), FINE, cv2.LINE_AA)
    _legend(image, picture)
    return bytes(cv2.imencode(".png", averaged(image))[1].tobytes())


def _points(rows: Rows, place: PictureLayout) -> Points:
    """Return the pixel positions along connected rows, the last end included."""
    if not len(rows):
        return np.zeros((0, 2))
    return place.pixels(np.concatenate([sample(rows, _CHORD / place.scale), rows[-1:, 2:4]]))


def _fill(image: Pixels, rings: Sequence[Points], colour: str) -> None:
    """Fill rings by the even-odd rule."""
    if rings:
        cv2.fillPoly(image, [fixed(ring) for ring in rings if len(ring) > 2], bgr(colour), cv2.LINE_AA, SHIFT)


def _draw(image: Pixels, points: Points, style: PicturePathStyle) -> None:
    """Draw a path in its style."""
    pieces = [points] if not style.dash else list(dashes(points, [length * FINE for length in style.dash]))
    width = max(1, round(style.width * FINE))
    cv2.polylines(
        image,
        [fixed(piece) for piece in pieces if len(piece) > 1],
        False,
        bgr(style.colour),
        width,
        cv2.LINE_AA,
        SHIFT,
    )


def _legend(image: Pixels, picture: PathPicture) -> None:
    x, y = (WIDTH - LEGEND) * FINE, (MARGIN + 14) * FINE
    _text(image, picture.title, (x, y), INK)
    for number, (label, colour, style) in enumerate(legend_rows(picture), 1):
        at = y + 26 * number * FINE
        middle = at - 4 * FINE
        if style is None:
            cv2.circle(image, (x + 17 * FINE, middle), 5 * FINE, bgr(colour), -1, cv2.LINE_AA)
        else:
            _draw(image, np.array([[x, middle], [x + 34 * FINE, middle]], float), style)
        _text(image, label, (x + 46 * FINE, at), MUTED)


def _text(image: Pixels, text: str, at: tuple[int, int], colour: str) -> None:
    shown = text.encode("ascii", "replace").decode()
    cv2.putText(image, shown, at, cv2.FONT_HERSHEY_SIMPLEX, 0.47 * FINE, bgr(colour), max(1, FINE // 2), cv2.LINE_AA)
