"""An independent oracle: distance from points to contours in plain float64 numpy, every point against every curve that
can be its nearest.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from app.model.curves import Arc, Circle, Line
from app.model.part import Contour

BLOCK = 64
"""Points that lie together and are looked at together."""


@dataclass(frozen=True)
class _Curves:
    """Lines and arcs as columns.

    Attributes:
        a, b: (m, 2) ends of the lines.
        centres, radii: (n, 2), (n,) of the arcs. first, last: (n, 2) their ends, counter-clockwise; begins, sweeps:
            (n,) angles, a turn for a circle.
    """

    a: np.ndarray
    b: np.ndarray
    centres: np.ndarray
    radii: np.ndarray
    first: np.ndarray
    last: np.ndarray
    begins: np.ndarray
    sweeps: np.ndarray

    @staticmethod
    def of(contours: Iterable[Contour]) -> _Curves:
        curves = [curve for contour in contours for curve in contour.primitives]
        lines = np.array([(c.start, c.end) for c in curves if isinstance(c, Line)]).reshape(-1, 2, 2)
        arcs = [c for c in curves if not isinstance(c, Line)]
        ends = np.array([_ends(c) for c in arcs]).reshape(-1, 2, 2)
        centres = np.array([c.centre for c in arcs]).reshape(-1, 2)
        away = ends - centres[:, None]
        angles = np.arctan2(away[:, :, 1], away[:, :, 0])
        whole = np.array([isinstance(c, Circle) for c in arcs], bool)
        sweeps = np.where(whole, math.tau, (angles[:, 1] - angles[:, 0]) % math.tau)
        radii = np.array([c.radius for c in arcs])
        return _Curves(lines[:, 0], lines[:, 1], centres, radii, ends[:, 0], ends[:, 1], angles[:, 0], sweeps)

    def distances(self, points: np.ndarray) -> np.ndarray:
        """Return the distance of each point (n, 2) from each curve, lines first."""
        return np.concatenate([_to_lines(points, self), _to_arcs(points, self)], axis=1)

    def some(self, chosen: np.ndarray) -> _Curves:
        """Return those that are chosen, by whether, lines first."""
        lines, arcs = chosen[: len(self.a)], chosen[len(self.a) :]
        return _Curves(
            self.a[lines],
            self.b[lines],
            self.centres[arcs],
            self.radii[arcs],
            self.first[arcs],
            self.last[arcs],
            self.begins[arcs],
            self.sweeps[arcs],
        )


def _ends(arc: Arc | Circle) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return the ends of an arc, counter-clockwise."""
    if isinstance(arc, Circle):
        return (arc.centre[0] + arc.radius, arc.centre[1]), (arc.centre[0] + arc.radius, arc.centre[1])
    return (arc.start, arc.end) if arc.ccw else (arc.end, arc.start)


def distance(points: np.ndarray, contours: Iterable[Contour]) -> np.ndarray:
    """Distance of points (n, 2) from the nearest curve.

    A curve that is farther from the middle of some points than another one by more than twice what they are from it
    is the nearest of none of them.
    """
    curves, best = _Curves.of(contours), np.full(len(points), np.inf)
    blocks = list(_blocks(points))
    if not len(curves.a) + len(curves.radii) or not blocks:
        return best
    middles = np.array([points[block].mean(axis=0) for block in blocks])
    spans = np.array([_length(points[block] - middle).max() for block, middle in zip(blocks, middles, strict=True)])
    from_middles = curves.distances(middles)
    near = from_middles <= from_middles.min(axis=1, keepdims=True) + 2 * spans[:, None] + 1e-6
    for block, chosen in zip(blocks, near, strict=True):
        best[block] = curves.some(chosen).distances(points[block]).min(axis=1)
    return best


def _blocks(points: np.ndarray) -> Iterator[np.ndarray]:
    """Yield indices of points that lie together: strips along X, each cut along Y."""
    strip = max(BLOCK, math.isqrt(len(points) * BLOCK))
    order = np.argsort(points[:, 0], kind="stable")
    for first in range(0, len(order), strip):
        along = order[first : first + strip]
        along = along[np.argsort(points[along, 1], kind="stable")]
        yield from (along[k : k + BLOCK] for k in range(0, len(along), BLOCK))


def _length(vectors: np.ndarray) -> np.ndarray:
    x, y = vectors[..., 0], vectors[..., 1]
    return np.sqrt(x * x + y * y)


def _to_lines(points: np.ndarray, curves: _Curves) -> np.ndarray:
    wide, high = (curves.b - curves.a).T
    x, y = points[:, :1] - curves.a[:, 0], points[:, 1:] - curves.a[:, 1]
    t = np.clip((x * wide + y * high) / (wide * wide + high * high), 0, 1)
    x, y = x - t * wide, y - t * high
    return np.sqrt(x * x + y * y)


def _to_arcs(points: np.ndarray, curves: _Curves) -> np.ndarray:
    away = points[:, None] - curves.centres
    ring = np.abs(_length(away) - curves.radii)
    within = (np.arctan2(away[:, :, 1], away[:, :, 0]) - curves.begins) % math.tau <= curves.sweeps
    ends = np.minimum(*(_length(points[:, None] - end) for end in (curves.first, curves.last)))
    return np.where(within, ring, ends)


def inside(points: np.ndarray, contours: Iterable[Contour]) -> np.ndarray:
    """Even-odd inside by winding angle of finely sampled contours; wrong only within 0.01 mm of a curve."""
    order = np.argsort(points[:, 1], kind="stable")
    x, y = points[order, 0], points[order, 1]
    crossed = np.zeros(len(points), np.int64)
    for contour in contours:
        polygon = np.concatenate([_sampled(curve) for curve in contour.primitives])
        a, b = polygon, np.roll(polygon, -1, axis=0)
        # of the points in order of Y those that are as high as an edge: not below its lower end, and below its upper
        first, last = np.searchsorted(y, [np.minimum(a[:, 1], b[:, 1]), np.maximum(a[:, 1], b[:, 1])])
        counts = np.maximum(last - first, 0)
        edge = np.repeat(np.arange(len(a)), counts)
        point = np.arange(len(edge)) + np.repeat(first - np.cumsum(counts) + counts, counts)
        (ax, ay), (wide, high) = a[edge].T, (b - a)[edge].T
        left = ax + (y[point] - ay) / high * wide < x[point]
        crossed += np.bincount(point[left], minlength=len(points))
    result = np.empty(len(points), bool)
    result[order] = crossed % 2 == 1
    return result


def _sampled(curve: Line | Arc | Circle) -> np.ndarray:
    if isinstance(curve, Line):
        return np.array([curve.start])
    sweep = math.tau * (1 if curve.ccw else -1) if isinstance(curve, Circle) else curve.sweep
    start = 0.0 if isinstance(curve, Circle) else curve.start_angle
    t = start + sweep * np.arange(180) / 180
    return np.array(curve.centre) + curve.radius * np.stack([np.cos(t), np.sin(t)], 1)
