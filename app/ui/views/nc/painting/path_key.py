"""The key of the path: what its lines mean, in a corner where nothing is cut."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

import numpy as np
from PySide6.QtCore import QPointF, QRectF, QSizeF, Qt
from PySide6.QtGui import QColor, QFontMetricsF, QPainter, QPen

from .....geometry.sample import Box
from ....framework.catalogue import tr
from ....framework.theme import Theme, text_font
from ..motion_hover import outline
from ..motion_shapes import Floats, MotionLineStyle, MotionShapes, ViewSide

_ROW_PX, _LINE_PX, _GAP_PX, _PAD_PX, _EDGE_PX = 18.0, 20.0, 8.0, 8.0, 10.0
_DASHES, _DOTS = (4.0, 3.0), (1.2, 2.4)
_DOT_PX = 6.0
_MOST_NEAR, _MOST_CURVED = 2_000, 200
"""A corner with more motions than these is taken as covered."""


class KeyCorner(Enum):
    """Where the key goes; the value says whether it is at the right and at the bottom."""

    TOP_RIGHT = (True, False)
    TOP_LEFT = (False, False)
    BOTTOM_RIGHT = (True, True)
    BOTTOM_LEFT = (False, True)


class KeyMark(Enum):
    """What stands before the words."""

    LINE = "line"
    DASHES = "dashes"
    DOTS = "dots"
    DOT = "dot"
    RING = "ring"
    PLUNGE = "plunge"


@dataclass(frozen=True, slots=True)
class _Ring:
    """A circle's radius and the width of its line, px."""

    radius: float
    line: float


_DOT_OF = {KeyMark.DOT: _DOT_PX, KeyMark.PLUNGE: 2.4}
_RING_OF = {KeyMark.RING: _Ring(_DOT_PX / 2, 1.0), KeyMark.PLUNGE: _Ring(4.2, 1.4)}
_LINE_OF: dict[KeyMark, tuple[float, ...]] = {KeyMark.LINE: (), KeyMark.DASHES: _DASHES, KeyMark.DOTS: _DOTS}


@dataclass(frozen=True, slots=True)
class KeyRow:
    """One line of the key."""

    words: str
    colour: QColor
    mark: KeyMark = KeyMark.LINE


def key_size(rows: Sequence[KeyRow]) -> QSizeF:
    """Return the size of a key, px; nothing for none."""
    metrics = QFontMetricsF(text_font())
    wide = max((metrics.horizontalAdvance(tr(row.words)) for row in rows), default=0.0)
    return QSizeF(wide + _LINE_PX + _GAP_PX + 2 * _PAD_PX, len(rows) * _ROW_PX + _PAD_PX) if rows else QSizeF(0.0, 0.0)


def key_place(size: QSizeF, area: QRectF, corner: KeyCorner) -> QRectF:
    """Return where in an area a key of this size goes, px."""
    right, bottom = corner.value
    left = area.right() - _EDGE_PX - size.width() if right else area.left() + _EDGE_PX
    top = area.bottom() - _EDGE_PX - size.height() if bottom else area.top() + _EDGE_PX
    return QRectF(left, top, size.width(), size.height())


def beside_key(size: QSizeF, area: QRectF) -> tuple[QRectF, QRectF]:
    """Return what is left of an area beside a key at its upper right, and what is left below it."""
    if size.isEmpty():
        return area, area
    return area.adjusted(0.0, 0.0, -size.width() - _EDGE_PX, 0.0), area.adjusted(
        0.0, size.height() + _EDGE_PX, 0.0, 0.0
    )


def _paint_mark(painter: QPainter, left: QPointF, row: KeyRow) -> None:
    """Paint what a row's words mean, from its left end on."""
    middle = left + QPointF(_LINE_PX / 2, 0.0)
    if row.mark in _DOT_OF:
        painter.setPen(QPen(row.colour, _DOT_OF[row.mark], Qt.PenStyle.SolidLine, Qt.PenCapStyle.RoundCap))
        painter.drawPoint(middle)
    if row.mark in _RING_OF:
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.setPen(QPen(row.colour, _RING_OF[row.mark].line))
        painter.drawEllipse(middle, _RING_OF[row.mark].radius, _RING_OF[row.mark].radius)
    if row.mark in _LINE_OF:
        dashes, width = _LINE_OF[row.mark], 1.0 if row.mark is KeyMark.DOTS else 2.0
        pen = QPen(row.colour, width, Qt.PenStyle.SolidLine, Qt.PenCapStyle.FlatCap)
        if dashes:
            pen.setDashPattern([dash / width for dash in dashes])
        painter.setPen(pen)
        painter.drawLine(left, left + QPointF(_LINE_PX, 0.0))


def paint_key(painter: QPainter, place: QRectF, rows: Sequence[KeyRow], theme: Theme) -> None:
    """Paint what lines mean at a place, px."""
    if not rows:
        return
    ground = QColor(theme.canvas)
    ground.setAlphaF(0.88)
    painter.fillRect(place, ground)
    painter.setFont(text_font())
    left, top = place.left() + _PAD_PX, place.top() + _PAD_PX / 2
    for at, row in enumerate(rows):
        middle = top + (at + 0.5) * _ROW_PX
        _paint_mark(painter, QPointF(left, middle), row)
        painter.setPen(theme.muted)
        words = QRectF(left + _LINE_PX + _GAP_PX, middle - _ROW_PX / 2, place.width(), _ROW_PX)
        painter.drawText(words, Qt.AlignmentFlag.AlignVCenter, tr(row.words))


def cuts_within(shapes: MotionShapes, side: ViewSide, box: Box) -> bool:
    """Return whether a motion that cuts comes into a box in mm as seen from a side; in doubt, yes.

    Args:
        shapes: the motions.
        side: from where they are seen.
        box: x0, y0, x1, y1, mm.
    """
    columns, low, high = list(side.value), np.array(box[:2]), np.array(box[2:])
    near = (shapes.look != MotionLineStyle.RAPID) & np.all(
        (shapes.low[:, columns] <= high) & (shapes.high[:, columns] >= low), axis=1
    )
    rows = shapes.seen(side, np.flatnonzero(near))
    curved = rows[shapes.offset[rows + 1] - shapes.offset[rows] > 1]
    if len(rows) > _MOST_NEAR or len(curved) > _MOST_CURVED:
        return True
    motions, straight = shapes.program.motions, np.setdiff1d(rows, curved)
    lines = [(motions.start[straight][:, columns], motions.end[straight][:, columns])]
    lines += [(points[:-1], points[1:]) for points in (outline(shapes, row)[:, columns] for row in curved.tolist())]
    return any(_enter(first, last, low, high) for first, last in lines)


def _enter(first: Floats, last: Floats, low: Floats, high: Floats) -> bool:
    """Return whether one of the lines from `first` to `last`, (k, 2), enters a box: by its part within each pair of
    sides.
    """
    way = last - first
    still = way == 0
    share = 1.0 / np.where(still, 1.0, way)
    a, b = (low - first) * share, (high - first) * share
    within = (first >= low) & (first <= high)
    begin = np.where(still, np.where(within, 0.0, 2.0), np.minimum(a, b))
    end = np.where(still, np.where(within, 1.0, -1.0), np.maximum(a, b))
    return bool(np.any(np.minimum(end.min(axis=1), 1.0) >= np.maximum(begin.max(axis=1), 0.0)))
