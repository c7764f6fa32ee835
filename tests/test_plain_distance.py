"""What measures for other tests measures what it says: against each point and each curve by itself."""

from __future__ import annotations

import math

import numpy as np
import pytest

from app.model.curves import Arc, Circle, Line
from app.model.part import Contour
from tests import plain_distance
from tests.part_shapes import random_part
from tests.rough_parts import rough_part


def one_distance(point: np.ndarray, curve: Line | Arc | Circle) -> float:
    if isinstance(curve, Line):
        a, b = np.array(curve.start), np.array(curve.end)
        t = min(max(float((point - a) @ (b - a)) / float((b - a) @ (b - a)), 0.0), 1.0)
        return math.dist(point, a + t * (b - a))
    away = point - np.array(curve.centre)
    ring = abs(math.hypot(*away) - curve.radius)
    if isinstance(curve, Circle):
        return ring
    first, last = (curve.start, curve.end) if curve.ccw else (curve.end, curve.start)
    angles = [math.atan2(p[1] - curve.centre[1], p[0] - curve.centre[0]) for p in (first, last)]
    if (math.atan2(away[1], away[0]) - angles[0]) % math.tau <= (angles[1] - angles[0]) % math.tau:
        return ring
    return min(math.dist(point, p) for p in (first, last))


def is_inside(point: np.ndarray, contours: list[Contour]) -> bool:
    odd = False
    for contour in contours:
        polygon = np.concatenate([plain_distance._sampled(curve) for curve in contour.primitives])
        for (ax, ay), (bx, by) in zip(polygon, np.roll(polygon, -1, axis=0), strict=True):
            if (ay <= point[1]) != (by <= point[1]):
                odd ^= bool(ax + (point[1] - ay) / (by - ay) * (bx - ax) < point[0])
    return odd


@pytest.mark.parametrize(
    "contours", [random_part(3)[0], random_part(8)[0], rough_part(1), rough_part(4), rough_part(9)]
)
def test_all_at_once_is_one_by_one(contours: list[Contour]) -> None:
    rng = np.random.default_rng(5)
    corners = np.array([curve.start for each in contours for curve in each.primitives if not isinstance(curve, Circle)])
    corners = np.concatenate([corners.reshape(-1, 2), [[0.0, 0.0], [30.0, 30.0]]])
    points = np.concatenate([rng.uniform(corners.min(axis=0) - 2, corners.max(axis=0) + 2, (300, 2)), corners[:50]])
    curves = [curve for contour in contours for curve in contour.primitives]
    expected = [min(one_distance(point, curve) for curve in curves) for point in points]
    assert plain_distance.distance(points, contours) == pytest.approx(expected, abs=1e-12)
    chosen = points[::7]
    assert plain_distance.inside(chosen, contours).tolist() == [is_inside(point, contours) for point in chosen]


def test_nothing_is_far_from_everything() -> None:
    assert plain_distance.distance(np.zeros((2, 2)), []).tolist() == [math.inf] * 2
    assert plain_distance.distance(np.zeros((0, 2)), [Contour((Circle((0, 0), 1),))]).tolist() == []
