"""The height that is left at single points, in float64: for places finer than the cells."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.pool import in_bands
from ...core.progress import NO_PROGRESS, Progress
from ...model.motion import Floats, MotionKind
from ..box_tree import box_tree
from ..cutter import Cutter
from ..field.solid import SolidStock
from ..field.target import MOST_REACH, cutter_profile, dilated, solid_target
from ..field.workpiece import Grid, Heights
from .course import Course
from .pieces import PieceSplitter, SweepPieces

_WORTH_TWO_CORES = 500
"""Points from which a second core is worth its start."""

PROVING_HELIX_CHORD = 1e-3
"""mm that chords of helices may be off where it is asked what stands of tabs and threads: a tenth of what counts there.
"""


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
    def of(courses: Sequence[Course], cutters: Mapping[int, Cutter], helix_chord: float = 0.0) -> PathProbe:
        """Return what cuts along courses, one after the other.

        Args:
            courses: rapids and what is left out do not cut.
            cutters: by T number.
            helix_chord: how far chords of helices may be off, mm; 0 = as near as of all other curves.
        """
        numbers, found, done = sorted(cutters), [], 0
        for course in courses:
            found.append(_cutting(course, numbers, done, helix_chord))
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


def _cutting(course: Course, numbers: Sequence[int], done: int, helix_chord: float) -> _CuttingPieces:
    """Return the pieces of a course that cut; `done` motions were before it."""
    motions = course.motions
    cuts = (motions.kind != MotionKind.RAPID) & np.isin(course.tool, np.array(numbers))
    cuts[list(course.left_out)] = False
    pieces = PieceSplitter(motions, helix_chord=helix_chord).pieces(0, len(motions)) if cuts.any() else None
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


# What tools can reach of a solid without touching it: grey dilation by a tool's profile, and erosion by it.
#
# The tool's tip may be where no part of the solid is in the tool: no lower than the greatest of part minus profile
# round it (dilation). The lowest that it cuts at a place is the least of tip plus profile round it (erosion). On cells
# both are known to half a cell's diagonal, so there are two answers: what is surely reached, by a cutter that keeps as
# much more away, and what may be, by one that keeps as much less.


CELLS = 1024
"""Along the longer side of the stock at most."""

PIN = np.zeros((1, 1), np.float32)
"""Profile of a cutter that is narrower than a cell."""


@dataclass(frozen=True, eq=False)
class ReachableHeights:
    """The lowest heights that some tool gets to, (rows, cols) each, mm.

    Attributes:
        grid: the stock, and the widest tool's radius round it.
        sure: some tool gets as low as that. possible: none gets lower.
        over_part: how far above the part the tool that gets lowest stays there; part and tool both taken at the cells'
            centres, so that a slope is no height.
    """

    grid: Grid
    sure: Heights
    possible: Heights
    over_part: Heights

    def over(self, grid: Grid) -> tuple[Heights, Heights, Heights]:
        """Return sure, possible and over_part at the cells of another grid."""
        cols = np.clip(((grid.xs() - self.grid.x0) / self.grid.pitch).astype(np.int64), 0, self.grid.cols - 1)
        rows = np.clip(((grid.ys() - self.grid.y0) / self.grid.pitch).astype(np.int64), 0, self.grid.rows - 1)
        place = np.ix_(rows, cols)
        return self.sure[place], self.possible[place], self.over_part[place]


def reach_of(
    solid: SolidStock,
    leave: float,
    box: tuple[float, float, float, float],
    cutters: Iterable[Cutter],
    progress: Progress = NO_PROGRESS,
) -> ReachableHeights:
    """Return what some cutters reach of a solid with stock to leave on it.

    Args:
        box: x0, y0, x1, y1 of the stock, mm.
        cutters: at least one.

    Raises:
        Cancelled: the job was asked to stop.
    """
    cutters = tuple(cutters)
    widest = max(cutter.radius for cutter in cutters)
    x0, y0, x1, y1 = box
    pitch = max((x1 - x0) / CELLS, (y1 - y0) / CELLS, widest / MOST_REACH)
    more = widest + 2 * pitch
    rows, cols = (math.ceil((side + 2 * more) / pitch) for side in (y1 - y0, x1 - x0))
    grid = Grid(x0 - more, y0 - more, pitch, rows, cols)
    target, half = solid_target(solid, grid, leave, progress).heights, pitch / math.sqrt(2.0)
    sure = [_lowest(target, cutter.grown(half), cutter, pitch, progress) for cutter in cutters]
    possible = [_lowest(target, cutter.shrunk(half), cutter, pitch, progress) for cutter in cutters]
    nearest = np.minimum.reduce([_lowest(target, cutter, cutter, pitch, progress) for cutter in cutters])
    over_part = np.zeros_like(target)
    # beside the part there is none to keep away from
    np.subtract(nearest, target, out=over_part, where=np.isfinite(target))
    return ReachableHeights(grid, np.minimum.reduce(sure), np.minimum.reduce(possible), over_part)


def _lowest(target: Heights, paths: Cutter | None, cuts: Cutter, pitch: float, progress: Progress) -> Heights:
    """Return how low a cutter gets where another one is led clear of the part."""
    form = cutter_profile(paths, pitch) if paths is not None else PIN
    tip = dilated(target, form, progress)
    return np.asarray(-dilated(-tip, cutter_profile(cuts, pitch), progress))


def reachable(
    left: NDArray[np.bool_], sure: NDArray[np.bool_], possible: NDArray[np.bool_], near: NDArray[np.bool_], cells: int
) -> NDArray[np.bool_]:
    """Return which of the cells that are left count as within reach.

    Sure ones do, and possible ones in places that are wide enough: beside inner corners possible reach is too wide by a
    part of a cell, so that what is no wider than so many cells is no finding. On slopes heights differ within a cell by
    more than that; there those count that a tool comes near enough to.

    Args:
        left: more than the tolerance is. sure, possible: told from heights, and so by a slope times a cell too little,
            too much.
        near: a tool is led to within the tolerance of the part, at the cell's centre.
        cells: so many in a row are a wide place.
    """
    import cv2

    maybe = (left & possible).astype(np.uint8)
    opened = cv2.morphologyEx(
        maybe, cv2.MORPH_OPEN, np.ones((cells, cells), np.uint8), borderType=cv2.BORDER_CONSTANT, borderValue=0
    )
    return np.asarray((left & (sure | (possible & near))) | opened.astype(bool))
