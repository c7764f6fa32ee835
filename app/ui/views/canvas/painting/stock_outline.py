"""The outline of a stock: dashed lines that stand still while a picture is moved, however near one looks."""

from __future__ import annotations

import math

from PySide6.QtCore import QLineF, QRectF
from PySide6.QtGui import QPainter

from ....framework.theme import Theme
from .pens import screen_pen

_WIDTH, _DASHES = 1.0, (6.0, 4.0)
DASH_PERIOD = sum(_DASHES)
"""Of the outline, px."""


def paint_outline(painter: QPainter, outline: QRectF, area: QRectF, theme: Theme) -> None:
    """Paint what of an outline is seen in an area, both px of the screen."""
    painter.setPen(screen_pen(painter, theme.muted, _WIDTH, _DASHES))
    painter.drawLines(edges_seen(outline, area))


def edges_seen(outline: QRectF, area: QRectF) -> list[QLineF]:
    """Return what of the edges of an outline may be seen in an area, px.

    Each begins a whole number of dashes from its corner, so that dashes stand still while a picture is moved and
    painted anew in parts; no line is much longer than the area, however near one looks.
    """

    def seen(low: float, high: float, first: float, last: float) -> tuple[float, float]:
        return low + max(math.floor((first - low) / DASH_PERIOD), 0) * DASH_PERIOD, min(high, last)

    left, right = seen(outline.left(), outline.right(), area.left(), area.right())
    top, bottom = seen(outline.top(), outline.bottom(), area.top(), area.bottom())
    lines = [QLineF(left, y, right, y) for y in (outline.top(), outline.bottom()) if area.top() <= y <= area.bottom()]
    lines += [QLineF(x, top, x, bottom) for x in (outline.left(), outline.right()) if area.left() <= x <= area.right()]
    near = [each for each in lines if each.x2() >= area.left() and each.y2() >= area.top()]
    return [each for each in near if each.x1() <= each.x2() and each.y1() <= each.y2()]
