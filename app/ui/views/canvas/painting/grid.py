"""The paper: raster, display frame with its cells, origin, rulers."""

from __future__ import annotations

import math
from collections.abc import Iterator

from PySide6.QtCore import QLineF, QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QFontMetricsF, QPainter, QPen

from .....raster.frame import BitmapFrame
from ....framework.catalogue import tr
from ....framework.figures import TIMES
from ....framework.theme import Theme, text_font
from ..view_transform import ViewTransform, nice_step

RULER = 24
CELL_PX = 6.0
_MAJOR_PX = 100.0
_CORNER_PX = 12.0


def grid_steps(view: ViewTransform, unit: float = 1.0) -> tuple[float, float]:
    """Return the distance of fine and of bold grid lines, mm: bold ones at least 100 px apart.

    Args:
        unit: size of the unit in which they are round numbers, mm.
    """
    major = nice_step(_MAJOR_PX / (view.scale * unit))
    parts = 4 if round(major / 10 ** math.floor(math.log10(major) + 1e-9)) == 2 else 5
    return major / parts * unit, major * unit


def cells_shown(view: ViewTransform, frame: BitmapFrame) -> bool:
    """Return whether the cells of the display are large enough to be seen."""
    return frame.pitch * view.scale >= CELL_PX


def paint_paper(painter: QPainter, view: ViewTransform, area: QRectF, theme: Theme, unit: float = 1.0) -> None:
    """Paint ground and raster within a screen rectangle; the raster's steps are round in a unit of so many mm."""
    painter.fillRect(area, theme.canvas)
    paint_raster(painter, view, area, theme, unit)


def paint_raster(painter: QPainter, view: ViewTransform, area: QRectF, theme: Theme, unit: float = 1.0) -> None:
    """Paint the raster alone."""
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, False)
    minor, major = grid_steps(view, unit)
    _paint_raster(painter, view, area, minor, theme.grid)
    _paint_raster(painter, view, area, major, theme.grid_major)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, True)


def paint_display(painter: QPainter, view: ViewTransform, area: QRectF, frame: BitmapFrame, theme: Theme) -> None:
    """Paint the display's cells when they are near."""
    if cells_shown(view, frame):
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, False)
        _paint_cells(painter, view, _outline(view, frame).intersected(area), frame, theme)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, True)


def _outline(view: ViewTransform, frame: BitmapFrame) -> QRectF:
    x0, y0, x1, y1 = frame.extent
    return QRectF(view.to_screen((x0, y1)), view.to_screen((x1, y0)))


def paint_display_marks(painter: QPainter, view: ViewTransform, area: QRectF, frame: BitmapFrame, theme: Theme) -> None:
    """Paint marks at the display's corners and its name: it is no stock, so it has no outline."""
    outline = _outline(view, frame)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, False)
    mark = min(_CORNER_PX, outline.width() / 4, outline.height() / 4)
    painter.setPen(_line(theme.muted))
    near = area.adjusted(-_CORNER_PX, -_CORNER_PX, _CORNER_PX, _CORNER_PX)
    for x, inwards in ((outline.left(), mark), (outline.right(), -mark)):
        for y, down in ((outline.top(), mark), (outline.bottom(), -mark)):
            if near.contains(x, y):
                corner = QPointF(_px(x), _px(y))
                painter.drawLine(corner, corner + QPointF(inwards, 0))
                painter.drawLine(corner, corner + QPointF(0, down))
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, True)
    painter.setFont(text_font())
    name = tr(f"{frame.cols} {TIMES} {frame.rows} display")
    at = QPointF(_px(outline.left()), _px(outline.top()) - 6)
    if QFontMetricsF(painter.font()).horizontalAdvance(name) < outline.width() and area.adjusted(
        -400, -40, 40, 40
    ).contains(at):
        painter.drawText(at, name)


def paint_origin(painter: QPainter, view: ViewTransform, theme: Theme) -> None:
    """Paint the drawing's zero: a ring and an arrow along each axis."""
    zero = view.to_screen((0.0, 0.0))
    painter.setPen(QPen(theme.ink, 1.5, Qt.PenStyle.SolidLine, Qt.PenCapStyle.RoundCap, Qt.PenJoinStyle.RoundJoin))
    painter.setBrush(theme.canvas)
    for dx, dy in ((1.0, 0.0), (0.0, -1.0)):
        tip = QPointF(zero.x() + 36 * dx, zero.y() + 36 * dy)
        painter.drawLine(QPointF(zero.x() + 4 * dx, zero.y() + 4 * dy), tip)
        for side in (-1, 1):
            painter.drawLine(tip, QPointF(tip.x() - 5 * dx + 3.5 * side * dy, tip.y() - 5 * dy + 3.5 * side * dx))
    painter.drawEllipse(zero, 4.0, 4.0)


