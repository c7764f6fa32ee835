"""What paths leave of the metal that a tool can reach, as squares decided by exact distances; everything else is proven
cut.

The distance from a path changes by no more than the way gone, so one exact distance, from a square's centre, can decide
the whole square: cut, when the cutter reaches its farthest corner; out of reach, when the tool does not reach its
nearest point. What neither proves is divided in four, down to a fraction of the tool's radius.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.core.progress import NO_PROGRESS, Progress
from app.geometry import kernels
from app.geometry.distance import DistanceField
from app.geometry.offset.offset import OffsetLevel
from app.geometry.primitives import Rows, boxes, within_half_turn
from app.toolpath.coverage import uncut_kernels
from tests.toolpath import uncut_squares_kernels

FINEST = 32
"""The smallest squares' half side goes so many times, or up to twice as many, into the smallest radius: sides are R/16
or less.
"""

_START = 32
"""Squares along the area's longer side at the beginning."""

_AT_ONCE = 64
"""Squares of the beginning that are looked at between two looks at the progress."""

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class UncutSquares:
    """Squares that hold every point which a tool could cut and no path cuts.

    Attributes:
        centres: (n, 2) of the squares, mm.
        halves: (n,) half their sides, mm; sides are at most 1/16 of the smallest radius, or the whole square is left.
        beyond_cut: (n,) how far each centre is from what paths sweep, mm; negative = that deep within, and only part of
            the square can be left.
        beyond_reach: (n,) how far each centre is from what the tool reaches, mm; negative = that deep within.
    """

    centres: Floats
    halves: Floats
    beyond_cut: Floats
    beyond_reach: Floats

    @property
    def sure(self) -> NDArray[np.bool_]:
        """(n,) True where the centre itself is left and within reach; the other squares lie on edges of both."""
        sure: NDArray[np.bool_] = (self.beyond_cut > 0) & (self.beyond_reach <= 0)
        return sure

    def thicker(self, than: float) -> UncutSquares:
        """Return the squares whose centres are farther than so many mm, >= 0, from what paths sweep, and within
        reach.
        """
        keep = (self.beyond_cut > than) & (self.beyond_reach <= 0)
        return UncutSquares(self.centres[keep], self.halves[keep], self.beyond_cut[keep], self.beyond_reach[keep])


def uncut(
    walls: DistanceField,
    frame: OffsetLevel,
    radius: float,
    paths: Sequence[tuple[Rows, float]],
    progress: Progress = NO_PROGRESS,
) -> UncutSquares:
    """Return what paths leave of all that a tool reaches.

    Args:
        walls: all that bounds the area, closed (a sheet's distances).
        frame: rings of the tool's centre nearest to the walls; it can be anywhere at that distance or more.
        radius: of the tool, mm, > 0, at most the frame's distance.
        paths: (rows (m, 8) of a path, radius of its cutter, mm, > 0); rows may sweep up to a full turn.
        progress: looked at between parts of the area.

    Raises:
        Cancelled: by progress.
    """
    if not frame.rings:
        return UncutSquares(np.zeros((0, 2)), *np.zeros((3, 0)))
    outline = DistanceField.of(np.concatenate([ring.rows for ring in frame.rings]))
    cut, radii = _together([(rows, cutter) for rows, cutter in paths if len(rows)])
    order, nodes = kernels.build_tree(np.ascontiguousarray(boxes(cut)))
    wide = uncut_kernels.widest(radii, order, len(nodes))
    limits = np.array([frame.distance, radius, min(radius, *radii[radii > 0], math.inf) / FINEST])
    squares = _grid(outline.boxes, radius)
    found = []
    for first in range(0, len(squares), _AT_ONCE):
        progress.step(first / len(squares), "Measuring what is left")
        part, count = uncut_squares_kernels.undecided(
            walls.rows,
            walls.order,
            walls.nodes,
            outline.rows,
            outline.order,
            outline.nodes,
            cut,
            order,
            nodes,
            radii,
            wide,
            limits,
            squares[first : first + _AT_ONCE],
        )
        found.append(part[:count])
    left = np.concatenate(found)
    return UncutSquares(left[:, :2], left[:, 2], left[:, 3], left[:, 4])


def _together(paths: Sequence[tuple[Rows, float]]) -> tuple[Rows, Floats]:
    """Return (rows (n, 8), radius of the cutter of each (n,)) of all paths; n > 0: without paths one that cuts
    nothing.
    """
    cut = [within_half_turn(rows) for rows, _ in paths]
    radii = [np.full(len(rows), cutter) for rows, (_, cutter) in zip(cut, paths, strict=True)]
    if not cut:
        return np.full((1, 8), 1e12) * [1, 1, 1, 1, 0, 0, 0, 0], np.zeros(1)
    return np.ascontiguousarray(np.concatenate(cut)), np.concatenate(radii)


def _grid(around: Floats, margin: float) -> Floats:
    """Return squares (n, 3) over all boxes (m, 4) and a margin; sides are binary fractions, so that edges meet to the
    last digit.
    """
    low, high = around[:, :2].min(axis=0) - margin, around[:, 2:].max(axis=0) + margin
    half = 2.0 ** math.ceil(math.log2(float((high - low).max()) / _START / 2))
    x, y = (
        np.arange(math.floor(a / half / 2), math.ceil(b / half / 2)) * 2 * half + half
        for a, b in zip(low, high, strict=True)
    )
    centres = np.stack(np.meshgrid(x, y), -1).reshape(-1, 2)
    return np.column_stack([centres, np.full(len(centres), half)])
