"""A sheet as PNG, drawn without Qt with anti-aliased lines."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterable

import cv2

from .flat import FlatPolyline, dashes, flat_drawing, flat_frame
from .page import PlotPage
from .pixels import FINE, SHIFT, Pixels, averaged, bgr, fixed, sheet_of

_DPI = 200
"""Pixels to the inch of paper."""
_MOST_PIXELS = 16e6
"""Of a page; a larger one is drawn coarser."""


def page_png(page: PlotPage) -> bytes:
    """Return one sheet, 200 dots an inch or as many as 16 million pixels allow; the file tells.

    Raises:
        GeometryError: a spline cannot be followed.
    """
    per_mm = min(_DPI / 25.4, (_MOST_PIXELS / (page.width * page.height)) ** 0.5)
    width, height = round(page.width * per_mm), round(page.height * per_mm)
    image = sheet_of(width, height, "#ffffff")
    inside = image.copy()
    _draw(inside, flat_drawing(page), per_mm * FINE)
    x0, x1 = (round(x * per_mm * FINE) for x in (page.window[0], page.window[2]))
    y0, y1 = (round((page.height - y) * per_mm * FINE) for y in (page.window[3], page.window[1]))
    image[y0:y1, x0:x1] = inside[y0:y1, x0:x1]
    _draw(image, flat_frame(page), per_mm * FINE)
    return _with_size(cv2.imencode(".png", averaged(image), (cv2.IMWRITE_PNG_COMPRESSION, 9))[1].tobytes(), per_mm)


def _draw(image: Pixels, flats: Iterable[FlatPolyline], per_mm: float) -> None:
    for flat in flats:
        colour = bgr(flat.pen.colour)
        pieces = list(dashes(flat.points, flat.pen.dash)) if flat.pen.dash else [flat.points]
        placed = [fixed(points * (per_mm, -per_mm) + (0.0, len(image))) for points in pieces]
        if flat.filled:
            cv2.fillPoly(image, placed, colour, cv2.LINE_AA, SHIFT)
        else:
            width = max(1, round(flat.pen.width * per_mm - 0.5))
            cv2.polylines(image, placed, False, colour, width, cv2.LINE_AA, SHIFT)


def _with_size(png: bytes, per_mm: float) -> bytes:
    """Return a PNG that tells how many dots a metre it has: a chunk behind the header's, which ends at byte 33."""
    dots = round(per_mm * 1000)
    chunk = b"pHYs" + struct.pack(">IIB", dots, dots, 1)
    return png[:33] + struct.pack(">I", 9) + chunk + struct.pack(">I", zlib.crc32(chunk)) + png[33:]
