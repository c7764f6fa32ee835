"""The height that is left at single points, in float64: for places finer than the cells."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.pool import in_bands
from ...model.motion import Floats, MotionKind
from ..box_tree import box_tree
from ..cutter import Cutter
from .course import Course
from .pieces import PieceSplitter, SweepPieces

_WORTH_TWO_CORES = 500
"""Points from which a second core is worth its start."""


class LowestReach(NamedTuple):
    """The lowest heights (m,) at points, infinite where nothing comes, and the motions' rows, -1 = none."""

    heights: Floats
    motion: NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class PathProbe:
    """Motions that cut, in pieces of a tree: whoever asks for a place meets those alone that come over it.

    Attributes:
        boxes: of the nodes, as `probe_kernels.lowest` wants them. pieces: (n, 9) in the order of the leaves. owners:
            (n, 2) of each the row of its motion, counted through all courses, and of its cutter. shapes: (c, 6) of the
            cutters.
    """

    boxes: Floats
    pieces: Floats
    owners: NDArray[np.int64]
    shapes: Floats

    @staticmethod
    def of(courses: Sequence[Course], cutters: Mapping[int, Cutter]) -> PathProbe:
        """Return what cuts along courses, one after the other.

        Args:
            courses: rapids and what is left out do not cut.
            cutters: by T number.
        """
        numbers, found, done = sorted(cutters), [], 0
        for course in courses:
            found.append(_cutting(course, numbers, done))
            done += len(course.motions)
        pieces, owners = np.concatenate([each.rows for each in found]), np.concatenate([each.owners for each in found])
        shapes = np.array([_shape(cutters[number]) for number in numbers]).reshape(-1, 6)
        if not len(pieces):
            return PathProbe(np.zeros((0, 6)), pieces, owners, shapes)
        low, high = _boxes(pieces, shapes[owners[:, 1]])
        order, boxes = box_tree(low, high)
        return PathProbe(boxes, np.ascontiguousarray(pieces[order]), np.ascontiguousarray(owners[order]), shapes)

    def lowest(self, points: Floats) -> LowestReach:
        """Return the lowest heights that are reached at points (m, 2)."""
        from .probe_kernels import lowest

        heights, motions = np.full(len(points), np.inf), np.full(len(points), -1, np.int64)
        if len(self.pieces) and len(points):
            points = np.ascontiguousarray(points)

            def look(band: slice) -> None:
                lowest(self.boxes, self.pieces, self.owners, self.shapes, points[band], heights[band], motions[band])

            in_bands(look, len(points), _WORTH_TWO_CORES)
        return LowestReach(heights, motions)


class _CuttingPieces(NamedTuple):
    """Pieces of paths that cut, rows (n, 9), and the motion and the cutter of each, (n, 2)."""

    rows: Floats
    owners: NDArray[np.int64]


def _cutting(course: Course, numbers: Sequence[int], done: int) -> _CuttingPieces:
    """Return the pieces of a course that cut; `done` motions were before it."""
    motions = course.motions
    cuts = (motions.kind != MotionKind.RAPID) & np.isin(course.tool, np.array(numbers))
    cuts[list(course.left_out)] = False
    pieces = PieceSplitter(motions).pieces(0, len(motions)) if cuts.any() else None
    if pieces is None:
        return _CuttingPieces(np.zeros((0, 9)), np.zeros((0, 2), np.int64))
    some = cuts[pieces.motion]
    rows = pieces.motion[some].astype(np.int64)
    owners = np.column_stack([rows + done, np.searchsorted(numbers, course.tool[rows])])
    return _CuttingPieces(_rows(pieces, some), owners)


def _rows(pieces: SweepPieces, some: NDArray[np.bool_]) -> Floats:
    """Return some pieces as rows (n, 9)."""
    rows = np.zeros((int(np.count_nonzero(some)), 9))
    rows[:, :3], rows[:, 3:6] = pieces.start[some], pieces.end[some]
    arc = pieces.arc[some]
    rows[arc >= 0, 6:] = pieces.arcs[arc[arc >= 0], :3]
    return rows


def _shape(cutter: Cutter) -> tuple[float, ...]:
    slope = 0.0 if math.isinf(cutter.slope) else cutter.slope
    return cutter.radius, cutter.flat, cutter.fillet, cutter.fillet_span, slope, cutter.lift


def _boxes(pieces: Floats, shapes: Floats) -> tuple[Floats, Floats]:
    """Return the lowest and highest coordinates (n, 3) that the cutters cut at; of arcs of at most a quarter turn, wide
    enough.
    """
    low, high = np.minimum(pieces[:, :3], pieces[:, 3:6]), np.maximum(pieces[:, :3], pieces[:, 3:6])
    # of a quarter turn beyond its chord, and more than what it is beyond the chord's box
    bulge = (1.0 - math.sqrt(0.5)) * pieces[:, 8:9]
    wide = shapes[:, :1] * (1.0 + 1e-9) + bulge
    low[:, :2] -= wide
    high[:, :2] += wide
    low[:, 2] += shapes[:, 5]
    high[:, 2] += shapes[:, 5]
    return low, high
