"""The feeds of a program cut into chunks that are painted with one pen each."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import chain, pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from PySide6.QtGui import QPainterPath

from .....geometry.coincident_points import row_keys
from .....model.motion import MotionKind
from ...canvas.painting.curve_path import path_of
from ...canvas.painting.move_shapes import RUN
from ..motion_shapes import Floats, Ints, MotionLineStyle, MotionShapes, ViewSide

_MOST_RUNS = 5_000
"""So many changes from lines to arcs and back are told apart along contours; of more, no eye could see where dashes
meet.
"""

_SAME_PLACE = 1e-3
"""mm; a path that comes so near a place is there again."""


@dataclass(frozen=True, slots=True)
class MotionChunk:
    """Motions of one look and tool.

    Attributes:
        path: in mm.
        kind: of its motions; of contours that were not cut by kind, of the first one.
        begins_at: length of its contour before it, so that dashes run on, mm.
    """

    path: QPainterPath
    look: MotionLineStyle
    tool: int
    kind: MotionKind
    begins_at: float = 0.0


@dataclass(frozen=True)
class MotionChunks:
    """Chunks as columns.

    Attributes:
        boxes: (k, 4) x0, y0, x1, y1, mm. sizes: (k,) elements of each path.
    """

    chunks: list[MotionChunk]
    boxes: Floats
    sizes: Ints

    @staticmethod
    def joined(parts: Iterable[MotionChunks]) -> MotionChunks:
        """Return chunks one behind the other."""
        every = list(parts)
        return MotionChunks(
            list(chain.from_iterable(part.chunks for part in every)),
            np.concatenate([np.zeros((0, 4)), *(part.boxes for part in every)]),
            np.concatenate([np.zeros(0, np.int64), *(part.sizes for part in every)]),
        )


def chunks_by_style(shapes: MotionShapes, side: ViewSide, rows: Ints) -> MotionChunks:
    """Return some motions in chunks of about 96 of one look, tool and kind."""
    codes = (shapes.tool[rows].astype(np.int64) * len(MotionLineStyle) + shapes.look[rows]) * len(
        MotionKind
    ) + shapes.program.motions.kind[rows]
    parts = []
    for own in _alike(rows, codes):
        contour = shapes.look[own[0]] == MotionLineStyle.CONTOUR
        along = _dashes(shapes, side, own).along if contour else np.zeros(len(own))
        parts.append(_cut(shapes, side, own, np.arange(0, len(own), RUN), along))
    return MotionChunks.joined(parts)


def contour_chunks(shapes: MotionShapes, side: ViewSide, rows: Ints, by_kind: bool) -> MotionChunks:
    """Return motions along contours in chunks of one tool, whose dashes go on from each to the next.

    Args:
        shapes: the motions.
        side: from where they are seen.
        rows: which of them.
        by_kind: no chunk holds motions of two kinds.
    """
    kinds = shapes.program.motions.kind
    if by_kind and np.count_nonzero(np.diff(kinds[rows])) > _MOST_RUNS:
        return chunks_by_style(shapes, side, rows)
    parts = []
    for own in _alike(rows, shapes.tool[rows]):
        begun, along = _dashes(shapes, side, own)
        # counted from where a path begins, so that all passes are cut alike: fine pens count dashes in steps of pixels
        count = np.arange(len(own))
        heads = (count - np.maximum.accumulate(np.where(begun, count, 0))) % RUN == 0
        heads[1:] |= by_kind & (np.diff(kinds[own]) != 0)
        parts.append(_cut(shapes, side, own, _with_ends(np.flatnonzero(heads), begun), along))
    return MotionChunks.joined(parts)


def _alike(rows: Ints, codes: NDArray[np.integer]) -> list[Ints]:
    """Return the rows of each code, in their order."""
    order = np.argsort(codes, kind="stable")
    return [own for own in np.split(rows[order], np.flatnonzero(np.diff(codes[order])) + 1) if len(own)]


def _with_ends(heads: Ints, breaks: NDArray[np.bool_]) -> Ints:
    """Return heads of chunks, and for each that goes on with a contour the place where that contour ends.

    Qt lets the dashes of every stretch of a path begin alike, so one that is in the midst of them must be alone.
    """
    broken = np.append(np.flatnonzero(breaks), len(breaks))
    ends = broken[np.searchsorted(broken, heads[~breaks[heads]])]
    return np.unique(np.concatenate([heads, ends[ends < len(breaks)]]))


def _cut(shapes: MotionShapes, side: ViewSide, own: Ints, heads: Ints, along: Floats) -> MotionChunks:
    """Cut some motions of one style before each of the heads; `along`: (n,) where in its dashes each begins, mm."""
    elements, at = shapes.elements(own, side, heads)
    edges = np.append(at[heads], at[-1])
    data, columns = elements.tobytes(), list(side.value)
    kinds, look, tool = (
        shapes.program.motions.kind[own[heads]],
        MotionLineStyle(int(shapes.look[own[0]])),
        int(shapes.tool[own[0]]),
    )
    pieces = zip(pairwise((edges * elements.itemsize).tolist()), kinds.tolist(), along[heads].tolist(), strict=True)
    chunks = [
        MotionChunk(path_of(data[first:last]), look, tool, MotionKind(kind), begin)
        for (first, last), kind, begin in pieces
    ]
    boxes = np.hstack(
        [
            np.minimum.reduceat(shapes.low[own][:, columns], heads),
            np.maximum.reduceat(shapes.high[own][:, columns], heads),
        ]
    )
    return MotionChunks(chunks, boxes, np.diff(edges))


class _Dashes(NamedTuple):
    """Of motions along contours (n,): whether dashes begin anew with each, and where in its dashes each begins, mm as
    it is seen.
    """

    begun: NDArray[np.bool_]
    along: Floats


def _dashes(shapes: MotionShapes, side: ViewSide, own: Ints) -> _Dashes:
    """Return how dashes go along contours, so that all passes over one have theirs over each other.

    They begin anew where another path begins, and where a path comes by the first of its places that it comes by again,
    as one that goes down without a lift does. Where a path was before they begin as far as they were there.
    """
    motions, columns = shapes.program.motions, list(side.value)
    chord = np.hypot(*(motions.end[own] - motions.start[own])[:, columns].T)
    length = np.where(motions.kind[own] == MotionKind.LINE, chord, shapes.length[own])
    before = np.cumsum(length) - length
    broken = shapes.breaks(own)
    path: Ints = np.cumsum(broken, dtype=np.int64)
    places = np.round(motions.start[own][:, columns] / _SAME_PLACE)
    begun = broken | _at_first_again(row_keys(np.column_stack([path, places])), path)
    _, first, number = np.unique(row_keys(places), return_index=True, return_inverse=True)
    return _Dashes(begun, before + _shifts(before, np.flatnonzero(begun), first[number])[np.cumsum(begun) - 1])


def _at_first_again(places: NDArray[np.uint64], path: Ints) -> NDArray[np.bool_]:
    """Tell of motions (n,) whether each begins at the first place of its path that the path comes by again.

    Args:
        places: (n,) a number of the place and the path of each.
    """
    _, number, counts = np.unique(places, return_inverse=True, return_counts=True)
    again = np.flatnonzero(counts[number] > 1)
    _, first = np.unique(path[again], return_index=True)
    return np.isin(number, number[again[first]])


def _shifts(before: Floats, begun: Ints, first: Ints) -> Floats:
    """Return how much farther dashes are than the length before them, mm, from each motion on with which they begin.

    Args:
        before: (n,) length before each motion, mm.
        begun: numbers of the motions with which dashes begin anew.
        first: (n,) the first motion that begins at the place of each.
    """
    shifts = -before[begun]
    of_first = np.searchsorted(begun, first[begun], side="right") - 1
    for k in np.flatnonzero(first[begun] < begun).tolist():
        shifts[k] += before[first[begun[k]]] + shifts[of_first[k]]
    return shifts
