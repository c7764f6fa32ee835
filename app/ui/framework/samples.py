"""Small painted things: line samples of paths, a switch, the drawing that explains stepover."""

from __future__ import annotations

from enum import Enum

from PySide6.QtCore import QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QBrush, QColor, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QAbstractButton, QWidget

from ...model.operation import Operation
from .theme import Theme
from .themed import Themed


class PathLineKind(Enum):
    """Kinds of lines that a drawing of paths has."""

    PART = "Part"
    POCKET = "Pocket"
    REST = "Rest"
    CONTOUR = "Contour"
    TAB = "Tab"
    LINK = "Link"
    RAPID = "Rapid"
    PLUNGE = "Plunge"
    LEFT = "Left material"
    UNREACHABLE = "Out of reach"
    CLAMP = "Keep-out"
    WEDGES = "Wedges"


def sample_pen(sample: PathLineKind, theme: Theme) -> QPen:
    """Return the pen that paths of this kind are drawn with."""
    colours = {
        PathLineKind.PART: theme.ink,
        PathLineKind.POCKET: theme.pocket,
        PathLineKind.REST: theme.rest,
        PathLineKind.CONTOUR: theme.contour,
        PathLineKind.TAB: theme.contour,
        PathLineKind.LINK: theme.pocket,
        PathLineKind.RAPID: theme.rapid,
        PathLineKind.PLUNGE: theme.plunge,
        PathLineKind.LEFT: theme.left,
        PathLineKind.UNREACHABLE: theme.unreachable,
        PathLineKind.CLAMP: theme.warning,
        PathLineKind.WEDGES: theme.regions[4],
    }
    pen = QPen(colours[sample], 1.0 if sample in (PathLineKind.LINK, PathLineKind.RAPID, PathLineKind.PART) else 1.8)
    pen.setCapStyle(Qt.PenCapStyle.FlatCap)
    if sample is PathLineKind.CONTOUR:
        pen.setDashPattern([3.0, 1.6])
    elif sample is PathLineKind.RAPID:
        pen.setDashPattern([1.2, 2.4])
    return pen


def sample_of(operation: Operation) -> PathLineKind:
    """Return the line that an operation's paths are drawn with, by what it does."""
    if operation.HOLES:
        return PathLineKind.PLUNGE
    if operation.FOLLOWS_WALLS:
        return PathLineKind.CONTOUR
    return PathLineKind.POCKET if operation.COARSE else PathLineKind.REST


