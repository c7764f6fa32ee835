"""A path in the pieces that the engine sweeps: straight ones, and level arcs of at most a quarter turn.

Level arcs of the XY plane stay arcs. Helices and arcs of the other planes become chords that keep within `CHORD` of
them (or as near as the caller wants), point by point: between its ends a curve leaves its chord, run at even parameter,
by at most max |second derivative| / 8, which for an arc of radius A, turn w and change of radius g in n chords is (A w²
+ 2 g w) / (8 n²). Splines become chords within `CHORD` of the hulls of their Bézier pieces (`app.geometry.arcs.nurbs`).
A cut height is then off by at most CHORD (1 + slope of the surface). Helices may be given chords that are farther off,
where a grid is no finer (`helix_chord`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ...core.pool import pool
from ...geometry.arcs.nurbs import flattened_all
from ...model.motion import Floats, MotionKind, Motions
from ...model.motion_path import ArcPaths, along_xyz, arc_paths

CHORD = 1e-6
"""mm."""

HELIX_CHORD = 1e-3
"""mm, of chords of helices where cells are asked alone, and never more than a thousandth of a cell: ten to thirty times
fewer chords.
"""

QUARTER = math.pi / 2
"""Radians; a longer level arc is swept in parts."""

_BANDS, _WORTH_TWO_CORES = 4, 20_000
"""Bands that motions are split in, and pieces from which that is worth it."""

Ints = NDArray[np.int32]


@dataclass(frozen=True, eq=False)
class SweepPieces:
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


@dataclass(frozen=True, eq=False)
class SweepWindow:
    """Where pieces matter.

    Attributes:
        box: low x, low y, high x, high y, mm.
        radius: (n,) of what goes along each motion, mm; negative infinite where nothing does.
    """

    box: tuple[float, float, float, float]
    radius: Floats

    def misses(self, rows: NDArray[np.intp], low: Floats, high: Floats) -> NDArray[np.bool_]:
        """Return which motions surely stay off; low and high (m, 3) are the corners of their boxes."""
        radius = self.radius[rows] + CHORD
        x0, y0, x1, y1 = self.box
        beside = (low[:, 0] - radius > x1) | (low[:, 1] - radius > y1) | (high[:, 0] + radius < x0)
        return np.asarray(beside | (high[:, 1] + radius < y0))


class PieceSplitter:
    """The pieces of motions, any part of them at a time."""

    def __init__(
        self,
        motions: Motions,
        arcs_stay: bool = True,
        window: SweepWindow | None = None,
        chord: float = CHORD,
        helix_chord: float = 0.0,
    ) -> None:
        """Prepare to split.

        Args:
            motions: n motions.
            arcs_stay: False: level arcs become chords too.
            window: of curves off it that fall into chords only the first and the last chord are made: neighbours need
                no more.
            chord: how far at most chords are from their curves, mm, > 0.
            helix_chord: the same of helices of the XY plane, where it is more: at even parameter their height is linear
                along curve and chord, so that they are off in X and Y alone.
        """
        self._motions = motions
        self._arcs = arc_paths(motions)
        self._level = _is_level(motions, self._arcs, chord) & arcs_stay
        self._arc = np.full(len(motions), -1)
        self._arc[self._arcs.rows] = np.arange(len(self._arcs))
        splines = motions.splines
        self._splines = dict(zip(splines, flattened_all(list(splines.values()), chord), strict=True)) if splines else {}
        self._table = _table(self._arcs, self._level)
        self._levelled = np.zeros(len(motions), np.bool_)
        self._levelled[self._arcs.rows] = self._level
        self._whole = np.ones(len(motions), np.int64)
        self._whole[self._arcs.rows] = _arc_counts(self._arcs, self._level, _chords(self._arcs, chord, helix_chord))
        for row, points in self._splines.items():
            self._whole[row] = len(points) - 1
        self.counts = self._whole.copy()
        """How many pieces each motion has."""
        if window is not None:
            slack = max(chord, helix_chord) - CHORD
            for rows, low, high in (self._reach_of_chords(), self._reach_of_splines()):
                off = rows[window.misses(rows, low - slack, high + slack)]
                self.counts[off] = np.minimum(self._whole[off], 2)

    def _reach_of_chords(self) -> tuple[NDArray[np.intp], Floats, Floats]:
        """Return the rows of arcs in chords, and the lowest and highest coordinates (m, 3) that they can have, mm."""
        arcs = self._arcs
        size = np.maximum(arcs.start_radius, arcs.end_radius)[:, None]
        ends = np.stack([arcs.height, arcs.height + arcs.rise], axis=1)
        low, high = (
            along_xyz(np.column_stack([arcs.centre + sign * size, side(ends, axis=1)]), arcs.axes)
            for sign, side in ((-1.0, np.min), (1.0, np.max))
        )
        return arcs.rows[~self._level], low[~self._level], high[~self._level]

    def _reach_of_splines(self) -> tuple[NDArray[np.intp], Floats, Floats]:
        """Return the rows of splines, and the lowest and highest coordinates (m, 3) of their chords, mm."""
        low, high = (
            np.array([side(points, axis=0) for points in self._splines.values()]).reshape(-1, 3)
            for side in (np.min, np.max)
        )
        return np.array(list(self._splines), np.intp), low, high

    def pieces(self, first: int, last: int) -> SweepPieces:
        """Return the pieces of the motions first … last - 1."""
        motions = self._motions
        rows = np.arange(first, last, dtype=np.int32)
        if not np.any(motions.kind[first:last] >= MotionKind.ARC_CW):
            return SweepPieces(
                motions.start[first:last],
                motions.end[first:last],
                rows,
                np.full(len(rows), -1, np.int32),
                np.zeros((0, 7)),
            )
        return self._split(first, last)

    def _split(self, first: int, last: int) -> SweepPieces:
        from .piece_kernels import split  # compiled: loaded where it is used

        counts = self.counts[first:last]
        levels = np.where(self._levelled[first:last], counts, 0)
        total, rows = int(counts.sum()), int(levels.sum())
        found = SweepPieces(
            np.empty((total, 3)),
            np.empty((total, 3)),
            np.empty(total, np.int32),
            np.empty(total, np.int32),
            np.empty((rows, 7)),
        )
        ends, asked = np.cumsum(counts), slice(first, last)
        before = [ends - counts, np.cumsum(levels) - levels]
        given = (self._motions.start[asked], self._motions.end[asked])
        tables = (*map(np.array, given), self._arc[asked], self._table, counts, self._whole[asked], *before)
        made = (found.start, found.end, found.motion, found.arc, found.arcs)
        if total < _WORTH_TWO_CORES:
            split(*tables, 0, last - first, *made)
        else:
            edges = np.append(np.searchsorted(ends, np.linspace(0, total, _BANDS + 1)[:-1]), last - first)
            list(pool().map(lambda band: split(*tables, *band, *made), pairwise(edges.tolist())))
        found.motion[:] += first
        for row in [row for row in self._splines if first <= row < last]:
            own = slice(*np.searchsorted(found.motion, [row, row + 1]).tolist())
            step = np.arange(self.counts[row])
            step = np.where((step == 1) & (self.counts[row] < self._whole[row]), self._whole[row] - 1, step)
            found.start[own], found.end[own] = self._splines[row][step], self._splines[row][step + 1]
        return found


def helix_chord(pitch: float) -> float:
    """Return how far the chords of helices may be from these on a grid, in X and Y alone, mm: what certificates make up
    for.

    Args:
        pitch: side of a cell, mm.
    """
    return max(CHORD, min(HELIX_CHORD, pitch / 1000))


def _is_level(motions: Motions, arcs: ArcPaths, chord: float) -> NDArray[np.bool_]:
    """Return which arcs are better swept as level arcs of mean radii than by chords."""
    level = (arcs.axes[:, 2] == 2) & (motions.start[arcs.rows, 2] == motions.end[arcs.rows, 2])
    return np.asarray(level & (_level_counts(arcs) <= _chord_counts(arcs, chord)))


def _level_counts(arcs: ArcPaths) -> NDArray[np.int64]:
    """Return in how many level arcs each falls: at most a quarter turn, and the radius within CHORD of its own."""
    return np.asarray(
        np.maximum(
            np.ceil(np.abs(arcs.sweep) / QUARTER - 1e-9),
            np.ceil(np.abs(arcs.end_radius - arcs.start_radius) / (2 * CHORD) - 1e-3),
        ).clip(1),
        dtype=np.int64,
    )


def _chords(arcs: ArcPaths, chord: float, helix_chord: float) -> Floats:
    """Return (m,) how far the chords of each arc may be from it, mm."""
    return np.where(arcs.axes[:, 2] == 2, max(chord, helix_chord), chord)


def _chord_counts(arcs: ArcPaths, chord: float | Floats) -> NDArray[np.int64]:
    """Return in how many chords each falls that are nowhere farther from it than `chord`, mm."""
    turn, grow = np.abs(arcs.sweep), np.abs(arcs.end_radius - arcs.start_radius)
    bend = np.maximum(arcs.start_radius, arcs.end_radius) * turn**2 + 2 * grow * turn
    return np.asarray(np.ceil(np.sqrt(bend / (8 * chord))).clip(1), dtype=np.int64)


def _arc_counts(arcs: ArcPaths, level: NDArray[np.bool_], chord: Floats) -> NDArray[np.int64]:
    return np.where(level, _level_counts(arcs), _chord_counts(arcs, chord))


def _table(arcs: ArcPaths, level: NDArray[np.bool_]) -> tuple[NDArray[np.generic], ...]:
    """Return arcs, and which of them are swept as level ones, as the kernel takes them."""
    numbers = (arcs.centre, arcs.angle, arcs.sweep, arcs.start_radius, arcs.end_radius, arcs.height, arcs.rise)
    return (
        np.ascontiguousarray(arcs.axes, np.int64),
        *(np.ascontiguousarray(each, np.float64) for each in numbers),
        np.ascontiguousarray(level),
    )
