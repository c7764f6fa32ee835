"""An independent oracle: distance from points to contours in plain float64 numpy, every point against every curve."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

from app.model.curves import Arc, Circle, Line
from app.model.part import Contour


def distance(points: np.ndarray, contours: Iterable[Contour]) -> np.ndarray:
    """Distance of points (n, 2) from the nearest curve."""
    best = np.full(len(points), np.inf)
    for contour in contours:
        for curve in contour.primitives:
            best = np.minimum(best, _to_line(points, curve) if isinstance(curve, Line) else _to_arc(points, curve))
    return best


def _to_line(points: np.ndarray, line: Line) -> np.ndarray:
    a, b = np.array(line.start), np.array(line.end)
    t = np.clip(((points - a) @ (b - a)) / ((b - a) @ (b - a)), 0, 1)
    return np.linalg.norm(points - a - t[:, None] * (b - a), axis=1)


def _to_arc(points: np.ndarray, arc: Arc | Circle) -> np.ndarray:
    away = points - np.array(arc.centre)
    ring = np.abs(np.linalg.norm(away, axis=1) - arc.radius)
    if isinstance(arc, Circle):
        return ring
    first, last = (arc.start, arc.end) if arc.ccw else (arc.end, arc.start)
    angle = [math.atan2(p[1] - arc.centre[1], p[0] - arc.centre[0]) for p in (first, last)]
    within = (np.arctan2(away[:, 1], away[:, 0]) - angle[0]) % math.tau <= (angle[1] - angle[0]) % math.tau
    ends = np.minimum(*(np.linalg.norm(points - np.array(p), axis=1) for p in (first, last)))
    return np.where(within, ring, ends)


def inside(points: np.ndarray, contours: Iterable[Contour]) -> np.ndarray:
    """Even-odd inside by winding angle of finely sampled contours; wrong only within 0.01 mm of a curve."""
    odd = np.zeros(len(points), bool)
    for contour in contours:
        polygon = np.concatenate([_sampled(curve) for curve in contour.primitives])
        a, b = polygon, np.roll(polygon, -1, axis=0)
        for (ax, ay), (bx, by) in zip(a, b, strict=True):
            if ay != by:
                hit = (ay <= points[:, 1]) != (by <= points[:, 1])
                odd ^= hit & (ax + (points[:, 1] - ay) / (by - ay) * (bx - ax) < points[:, 0])
    return odd


def _sampled(curve: Line | Arc | Circle) -> np.ndarray:
    if isinstance(curve, Line):
        return np.array([curve.start])
    sweep = math.tau * (1 if curve.ccw else -1) if isinstance(curve, Circle) else curve.sweep
    start = 0.0 if isinstance(curve, Circle) else curve.start_angle
    t = start + sweep * np.arange(180) / 180
    return np.array(curve.centre) + curve.radius * np.stack([np.cos(t), np.sin(t)], 1)
