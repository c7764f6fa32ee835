"""Paints lines of a scene from where they are looked at; the mouse turns, shifts and zooms."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QColor, QKeyEvent, QMouseEvent, QPainter, QPaintEvent, QPen, QPolygonF, QResizeEvent, QWheelEvent
from PySide6.QtWidgets import QWidget

from app.ui.cut.camera import Camera, Floats, StandardView
from app.ui.surfaces.shown_scene import Picture, Role
from app.ui.theme import LIGHT, Theme

_WIDTH = {Role.SURFACE: 1.0, Role.PATH: 1.6, Role.RAPID: 1.0, Role.TIP: 1.0}
_MARK_PX, _TURN, _ZOOM = 3.0, 0.008, 1.0015
_FAINT = 0.45
_LABELS = 24
"""More names of boundary points than this would cover what they name."""
_EDGE = 16


class SceneCanvas(QWidget):
    """A picture of lines.

    Attributes:
        camera: from where it is looked at. turns: dragging turns it; else it shifts it.
    """

    def __init__(self) -> None:
        super().__init__()
        self.camera, self.turns = Camera(), True
        self._theme = LIGHT
        self._picture: Picture | None = None
        self._colours: tuple[str, ...] = ()
        self._names: tuple[str, ...] = ()
        self._from = QPointF()
        self._moved = False
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)

    def set_theme(self, theme: Theme) -> None:
        """Follow the theme."""
        self._theme = theme
        self.update()

    def show_picture(self, picture: Picture | None, colours: Sequence[str] = (), names: Sequence[str] = ()) -> None:
        """Show lines; colours and names of surfaces by number. What is looked at stays."""
        self._picture, self._colours, self._names = picture, tuple(colours), tuple(names)
        self.update()

    def look(self, view: StandardView) -> None:
        """Look from a standard direction at everything."""
        self.turns = view is StandardView.ISOMETRIC
        self.camera = self.camera.seen_from(view)
        self.fit()

    def fit(self) -> None:
        """Show everything."""
        self._moved = False
        if self._picture is not None and self._picture.lines:
            self.camera = self.camera.fitted(*self._picture.box, self._size)
        self.update()

    def zoom_by(self, factor: float) -> None:
        """Zoom in or out round the middle."""
        self._zoom(factor, self.width() / 2, self.height() / 2)

    @property
    def _size(self) -> tuple[float, float]:
        return float(max(self.width(), 1)), float(max(self.height(), 1))

    def _zoom(self, factor: float, x: float, y: float) -> None:
        self._moved = True
        self.camera = self.camera.zoomed(factor, (x, y), self._size)
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802 (Qt's name)
        """Paint lines, marks and the legend."""
        painter = QPainter(self)
        painter.fillRect(self.rect(), self._theme.canvas)
        if self._picture is None:
            return
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        for line in self._picture.lines:
            painter.setPen(self._pen(line.role, line.surface))
            painter.drawPolyline(_polygon(self.camera.project(line.points, self._size)))
        self._paint_marks(painter, self._picture)
        self._paint_legend(painter)

    def _pen(self, role: Role, surface: int) -> QPen:
        colour = QColor(self._colours[surface]) if surface >= 0 else QColor(self._theme.rapid)
        if role is Role.SURFACE:
            colour.setAlphaF(_FAINT)
        pen = QPen(colour, _WIDTH[role])
        if role in (Role.RAPID, Role.TIP):
            pen.setStyle(Qt.PenStyle.DotLine)
        return pen

    def _paint_marks(self, painter: QPainter, picture: Picture) -> None:
        if not len(picture.marks):
            return
        painter.setPen(QPen(self._theme.ink, 1.0))
        painter.setBrush(self._theme.canvas)
        seen = self.camera.project(picture.marks, self._size)[:, :2].tolist()
        for x, y in seen:
            painter.drawEllipse(QPointF(x, y), _MARK_PX, _MARK_PX)
        if len(seen) <= _LABELS:
            for (x, y), label in zip(seen, picture.labels, strict=False):
                painter.drawText(QPointF(x + 6, y - 6), label)

    def _paint_legend(self, painter: QPainter) -> None:
        step = painter.fontMetrics().height() + 4
        for row, (colour, name) in enumerate(zip(self._colours, self._names, strict=False)):
            y = _EDGE + row * step
            painter.setPen(QPen(QColor(colour), 3.0))
            painter.drawLine(QPointF(_EDGE, y + step / 2), QPointF(_EDGE + 16, y + step / 2))
            painter.setPen(self._theme.ink)
            painter.drawText(QPointF(_EDGE + 24, y + step / 2 + painter.fontMetrics().ascent() / 2 - 1), name)

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 (Qt's name)
        """Fit again what was never moved."""
        if not self._moved:
            self.fit()

    def mousePressEvent(self, event: QMouseEvent) -> None:  # noqa: N802 (Qt's name)
        """Begin to drag."""
        self._from = event.position()

    def mouseMoveEvent(self, event: QMouseEvent) -> None:  # noqa: N802 (Qt's name)
        """Turn or shift."""
        by, self._from = event.position() - self._from, event.position()
        self._moved = True
        if self.turns and event.buttons() == Qt.MouseButton.LeftButton:
            self.camera = self.camera.orbited(-by.x() * _TURN, by.y() * _TURN, np.array(self.camera.target))
        else:
            self.camera = self.camera.panned(by.x(), by.y())
        self.update()

    def wheelEvent(self, event: QWheelEvent) -> None:  # noqa: N802 (Qt's name)
        """Zoom at the mouse."""
        self._zoom(_ZOOM ** event.angleDelta().y(), event.position().x(), event.position().y())

    def keyPressEvent(self, event: QKeyEvent) -> None:  # noqa: N802 (Qt's name)
        """F fits."""
        if event.key() == Qt.Key.Key_F and not event.modifiers():
            self.fit()
        else:
            super().keyPressEvent(event)


def _polygon(seen: Floats) -> QPolygonF:
    """Return a line on the screen without the points that fall on the pixel of the one before."""
    pixels = np.round(2 * seen[:, :2])
    kept = np.append(True, (np.diff(pixels, axis=0) != 0).any(axis=1))
    kept[-1] = True
    return QPolygonF([QPointF(x, y) for x, y in seen[kept, :2].tolist()])
