"""Paints what is left on the floor: hatched where no tool reaches, and where a tool could have cut."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QBrush, QColor, QPainter, QPainterPath, QPolygonF, QTransform

from .....geometry.sample import Box
from ..view_transform import ViewTransform
from .curve_path import MANY
from .pens import FINE, screen_pen

if TYPE_CHECKING:
    from .....toolpath.coverage.coverage import UncutPlace

_SMALLEST_PX = 0.8
"""What is smaller on the screen is not painted."""

_HATCHED_PX = 5.0
"""What is smaller on the screen is only filled: a hatch could not be seen in it."""

_FILL = 0.35
"""Opacity of the ground under the hatch."""


class RemainderLayer:
    """Pieces of floor that are left, of one kind, ready to paint."""

    def __init__(self, places: Sequence[UncutPlace]) -> None:
        """Build every outline once, in mm."""
        self._paths = [_outline(place) for place in places]
        bounds = [(*place.outline.min(axis=0), *place.outline.max(axis=0)) for place in places]
        self._boxes = np.array(bounds, dtype=np.float64).reshape(-1, 4)

    def __bool__(self) -> bool:
        """Whether there is anything left."""
        return bool(self._paths)

    def paint(self, painter: QPainter, view: ViewTransform, box: Box, colour: QColor) -> None:
        """Paint what lies in a box in mm; the painter already works in mm."""
        boxes = self._boxes
        near = (boxes[:, 0] <= box[2]) & (boxes[:, 2] >= box[0]) & (boxes[:, 1] <= box[3]) & (boxes[:, 3] >= box[1])
        size = np.maximum(boxes[:, 2] - boxes[:, 0], boxes[:, 3] - boxes[:, 1]) * view.scale
        seen = np.flatnonzero(near & (size >= _SMALLEST_PX))
        ground = QColor(colour)
        ground.setAlphaF(_FILL)
        hatch = QBrush(colour, Qt.BrushStyle.BDiagPattern)
        hatch.setTransform(QTransform.fromScale(1 / view.scale, -1 / view.scale))
        plain = sum(self._paths[k].elementCount() for k in seen) > MANY
        painter.setPen(Qt.PenStyle.NoPen if plain else screen_pen(painter, colour, FINE))
        for k in seen:
            painter.setBrush(ground)
            painter.drawPath(self._paths[k])
            if size[k] >= _HATCHED_PX and not plain:
                painter.fillPath(self._paths[k], hatch)


def _outline(place: UncutPlace) -> QPainterPath:
    path = QPainterPath()
    path.setFillRule(Qt.FillRule.OddEvenFill)
    for ring in (place.outline, *place.holes):
        path.addPolygon(QPolygonF([QPointF(x, y) for x, y in ring.tolist()]))
        path.closeSubpath()
    return path
