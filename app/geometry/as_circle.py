"""Which closed contours are circles: drawn as one, by arcs, or by many short chords as other programs write them."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ..core.tolerances import CURVE
from ..model.curves import Circle, Line
from ..model.part import Contour
from .primitives import TURN, contour_rows, points_at

LEAST_CHORDS = 12
"""Chords of a polygon that is a circle, and the share of a turn that none may exceed: a hexagon or an octagon is meant
as one.
"""

ROUNDED = 0.01
"""mm; the corners of such a polygon may lie off its circle by this, and by no more than 1 % of the radius: written with
2 decimals.
"""

_UNEVEN = 1.5
"""Times the middle chord's angle that no chord may exceed: a longer one is a flat on a shaft."""


def as_circle(contour: Contour) -> Circle | None:
    """Return the circle that a closed contour is, None where it is none.

    Ends and middles of arcs may lie off it by as much as curves may when they become arcs. A polygon's circle goes
    through its corners, as programs write it that turn circles into chords. Arcs mixed with lines are none.
    """
    curves = contour.primitives
    if not contour.closed:
        return None
    if len(curves) == 1 and isinstance(curves[0], Circle):
        return curves[0]
    if len(curves) < LEAST_CHORDS and any(isinstance(curve, Line) for curve in curves):
        return None
    rows = contour_rows(contour)
    lines = rows[:, TURN] == 0
    if lines.any() != lines.all():
        return None
    points = (
        rows[:, :2]
        if lines.all()
        else np.stack([rows[:, :2], points_at(rows, np.full(len(rows), 0.5))], axis=1).reshape(-1, 2)
    )
    centre, radius = _fit(points)
    off = float(np.abs(np.hypot(*(points - centre).T) - radius).max())
    if off > (min(ROUNDED, radius / 100) if lines.all() else CURVE) or not _goes_round(
        points - centre, bool(lines.all())
    ):
        return None
    return Circle((float(centre[0]), float(centre[1])), radius)


def _fit(points: NDArray[np.float64]) -> tuple[NDArray[np.float64], float]:
    """Return centre and radius of the circle with the least squares of x^2 + y^2 - 2 a x - 2 b y - c; unbiased all
    round.
    """
    middle = points.mean(axis=0)
    x, y = (points - middle).T
    a, b, c = np.linalg.lstsq(np.column_stack([2 * x, 2 * y, np.ones(len(x))]), x * x + y * y, rcond=None)[0].tolist()
    return middle + (a, b), math.sqrt(max(a * a + b * b + c, 0.0))


def _goes_round(arms: NDArray[np.float64], chords: bool) -> bool:
    """Tell whether points, as seen from the centre, go round it once and never back, and chords between them are short
    and even.
    """
    after = np.roll(arms, -1, axis=0)
    step = np.arctan2(arms[:, 0] * after[:, 1] - arms[:, 1] * after[:, 0], np.sum(arms * after, axis=1))
    step = step if step.sum() > 0 else -step
    if step.min() <= 0 or abs(float(step.sum()) - math.tau) > 1e-6:
        return False
    longest = float(step.max())
    return not chords or (longest <= 1.01 * math.tau / LEAST_CHORDS and longest <= _UNEVEN * float(np.median(step)))
