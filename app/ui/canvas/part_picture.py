"""Paints the drawing and what of it is selected, and finds the entity under the mouse."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import Qt
from PySide6.QtGui import QColor, QPainter, QPainterPath, QPen

from app.edit.sample import Box, sample
from app.model.curves import Curve, Point
from app.model.part import Entity, Part
from app.ui.canvas.chunks import PartChunks
from app.ui.canvas.curve_path import MANY, curve_path
from app.ui.canvas.pens import FINE, screen_pen
from app.ui.canvas.view import View
from app.ui.theme import Theme

PART_WIDTH, SELECTED_WIDTH = 1.25, 2.6
_BATCH = 64


class PartPicture:
    """One part, ready to paint.

    Attributes:
        lookup: its chunks, boxes and snap points.
    """

    def __init__(self) -> None:
        """Begin with an empty drawing."""
        self.lookup = PartChunks()
        self._colours: dict[str, str] = {}
        self._locked: frozenset[str] = frozenset()
        self._selected: list[QPainterPath] = []

    def update(self, part: Part) -> None:
        """Take over another part."""
        self.lookup.update(part)
        self._colours = {layer.name: layer.colour for layer in part.layers}
        self._locked = frozenset(layer.name for layer in part.layers if layer.locked)

    def select(self, ids: frozenset[int]) -> None:
        """Take over another selection."""
        chosen = [e for e in self.lookup.entities if e.id in ids] if ids else []
        self._selected = [curve_path(*(e.curve for e in chosen[at:at + _BATCH])) for at in range(0, len(chosen), _BATCH)]

    def paint(self, painter: QPainter, view: View, box: Box, theme: Theme) -> None:
        """Paint what lies in a box in mm, and what is selected; the painter works in screen px."""
        self.paint_curves(painter, view, box, theme)
        painter.save()
        painter.setTransform(view.transform(), True)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        fine = sum(path.elementCount() for path in self._selected) > MANY
        painter.setPen(_round_pen(painter, theme.selection, FINE if fine else SELECTED_WIDTH))
        for path in self._selected:
            painter.drawPath(path)
        painter.restore()

    def paint_curves(self, painter: QPainter, view: View, box: Box, theme: Theme, *, without: tuple[str, ...] = ()) -> None:
        """Paint what lies in a box in mm, but for some layers; the painter works in screen px."""
        painter.save()
        painter.setTransform(view.transform(), True)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        seen = [c for c in self.lookup.chunks
                if c.box[0] <= box[2] and c.box[2] >= box[0] and c.box[1] <= box[3] and c.box[3] >= box[1]]
        fine = sum(path.elementCount() for c in seen for path in c.paths.values()) > MANY
        for chunk in seen:
            for layer, path in ((name, path) for name, path in chunk.paths.items() if name not in without):
                painter.setPen(_round_pen(painter, QColor(self._colours.get(layer) or theme.ink), FINE if fine else PART_WIDTH))
                painter.drawPath(path)
        painter.restore()

    def nearest(self, at: Point, reach: float) -> Entity | None:
        """Return the entity nearest to a point within `reach` mm, not on a locked layer, or None."""
        boxes = self.lookup.boxes
        near = ((boxes[:, 0] <= at[0] + reach) & (boxes[:, 2] >= at[0] - reach)
                & (boxes[:, 1] <= at[1] + reach) & (boxes[:, 3] >= at[1] - reach))
        found: tuple[float, Entity | None] = (reach, None)
        for row in np.flatnonzero(near):
            entity = self.lookup.entities[row]
            if entity.layer not in self._locked and (distance := _distance(entity.curve, at)) <= found[0]:
                found = (distance, entity)
        return found[1]


def _distance(curve: Curve, at: Point) -> float:
    points = sample(curve)
    a, d = points[:-1], np.diff(points, axis=0)
    square = np.einsum("ij,ij->i", d, d)
    share = np.clip(np.einsum("ij,ij->i", np.asarray(at) - a, d) / np.where(square > 0, square, 1.0), 0.0, 1.0)
    return float(np.hypot(*(a + share[:, None] * d - at).T).min())


def _round_pen(painter: QPainter, colour: QColor, width: float) -> QPen:
    pen = screen_pen(painter, colour, width)
    pen.setCapStyle(Qt.PenCapStyle.RoundCap)
    pen.setJoinStyle(Qt.PenJoinStyle.RoundJoin)
    return pen
