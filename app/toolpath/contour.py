"""Contour paths: the contour tool follows every wall at its radius (step 120, A to A')."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from app.geometry.offset import Ring
from app.geometry.primitives import TURN, lengths, reversed_rows
from app.model.moves import Purpose
from app.model.operation import Direction
from app.toolpath.build import Stroke, started_at


def contour_strokes(rings: Sequence[Ring], direction: Direction) -> tuple[Stroke, ...]:
    """Return one closed stroke a ring.

    The wall is on the right of a ring's own direction, so climb milling keeps it. Each starts in the middle of its
    longest line, away from corners.

    Args:
        rings: rings at tool radius + stock to leave from the walls.
    """
    strokes = []
    for ring in rings:
        rows = ring.rows if direction is Direction.CLIMB else reversed_rows(ring.rows)
        size = lengths(rows) * np.where(rows[:, TURN] == 0, 1.0, 1e-3)
        rows = started_at(rows, int(np.argmax(size)), 0.5)
        strokes.append(Stroke(rows, np.full(len(rows), Purpose.CONTOUR, np.uint8), ring.region))
    return tuple(strokes)


def nearest_first(strokes: Sequence[Stroke], start: tuple[float, float] = (0.0, 0.0)) -> tuple[Stroke, ...]:
    """Return the strokes in an order of short rapids: always on to the one that begins nearest.

    Args:
        start: where the tool is before the first one, mm.
    """
    starts = np.array([stroke.start for stroke in strokes]).reshape(-1, 2)
    left = np.ones(len(strokes), np.bool_)
    at = np.array(start)
    order = []
    for _ in strokes:
        distance = np.where(left, np.hypot(*(starts - at).T), np.inf)
        k = int(np.argmin(distance))
        left[k] = False
        order.append(strokes[k])
        at = strokes[k].rows[-1, 2:4]
    return tuple(order)
