"""A program cut into chunks that are painted with one pen each."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from PySide6.QtGui import QPainterPath

from .....geometry.sample import Box
from .....model.moves import Purpose
from .curve_path import ELEMENT, LINE_TO, path_of
from .move_shapes import RUN, MoveShapes

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class MoveStyle:
    """What decides how a path looks."""

    purpose: Purpose
    operation: int
    tool: int
    region: int
    step: int = 0


@dataclass(frozen=True)
class PathChunk:
    """Moves of one style, near one another in the program.

    Attributes:
        path: in mm. box: x0, y0, x1, y1, mm.
        begins_at: length of its piece before it, so that dashes run on, mm.
    """

    style: MoveStyle
    path: QPainterPath
    box: Box
    begins_at: float


@dataclass(frozen=True)
class _Runs:
    """The runs of a program as columns: style number, bytes of painter path elements, box in mm, length of the piece
    before, mm.
    """

    styles: list[MoveStyle]
    style: list[int]
    data: list[bytes]
    boxes: list[list[float]]
    begins_at: list[float]


def chunks(shapes: MoveShapes) -> list[PathChunk]:
    """Return all cutting paths to be painted; what lies again on the same place (a deeper pass) is left out."""
    if not len(shapes.moves):
        return []
    runs = _runs(shapes)
    waiting: dict[int, list[int]] = {}
    found: list[PathChunk] = []
    seen: set[tuple[int, bytes]] = set()
    for run, number in enumerate(runs.style):
        mark = (number, runs.data[run])
        if runs.styles[number].purpose in (Purpose.DRILL, Purpose.RAPID) or mark in seen:
            continue
        seen.add(mark)
        if runs.begins_at[run] > 0:
            found.append(_chunk(runs, [run]))
            continue
        batch = waiting.setdefault(number, [])
        batch.append(run)
        if sum(len(runs.data[r]) for r in batch) > RUN * ELEMENT.itemsize:
            found.append(_chunk(runs, waiting.pop(number)))
    return found + [_chunk(runs, batch) for batch in waiting.values()]


def rapids(shapes: MoveShapes) -> Floats:
    """Return (n, 4) start and end of the rapids that move in the plane, mm, each once."""
    where = shapes.moves.purpose == Purpose.RAPID
    lines = np.hstack([shapes.start[where, :2], shapes.moves.end[where, :2]])
    return np.unique(lines[np.any(lines[:, :2] != lines[:, 2:], axis=1)], axis=0)


def rapids_path(lines: Floats, box: Box) -> QPainterPath:
    """Return the painter path in mm of those of the lines (n, 4) that come near a box."""
    low, high = np.minimum(lines[:, :2], lines[:, 2:]), np.maximum(lines[:, :2], lines[:, 2:])
    near = lines[np.all((low <= box[2:]) & (high >= box[:2]), axis=1)]
    elements = np.zeros(2 * len(near), dtype=ELEMENT)
    elements["kind"][1::2] = LINE_TO
    elements["x"], elements["y"] = near[:, [0, 2]].ravel(), near[:, [1, 3]].ravel()
    return path_of(elements.tobytes())


def plunges(shapes: MoveShapes) -> Floats:
    """Return (n, 2) places where a tool begins to go down, mm, each once: of a ramp or a helix its beginning."""
    down = np.isin(shapes.moves.purpose, (Purpose.PLUNGE, Purpose.DRILL))
    begins = down & ~np.concatenate([[False], down[:-1]]) if len(down) else down
    return np.unique(shapes.start[begins, :2], axis=0)


def _runs(shapes: MoveShapes) -> _Runs:
    m, first = shapes.moves, shapes.run[:-1]
    keys = np.stack(
        [m.purpose[first], m.operation[first], m.tool[first], m.region[first], shapes.step[first]], axis=1
    ).astype(np.int64)
    unique, style = np.unique(keys, axis=0, return_inverse=True)
    styles = [MoveStyle(Purpose(purpose), *rest) for purpose, *rest in unique.tolist()]
    whole, at = shapes.elements.tobytes(), (shapes.offset[shapes.run] * ELEMENT.itemsize).tolist()
    data = [whole[a:b] for a, b in pairwise(at)]
    boxes = np.hstack(
        [np.minimum.reduceat(shapes.boxes[:, :2], first), np.maximum.reduceat(shapes.boxes[:, 2:], first)]
    )
    before = np.concatenate([[0.0], np.cumsum(shapes.length)])
    piece_first = shapes.first[shapes.piece[first]]
    begins_at = np.where(first > piece_first, before[first] - before[piece_first], 0.0)
    begins_at[keys[:, 0] != Purpose.CONTOUR] = 0.0
    return _Runs(styles, style.ravel().tolist(), data, boxes.tolist(), begins_at.tolist())


def _chunk(runs: _Runs, batch: list[int]) -> PathChunk:
    x0, y0, x1, y1 = zip(*(runs.boxes[run] for run in batch), strict=True)
    path = path_of(*(runs.data[run] for run in batch))
    return PathChunk(
        runs.styles[runs.style[batch[0]]], path, (min(x0), min(y0), max(x1), max(y1)), runs.begins_at[batch[0]]
    )
