"""Pens whose width is in screen px, whatever the zoom and however fine the screen is."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtGui import QColor, QPainter, QPen

FINE = 0.0
"""The finest pen there is, one px of the screen itself; Qt strokes it about eight times as fast as any other."""


def screen_pen(painter: QPainter, colour: QColor, width: float, dashes: tuple[float, ...] = ()) -> QPen:
    """Return a pen that keeps its width at every zoom.

    Args:
        painter: whose device tells how many px of its own a px has.
        width: px, or FINE.
        dashes: lengths of dashes and gaps in turn, px.
    """
    real = width * painter.device().devicePixelRatioF() if width > FINE else 1.0
    pen = QPen(colour, real)
    pen.setCosmetic(True)
    pen.setCapStyle(Qt.PenCapStyle.FlatCap)
    pen.setJoinStyle(Qt.PenJoinStyle.BevelJoin)
    if dashes:
        ratio = painter.device().devicePixelRatioF() / real
        pen.setDashPattern([d * ratio for d in dashes])
    return pen
