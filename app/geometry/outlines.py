"""Many contours as one array of rows: measured, sampled and filled all at once, however many there are.

One contour is a batch of one; nothing here is asked for each of them by itself.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import shapely
from numpy.typing import NDArray

from ..model.part import Contour
from . import kernels
from .primitives import Indices, R, Rows, boxes, contour_rows, samples, sweeps
from .primitives import lengths as row_lengths

Floats = NDArray[np.float64]
Shapes = NDArray[np.object_]


@dataclass(frozen=True, eq=False)
class Outlines:
    """Contours, one after the other.

    Attributes:
        rows: (n, 8) of all of them, see `app.geometry.primitives`.
        first: (m + 1,) number of the first row of each; none is without rows.
    """

    rows: Rows
    first: Indices

    @staticmethod
    def of(contours: Sequence[Contour]) -> Outlines:
        """Return contours as rows."""
        return Outlines.joined([contour_rows(contour) for contour in contours])

    @staticmethod
    def joined(parts: Sequence[Rows]) -> Outlines:
        """Return the rows (k, 8), k > 0, of each of some paths as one array."""
        counts = np.array([len(part) for part in parts], np.int64)
        return Outlines(
            np.concatenate([np.zeros((0, 8)), *parts]), np.concatenate([np.zeros(1, np.int64), np.cumsum(counts)])
        )

    def __len__(self) -> int:
        return len(self.first) - 1

    @cached_property
    def owner(self) -> Indices:
        """(n,) number of the contour of each row."""
        return np.repeat(np.arange(len(self)), np.diff(self.first))

    @cached_property
    def following(self) -> Indices:
        """(n,) number of the row that comes after each, round and round its contour."""
        after = np.arange(1, len(self.rows) + 1)
        after[self.first[1:] - 1] = self.first[:-1]
        return after

    @cached_property
    def previous(self) -> Indices:
        """(n,) number of the row that comes before each, round and round its contour."""
        before = np.arange(-1, len(self.rows) - 1)
        before[self.first[:-1]] = self.first[1:] - 1
        return before

    @cached_property
    def sizes(self) -> Floats:
        """(n,) length of each row, mm."""
        return row_lengths(self.rows)

    @cached_property
    def lengths(self) -> Floats:
        """(m,) length of each contour, mm."""
        return self.sums(self.sizes)

    @cached_property
    def areas(self) -> Floats:
        """(m,) area that each encloses, mm2, positive when counter-clockwise (Green's theorem, exact for arcs)."""
        base = np.tile(self.rows[self.first[:-1], :2][self.owner], 2)
        x0, y0, x1, y1 = (self.rows[:, :4] - base).T  # from where each begins: what is far from zero loses digits
        turn = sweeps(self.rows)
        return self.sums(x0 * y1 - x1 * y0) / 2 + self.sums(self.rows[:, R] ** 2 * (turn - np.sin(turn))) / 2

    @cached_property
    def boxes(self) -> Floats:
        """(m, 4) box x0, y0, x1, y1 that holds each exactly, mm."""
        if not len(self):
            return np.zeros((0, 4))
        around = boxes(self.rows)
        low, high = (
            ufunc.reduceat(part, self.first[:-1])
            for ufunc, part in ((np.minimum, around[:, :2]), (np.maximum, around[:, 2:]))
        )
        return np.hstack([low, high])

    def sums(self, values: Floats) -> Floats:
        """Return the sum (m,) over each contour of values (n,) of the rows."""
        total: Floats = np.add.reduceat(values, self.first[:-1]) if len(self) else np.zeros(0)
        return total

    def enclose(self, points: Floats) -> NDArray[np.bool_]:
        """Tell for each contour whether it encloses the point (m, 2) of its own, by the even-odd rule."""
        held = np.empty(len(self), np.bool_)
        kernels.inside_own(np.ascontiguousarray(self.rows), self.first, np.ascontiguousarray(points, np.float64), held)
        return held

    def sampled(self, tolerance: float | Floats) -> tuple[Indices, Floats]:
        """Return (contour (k,), points (k, 2)) along the contours, whose chords stay within a tolerance, mm.

        Args:
            tolerance: for all of them, or (m,) for each.
        """
        row, points = samples(self.rows, np.broadcast_to(tolerance, len(self))[self.owner])
        return self.owner[row], points

    def rings(self, tolerance: float | Floats) -> tuple[Indices, Shapes]:
        """Return (contour (k,), its ring of chords within a tolerance, mm) of each but those of fewer than three
        chords.
        """
        owner, points = self.sampled(tolerance)
        wide = np.bincount(owner, minlength=len(self)) > 2
        kept = np.flatnonzero(wide)
        if not len(kept):
            return kept, np.zeros(0, object)
        number = np.cumsum(wide) - 1
        return kept, np.asarray(
            shapely.linearrings(points[wide[owner]], indices=number[owner[wide[owner]]]), dtype=object
        )


def polygons(outlines: Outlines, group: Indices, tolerance: float | Floats) -> tuple[Indices, Shapes]:
    """Return (group (k,), its polygon, valid and not empty): the first contour of a group is the boundary, the others
    are its holes.

    Args:
        outlines: the contours of a group one after the other.
        group: (m,) number of the group of each, rising.
        tolerance: of the chords, mm, for all contours or (m,) for each.
    """
    kept, rings = outlines.rings(tolerance)
    boundary = np.flatnonzero(np.diff(group, prepend=-1))
    bounded = np.isin(group, group[boundary[np.isin(boundary, kept)]])
    rings, kept = rings[bounded[kept]], kept[bounded[kept]]
    if not len(kept):
        return kept, np.zeros(0, object)
    numbers, index = np.unique(group[kept], return_inverse=True)
    shapes = np.asarray(shapely.make_valid(shapely.polygons(rings, indices=index)), dtype=object)
    there = ~shapely.is_empty(shapes)
    return numbers[there], shapes[there]
