"""What curves are to become, as coloured areas of the drawing: filled where metal goes, else a broad line."""

from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtCore import Qt
from PySide6.QtGui import QColor, QPainter, QPainterPath

from ....framework.samples import PathLineKind, sample_pen
from ....framework.theme import Theme
from ..view_transform import ViewTransform
from .pens import screen_pen

_FILL_ALPHA, _LINE_ALPHA, _LINE_PX = 0.16, 0.45, 5.0
_MOST_ELEMENTS = 20_000
"""Of a path; what has more is not painted with every move of the mouse."""


@dataclass(frozen=True, eq=False)
class PurposeShape:
    """Where an operation works.

    Attributes:
        path: of its curves, mm. kind: of the line that its paths have. filled: what lies within goes.
    """

    path: QPainterPath
    kind: PathLineKind
    filled: bool


def paint_purposes(painter: QPainter, view: ViewTransform, shapes: tuple[PurposeShape, ...], theme: Theme) -> None:
    """Paint areas in the colour of their operation's paths."""
    painter.save()
    painter.setTransform(view.transform(), True)
    for shape in shapes:
        if shape.path.elementCount() > _MOST_ELEMENTS:
            continue
        colour = QColor(sample_pen(shape.kind, theme).color())
        colour.setAlphaF(_FILL_ALPHA if shape.filled else _LINE_ALPHA)
        painter.setPen(Qt.PenStyle.NoPen if shape.filled else screen_pen(painter, colour, _LINE_PX))
        painter.setBrush(colour if shape.filled else Qt.BrushStyle.NoBrush)
        painter.drawPath(shape.path)
    painter.restore()
