"""How far apart two paths are that are run in the same sense, however they are cut into motions."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from ...model.motion import Floats, Motions
from ...model.motion_path import ArcPaths, arc_paths, fine_spline_points

MOST_PIECES = 16_384
"""Chords that one arc or spline becomes at most."""
MOST_SAMPLES = 4000
"""Places along a path that are looked at, beside its own points, for the one farthest away."""
STRAY = 1e-3
"""How much nearer, in parts of the way to it, a place must be to be taken before one at about the same length: where a
path runs over itself both are as near.
"""
PORTION = 50_000
"""Points whose nearest places are looked for at once, so that memory stays small."""
WINDOW = 6
"""Pieces before and behind the one that lies at the same length, among which the nearest point is looked for."""


@dataclass(frozen=True)
class Polyline:
    """A path as straight pieces.

    Attributes:
        points: (k, 3) mm.
        owner: (k,) row of the motion that leads to each point; that of the first point is the first motion's.
        along: (k,) length of the path up to each point, mm.
    """

    points: Floats
    owner: NDArray[np.int64]
    along: Floats

    @staticmethod
    def through(points: Floats, owner: NDArray[np.int64]) -> Polyline:
        """Return the path through points."""
        steps = np.diff(points, axis=0)
        return Polyline(points, owner, np.concatenate([[0.0], np.cumsum(np.sqrt(np.einsum("ij,ij->i", steps, steps)))]))


class PolylinePaths:
    """The paths of a program's motions as straight pieces."""

    def __init__(self, motions: Motions, chord: float) -> None:
        """Make ready to cut paths into pieces.

        Args:
            motions: of a program.
            chord: largest distance of a piece from its arc or spline, mm; the finest become 16,384 pieces.
        """
        self._motions, self._arcs, self._chord = motions, arc_paths(motions), chord
        self._count = _pieces(self._arcs, chord)

    def polyline(self, first: int, stop: int) -> Polyline:
        """Return the path of motions `first` to `stop`, at least one, `stop` excluded."""
        motions, rows = self._motions, np.arange(first, stop)
        jumps = rows[1:][np.any(motions.start[rows[1:]] != motions.end[rows[:-1]], axis=1)]
        points = [motions.start[rows[:1]], motions.end[rows], motions.start[jumps]]
        owner, order = [rows[:1], rows, jumps], [np.array([first - 1.0]), rows + 1.0, jumps.astype(float)]
        for some, inner in self._inner_points(first, stop):
            count = inner.shape[1]
            points.append(inner.reshape(-1, 3))
            owner.append(np.repeat(some, count))
            order.append((some[:, None] + np.arange(1, count + 1) / (count + 1)).ravel())
        sequence = np.argsort(np.concatenate(order), kind="stable")
        return Polyline.through(np.concatenate(points)[sequence], np.concatenate(owner)[sequence])

    def _inner_points(self, first: int, stop: int) -> Iterator[tuple[NDArray[np.int64], Floats]]:
        """Yield rows and their (m, k, 3) points between the ends, of arcs and splines."""
        low, high = np.searchsorted(self._arcs.rows, (first, stop))
        mine = _chosen(self._arcs, slice(low, high))
        pieces = self._count[low:high]
        for count in np.unique(pieces[pieces > 1]).tolist():
            some = _chosen(mine, pieces == count)
            yield some.rows.astype(np.int64), some.points(np.arange(1, count) / count)
        for row, spline in self._motions.splines.items():
            if first <= row < stop:
                yield np.array([row]), fine_spline_points(spline, self._chord, MOST_PIECES)[None, 1:-1]


def _chosen(arcs: ArcPaths, which: NDArray[np.bool_] | slice) -> ArcPaths:
    return ArcPaths(**{each.name: getattr(arcs, each.name)[which] for each in fields(arcs)})


def _pieces(arcs: ArcPaths, chord: float) -> NDArray[np.int64]:
    """Return (m,) how many chords keep to an arc, as powers of two so that few different counts come."""
    radius = np.maximum(np.maximum(arcs.start_radius, arcs.end_radius), chord)
    exact = np.abs(arcs.sweep) / (2 * np.arccos(1 - chord / radius))
    return np.asarray(np.minimum(2 ** np.ceil(np.log2(np.maximum(exact, 1))), MOST_PIECES), np.int64)


def leash(a: Polyline, b: Polyline) -> float:
    """Return a length, mm, with which a leash between two points is long enough while each runs one path, never back.

    It is never less than the distance of the paths both ways, and it is the largest distance of the two points in one
    way of running them, the better of two: each point of b is reached when a is at the same share of its length, or at
    the nearest place of its own near there.
    """
    along_a, along_b = a.along, b.along
    if min(along_a[-1], along_b[-1]) == 0.0:
        return float(max(np.max(_distances(a.points, b.points[:1])), np.max(_distances(b.points, a.points[:1]))))
    expected = along_b / along_b[-1] * along_a[-1]
    return min(_leash_by(a, b, at) for at in (expected, _feet(b, expected, a, along_a)))


