"""The points of the moves on the screen, by what each is to the curves: on the true shape, left out, or moved to it."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache

import numpy as np
from PySide6.QtCore import QLineF, QPointF, Qt
from PySide6.QtGui import QColor, QPainter, QPen

from app.edit.sample import Box
from app.fit.effective_points import PointState
from app.ui.canvas.pens import FINE, screen_pen
from app.ui.curves.curves_shown import Points
from app.ui.nc.motion_shapes import Floats, Side
from app.ui.nc.path_key import KeyMark, KeyRow
from app.ui.theme import Theme

_POINT_PX, _RING_PX = 3.2, 2.6
_DOT_PX = 5.0
"""Of points that are told apart."""
_APART_PX = 5.0
"""Points are shown where they are so far apart, in the mean."""


@lru_cache(maxsize=3)
def _apart(points: Points, side: Side) -> float:
    """Return how far points are apart, in the middle, mm."""
    step = np.linalg.norm(np.diff(points.was[:, list(side.value)], axis=0), axis=1)
    return float(np.median(step)) if len(step) else 0.0


def are_apart(points: Points, side: Side, scale: float) -> bool:
    """Tell whether points can be told apart at a scale, px/mm."""
    return _apart(points, side) * scale >= _APART_PX


def paint_points(painter: QPainter, points: Points, view: tuple[Side, Box, Callable[[Floats], Floats]], theme: Theme) -> None:
    """Paint the points that a box shows.

    Args:
        view: side, box, and where (k, 2) places of that side are on the screen, px.
    """
    side, box, on_screen = view
    was, places = points.was[:, list(side.value)], points.places[:, list(side.value)]
    near = np.all((was >= box[:2]) & (was <= box[2:]), axis=1)

    def dots(state: PointState, places: Floats, size: float) -> None:
        painter.setPen(QPen(_colour(state, points, theme), size, Qt.PenStyle.SolidLine, Qt.PenCapStyle.RoundCap))
        painter.drawPoints([QPointF(x, y) for x, y in on_screen(places[near & (points.state == state)]).tolist()])

    if not points.told_apart:
        dots(PointState.EFFECTIVE, was, _POINT_PX)
        return
    moved = near & np.any(was != places, axis=1)
    painter.setPen(screen_pen(painter, theme.muted, FINE))
    ways = zip(on_screen(was[moved]).tolist(), on_screen(places[moved]).tolist(), strict=True)
    painter.drawLines([QLineF(*a, *b) for a, b in ways])
    painter.setPen(QPen(theme.muted, 1.0))
    painter.setBrush(theme.canvas)
    for x, y in on_screen(was[near & (points.state == PointState.INVALID)]).tolist():
        painter.drawEllipse(QPointF(x, y), _RING_PX, _RING_PX)
    dots(PointState.CORRECTED, places, _DOT_PX)
    dots(PointState.EFFECTIVE, places, _DOT_PX)


def key_rows(points: Points, theme: Theme) -> list[KeyRow]:
    """Return what the marks mean; nothing where all points are alike."""
    if not points.told_apart:
        return []
    names = {PointState.EFFECTIVE: "Effective", PointState.CORRECTED: "Corrected", PointState.INVALID: "Left out"}
    return [
        KeyRow(name, _colour(state, points, theme), mark=KeyMark.RING if state is PointState.INVALID else KeyMark.DOT)
        for state, name in names.items() if np.any(points.state == state)
    ]  # fmt: skip


def _colour(state: PointState, points: Points, theme: Theme) -> QColor:
    if state is PointState.CORRECTED:
        return theme.left
    return theme.ink if points.told_apart and state is PointState.EFFECTIVE else theme.muted
