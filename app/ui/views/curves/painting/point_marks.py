"""The points of the moves on the screen, by what each is to the curves: on the true shape, left out, or moved to it."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QLineF, QPointF, Qt
from PySide6.QtGui import QColor, QPainter, QPen

from .....fitting.point_curves.effective_points import PointState
from .....geometry.sample import Box
from ....framework.theme import Theme
from ...canvas.painting.pens import FINE, screen_pen
from ...nc.motion_shapes import Floats, ViewSide
from ...nc.painting.path_key import KeyMark, KeyRow
from ..model import SmoothedPoints

_POINT_PX, _RING_PX = 3.2, 2.6
_DOT_PX = 5.0
"""Of points that are told apart."""
_APART_PX = 5.0
"""Points are shown where they are so far apart, in the mean."""
_PER_PX = 4.0
"""Marks that lie within one part of so many of a px are one."""


@lru_cache(maxsize=3)
def _apart(points: SmoothedPoints, side: ViewSide) -> float:
    """Return how far points are apart, in the middle, mm."""
    step = np.linalg.norm(np.diff(points.was[:, list(side.value)], axis=0), axis=1)
    return float(np.median(step)) if len(step) else 0.0


def are_apart(points: SmoothedPoints, side: ViewSide, scale: float) -> bool:
    """Tell whether points can be told apart at a scale, px/mm."""
    return _apart(points, side) * scale >= _APART_PX


class PointsInSight(NamedTuple):
    """From which side points are seen, the box, mm, and where (k, 2) places of that side are on the screen, px."""

    side: ViewSide
    box: Box
    on_screen: Callable[[Floats], Floats]


def paint_points(painter: QPainter, points: SmoothedPoints, view: PointsInSight, theme: Theme) -> None:
    """Paint the points that a box shows."""
    side, box, on_screen = view
    was, places = points.was[:, list(side.value)], points.places[:, list(side.value)]
    near = _within(was, box) | _within(places, box)

    def dots(state: PointState, places: Floats, size: float) -> None:
        painter.setPen(QPen(_colour(state, points, theme), size, Qt.PenStyle.SolidLine, Qt.PenCapStyle.RoundCap))
        painter.drawPoints([QPointF(x, y) for x, y in _once(on_screen(places[near & (points.state == state)]))])

    if not points.told_apart:
        dots(PointState.EFFECTIVE, was, _POINT_PX)
        return
    moved = near & np.any(was != places, axis=1)
    painter.setPen(screen_pen(painter, theme.muted, FINE))
    painter.drawLines([QLineF(*way) for way in _once(np.hstack([on_screen(was[moved]), on_screen(places[moved])]))])
    painter.setPen(QPen(theme.muted, 1.0))
    painter.setBrush(theme.canvas)
    for x, y in _once(on_screen(was[near & (points.state == PointState.INVALID)])):
        painter.drawEllipse(QPointF(x, y), _RING_PX, _RING_PX)
    dots(PointState.CORRECTED, places, _DOT_PX)
    dots(PointState.EFFECTIVE, places, _DOT_PX)


def _within(places: Floats, box: Box) -> NDArray[np.bool_]:
    return np.asarray(np.all((places >= box[:2]) & (places <= box[2:]), axis=1))


def _once(marks: Floats) -> list[list[float]]:
    """Return marks (k, c) px but for those that lie on another: passes below one another would all be painted."""
    _, first = np.unique(np.round(marks * _PER_PX), axis=0, return_index=True)
    kept: list[list[float]] = marks[first].tolist()
    return kept


def key_rows(points: SmoothedPoints, theme: Theme) -> list[KeyRow]:
    """Return what the marks mean; nothing where all points are alike."""
    if not points.told_apart:
        return []
    names = {PointState.EFFECTIVE: "Effective", PointState.CORRECTED: "Corrected", PointState.INVALID: "Left out"}
    return [
        KeyRow(name, _colour(state, points, theme), mark=KeyMark.RING if state is PointState.INVALID else KeyMark.DOT)
        for state, name in names.items()
        if np.any(points.state == state)
    ]


def _colour(state: PointState, points: SmoothedPoints, theme: Theme) -> QColor:
    if state is PointState.CORRECTED:
        return theme.left
    return theme.ink if points.told_apart and state is PointState.EFFECTIVE else theme.muted