def _leash_by(a: Polyline, b: Polyline, at: Floats) -> float:
    """Return the length of the leash where each point of b is reached when a is at these lengths, or as far as it ever
    was.
    """
    at = np.maximum.accumulate(at)
    at[0], at[-1] = 0.0, a.along[-1]
    rise = at + np.arange(len(at)) * (1e-12 * a.along[-1])
    breaks = np.sort(np.concatenate([rise, np.minimum(a.along, rise[-1])]))
    on_b = np.column_stack([np.interp(breaks, rise, column) for column in b.points.T])
    on_a = np.column_stack([np.interp(breaks, a.along, column) for column in a.points.T])
    return float(np.sqrt(np.max(np.sum((on_a - on_b) ** 2, axis=1))))


def _feet(b: Polyline, expected: Floats, a: Polyline, along_a: Floats) -> Floats:
    """Return (k,) lengths along a of the points nearest to those of b, looked for near the expected lengths."""
    last = len(a.points) - 2
    steps = np.diff(a.points, axis=0)
    squared = np.sum(steps**2, axis=1)
    reach = min(WINDOW, last)
    offsets = np.arange(-reach, reach + 1)
    middle = np.clip(np.searchsorted(along_a, expected, side="right") - 1, 0, last)
    where = np.empty_like(expected)
    for first in range(0, len(expected), PORTION):
        rows = slice(first, first + PORTION)
        piece = np.clip(middle[rows, None] + offsets, 0, last)
        share, distance = _nearest(b.points[rows, None], a.points[piece], steps[piece], squared[piece])
        at = along_a[piece] + share * np.sqrt(squared[piece])
        best = np.argmin(distance + STRAY * np.abs(at - expected[rows, None]), axis=1)[:, None]
        where[rows] = np.take_along_axis(at, best, axis=1)[:, 0]
    return where


def _nearest(points: Floats, starts: Floats, steps: Floats, squared: Floats) -> tuple[Floats, Floats]:
    """Return where on straight pieces the points beside them are nearest, as a part of the piece, and how far they are,
    mm.
    """
    share = np.clip(np.sum((points - starts) * steps, axis=-1) / np.where(squared > 0, squared, 1.0), 0.0, 1.0)
    return share, np.sqrt(np.sum((starts + share[..., None] * steps - points) ** 2, axis=-1))


def _distances(points: Floats, place: Floats) -> Floats:
    return np.asarray(np.sqrt(np.sum((points - place) ** 2, axis=1)))


@dataclass(frozen=True, slots=True)
class LargestDistance:
    """The largest distance between two paths, both ways: how far, mm, and where on the one and on the other."""

    distance: float
    a: tuple[float, float, float]
    b: tuple[float, float, float]


def farthest(a: Polyline, b: Polyline) -> LargestDistance:
    """Return where two paths are farthest apart: the point of either that lies farthest from the other path.

    Looked at are the points of both, and places evenly along each, 16 a piece but not more than 4000; between two of
    these the distance is not more than half their spacing larger.
    """
    dense_a, dense_b = (_dense(path, min(MOST_SAMPLES, 16 * len(path.points))) for path in (a, b))
    from_a, from_b = _one_way(dense_a, dense_b), _one_way(dense_b, dense_a)
    if from_a.distance >= from_b.distance:
        return from_a
    return LargestDistance(from_b.distance, from_b.b, from_b.a)


def _dense(path: Polyline, samples: int) -> Floats:
    """Return points of a path: its own, and so many more along it."""
    at = np.union1d(path.along, np.linspace(0.0, path.along[-1], samples))
    return np.column_stack([np.interp(at, path.along, column) for column in path.points.T])


def _one_way(a: Floats, b: Floats) -> LargestDistance:
    """Return the point of a that is farthest from the pieces of b."""
    from scipy.spatial import cKDTree

    _, nearest = cKDTree(b).query(a)
    best, foot = np.full(len(a), np.inf), np.empty_like(a)
    for first in (np.maximum(nearest - 1, 0), np.minimum(nearest, max(len(b) - 2, 0))):
        steps = b[np.minimum(first + 1, len(b) - 1)] - b[first]
        share, distance = _nearest(a, b[first], steps, np.sum(steps**2, axis=1))
        foot = np.where((distance < best)[:, None], b[first] + share[:, None] * steps, foot)
        best = np.minimum(distance, best)
    row = int(np.argmax(best))
    return LargestDistance(float(best[row]), _place(a[row]), _place(foot[row]))


def _place(point: Floats) -> tuple[float, float, float]:
    x, y, z = point.tolist()
    return x, y, z
