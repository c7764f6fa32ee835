"""The mark of a snap: a figure for each kind, in one style."""

from __future__ import annotations

from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QPainter, QPen, QPolygonF

from ....framework.theme import Theme
from ..snap import Snap, SnapKind
from ..view_transform import ViewTransform

_HALF = 5.5

_Strokes = tuple[tuple[tuple[float, float], ...], ...]

_STROKES: dict[SnapKind, _Strokes] = {
    SnapKind.END: (((-0.9, -0.9), (0.9, -0.9), (0.9, 0.9), (-0.9, 0.9), (-0.9, -0.9)),),
    SnapKind.MIDDLE: (((-1, 0.8), (1, 0.8), (0, -1), (-1, 0.8)),),
    SnapKind.QUADRANT: (((-1, 0), (0, -1), (1, 0), (0, 1), (-1, 0)),),
    SnapKind.NODE: (((-0.7, -0.7), (0.7, 0.7)), ((-0.7, 0.7), (0.7, -0.7))),
    SnapKind.INTERSECTION: (((-0.9, -0.9), (0.9, 0.9)), ((-0.9, 0.9), (0.9, -0.9))),
    SnapKind.PERPENDICULAR: (((-0.9, -1), (-0.9, 0.9), (1, 0.9)), ((-0.9, 0), (0, 0), (0, 0.9))),
    SnapKind.TANGENT: (((-1, -1), (1, -1)),),
    SnapKind.NEAREST: (((-0.9, -0.9), (0.9, -0.9), (-0.9, 0.9), (0.9, 0.9), (-0.9, -0.9)),),
    SnapKind.ORIGIN: (((-1.2, 0), (1.2, 0)), ((0, -1.2), (0, 1.2))),
    SnapKind.GRID: (((-0.7, 0), (0.7, 0)), ((0, -0.7), (0, 0.7))),
}
"""In halves of the mark, y down."""

_RINGS = {SnapKind.CENTRE: 1.0, SnapKind.NODE: 1.0, SnapKind.TANGENT: 0.8, SnapKind.ORIGIN: 0.6}
"""Radius of a circle that belongs to the mark."""


def paint_snap(painter: QPainter, view: ViewTransform, snap: Snap, theme: Theme) -> None:
    """Paint the mark of a snap; that of the grid is quieter."""
    at = view.to_screen(snap.point)
    painter.setPen(QPen(theme.muted, 1.2) if snap.kind is SnapKind.GRID else QPen(theme.accent_text, 1.8))
    painter.setBrush(Qt.BrushStyle.NoBrush)
    for stroke in _STROKES.get(snap.kind, ()):
        painter.drawPolyline(QPolygonF([at + QPointF(x, y) * _HALF for x, y in stroke]))
    if snap.kind in _RINGS:
        painter.drawEllipse(at, _RINGS[snap.kind] * _HALF, _RINGS[snap.kind] * _HALF)
