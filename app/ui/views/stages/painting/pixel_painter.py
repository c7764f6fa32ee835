"""Paints a plane of codes: nearest-neighbour pixels from one image, their raster when they are large, their letters
when very large.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QLineF, QRectF, Qt
from PySide6.QtGui import QColor, QImage, QPainter

from .....raster.frame import BitmapFrame, Plane
from ....framework.theme import text_font
from ...canvas.painting.pens import screen_pen
from ...canvas.view_transform import ViewTransform
from .code_key import ink_on

RASTER_PX, LETTER_PX = 7.0, 20.0
"""From these sizes on a pixel has a border, and its letter in it."""


@dataclass(frozen=True, eq=False)
class PixelPaint:
    """What is painted.

    Attributes:
        frame: where the pixels lie on the part. plane: (rows, cols) codes.
        colours: of each code, as QRgb. letters: of codes that have one.
        ranks: of each code; where several pixels fall on one of the screen, the highest shows. None = the plane is a
            photograph, whose greys are mixed.
    """

    frame: BitmapFrame
    plane: Plane
    colours: list[int]
    letters: Mapping[int, str] = field(default_factory=dict)
    ranks: NDArray[np.uint8] | None = None

    def code(self, row: int, col: int) -> int:
        """Return the code of a pixel."""
        return int(self.plane[row, col])


@dataclass(frozen=True, slots=True)
class PixelWindow:
    """The rows and columns that a screen rectangle shows, last excluded."""

    row0: int
    col0: int
    row1: int
    col1: int

    @property
    def empty(self) -> bool:
        """Whether it shows no pixel."""
        return self.row0 >= self.row1 or self.col0 >= self.col1


def window_of(frame: BitmapFrame, view: ViewTransform, area: QRectF) -> PixelWindow:
    """Return the pixels that lie in a screen rectangle, those at its edges included."""
    x0, y0, x1, y1 = view.world_box(area)
    (col0, row1), (col1, row0) = frame.to_px(np.array([(x0, y0), (x1, y1)])).tolist()
    return PixelWindow(
        max(math.floor(row0), 0),
        max(math.floor(col0), 0),
        min(math.ceil(row1), frame.rows),
        min(math.ceil(col1), frame.cols),
    )


def screen_rect(frame: BitmapFrame, view: ViewTransform, window: PixelWindow) -> QRectF:
    """Return where a window's pixels lie on the screen."""
    corners = frame.to_mm(np.array([(window.col0, window.row0), (window.col1, window.row1)], dtype=np.float64)).tolist()
    (x0, y0), (x1, y1) = corners
    return QRectF(view.to_screen((x0, y0)), view.to_screen((x1, y1)))


def pixel_at(frame: BitmapFrame, at: tuple[float, float]) -> tuple[int, int] | None:
    """Return row and column of the pixel under a point in mm, or None beside the bitmap."""
    col, row = (math.floor(value) for value in frame.to_px(np.array([at]))[0].tolist())
    return (row, col) if 0 <= row < frame.rows and 0 <= col < frame.cols else None


def paint_pixels(painter: QPainter, view: ViewTransform, area: QRectF, pixels: PixelPaint) -> None:
    """Paint the pixels within a screen rectangle, each a square of its colour."""
    window = window_of(pixels.frame, view, area)
    if window.empty:
        return
    size = pixels.frame.pitch * view.scale
    # as large as a screen pixel at the least: of smaller ones rows would be passed over, and lines with them
    group = 1 if pixels.ranks is None else max(math.ceil(1 / size - 1e-9), 1)
    window = _whole_groups(window, group)
    part = np.ascontiguousarray(pixels.plane[window.row0 : window.row1, window.col0 : window.col1])
    if group > 1 and pixels.ranks is not None:
        part = _highest(part, pixels.ranks, group)
    rows, cols = part.shape
    image = QImage(part.data, cols, rows, cols, QImage.Format.Format_Indexed8)
    image.setColorTable(pixels.colours)
    painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform, pixels.ranks is None and size < 1)
    shown = PixelWindow(window.row0, window.col0, window.row0 + rows * group, window.col0 + cols * group)
    painter.drawImage(screen_rect(pixels.frame, view, shown), image)


def _whole_groups(window: PixelWindow, group: int) -> PixelWindow:
    """Return the window, begun at a whole group, so that groups do not change while the view moves."""
    return PixelWindow(window.row0 - window.row0 % group, window.col0 - window.col0 % group, window.row1, window.col1)


def _highest(plane: Plane, ranks: NDArray[np.uint8], group: int) -> Plane:
    """Return a plane of squares of `group` pixels, each with its highest code."""
    rows, cols = (-(-size // group) for size in plane.shape)
    ranked = ranks[plane]
    best = np.zeros((rows, cols), np.uint8)
    for r in range(group):
        for c in range(group):
            part = ranked[r::group, c::group]
            own = best[: part.shape[0], : part.shape[1]]
            np.maximum(own, part, out=own)
    code = np.zeros(len(ranks), np.uint8)
    code[ranks] = np.arange(len(ranks))
    return np.ascontiguousarray(code[best])


def paint_raster(painter: QPainter, view: ViewTransform, area: QRectF, frame: BitmapFrame, colour: QColor) -> None:
    """Paint the borders of the pixels, stronger the larger they are; nothing while they are small."""
    size = frame.pitch * view.scale
    window = window_of(frame, view, area)
    if size < RASTER_PX or window.empty:
        return
    hue = QColor(colour)
    hue.setAlphaF(min(0.4, 0.12 + 0.02 * (size - RASTER_PX)))
    inside = screen_rect(frame, view, window)
    painter.setPen(screen_pen(painter, hue, 1.0))
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, False)
    columns = [inside.left() + k * size for k in range(window.col1 - window.col0 + 1)]
    rows = [inside.top() + k * size for k in range(window.row1 - window.row0 + 1)]
    painter.drawLines(
        [QLineF(x, inside.top(), x, inside.bottom()) for x in columns]
        + [QLineF(inside.left(), y, inside.right(), y) for y in rows]
    )
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, True)


def paint_letters(painter: QPainter, view: ViewTransform, area: QRectF, pixels: PixelPaint) -> None:
    """Paint each pixel's letter in it; nothing while pixels are small."""
    size = pixels.frame.pitch * view.scale
    window = window_of(pixels.frame, view, area)
    if size < LETTER_PX or window.empty:
        return
    painter.setFont(text_font(min(round(0.62 * size), 26)))
    first = screen_rect(pixels.frame, view, window).topLeft()
    part = pixels.plane[window.row0 : window.row1, window.col0 : window.col1]
    for code, letter in pixels.letters.items():
        painter.setPen(ink_on(QColor(pixels.colours[code]), 0.28 if code == 0 else 0.9))
        for row, col in np.argwhere(part == code).tolist():
            painter.drawText(
                QRectF(first.x() + col * size, first.y() + row * size, size, size), Qt.AlignmentFlag.AlignCenter, letter
            )