class LineSample(Themed, QWidget):
    """26 px of a path's line."""

    def __init__(self, sample: PathLineKind) -> None:
        super().__init__()
        self._sample = sample
        self._any_colour = False
        self.setFixedSize(28, 16)

    def set_any_colour(self, on: bool) -> None:
        """Draw cutting paths in grey: their colour tells something else than their kind."""
        self._any_colour = on
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802 (Qt's name)
        """Draw the line, or the mark of a plunge."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setOpacity(1.0 if self.isEnabled() else 0.35)
        pen = sample_pen(self._sample, self._theme)
        if self._any_colour and self._sample in (
            PathLineKind.POCKET,
            PathLineKind.REST,
            PathLineKind.CONTOUR,
            PathLineKind.TAB,
            PathLineKind.LINK,
        ):
            pen.setColor(self._theme.muted)
        painter.setPen(pen)
        middle = QPointF(self.width() / 2, self.height() / 2)
        if self._sample is PathLineKind.PLUNGE:
            painter.setPen(QPen(self._theme.plunge, 1.4))
            painter.drawEllipse(middle, 4.2, 4.2)
            painter.setPen(QPen(self._theme.plunge, 2.6, Qt.PenStyle.SolidLine, Qt.PenCapStyle.RoundCap))
            painter.drawPoint(middle)
        elif self._sample in (PathLineKind.LEFT, PathLineKind.UNREACHABLE, PathLineKind.CLAMP):
            self._hatch(painter, painter.pen().color())
        elif self._sample is PathLineKind.WEDGES:
            self._facets(painter)
        elif self._sample is PathLineKind.TAB:
            self._tab(painter, middle)
        else:
            painter.drawLine(QPointF(1, middle.y()), QPointF(self.width() - 1, middle.y()))

    def _tab(self, painter: QPainter, middle: QPointF) -> None:
        """Draw a short thick piece of a path, as one over a tab is painted."""
        pen = painter.pen()
        pen.setWidthF(5.0)
        painter.setPen(pen)
        painter.drawLine(middle - QPointF(7, 0), middle + QPointF(7, 0))

    def _facets(self, painter: QPainter) -> None:
        """Draw two facets of a cylinder and two of a wedge."""
        colours = (self._theme.regions[4], self._theme.contour)
        for k in range(4):
            painter.setPen(QPen(colours[k // 2].darker(220), 1))
            painter.setBrush(colours[k // 2])
            painter.drawRect(QRectF(2.5 + 6 * k, 3.5, 6, self.height() - 7))

    def _hatch(self, painter: QPainter, colour: QColor) -> None:
        area = QRectF(1.5, 2.5, self.width() - 3, self.height() - 5)
        ground = QColor(colour)
        ground.setAlphaF(0.35)
        painter.fillRect(area, ground)
        painter.setPen(QPen(colour, 1))
        painter.setBrush(QBrush(colour, Qt.BrushStyle.BDiagPattern))
        painter.drawRect(area)


class Switch(Themed, QAbstractButton):
    """On or off: a knob in a groove."""

    def __init__(self, name: str) -> None:
        super().__init__()
        self.setCheckable(True)
        self.setAccessibleName(name)
        self.setToolTip(name)
        self.setCursor(Qt.CursorShape.PointingHandCursor)
        self.setFixedSize(30, 18)

    def sizeHint(self) -> QSize:  # noqa: N802 (Qt's name)
        """28 x 16 px and room for the focus ring."""
        return QSize(30, 18)

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802 (Qt's name)
        """Draw groove and knob."""
        theme, on = self._theme, self.isChecked()
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(QPen(theme.ink, 1) if self.hasFocus() else Qt.PenStyle.NoPen)
        off = QColor(theme.muted)
        off.setAlphaF(0.55)
        painter.setBrush(theme.accent if on else off)
        painter.drawRoundedRect(QRectF(1.5, 1.5, 27, 15), 7.5, 7.5)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor("#FFFFFF"))
        painter.drawEllipse(QPointF(21 if on else 9, 9), 5.5, 5.5)


_METAL_PX = 10.0  # of standing metal that is seen however wide the stepover


class StepoverDrawing(Themed, QWidget):
    """The tool in two neighbouring rings, seen from the side: s is what it moves, the rest is overlap."""

    def __init__(self) -> None:
        super().__init__()
        self._ratio = 0.5
        self.setFixedSize(150, 70)

    def show_ratio(self, ratio: float) -> None:
        """Draw a stepover of `ratio` tool diameters, in (0, 1]."""
        self._ratio = min(max(ratio, 0.0), 1.0)
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802 (Qt's name)
        """Draw floor, standing metal, the tool before (dashed) and now, and the arrow s."""
        theme = self._theme
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        top, floor, right = 20.5, 62.5, 116.5
        diameter = min(66.0, (right - _METAL_PX) / (1 + self._ratio))
        step = max(self._ratio * diameter, 2.0)
        left = right - diameter
        self._metal(painter, left - step, floor)
        dashed = QPen(theme.muted, 1, Qt.PenStyle.CustomDashLine)
        dashed.setDashPattern([3, 3])
        painter.setPen(dashed)
        for x in (left - step, right - step):
            painter.drawLine(QPointF(x, top), QPointF(x, floor))
        painter.setPen(QPen(theme.ink, 1.4))
        painter.drawPolyline([QPointF(left, top), QPointF(left, floor), QPointF(right, floor), QPointF(right, top)])
        self._arrow(painter, left - step, left, 10.5)

    def _metal(self, painter: QPainter, wall: float, floor: float) -> None:
        painter.setPen(QPen(self._theme.muted, 1))
        painter.drawLine(QPointF(0, floor - 22), QPointF(max(wall, 0), floor - 22))
        painter.drawLine(QPointF(0, floor), QPointF(146, floor))

    def _arrow(self, painter: QPainter, left: float, right: float, y: float) -> None:
        painter.setPen(QPen(self._theme.accent_text, 1.3))
        for x in (left, right):
            painter.drawLine(QPointF(x, y - 5), QPointF(x, y + 5))
        painter.drawLine(QPointF(left, y), QPointF(right, y))
        size = min(3.5, (right - left) / 3)
        for x, way in ((left, 1), (right, -1)):
            painter.drawLine(QPointF(x, y), QPointF(x + way * size, y - size))
            painter.drawLine(QPointF(x, y), QPointF(x + way * size, y + size))
        painter.setPen(self._theme.ink)
        painter.drawText(QPointF(right + 6, y + 4), "s")
