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

import numpy as np
from numpy.typing import NDArray

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


@dataclass(frozen=True, eq=False)
class Window:
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


class Splitter:
    """The pieces of motions, any part of them at a time."""

    def __init__(
        self,
        motions: Motions,
        arcs_stay: bool = True,
        window: Window | None = None,
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
        self._splines = dict(zip(motions.splines, flattened_all(list(motions.splines.values()), chord), strict=True))
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

    def pieces(self, first: int, last: int) -> Pieces:
        """Return the pieces of the motions first … last - 1."""
        motions, counts = self._motions, self.counts[first:last]
        rows = np.arange(first, last, dtype=np.int32)
        if not np.any(motions.kind[first:last] >= MotionKind.ARC_CW):
            return Pieces(
                motions.start[first:last],
                motions.end[first:last],
                rows,
                np.full(len(rows), -1, np.int32),
                np.zeros((0, 7)),
            )
        rows, step = np.repeat(rows, counts), _counted(counts)
        step = np.where((step == 1) & (self.counts[rows] < self._whole[rows]), self._whole[rows] - 1, step)
        start, end, arc, k = motions.start[rows], motions.end[rows], np.full(len(rows), -1, np.int32), self._arc[rows]
        round_ = np.flatnonzero(k >= 0)
        level, chords = round_[self._level[k[round_]]], round_[~self._level[k[round_]]]
        arc[level] = np.arange(len(level))
        start[level], end[level], table = _level_arcs(self._arcs, k[level], step[level], self._whole[rows[level]])
        inner, ahead = chords[step[chords] > 0], chords[step[chords] + 1 < self._whole[rows[chords]]]
        start[inner] = _places(self._arcs, k[inner], step[inner] / self._whole[rows[inner]])
        end[ahead] = start[ahead + 1]
        ahead = ahead[step[ahead + 1] != step[ahead] + 1]
        end[ahead] = _places(self._arcs, k[ahead], (step[ahead] + 1) / self._whole[rows[ahead]])
        for row in [row for row in self._splines if first <= row < last]:
            part = slice(*np.searchsorted(rows, [row, row + 1]))
            start[part], end[part] = self._splines[row][step[part]], self._splines[row][step[part] + 1]
        return Pieces(start, end, rows, arc, table)


def helix_chord(pitch: float) -> float:
    """Return how far the chords of helices may be from these on a grid, in X and Y alone, mm: what certificates make up
    for.

    Args:
        pitch: side of a cell, mm.
    """
    return max(CHORD, min(HELIX_CHORD, pitch / 1000))


def _counted(sizes: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return 0 … size - 1 for each size, one after the other."""
    return np.arange(sizes.sum()) - np.repeat(np.cumsum(sizes) - sizes, sizes)


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


def _places(arcs: ArcPaths, k: NDArray[np.int64], fractions: Floats) -> Floats:
    """Return (n, 3) places of the arcs k (n,) at fractions (n,)."""
    angle = arcs.angle[k] + arcs.sweep[k] * fractions
    radius = arcs.start_radius[k] + (arcs.end_radius[k] - arcs.start_radius[k]) * fractions
    return along_xyz(
        np.column_stack(
            [
                arcs.centre[k, 0] + radius * np.cos(angle),
                arcs.centre[k, 1] + radius * np.sin(angle),
                arcs.height[k] + arcs.rise[k] * fractions,
            ]
        ),
        arcs.axes[k],
    )


def _level_arcs(
    arcs: ArcPaths, k: NDArray[np.int64], at: NDArray[np.int64], count: NDArray[np.int64]
) -> tuple[Floats, Floats, Floats]:
    """Return starts, ends and rows of the n level arcs that some arcs fall into.

    Args:
        k: (n,) the arc that each belongs to. at: which of its parts each is. count: how many these are.
    """
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