def paint_rulers(painter: QPainter, view: ViewTransform, size: QSize, theme: Theme, unit: float = 1.0) -> None:
    """Paint the rulers along the top and the left of a widget, 24 px each, in a unit of so many mm."""
    width, height = float(size.width()), float(size.height())
    painter.fillRect(QRectF(0, 0, width, RULER), theme.paper)
    painter.fillRect(QRectF(0, 0, RULER, height), theme.paper)
    painter.setFont(text_font())
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, False)
    painter.setPen(_line(theme.hairline))
    painter.drawLine(QLineF(RULER, RULER - 1, width, RULER - 1))
    painter.drawLine(QLineF(RULER - 1, RULER, RULER - 1, height))
    minor, major = grid_steps(view, unit)
    tick = QColor(theme.muted)
    tick.setAlphaF(0.6)
    for value in _multiples((RULER - view.ox) / view.scale, (width - view.ox) / view.scale, minor):
        _top_mark(painter, _px(view.ox + value * view.scale), _text_at(value / unit, major / unit), (tick, theme.muted))
    for value in _multiples((view.oy - height) / view.scale, (view.oy - RULER) / view.scale, minor):
        _left_mark(
            painter, _px(view.oy - value * view.scale), _text_at(value / unit, major / unit), (tick, theme.muted)
        )
    painter.fillRect(QRectF(0, 0, RULER, RULER), theme.paper)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, True)


def paint_ruler_marks(painter: QPainter, at: QPointF, theme: Theme) -> None:
    """Paint where the mouse is on both rulers."""
    painter.setPen(_line(theme.accent, 2))
    painter.drawLine(QLineF(at.x(), RULER - 9, at.x(), RULER - 2))
    painter.drawLine(QLineF(RULER - 9, at.y(), RULER - 2, at.y()))


def _top_mark(painter: QPainter, x: float, text: str, colours: tuple[QColor, QColor]) -> None:
    painter.setPen(_line(colours[0]))
    painter.drawLine(QLineF(x, RULER - (6 if text else 4), x, RULER - 2))
    if _beside_corner(painter, x, text):
        painter.setPen(colours[1])
        painter.drawText(QRectF(x - 50, 0, 100, RULER - 6), Qt.AlignmentFlag.AlignCenter, text)


def _left_mark(painter: QPainter, y: float, text: str, colours: tuple[QColor, QColor]) -> None:
    painter.setPen(_line(colours[0]))
    painter.drawLine(QLineF(RULER - (6 if text else 4), y, RULER - 2, y))
    if _beside_corner(painter, y, text):
        painter.setPen(colours[1])
        painter.save()
        painter.translate((RULER - 6) / 2, y)
        painter.rotate(-90)
        height = QFontMetricsF(painter.font()).height()
        painter.drawText(QRectF(-50, -height / 2, 100, height), Qt.AlignmentFlag.AlignCenter, text)
        painter.restore()


def _beside_corner(painter: QPainter, at: float, text: str) -> bool:
    """Whether there is a text, and the rulers' corner does not cut it."""
    return bool(text) and at - QFontMetricsF(painter.font()).horizontalAdvance(text) / 2 >= RULER


def _text_at(value: float, major: float) -> str:
    """Return the number to write at a ruler's tick, or "" between bold lines."""
    whole = round(value / major)
    if abs(value - whole * major) > 1e-6 * major:
        return ""
    digits = max(0, -math.floor(math.log10(major) + 1e-9))
    return f"{whole * major + 0.0:.{digits}f}".replace("-", "\u2212")


def _paint_raster(painter: QPainter, view: ViewTransform, area: QRectF, step: float, colour: QColor) -> None:
    x0, y0, x1, y1 = view.world_box(area)
    columns = [_px(view.ox + x * view.scale) for x in _multiples(x0, x1, step)]
    rows = [_px(view.oy - y * view.scale) for y in _multiples(y0, y1, step)]
    painter.setPen(_line(colour))
    painter.drawLines(
        [QLineF(x, area.top(), x, area.bottom()) for x in columns]
        + [QLineF(area.left(), y, area.right(), y) for y in rows]
    )


def _paint_cells(painter: QPainter, view: ViewTransform, part: QRectF, frame: BitmapFrame, theme: Theme) -> None:
    """Paint the raster of the display's cells, stronger the larger they are."""
    if part.isEmpty():
        return
    colour = QColor(theme.muted)
    colour.setAlphaF(min(0.28, 0.07 + 0.01 * (frame.pitch * view.scale - CELL_PX)))
    x0, y0, x1, y1 = view.world_box(part)
    columns = [frame.x0 + step for step in _multiples(x0 - frame.x0, x1 - frame.x0, frame.pitch)]
    rows = [frame.y0 + step for step in _multiples(y0 - frame.y0, y1 - frame.y0, frame.pitch)]
    painter.setPen(_line(colour))
    painter.drawLines(
        [QLineF(x, part.top(), x, part.bottom()) for x in (_px(view.ox + c * view.scale) for c in columns)]
        + [QLineF(part.left(), y, part.right(), y) for y in (_px(view.oy - r * view.scale) for r in rows)]
    )


def _multiples(first: float, last: float, step: float) -> Iterator[float]:
    return (k * step for k in range(math.ceil(first / step), math.floor(last / step) + 1))


def _px(position: float) -> int:
    """Return the whole px nearest to a position; unlike `round`, the same for a scene shifted by whole px."""
    return math.floor(position + 0.5)


def _line(colour: QColor, width: float = 1.0) -> QPen:
    pen = QPen(colour, width)
    pen.setCosmetic(True)
    pen.setCapStyle(Qt.PenCapStyle.FlatCap)
    return pen
