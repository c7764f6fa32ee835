"""A path in the pieces that the engine sweeps: straight ones, and level arcs of at most a quarter turn.

Level arcs of the XY plane stay arcs. Helices, arcs of the other planes and splines become chords that keep within
`CHORD` of them, point by point: between its ends a curve leaves its chord, run at even parameter, by at most
max |second derivative| / 8, which for an arc of radius A, turn w and change of radius g in n chords is (A w² + 2 g w) / (8 n²).
A cut height is then off by at most CHORD (1 + slope of the surface).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.model.motion import Floats, MotionKind, Motions, Nurbs
from app.model.motion_path import ArcPaths, arc_paths, spline_points

CHORD = 1e-6
"""mm."""

QUARTER = math.pi / 2

Ints = NDArray[np.int32]


@dataclass(frozen=True, eq=False)
class Pieces:
    """n pieces in the order of cutting.

    Attributes:
        start, end: (n, 3) mm; of an arc so that it is counter-clockwise.
        motion: (n,) row of the motion that each belongs to.
        arc: (n,) row of `arcs`, -1 for straight ones.
        arcs: (m, 7) centre x, y, radius, and the box low x, low y, high x, high y, mm.
    """

    start: Floats
    end: Floats
    motion: Ints
    arc: Ints
    arcs: Floats

    def __len__(self) -> int:
        return len(self.motion)


class Splitter:
    """The pieces of motions, any part of them at a time."""

    def __init__(self, motions: Motions, arcs_stay: bool = True) -> None:
        """Prepare to split; with `arcs_stay` False level arcs become chords too."""
        self._motions = motions
        self._arcs = arc_paths(motions)
        self._level = _is_level(motions, self._arcs) & arcs_stay
        self._turns = _arc_counts(self._arcs, self._level)
        self.counts = np.ones(len(motions), np.int64)
        """How many pieces each motion has."""
        self.counts[self._arcs.rows] = self._turns
        for row, spline in motions.splines.items():
            self.counts[row] = spline_chords(spline)

    def pieces(self, first: int, last: int) -> Pieces:
        """Return the pieces of the motions first … last - 1."""
        motions, counts = self._motions, self.counts[first:last]
        start, end = motions.start[first:last], motions.end[first:last]
        rows = np.arange(first, last, dtype=np.int32)
        curved = np.flatnonzero(motions.kind[first:last] >= MotionKind.ARC_CW)
        if not len(curved):
            return Pieces(start, end, rows, np.full(last - first, -1, np.int32), np.zeros((0, 7)))
        at = np.cumsum(counts) - counts
        start, end, rows = np.repeat(start, counts, axis=0), np.repeat(end, counts, axis=0), np.repeat(rows, counts)
        mine = slice(*np.searchsorted(self._arcs.rows, [first, last]))
        level = np.flatnonzero(self._level[mine]) + mine.start
        arc, own = np.full(len(rows), -1, np.int32), self._arcs.rows[level] - first
        places = np.repeat(at[own], counts[own]) + _counted(counts[own])
        start[places], end[places], table = _level_arcs(self._arcs, np.repeat(level, counts[own]), counts[own])
        arc[places] = np.arange(len(places))
        for row in np.setdiff1d(curved, own):
            part = slice(int(at[row]), int(at[row] + counts[row]))
            points = self._points(first + int(row), int(counts[row]))
            start[part], end[part] = points[:-1], points[1:]
        return Pieces(start, end, rows, arc, table)

    def _points(self, row: int, count: int) -> Floats:
        """Return the ends of the chords of a motion that is no level arc."""
        motions = self._motions
        if row in motions.splines:
            return spline_points(motions.splines[row], count + 1)
        points = _places(self._arcs, int(np.searchsorted(self._arcs.rows, row)), np.linspace(0.0, 1.0, count + 1))
        points[0], points[-1] = motions.start[row], motions.end[row]
        return points


def _counted(sizes: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return 0 … size - 1 for each size, one after the other."""
    return np.arange(sizes.sum()) - np.repeat(np.cumsum(sizes) - sizes, sizes)


