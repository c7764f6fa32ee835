"""The feeds of a program cut into chunks that are painted with one pen each."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import chain, pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from PySide6.QtGui import QPainterPath

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

_MIX = (0x9E3779B97F4A7C1, 0xC2B2AE3D27D4EB5, 0x165667B19E3779F)
"""Odd numbers that spread what they multiply over 64 bits."""


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
    return MotionChunks.joined(_cut(shapes, side, own, np.arange(0, len(own), RUN)) for own in _alike(rows, codes))


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
        begun = _begun(shapes, side, own)
        # counted from where a path begins, so that all passes are cut alike: fine pens count dashes in steps of pixels
        count = np.arange(len(own))
        heads = (count - np.maximum.accumulate(np.where(begun, count, 0))) % RUN == 0
        heads[1:] |= by_kind & (np.diff(kinds[own]) != 0)
        parts.append(_cut(shapes, side, own, _with_ends(np.flatnonzero(heads), begun)))
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


def _cut(shapes: MotionShapes, side: ViewSide, own: Ints, heads: Ints) -> MotionChunks:
    """Cut some motions of one style before each of the heads."""
    elements, at = shapes.elements(own, side, heads)
    edges = np.append(at[heads], at[-1])
    data, columns = elements.tobytes(), list(side.value)
    begins = _begins(shapes, side, own, heads)
    kinds, look, tool = (
        shapes.program.motions.kind[own[heads]],
        MotionLineStyle(int(shapes.look[own[0]])),
        int(shapes.tool[own[0]]),
    )
    pieces = zip(pairwise((edges * elements.itemsize).tolist()), kinds.tolist(), begins, strict=True)
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


def _begins(shapes: MotionShapes, side: ViewSide, own: Ints, heads: Ints) -> list[float]:
    """Return how long the path is before each head, from where its dashes last began anew, as it is seen, mm; 0 but for
    contours.
    """
    if shapes.look[own[0]] != MotionLineStyle.CONTOUR:
        return [0.0] * len(heads)
    motions, columns = shapes.program.motions, list(side.value)
    chord = np.hypot(*(motions.end[own] - motions.start[own])[:, columns].T)
    before = np.concatenate(
        [[0.0], np.cumsum(np.where(motions.kind[own] == MotionKind.LINE, chord, shapes.length[own]))]
    )
    begun = np.flatnonzero(_begun(shapes, side, own))
    at_begin = _phases(before, begun, _numbers(_places(shapes, side, own)).first)
    last = np.searchsorted(begun, heads, side="right") - 1
    return list((before[heads] - before[begun[last]] + at_begin[last]).tolist())


def _phases(before: Floats, begun: Ints, first: Ints) -> Floats:
    """Return how far in its dashes each path begins, mm: at a place where one was before, as far as that one was there,
    so that all passes over a contour have theirs over each other.

    Args:
        before: (n + 1,) length before each motion, mm.
        begun: numbers of the motions with which paths begin.
        first: (n,) the first motion that begins at the place of each.
    """
    phases = np.zeros(len(begun))
    of_first = np.searchsorted(begun, first[begun], side="right") - 1
    for k in np.flatnonzero(first[begun] < begun).tolist():
        j = of_first[k]
        phases[k] = before[first[begun[k]]] - before[begun[j]] + phases[j]
    return phases


class _Numbers(NamedTuple):
    """Of each of some keys (n,): which number it is of the different ones, how often it is there, and where first."""

    number: Ints
    times: Ints
    first: Ints


def _numbers(keys: Ints) -> _Numbers:
    _, first, number, counts = np.unique(keys, return_index=True, return_inverse=True, return_counts=True)
    return _Numbers(number, counts[number], first[number])


def _places(shapes: MotionShapes, side: ViewSide, own: Ints) -> Ints:
    """Return a number (n,) for the place at which each motion begins: one, as rows of two take ten times as long to
    sort; two places that had the same would shift some dashes.
    """
    x, y = np.round(shapes.program.motions.start[own][:, list(side.value)] / _SAME_PLACE).astype(np.int64).T
    mixed: Ints = (x * _MIX[0]) ^ (y * _MIX[1])
    return mixed


def _begun(shapes: MotionShapes, side: ViewSide, own: Ints) -> NDArray[np.bool_]:
    """Tell of motions along contours (n,) where dashes begin anew: where another path begins, and where a path comes by
    the first of its places that it comes by again, so that all passes of one that goes down without a lift have their
    dashes over each other.
    """
    begun = shapes.breaks(own)
    path = np.cumsum(begun)
    found = _numbers((path * _MIX[2]) ^ _places(shapes, side, own))
    again = np.flatnonzero(found.times > 1)
    _, first = np.unique(path[again], return_index=True)
    return begun | np.isin(found.number, found.number[again[first]])
