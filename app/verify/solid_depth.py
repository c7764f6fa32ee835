"""How deep places lie in a solid: the exact distance to its nearest triangle, over whole columns of metal that was cut
away.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.progress import NO_PROGRESS, Progress
from ..model.motion import Floats
from ..simulation.field.solid import SolidStock
from ..simulation.field.triangle_tree import TriangleTree
from .outer_faces import outer_faces

FINE = 1e-5
"""mm by which the depth of a column may be told too small."""

ASIDE = 1.3e-7
"""mm by which a line is moved, so that it hardly ever runs along an upright triangle."""


@dataclass(frozen=True, eq=False)
class CutColumns:
    """Upright pieces of metal that were cut away, (m,) each.

    Attributes:
        places: (m, 2) x, y, mm. low, high: their ends, mm; where high is below low there is nothing.
    """

    places: Floats
    low: Floats
    high: Floats

    def __len__(self) -> int:
        return len(self.low)

    def only(self, rows: NDArray[np.int64] | slice) -> CutColumns:
        """Return some of them."""
        return CutColumns(self.places[rows], self.low[rows], self.high[rows])


class _ColumnParts(NamedTuple):
    """Parts of columns: which column each is of, and x, y, low, high (k, 4), mm."""

    column: NDArray[np.int64]
    segments: Floats


class DepthInSolid:
    """Answers how deep metal was cut into a solid with stock to leave on it."""

    def __init__(self, solid: SolidStock, leave: float = 0.0, progress: Progress = NO_PROGRESS) -> None:
        """Find what bounds the solid's bodies together.

        Raises:
            Cancelled: by progress.
        """
        self._solid, self._leave = solid, leave
        self._tree = solid.tree if solid.shells == 1 else TriangleTree.of(outer_faces(solid, progress))

    def of(self, columns: CutColumns, known: float = 0.0, fine: float = FINE) -> Floats:
        """Return how deep the deepest place of each column lies below the surface of what is wanted, mm, >= 0.

        Args:
            known: columns that are no deeper than this, mm, are of no interest: for them less may be told.
            fine: by so much a depth may be told too small, mm.
        """
        depth = np.zeros(len(columns))
        column, segments = self._in_solid(columns)
        if len(column):
            deepest = self._tree.deepest(segments, np.full(len(segments), max(known - self._leave, 0.0)), fine)
            np.maximum.at(depth, column, deepest + self._leave)
        if self._leave:
            skin = np.flatnonzero((depth == 0) & (columns.high > columns.low))
            places = np.column_stack([columns.places[skin], columns.low[skin]])
            depth[skin] = np.maximum(self._leave - self._tree.distances(places), 0.0)
        return depth

    def _in_solid(self, columns: CutColumns) -> _ColumnParts:
        """Return what of columns lies in the solid, by the winding number."""
        point, heights, up = self._solid.tree.met(columns.places + np.array([ASIDE, ASIDE * 0.7]))
        order = np.lexsort((heights, point))
        point, heights, up = point[order], heights[order], up[order]
        winds = np.cumsum(-up)  # a face that looks down begins a solid, one that looks up ends it
        winds -= (winds + up)[np.searchsorted(point, point)]  # each column begins at 0, whatever came of the one before
        inside = np.flatnonzero((winds[:-1] > 0.5) & (point[:-1] == point[1:]))
        column = point[inside]
        low, high = (
            np.maximum(heights[inside], columns.low[column]),
            np.minimum(heights[inside + 1], columns.high[column]),
        )
        some = high > low
        return _ColumnParts(column[some], np.column_stack([columns.places[column], low, high])[some])