def _is_level(motions: Motions, arcs: ArcPaths) -> NDArray[np.bool_]:
    """Return which arcs are better swept as level arcs of mean radii than by chords."""
    level = (arcs.axes[:, 2] == 2) & (motions.start[arcs.rows, 2] == motions.end[arcs.rows, 2])
    return np.asarray(level & (_level_counts(arcs) <= _chord_counts(arcs)))


def _level_counts(arcs: ArcPaths) -> NDArray[np.int64]:
    """Return in how many level arcs each falls: at most a quarter turn, and the radius within CHORD of its own."""
    return np.asarray(np.maximum(
        np.ceil(np.abs(arcs.sweep) / QUARTER - 1e-9), np.ceil(np.abs(arcs.end_radius - arcs.start_radius) / (2 * CHORD) - 1e-3),
    ).clip(1), dtype=np.int64)  # fmt: skip


def _chord_counts(arcs: ArcPaths) -> NDArray[np.int64]:
    """Return in how many chords each falls."""
    turn, grow = np.abs(arcs.sweep), np.abs(arcs.end_radius - arcs.start_radius)
    bend = np.maximum(arcs.start_radius, arcs.end_radius) * turn**2 + 2 * grow * turn
    return np.asarray(np.ceil(np.sqrt(bend / (8 * CHORD))).clip(1), dtype=np.int64)


def _arc_counts(arcs: ArcPaths, level: NDArray[np.bool_]) -> NDArray[np.int64]:
    return np.where(level, _level_counts(arcs), _chord_counts(arcs))


def _places(arcs: ArcPaths, k: int, fractions: Floats) -> Floats:
    """Return (n, 3) places of arc k."""
    angle = arcs.angle[k] + arcs.sweep[k] * fractions
    radius = arcs.start_radius[k] + (arcs.end_radius[k] - arcs.start_radius[k]) * fractions
    places = np.empty((len(fractions), 3))
    places[:, arcs.axes[k]] = np.column_stack([
        arcs.centre[k, 0] + radius * np.cos(angle), arcs.centre[k, 1] + radius * np.sin(angle), arcs.height[k] + arcs.rise[k] * fractions,
    ])  # fmt: skip
    return places


def _level_arcs(arcs: ArcPaths, k: NDArray[np.int64], sizes: NDArray[np.int64]) -> tuple[Floats, Floats, Floats]:
    """Return starts, ends and rows of the n level arcs that some arcs fall into.

    Args:
        k: (n,) the arc that each belongs to, those of one arc one after the other. sizes: how many each arc falls into.
    """
    count, at = np.repeat(sizes, sizes), _counted(sizes)
    angles = [arcs.angle[k] + arcs.sweep[k] * (each / count) for each in (at, at + 1)]
    radius = arcs.start_radius[k] + (arcs.end_radius[k] - arcs.start_radius[k]) * ((at + 0.5) / count)
    cx, cy, height = arcs.centre[k, 0], arcs.centre[k, 1], arcs.height[k]
    ends = [np.column_stack([cx + radius * np.cos(a), cy + radius * np.sin(a), height]) for a in angles]
    low, high = np.minimum(*angles), np.maximum(*angles)
    box = [fold(ends[0][:, axis], ends[1][:, axis]) for fold in (np.minimum, np.maximum) for axis in (0, 1)]
    for quarter, side, edge in ((0, 2, cx + radius), (1, 3, cy + radius), (2, 0, cx - radius), (3, 1, cy - radius)):
        passed = (quarter * QUARTER - low) % (2 * math.pi) <= high - low
        box[side] = np.where(passed, edge, box[side])
    rows = np.column_stack([cx, cy, radius, *box])
    ccw = (arcs.sweep[k] > 0)[:, None]
    return np.where(ccw, ends[0], ends[1]), np.where(ccw, ends[1], ends[0]), rows


def spline_chords(spline: Nurbs) -> int:
    """Return in how many chords, even in the parameter, a spline falls.

    Doubled until no middle of a parameter step is farther than a quarter of CHORD from its chord's; the error falls
    by four with each doubling, so this is met well, though it is measured and not proven.
    """
    count = 2 * len(spline.knots)
    while count < 1 << 20:
        places = spline_points(spline, 2 * count + 1)
        off = places[1::2] - (places[:-1:2] + places[2::2]) / 2
        if np.max(np.einsum("ij,ij->i", off, off)) <= (CHORD / 4) ** 2:
            break
        count *= 2
    return count
