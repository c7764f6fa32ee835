"""Shows a plane of pixels: wheel zooms at the mouse, dragging pans, F fits; the pixel under the mouse says what it
is.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from PySide6.QtCore import QEvent, QPointF, QRectF, Qt, Signal
from PySide6.QtGui import QColor, QKeyEvent, QMouseEvent, QPainter, QPainterPath, QPen

from ....geometry.primitives import Rows, row_curve, within_half_turn
from ....model.curves import Point
from ....raster.frame import BitmapFrame
from ....raster.trace import PixelChain
from ...framework.theme import LIGHT, Theme
from ..canvas.looking import LookingAnswers, LookingHand
from ..canvas.painting.curve_path import curve_path
from ..canvas.painting.grid import paint_rulers
from ..canvas.painting.overlay import paint_highlight, paint_place
from ..canvas.painting.pens import screen_pen
from ..canvas.viewport import Viewport, ViewportScene
from .painting.code_key import EDGE_PX, CodeRow, code_key_place, code_key_size, paint_code_key
from .painting.pixel_painter import (
    PixelPaint,
    PixelWindow,
    paint_letters,
    paint_pixels,
    paint_raster,
    pixel_at,
    screen_rect,
)

_FAINT, _LARGE_PX = 0.3, 5.0
"""How strong fitted lines are over pixels of one of the screen's, and how large pixels are under lines of full
strength.
"""


@dataclass(frozen=True, eq=False)
class PixelMark:
    """A place that is pointed at, mm; `strong` where it is the chosen one."""

    at: Point
    strong: bool = False


class PixelView(Viewport):
    """One plane of pixels, with lines, chains and marks over it.

    Signals:
        hovered(row, col): the pixel under the mouse; -1, -1 = none. cursor_moved(x, y): the place under it, mm.
        clicked(row, col, x, y): a pixel was clicked, at that place, mm.
    """

    hovered = Signal(int, int)
    cursor_moved = Signal(float, float)
    clicked = Signal(int, int, float, float)

    def __init__(self) -> None:
        super().__init__(ViewportScene(self._scene_steps, self._paint_margins, self._paint_overlay))
        self._theme = LIGHT
        self.pixels: PixelPaint | None = None
        self.key: tuple[CodeRow, ...] = ()
        self.marks: tuple[PixelMark, ...] = ()
        self.pixel: tuple[int, int] | None = None
        self._rows, self._lit, self._starts = QPainterPath(), QPainterPath(), QPainterPath()
        self._hand = LookingHand(self, LookingAnswers(self._look, self._click, self.fit, (Qt.Key.Key_F,)))
        self.setMinimumSize(220, 160)
        self.setAccessibleName("Display memory")

    def set_theme(self, theme: Theme) -> None:
        """Paint with another theme."""
        self._theme = theme
        self.repaint_scene()

    def show_pixels(self, pixels: PixelPaint | None) -> None:
        """Show other pixels; the view stays, unless they lie elsewhere."""
        moved = pixels is not None and (self.pixels is None or self.pixels.frame != pixels.frame)
        self.pixels = pixels
        if moved:
            self.fit_now()
        self.repaint_scene()
        if self._hand.mouse is not None:
            self._look(self._hand.mouse)

    def show_key(self, rows: tuple[CodeRow, ...]) -> None:
        """Explain other codes."""
        if rows == self.key:
            return
        wide, self.key = code_key_size(self.key).width(), rows
        self.covered_right = code_key_size(rows).width() + 2 * EDGE_PX if rows else 0.0
        if self._fitted is not None and wide != code_key_size(rows).width():
            self.fit_now()
        self.update()

    def show_rows(self, rows: Rows) -> None:
        """Draw lines and arcs, mm, over the pixels."""
        self._rows = curve_path(*(row_curve(row) for row in within_half_turn(rows)))
        self.update()

    def light(self, chains: Sequence[PixelChain]) -> None:
        """Light up chains, with their start pixels."""
        self._lit, self._starts = QPainterPath(), QPainterPath()
        if self.pixels is not None:
            frame = self.pixels.frame
            for chain in chains:
                points = frame.to_mm(chain.pixels()[:, ::-1].astype(np.float64) + 0.5).tolist()
                self._lit.moveTo(*points[0])
                for x, y in points[1:]:
                    self._lit.lineTo(x, y)
                self._starts.addRect(
                    points[0][0] - frame.pitch / 2, points[0][1] - frame.pitch / 2, frame.pitch, frame.pitch
                )
        self.update()

    def show_marks(self, marks: tuple[PixelMark, ...]) -> None:
        """Point at places."""
        self.marks = marks
        self.update()

    def fit(self) -> None:
        """Show the whole bitmap."""
        if self.pixels is not None:
            self.glide_to_box(self.pixels.frame.extent)

    def fit_now(self) -> None:
        """Show the whole bitmap at once, and again when the size changes."""
        if self.pixels is not None:
            self.fit_to(self.pixels.frame.extent)

    def go_to(self, at: Point, pixels: float = 40.0) -> None:
        """Glide to a place so that about so many pixels are seen across."""
        if self.pixels is not None:
            half = pixels * self.pixels.frame.pitch / 2
            self.glide_to_box((at[0] - half, at[1] - half, at[0] + half, at[1] + half))

    def _scene_steps(self, painter: QPainter, area: QRectF) -> Iterator[None]:
        """Paint the pixels within a screen rectangle."""
        theme = self._theme
        painter.fillRect(area, theme.paper)
        if self.pixels is None:
            return iter(())
        paint_pixels(painter, self.view, area, self.pixels)
        paint_raster(painter, self.view, area, self.pixels.frame, theme.muted)
        paint_letters(painter, self.view, area, self.pixels)
        painter.setPen(screen_pen(painter, theme.muted, 1.0))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawRect(_whole(self.pixels.frame, self).intersected(area.adjusted(-4, -4, 4, 4)))
        return iter(())

    def _paint_margins(self, painter: QPainter) -> None:
        """Paint the rulers."""
        paint_rulers(painter, self.view, self.size(), self._theme, self.unit)

    def _paint_overlay(self, painter: QPainter) -> None:
        """Paint fitted lines, what is lit up, marks, the key, and the pixel under the mouse."""
        theme = self._theme
        painter.setClipRect(self.area)
        if not self._rows.isEmpty():
            self._paint_path(painter, self._rows, self._row_pen())
        if not self._lit.isEmpty():
            paint_highlight(painter, self.view, self._lit, (theme.accent, theme.accent_text), 2.0)
            self._paint_path(painter, self._starts, QPen(theme.accent_text, 2.0))
        for mark in self.marks:
            colour, width = (theme.error, 2.2) if mark.strong else (theme.warning, 1.5)
            paint_place(painter, self.view.to_screen(mark.at), colour, width)
        if self.pixels is not None and self.pixel is not None:
            self._paint_pixel(painter, self.pixels.frame, self.pixel)
        paint_code_key(painter, code_key_place(self.key, self.area), self.key, self._code(), theme)
        painter.setClipping(False)
        self._hand.paint_marks(painter, theme)

    def _row_pen(self) -> QPen:
        """Return the pen of fitted lines: fine and faint until pixels are large, so that their colours show beside
        it.
        """
        size = self.pixels.frame.pitch * self.view.scale if self.pixels is not None else 0.0
        grown = min(max((size - 1) / (_LARGE_PX - 1), 0.0), 1.0)
        ink = QColor(self._theme.ink)
        ink.setAlphaF(_FAINT + (1 - _FAINT) * grown)
        return QPen(ink, 1.0 + 0.6 * grown)

    def _paint_path(self, painter: QPainter, path: QPainterPath, pen: QPen) -> None:
        pen.setCosmetic(True)
        painter.save()
        painter.setTransform(self.view.transform(), True)
        painter.setPen(pen)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawPath(path)
        painter.restore()

    def _paint_pixel(self, painter: QPainter, frame: BitmapFrame, pixel: tuple[int, int]) -> None:
        """Outline the pixel under the mouse, so that it is seen however small."""
        row, col = pixel
        place = screen_rect(frame, self.view, PixelWindow(row, col, row + 1, col + 1))
        grow = max((5 - place.width()) / 2, 0.5)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.setPen(QPen(self._theme.canvas, 3))
        painter.drawRect(place.adjusted(-grow, -grow, grow, grow))
        painter.setPen(QPen(QColor(self._theme.accent_text), 1.5))
        painter.drawRect(place.adjusted(-grow, -grow, grow, grow))

    def _code(self) -> int | None:
        """Return the code of the pixel under the mouse."""
        return self.pixels.code(*self.pixel) if self.pixels is not None and self.pixel is not None else None

    def mousePressEvent(self, event: QMouseEvent) -> None:  # noqa: N802 (Qt's name)
        """Hold the picture; what is not dragged is a click."""
        self.setFocus(Qt.FocusReason.MouseFocusReason)
        self._hand.press(event)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:  # noqa: N802 (Qt's name)
        """Drag the picture, or look at the pixel under the mouse."""
        self._hand.move(event)
        self.cursor_moved.emit(*self.view.to_world(event.position()))

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:  # noqa: N802 (Qt's name)
        """Let the picture go, or click a pixel."""
        self._hand.release(event)

    def leaveEvent(self, event: QEvent) -> None:  # noqa: N802 (Qt's name)
        """Forget the mouse."""
        self._hand.leave()
        self._tell(None)

    def keyPressEvent(self, event: QKeyEvent) -> None:  # noqa: N802 (Qt's name)
        """F fits, + and - zoom."""
        if not self._hand.key(event):
            super().keyPressEvent(event)

    def _click(self, position: QPointF) -> None:
        """Say which pixel was clicked."""
        at = self.view.to_world(position)
        pixel = pixel_at(self.pixels.frame, at) if self.pixels is not None else None
        if pixel is not None:
            self.clicked.emit(*pixel, *at)

    def _look(self, position: QPointF) -> None:
        inside = self.pixels is not None and self.area.contains(position)
        self._tell(
            pixel_at(self.pixels.frame, self.view.to_world(position)) if inside and self.pixels is not None else None
        )

    def _tell(self, pixel: tuple[int, int] | None) -> None:
        self.pixel = pixel
        self.hovered.emit(*(pixel or (-1, -1)))


def _whole(frame: BitmapFrame, view: PixelView) -> QRectF:
    return screen_rect(frame, view.view, PixelWindow(0, 0, frame.rows, frame.cols))
