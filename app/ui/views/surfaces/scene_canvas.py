"""Shows a scene from where it is looked at; the mouse turns, shifts and zooms, and points at what is there."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QEvent, QPointF, QRectF, Qt, QTimer, Signal
from PySide6.QtGui import (
    QColor,
    QImage,
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QPen,
    QPolygonF,
    QResizeEvent,
    QWheelEvent,
)
from PySide6.QtWidgets import QWidget

from ....model.scene import LineType
from ...framework.theme import LIGHT, Theme
from ..cut.camera import Camera, Floats, StandardView
from .scene_raster import (
    SURFACE_STRENGTH,
    Rgb,
    SceneColourBy,
    SceneColours,
    SceneLayer,
    SceneRaster,
    SceneStyle,
    raster,
)
from .shown_scene import ScenePicture

_MARK_PX, _REACH_PX, _TURN, _ZOOM, _STEP = 3.0, 9.0, 0.008, 1.0015, 40.0
_CLICK_PX = 3.0
_MANY, _SAME_PX, _BEHIND = 300, 150, 0.3
"""More boundary points than this are dots; the same name stands this far apart, px; what is left of points behind a
surface.
"""
_EDGE = 16
_LONG_S, _REST_MS = 0.03, 150
"""A picture that takes longer is painted coarsely while it moves, and fine when it has rested for so long."""
_KEYS = {Qt.Key.Key_Left: (-1, 0), Qt.Key.Key_Right: (1, 0), Qt.Key.Key_Up: (0, -1), Qt.Key.Key_Down: (0, 1)}


@dataclass(frozen=True)
class PickedPart:
    """What the mouse is over.

    Attributes:
        mark: number of a boundary point of the picture, -1 = none. surface: its number, -1 = none.
        place: mm, of the point, or of the surface there; in a section along the plane, 0, and up.
    """

    mark: int
    surface: int
    place: tuple[float, float, float]


class SceneCanvas(QWidget):
    """A picture of surfaces and lines.

    Signals:
        pointed(PickedPart | None): what the mouse is over. picked(PickedPart): it was clicked.

    Attributes:
        camera: from where it is looked at. turns: dragging turns it; else it shifts it. layers, colour_by: see
            `scene_raster`.
        marked: number of the boundary point that stands out, -1 = none. drawn: the picture as it was painted last.
    """

    pointed = Signal(object)
    picked = Signal(object)

    def __init__(self) -> None:
        super().__init__()
        self.camera, self.turns = Camera(), True
        self.layers, self.colour_by = SceneLayer.ALL, SceneColourBy.SURFACE
        self.marked = -1
        self.drawn: SceneRaster | None = None
        self._theme = LIGHT
        self._picture: ScenePicture | None = None
        self._colours: tuple[str, ...] = ()
        self._names: tuple[str, ...] = ()
        self._lines: tuple[LineType, ...] = ()
        self._tools: dict[int, str] = {}
        self._from, self._at, self._pressed = QPointF(), QPointF(-1, -1), QPointF()
        self._moved = False
        self._over: PickedPart | None = None
        self._moving, self._took_s, self._ratio = False, 0.0, 1.0
        self._resting = QTimer(self)
        self._resting.setSingleShot(True)
        self._resting.setInterval(_REST_MS)
        self._resting.timeout.connect(self._on_rest)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setMouseTracking(True)

    def set_theme(self, theme: Theme) -> None:
        """Follow the theme."""
        self._theme = theme
        self._refresh()

    def show_picture(
        self,
        picture: ScenePicture | None,
        colours: Sequence[str] = (),
        names: Sequence[str] = (),
        lines: Sequence[LineType] = (),
        tools: dict[int, str] | None = None,
    ) -> None:
        """Show another picture; colours, names and line types of surfaces by number, names of tools. What is looked at
        stays; as long as that was everything, it still is.
        """
        self._picture, self._colours, self._names, self._lines = picture, tuple(colours), tuple(names), tuple(lines)
        self._tools = tools or {}
        self.marked = -1
        if self._moved:
            self._refresh()
        else:
            self.fit()

    def set_layers(self, layers: SceneLayer) -> None:
        """Show other layers."""
        self.layers = layers
        self._refresh()

    def set_colour_by(self, by: SceneColourBy) -> None:
        """Tell paths apart by something else."""
        self.colour_by = by
        self._refresh()

    def mark_point(self, number: int) -> None:
        """Have a boundary point stand out, and bring it into sight; -1 = none."""
        self.marked = number
        if self._picture is not None and 0 <= number < len(self._picture.marks):
            x, y = self._seen(self._picture.marks[number : number + 1])[0, :2]
            if not (_EDGE < x < self.width() - _EDGE and _EDGE < y < self.height() - _EDGE):
                self._move(self.camera.panned(self.width() / 2 - x, self.height() / 2 - y))
        self.update()

    def look(self, view: StandardView) -> None:
        """Look from a standard direction at everything."""
        self.turns = view is StandardView.ISOMETRIC
        self.camera = self.camera.seen_from(view)
        self.fit()

    def fit(self) -> None:
        """Show everything."""
        self._moved = False
        if self._picture is not None and self._picture.shows:
            self.camera = self.camera.fitted(*self._picture.box, self._size)
        self._refresh()

    def zoom_by(self, factor: float) -> None:
        """Zoom in or out round the middle."""
        self._zoom(factor, self.width() / 2, self.height() / 2)

    @property
    def _size(self) -> tuple[float, float]:
        return float(max(self.width(), 1)), float(max(self.height(), 1))

    def _refresh(self) -> None:
        self.drawn = None
        self.update()

    def _zoom(self, factor: float, x: float, y: float) -> None:
        self._move(self.camera.zoomed(factor, (x, y), self._size))

    def _seen(self, points: Floats) -> Floats:
        return self.camera.project(points, self._size)

    @property
    def _inks(self) -> SceneColours:
        theme = self._theme
        tools = {number: _rgb(theme.regions[at % len(theme.regions)]) for at, number in enumerate(self._tools)}
        return SceneColours(
            _rgb(theme.canvas),
            _rgb(theme.ink),
            _rgb(theme.rapid),
            _rgb(theme.plunge),
            [_rgb(QColor(colour)) for colour in self._colours],
            tools,
            self._lines,
        )

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802 (Qt's name)
        """Paint surfaces and lines, unless they are as they were, and over them points, names, the legend, and the
        tool.
        """
        painter = QPainter(self)
        if self._picture is None:
            painter.fillRect(self.rect(), self._theme.canvas)
            return
        if self.drawn is None:
            self.drawn = self._drawn_now(self._picture)
        pixels = self.drawn.pixels
        size = (pixels.shape[1], pixels.shape[0])
        painter.drawImage(
            QRectF(self.rect()), QImage(pixels.data, size[0], size[1], 4 * size[0], QImage.Format.Format_RGB32)
        )
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        self._paint_marks(painter, self._picture)
        self._paint_tool(painter, self._picture)
        self._paint_legend(painter)

    def _drawn_now(self, picture: ScenePicture) -> SceneRaster:
        """Paint the picture anew: while it moves, and that takes long, with half as many px each way, and fine once it
        rests.
        """
        coarse = self._moving and self._took_s > _LONG_S
        self._ratio = self.devicePixelRatioF() * (0.5 if coarse else 1.0)
        size = (max(round(self.width() * self._ratio), 1), max(round(self.height() * self._ratio), 1))
        began = time.perf_counter()
        made = raster(
            picture, SceneStyle(self.camera, self._inks, self.layers, self.colour_by, self._ratio, coarse), size
        )
        if coarse:
            self._resting.start()
        else:
            self._took_s = time.perf_counter() - began
        return made

    def _on_rest(self) -> None:
        self._moving = False
        self._refresh()

    def _move(self, camera: Camera) -> None:
        """Look from elsewhere."""
        self._moved = self._moving = True
        self.camera = camera
        self._refresh()

    def _paint_marks(self, painter: QPainter, picture: ScenePicture) -> None:
        if not len(picture.marks) or SceneLayer.POINTS not in self.layers:
            return
        seen = self._seen(picture.marks)
        ahead = self._ahead(seen)
        many = len(seen) > _MANY
        for (x, y), clear in zip(seen[:, :2].tolist(), ahead.tolist(), strict=True):
            ink = QColor(self._theme.ink)
            ink.setAlphaF(1.0 if clear else _BEHIND)
            painter.setPen(Qt.PenStyle.NoPen if many else QPen(ink, 1.0))
            painter.setBrush(ink if many else self._theme.canvas if clear else Qt.BrushStyle.NoBrush)
            painter.drawEllipse(QPointF(x, y), *((_MARK_PX / 2.4,) * 2 if many else (_MARK_PX,) * 2))
        over = self._over.mark if self._over is not None else -1
        for number, colour in ((over, self._theme.ink), (self.marked, self._theme.accent)):
            if 0 <= number < len(seen):
                painter.setPen(QPen(colour, 2.0))
                painter.setBrush(Qt.BrushStyle.NoBrush)
                painter.drawEllipse(QPointF(*seen[number, :2].tolist()), 2 * _MARK_PX, 2 * _MARK_PX)
        labels = [label if clear else "" for label, clear in zip(picture.labels, ahead.tolist(), strict=True)]
        self._paint_names(painter, seen, labels, [each for each in (over, self.marked) if each >= 0])

    def _ahead(self, seen: Floats) -> NDArray[np.bool_]:
        """Return which places, as they are seen, no surface hides."""
        drawn, ratio = self.drawn, self._ratio
        if drawn is None:
            return np.ones(len(seen), np.bool_)
        high, wide = drawn.depths.shape
        column, row = (np.floor(seen[:, axis] * ratio).astype(np.int64) for axis in (0, 1))
        inside = (column >= 0) & (column < wide) & (row >= 0) & (row < high)
        depth = drawn.depths[np.where(inside, row, 0), np.where(inside, column, 0)]
        return np.asarray(~inside | (seen[:, 2] >= depth - 8.0 / self.camera.scale))

    def _paint_names(self, painter: QPainter, seen: Floats, labels: Sequence[str], first: Sequence[int]) -> None:
        """Write names where they cover no other one, and far from the same name; those of `first` in any case."""
        taken: list[QRectF] = []
        said: dict[str, list[QPointF]] = {}
        metrics, every = painter.fontMetrics(), range(len(labels)) if SceneLayer.NAMES in self.layers else ()
        for number in (*(each for each in first if each < len(labels)), *every):
            if not labels[number]:
                continue
            x, y = seen[number, :2].tolist()
            box = QRectF(x + 7, y - 7 - metrics.ascent(), metrics.horizontalAdvance(labels[number]), metrics.height())
            near = any((QPointF(x, y) - other).manhattanLength() < _SAME_PX for other in said.get(labels[number], ()))
            if number not in first and (near or any(box.intersects(other) for other in taken)):
                continue
            said.setdefault(labels[number], []).append(QPointF(x, y))
            taken.append(box.adjusted(-8, -3, 8, 3))
            ground = QColor(self._theme.canvas)
            ground.setAlphaF(0.7)
            painter.fillRect(box.adjusted(-2, 0, 2, 0), ground)
            painter.setPen(self._theme.ink)
            painter.drawText(QPointF(x + 7, y - 7), labels[number])

    def _paint_tool(self, painter: QPainter, picture: ScenePicture) -> None:
        """Draw the tool where its path is above or below the mouse, in a section."""
        if not len(picture.lows) or not len(picture.tool) or self._over is None:
            return
        along = self._over.place[0]
        if not picture.lows[0, 0] <= along <= picture.lows[-1, 0]:
            return
        low = float(np.interp(along, picture.lows[:, 0], picture.lows[:, 1]))
        half = picture.tool + np.array([0.0, low])
        whole = np.concatenate([half[::-1] * [-1, 1], half[1:]])
        seen = self._seen(np.column_stack([whole[:, 0] + along, np.zeros(len(whole)), whole[:, 1]]))
        painter.setPen(QPen(self._theme.muted, 1.2))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawPolyline(QPolygonF([QPointF(x, y) for x, y in seen[:, :2].tolist()]))

    def _paint_legend(self, painter: QPainter) -> None:
        step = painter.fontMetrics().height() + 4
        if self.colour_by is SceneColourBy.TOOL:
            tools = self._theme.regions
            entries = [(tools[at % len(tools)], name, LineType.SOLID) for at, name in enumerate(self._tools.values())]
        else:
            by_line = self.colour_by is SceneColourBy.LINE
            entries = [
                (self._theme.ink if by_line else QColor(colour), name, line if by_line else LineType.SOLID)
                for colour, name, line in zip(self._colours, self._names, self._lines, strict=False)
            ]
        for row, (colour, name, line) in enumerate(entries):
            y = _EDGE + row * step
            if self._picture is not None and self._picture.compound and self.colour_by is SceneColourBy.SURFACE:
                self._paint_swatch(painter, colour, QRectF(_EDGE, y + step / 2 - 6, 24, 12))
            pen = QPen(colour, 2.0 if line is LineType.SOLID else 1.6)
            if line is not LineType.SOLID:
                pen.setDashPattern([1.2, 2.0] if line is LineType.DOTTED else [6.0, 2.0, 1.2, 2.0])
            painter.setPen(pen)
            painter.drawLine(QPointF(_EDGE, y + step / 2), QPointF(_EDGE + 24, y + step / 2))
            painter.setPen(self._theme.ink)
            painter.drawText(QPointF(_EDGE + 32, y + step / 2 + painter.fontMetrics().ascent() / 2 - 1), name)

    def _paint_swatch(self, painter: QPainter, colour: QColor, area: QRectF) -> None:
        """Paint a piece of a surface as it is where the light falls full on it."""
        painter.fillRect(area, self._theme.canvas)
        surface = QColor(colour)
        surface.setAlphaF(SURFACE_STRENGTH)
        painter.fillRect(area, surface)

    def _point(self, at: QPointF) -> PickedPart | None:
        """Return what is at a place of the widget: a boundary point that is near, else the surface; in a section, the
        place.
        """
        picture, drawn = self._picture, self.drawn
        if picture is None:
            return None
        if len(picture.marks) and SceneLayer.POINTS in self.layers:
            off = np.hypot(*(self._seen(picture.marks)[:, :2] - (at.x(), at.y())).T)
            nearest = int(off.argmin())
            if off[nearest] <= _REACH_PX:
                x, y, z = picture.marks[nearest].tolist()
                return PickedPart(nearest, -1, (x, y, z))
        ray = self.camera.ray((at.x(), at.y()), self._size)
        if len(picture.lows):
            x, y, z = ray.origin.tolist()
            return PickedPart(-1, -1, (x, y, z))
        ratio = self._ratio
        row, column = int(at.y() * ratio), int(at.x() * ratio)
        if drawn is None or not (0 <= row < drawn.owners.shape[0] and 0 <= column < drawn.owners.shape[1]):
            return None
        if drawn.owners[row, column] < 0:
            return None
        x, y, z = (ray.origin - ray.direction * float(drawn.depths[row, column])).tolist()
        return PickedPart(-1, int(drawn.owners[row, column]), (x, y, z))

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 (Qt's name)
        """Fit again what was never moved."""
        self._refresh()
        if not self._moved:
            self.fit()

    def mousePressEvent(self, event: QMouseEvent) -> None:  # noqa: N802 (Qt's name)
        """Begin to drag."""
        self._from = self._pressed = event.position()

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:  # noqa: N802 (Qt's name)
        """A press that did not become a drag picks."""
        if (
            event.button() is Qt.MouseButton.LeftButton
            and (event.position() - self._pressed).manhattanLength() <= _CLICK_PX
        ):
            found = self._point(event.position())
            if found is not None:
                self.picked.emit(found)

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:  # noqa: N802 (Qt's name)
        """Show everything."""
        self.fit()

    def mouseMoveEvent(self, event: QMouseEvent) -> None:  # noqa: N802 (Qt's name)
        """Turn or shift; without a button, point."""
        if not event.buttons():
            self._set_over(self._point(event.position()))
            return
        by, self._from = event.position() - self._from, event.position()
        if self.turns and event.buttons() == Qt.MouseButton.LeftButton:
            self._move(self.camera.orbited(-by.x() * _TURN, by.y() * _TURN, np.array(self.camera.target)))
        else:
            self._move(self.camera.panned(by.x(), by.y()))

    def leaveEvent(self, event: QEvent) -> None:  # noqa: N802 (Qt's name)
        """Point at nothing."""
        self._set_over(None)

    def _set_over(self, over: PickedPart | None) -> None:
        self._over = over
        self.pointed.emit(over)
        self.update()

    def wheelEvent(self, event: QWheelEvent) -> None:  # noqa: N802 (Qt's name)
        """Zoom at the mouse."""
        self._zoom(_ZOOM ** event.angleDelta().y(), event.position().x(), event.position().y())

    def keyPressEvent(self, event: QKeyEvent) -> None:  # noqa: N802 (Qt's name)
        """F fits; arrows turn, or shift; + and - zoom."""
        way = _KEYS.get(Qt.Key(event.key()))
        if event.modifiers() & ~Qt.KeyboardModifier.KeypadModifier & ~Qt.KeyboardModifier.ShiftModifier:
            super().keyPressEvent(event)
        elif way is not None:
            if self.turns:
                self._move(
                    self.camera.orbited(
                        way[0] * _STEP * _TURN / 4, -way[1] * _STEP * _TURN / 4, np.array(self.camera.target)
                    )
                )
            else:
                self._move(self.camera.panned(-way[0] * _STEP, -way[1] * _STEP))
        elif event.key() == Qt.Key.Key_F:
            self.fit()
        elif event.key() in (Qt.Key.Key_Plus, Qt.Key.Key_Minus):
            self.zoom_by(1.25 if event.key() == Qt.Key.Key_Plus else 0.8)
        else:
            super().keyPressEvent(event)


def _rgb(colour: QColor) -> Rgb:
    return colour.red(), colour.green(), colour.blue()
