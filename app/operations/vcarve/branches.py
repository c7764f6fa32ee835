"""The medial axis as branches of chords: what a cutter can go along in straight moves.

A chord is as near to its piece as asked in x, y and radius together, so a cone on it neither cuts beyond a wall nor
keeps off it by more: distance from walls changes by no more than the way gone.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.errors import GeometryError
from ...core.wording import in_plane
from ...geometry.medial_axis.axis import MedialAxis

Floats = NDArray[np.float64]

CHORD = 5e-4
"""mm; half of what a path may be off, the other half is for the digits that it is written with."""

_LOOKED = np.linspace(0.0, 1.0, 9)
"""Fractions of a chord at which it is held against its piece."""

_HALVINGS = 30
"""Of a piece, at most: one that is not straight then bends more than can be told."""


@dataclass(frozen=True, eq=False)
class AxisBranch:
    """A way along the medial axis.

    Attributes:
        discs: (n, 3) x, y and radius of the disc, mm, n > 1.
    """

    discs: Floats

    @property
    def length(self) -> float:
        """Seen from above, mm."""
        return float(joined([self]).lengths()[0])

    def backwards(self) -> AxisBranch:
        """Return it from its end to its beginning."""
        return AxisBranch(np.ascontiguousarray(self.discs[::-1]))

    def clipped(self, low: float, high: float) -> list[AxisBranch]:
        """Return the parts of it whose radius is within limits, mm; they end at the limit."""
        found: list[AxisBranch] = []
        points: list[Floats] = []
        for a, b in zip(self.discs[:-1], self.discs[1:], strict=True):
            part = _clipped(a, b, low, high)
            if part is None:
                continue
            if points and not np.array_equal(points[-1], part[0]):
                found.append(AxisBranch(np.array(points)))
                points = []
            points += [part[1]] if points else list(part)
        return [*found, AxisBranch(np.array(points))] if len(points) > 1 else found


class JoinedBranches(NamedTuple):
    """Branches, or ways, one after the other.

    Attributes:
        discs: (n, 3) of all.
        upto: (m + 1,) the number of the first disc of each, and how many there are.
    """

    discs: Floats
    upto: NDArray[np.int64]

    def lengths(self) -> Floats:
        """Return the length (m,) of each, seen from above, mm.

        Those of as many chords are summed together, each as it would be alone: of branches as long the first counts,
        and where they stand must not tell.
        """
        chords = np.hypot(*np.diff(self.discs[:, :2], axis=0).T)
        counts = np.diff(self.upto) - 1
        found = np.zeros(len(counts))
        for count in np.unique(counts).tolist():
            same = np.flatnonzero(counts == count)
            found[same] = chords[self.upto[same, None] + np.arange(count)].sum(axis=1)
        return found

    def ends(self) -> Floats:
        """Return the discs (2 m, 3) at which each begins and ends."""
        ends: Floats = self.discs[np.stack([self.upto[:-1], self.upto[1:] - 1], axis=1).ravel()]
        return ends


def joined(branches: Sequence[AxisBranch]) -> JoinedBranches:
    """Return branches one after the other."""
    discs = np.concatenate([np.zeros((0, 3)), *[branch.discs for branch in branches]])
    return JoinedBranches(discs, np.cumsum([0, *[len(branch.discs) for branch in branches]], dtype=np.int64))


def between(branches: Sequence[AxisBranch], low: float, high: float) -> list[AxisBranch]:
    """Return the parts of branches whose radius is within limits, mm; they end at the limit."""
    if not branches:
        return []
    discs, upto = joined(branches)
    least, most = np.minimum.reduceat(discs[:, 2], upto[:-1]), np.maximum.reduceat(discs[:, 2], upto[:-1])
    inside = ((low <= least) & (most <= high)).tolist()
    outside = ((most < low) | (least > high)).tolist()
    found: list[AxisBranch] = []
    for branch, whole, none in zip(branches, inside, outside, strict=True):
        if whole:
            found.append(branch)
        elif not none:
            found += branch.clipped(low, high)
    return found


def _clipped(a: Floats, b: Floats, low: float, high: float) -> tuple[Floats, Floats] | None:
    """Return what of a chord has a radius within limits; None where nothing has."""
    rise = float(b[2] - a[2])
    if rise == 0.0:
        return (a, b) if low <= a[2] <= high else None
    first, last = sorted(((low - a[2]) / rise, (high - a[2]) / rise))
    first, last = max(first, 0.0), min(last, 1.0)
    if last <= first:
        return None
    return (a if first == 0.0 else a + (b - a) * first), (b if last == 1.0 else a + (b - a) * last)


def branches(axis: MedialAxis) -> list[AxisBranch]:
    """Return the pieces of an axis as chords that are within CHORD of them.

    Raises:
        GeometryError: a piece bends more than can be told.
    """
    waiting, name = axis.pieces, np.arange(len(axis.pieces))
    names, begins, chords = [name[:0]], [np.zeros(0)], [np.zeros((0, 2, 3))]
    for _ in range(_HALVINGS):
        if not len(waiting):
            break
        discs = replace(axis, pieces=np.ascontiguousarray(waiting)).discs(_LOOKED)
        straight = _bent(discs) <= CHORD
        names.append(name[straight])
        begins.append(waiting[straight, 2])
        chords.append(discs[straight][:, [0, -1]])
        again, name = waiting[~straight], np.repeat(name[~straight], 2)
        middle = (again[:, 2] + again[:, 3]) / 2
        waiting = np.repeat(again, 2, axis=0)
        waiting[::2, 3], waiting[1::2, 2] = middle, middle
    if len(waiting):
        x, y = axis.discs(_LOOKED)[name[0], 4, :2].tolist()
        raise GeometryError(
            f"The medial axis of region {axis.region} bends more near {in_plane(x, y)} than a path of straight moves "
            "can follow; look there for edges that cross or lie on one another, and mend them."
        )
    piece, begin, ends = np.concatenate(names), np.concatenate(begins), np.concatenate(chords)
    forward = np.where(axis.pieces[:, 3] >= axis.pieces[:, 2], 1.0, -1.0)
    order = np.lexsort((begin * forward[piece], piece))
    runs = np.split(ends[order], np.flatnonzero(np.diff(piece[order])) + 1) if len(order) else []
    return [AxisBranch(np.concatenate([run[0], run[1:, 1]])) for run in runs]


def _bent(discs: Floats) -> Floats:
    """Return (m,) how far discs (m, k, 3) leave the chord from the first to the last, in x, y and radius together."""
    chord = discs[:, -1] - discs[:, 0]
    size = np.maximum(np.einsum("mi,mi->m", chord, chord), 1e-300)
    off = discs - discs[:, :1]
    along = np.clip(np.einsum("mki,mi->mk", off, chord) / size[:, None], 0.0, 1.0)
    away = off - along[:, :, None] * chord[:, None]
    # in the plane and in radius: both shift the cone's rim sideways
    bent: Floats = (np.hypot(away[:, :, 0], away[:, :, 1]) + np.abs(away[:, :, 2])).max(axis=1)
    return bent
