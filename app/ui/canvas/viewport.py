"""A widget on the drawing plane: zoom, pan, glide, and a picture of the scene that is painted only when it changes."""

from __future__ import annotations

import time
from collections.abc import Callable

from PySide6.QtCore import QEasingCurve, QPointF, QRectF, Qt, QTimer, QVariantAnimation, Signal
from PySide6.QtGui import QMouseEvent, QPainter, QPaintEvent, QPixmap, QResizeEvent, QWheelEvent
from PySide6.QtWidgets import QWidget

from app.edit.sample import Box
from app.ui.canvas.grid import RULER
from app.ui.canvas.view import View, fitted

GLIDE_MS = 150
_SETTLE_MS = 90
"""After this rest a shifted scene is painted anew, so that dashes meet where the strips met."""

_NOTCH = 1.2
_SPARE = 0.45


class Viewport(QWidget):
    """Shows a scene; what follows the mouse is painted over it and never repaints it.

    Attributes:
        scene_ms: how long the last painting of the scene took, ms.
        covered_right: width at the right that something is laid over, px; what is fitted is fitted beside it.
    """

    view_changed = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        """Begin with 5 px per mm."""
        super().__init__(parent)
        self.view = View()
        self.scene_ms = 0.0
        self._scene: QPixmap | None = None
        self._scene_view = self.view
        self._pan_from: QPointF | None = None
        self._fitted: Box | None = None
        self.covered_right = 0.0
        self._settle = QTimer(self, singleShot=True, interval=_SETTLE_MS)
        self._settle.timeout.connect(self.repaint_scene)
        self._glide = QVariantAnimation(self)
        self._glide.setDuration(GLIDE_MS)
        self._glide.setEasingCurve(QEasingCurve.Type.OutCubic)
        self._glide.setStartValue(0.0)
        self._glide.setEndValue(1.0)
        self._glide.valueChanged.connect(self._glide_on)
        self._way = (self.view, self.view)

    @property
    def area(self) -> QRectF:
        """The part of the widget that shows the drawing, beside the rulers."""
        return QRectF(RULER, RULER, max(self.width() - RULER, 1), max(self.height() - RULER, 1))

    def paint_scene(self, painter: QPainter, area: QRectF) -> None:
        """Paint what lies in a screen rectangle and stays while only the mouse moves."""
        raise NotImplementedError

    def paint_margins(self, painter: QPainter) -> None:
        """Paint what stands round the drawing."""
        raise NotImplementedError

    def paint_overlay(self, painter: QPainter) -> None:
        """Paint what follows the mouse."""
        raise NotImplementedError

    def set_view(self, view: View) -> None:
        """Look at the drawing this way; a shift by whole px keeps what was painted."""
        self._fitted = None
        self._show(view)

    def fit_to(self, box: Box) -> None:
        """Show a box in mm at once, and again when the size of the widget changes, until the view is moved."""
        self.set_view(fitted(box, self.free_area(box)))
        self._fitted = box

    def free_area(self, box: Box) -> QRectF:
        """Return the part of the area that a box in mm is fitted into: nothing laid over it covers it, unless there is no room."""
        covered = self.covered_right if self.covered_right < _SPARE * self.area.width() else 0.0
        return self.area.adjusted(0.0, 0.0, -covered, 0.0)

    def _show(self, view: View) -> None:
        self.view = view
        if self._scroll() is None:
            self._scene = None
        else:
            self._settle.start()
        self.update()
        self.view_changed.emit()

    def repaint_scene(self) -> None:
        """Paint the scene anew when the widget is next shown."""
        self._scene = None
        self.update()

    def zoom_by(self, factor: float, at: QPointF | None = None) -> None:
        """Zoom; the point under `at` (by default the middle) stays where it is."""
        self._glide.stop()
        self.set_view(self.view.zoomed(factor, at or self.area.center()))

    def glide_to(self, view: View) -> None:
        """Go to another view in 150 ms; at once while the widget is hidden."""
        self._glide.stop()
        self._fitted = None
        if not self.isVisible():
            self._show(view)
            return
        self._way = (self.view, view)
        self._glide.start()

    def glide_to_box(self, box: Box) -> None:
        """Go to the view that shows a box in mm, as `fit_to` does."""
        self.glide_to(fitted(box, self.free_area(box)))
        self._fitted = box

    def paint_more(self, paint: Callable[[QPainter], None]) -> None:
        """Paint more into the kept scene; nothing where it is to be painted anew anyway."""
        if self._scene is None or self._scene_view != self.view:
            return
        painter = QPainter(self._scene)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setClipRect(self.area)
        paint(painter)
        painter.end()
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802 (Qt's name)
        """Show the kept scene and paint over it."""
        if self._scene is None or self._scene_view != self.view:
            self._scene = self._painted(self._scene, self._scroll())
            self._scene_view = self.view
        painter = QPainter(self)
        painter.drawPixmap(0, 0, self._scene)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        self.paint_overlay(painter)
        painter.end()

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 (Qt's name)
        """Keep what was fitted fitted, or else the middle of the view in the middle."""
        old = event.oldSize()
        if self._fitted is not None:
            self._glide.stop()
            self.view = fitted(self._fitted, self.free_area(self._fitted))
        elif old.isValid():
            self.view = self.view.panned((self.width() - old.width()) / 2, (self.height() - old.height()) / 2)
        self.repaint_scene()
        self.view_changed.emit()

    def wheelEvent(self, event: QWheelEvent) -> None:  # noqa: N802 (Qt's name)
        """Zoom at the mouse."""
        turn = event.angleDelta().y()
        if turn:
            self.zoom_by(_NOTCH ** (turn / 120), event.position())
        event.accept()

    def begin_pan(self, at: QPointF) -> None:
        """Hold the drawing at a screen position."""
        self._glide.stop()
        self._pan_from = at
        self.setCursor(Qt.CursorShape.ClosedHandCursor)

    def pan_to(self, event: QMouseEvent) -> bool:
        """Drag the held drawing along; return whether it is held."""
        if self._pan_from is None:
            return False
        step = event.position() - self._pan_from
        self._pan_from = event.position()
        self.set_view(self.view.panned(step.x(), step.y()))
        return True

    def end_pan(self) -> bool:
        """Let the drawing go; return whether it was held."""
        held = self._pan_from is not None
        self._pan_from = None
        return held

    def _scroll(self) -> QPointF | None:
        """Return by how many whole px the kept scene is to be shifted for the view, or None when that is not enough."""
        shift = QPointF(self.view.ox - self._scene_view.ox, self.view.oy - self._scene_view.oy)
        whole = QPointF(round(shift.x()), round(shift.y()))
        same = self.view.scale == self._scene_view.scale and (shift - whole).manhattanLength() < 1e-6
        return whole if self._scene is not None and same and self.devicePixelRatioF().is_integer() else None

    def _painted(self, old: QPixmap | None, scroll: QPointF | None) -> QPixmap:
        ratio = self.devicePixelRatioF()
        pixmap = QPixmap(round(self.width() * ratio), round(self.height() * ratio))
        pixmap.setDevicePixelRatio(ratio)
        begun = time.perf_counter()
        painter = QPainter(pixmap)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        if old is not None and scroll is not None:
            painter.drawPixmap(scroll, old)
        for part in [self.area] if scroll is None else _uncovered(self.area, scroll):
            painter.setClipRect(part)
            self.paint_scene(painter, part)
        painter.setClipping(False)
        self.paint_margins(painter)
        painter.end()
        self.scene_ms = (time.perf_counter() - begun) * 1000
        return pixmap

    def _glide_on(self, share: float) -> None:
        self._show(self._way[0].towards(self._way[1], float(share), self.area))


def _uncovered(area: QRectF, scroll: QPointF) -> list[QRectF]:
    """Return the strips of an area that its own picture, shifted, does not cover."""
    strips = []
    kept = area.translated(scroll).intersected(area)
    if kept.isEmpty():
        return [area]
    if scroll.x():
        left = area.left() if scroll.x() > 0 else kept.right()
        strips.append(QRectF(left, area.top(), area.width() - kept.width(), area.height()))
    if scroll.y():
        top = area.top() if scroll.y() > 0 else kept.bottom()
        strips.append(QRectF(area.left(), top, area.width(), area.height() - kept.height()))
    return strips
