"""Bridges between rings: where the tool can go from one ring to the next without touching a wall."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import Delaunay, QhullError

from app import tolerances
from app.geometry.distance import DistanceField
from app.geometry.offset import Level, Ring
from app.geometry.primitives import Rows, lengths, points_at


@dataclass(frozen=True)
class Place:
    """A point of a ring: fraction in [0, 1] of one of its rows."""

    ring: int
    row: int
    fraction: float


@dataclass(frozen=True)
class Bridge:
    """A straight way between two rings that keeps the outermost frame's distance from all walls.

    Attributes:
        a, b: its ends.
        length: mm.
    """

    a: Place
    b: Place
    length: float


def inward_bridges(levels: Sequence[Level], field: DistanceField) -> list[Bridge]:
    """Return bridges from every ring to rings of the level before.

    From any point of a level the way towards its nearest point on the drawing keeps the distance rule by
    construction: distance falls by exactly the length gone. So each bridge is as long as the levels are apart.

    Args:
        levels: the pocket's levels, outermost first; rings are numbered through them in order.
        field: distances from the drawing.
    """
    bridges: list[Bridge] = []
    first = 0
    for outer, inner in pairwise(levels):
        if not inner.rings:
            break
        target = _Target.of(outer.rings, first)
        first += len(outer.rings)
        for number, ring in enumerate(inner.rings, first):
            bridges.extend(_from_ring(ring, number, target, field, inner.distance - outer.distance))
    return bridges


@dataclass(frozen=True)
class _Target:
    """All rows of one level, and which ring each belongs to."""

    field: DistanceField
    ring: np.ndarray
    row: np.ndarray

    @staticmethod
    def of(rings: Sequence[Ring], first: int) -> _Target:
        return _Target(DistanceField.of(np.concatenate([r.rows for r in rings])),
                       np.repeat(np.arange(first, first + len(rings)), [len(r.rows) for r in rings]),
                       np.concatenate([np.arange(len(r.rows)) for r in rings]))


def _from_ring(ring: Ring, number: int, target: _Target, field: DistanceField, step: float) -> list[Bridge]:
    """Return the best bridge from a ring to each ring of the level before that it can reach."""
    size = lengths(ring.rows)
    order = np.argsort(-size)[:64]
    points = points_at(ring.rows[order], np.full(len(order), 0.5))
    distance, nearest = field.nearest(points)
    feet = foot(field.rows[nearest], points)
    arrived = points + (feet - points) * (step / distance)[:, None]
    off, rows = target.field.nearest(arrived)
    best: dict[int, Bridge] = {}
    for k in range(len(order)):
        other = int(target.ring[rows[k]])
        if off[k] > tolerances.LEVEL or other in best:
            continue
        at = fraction_at(target.field.rows[rows[k]], arrived[k])
        best[other] = Bridge(Place(number, int(order[k]), 0.5), Place(other, int(target.row[rows[k]]), at), step)
    return list(best.values())


def foot(rows: Rows, points: np.ndarray) -> np.ndarray:
    """Return the point of each row (n, 8) nearest to each point (n, 2)."""
    return points_at(rows, np.array([fraction_at(row, point) for row, point in zip(rows, points, strict=True)]))


def fraction_at(row: Rows, point: np.ndarray) -> float:
    """Return the fraction in [0, 1] of a row's length that is nearest to a point."""
    if row[7] == 0:
        along = row[2:4] - row[:2]
        return float(np.clip((point - row[:2]) @ along / (along @ along), 0, 1))
    start = np.arctan2(row[1] - row[5], row[0] - row[4])
    sweep = (np.arctan2(row[3] - row[5], row[2] - row[4]) - start) * row[7] % (2 * np.pi)
    turn = (np.arctan2(point[1] - row[5], point[0] - row[4]) - start) * row[7] % (2 * np.pi)
    if turn <= sweep:
        return float(turn / sweep)
    return 1.0 if turn - sweep < 2 * np.pi - turn else 0.0


def level_bridges(rings: Sequence[Ring], groups: Sequence[int], spacing: float,
                  most: int | None = None) -> Iterator[tuple[Bridge, NDArray[np.float64]]]:
    """Yield candidates between rings of the outermost level with their ends (2, 2), shortest first; clearance is not checked.

    The shortest tree through all rings is part of the Delaunay triangulation of points along them.

    Args:
        rings: the outermost level's rings, numbered from 0.
        groups: what is already joined has the same number.
        spacing: between points, mm.
        most: candidates between any two rings, the shortest; None = all.
    """
    rows = np.concatenate([r.rows for r in rings])
    owner = np.repeat(np.arange(len(rings)), [len(r.rows) for r in rings])
    number = np.concatenate([np.arange(len(r.rows)) for r in rings])
    counts = np.maximum(1, np.ceil(lengths(rows) / spacing)).astype(np.int64)
    row = np.repeat(np.arange(len(rows)), counts)
    part = (np.arange(len(row)) - np.repeat(np.cumsum(counts) - counts, counts) + 0.5) / counts[row]
    points = points_at(rows[row], part)
    try:
        corners = Delaunay(points).simplices
    except (QhullError, ValueError):  # fewer than three points, or all on a line
        return
    edges = np.sort(np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]]), axis=1)
    ring = owner[row]
    group, region = np.array(groups)[ring], np.array([r.region for r in rings])[ring]
    apart = (group[edges[:, 0]] != group[edges[:, 1]]) & (region[edges[:, 0]] == region[edges[:, 1]])
    edges = np.unique(edges[apart], axis=0)
    size = np.hypot(*(points[edges[:, 0]] - points[edges[:, 1]]).T)
    order = np.argsort(size, kind="stable")
    if most is not None:
        order = order[_rank(ring[edges[order]].min(axis=1) * len(rings) + ring[edges[order]].max(axis=1)) < most]
    for k in order:
        a, b = (Place(int(ring[i]), int(number[row[i]]), float(part[i])) for i in edges[k])
        yield Bridge(a, b, float(size[k])), points[edges[k]]


def _rank(keys: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return how many equal keys come before each."""
    order = np.argsort(keys, kind="stable")
    first = np.flatnonzero(np.concatenate([[True], np.diff(keys[order]) != 0])) if len(keys) else np.zeros(0, np.int64)
    ranks = np.empty(len(keys), np.int64)
    ranks[order] = np.arange(len(keys)) - np.repeat(first, np.diff(np.append(first, len(keys))))
    return ranks


def is_clear(field: DistanceField, a: np.ndarray, b: np.ndarray, distance: float) -> bool:
    """Tell whether the straight way from a to b stays at least `distance` - 1 um from the drawing.

    Distance changes by no more than the length gone, so a step of (measured - needed) cannot pass a wall unseen.
    """
    length = float(np.hypot(*(b - a)))
    at = 0.0
    while at < length:
        spare = float(field.nearest((a + (b - a) * (at / length))[None])[0][0]) - distance
        if spare < -tolerances.LEVEL / 2:
            return False
        at += max(spare, tolerances.LEVEL)
    return True
