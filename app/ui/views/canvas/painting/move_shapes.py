"""The moves of a program prepared for painting and picking: built once, in mm, by numpy."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from PySide6.QtGui import QPainterPath

from .....model.moves import MoveKind, Moves
from .curve_path import CURVE_DATA, CURVE_TO, ELEMENT, LINE_TO, MOVE_TO, PIECE, Elements, path_of

RUN = 96
"""Longer painter paths cost more than their share."""

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_LIT = 300


@dataclass(frozen=True)
class MoveShapes:
    """The moves as columns for painting and picking.

    Attributes:
        moves: the moves themselves.
        step: (n,) of engagement, see `engaged`; 0 where it was not measured.
        start: (n, 3) mm. sweep: (n,) radians. length: (n,) mm.
        boxes: (n, 4) x0, y0, x1, y1 of each move, mm.
        piece: (n,) number of the piece it belongs to: neighbours of one operation, purpose, tool and region.
        first, last: (k,) range of moves of each piece, last excluded.
        run: (m + 1,) first move of each run: at most 96 moves of one piece and step; the last entry is n.
        elements: painter path elements of all moves, each run begun by a MOVE_TO. offset: (n + 1,) where each move's
            begin.
    """

    moves: Moves
    step: Ints
    start: Floats
    sweep: Floats
    length: Floats
    boxes: Floats
    piece: Ints
    first: Ints
    last: Ints
    run: Ints
    elements: Elements
    offset: Ints

    def piece_path(self, move: int) -> QPainterPath:
        """Return the painter path in mm of the piece that a move belongs to; of a very long one, 300 moves each way."""
        piece = self.piece[move]
        first, last = max(int(self.first[piece]), move - _LIT), min(int(self.last[piece]), move + _LIT)
        head = np.array([(MOVE_TO, self.start[first, 0], self.start[first, 1])], dtype=ELEMENT)
        return path_of(head.tobytes(), self.elements[self.offset[first] : self.offset[last]].tobytes())


def shape_moves(moves: Moves, step: Ints | None = None) -> MoveShapes:
    """Return the moves prepared for painting and picking; `step` (n,) parts runs, but not the pieces that dashes run
    along.
    """
    step = np.zeros(len(moves), np.int64) if step is None else step
    start, sweep, length = moves.start, moves.sweeps(), moves.lengths()
    key = np.stack([moves.operation, moves.purpose, moves.tool, moves.region]).astype(np.int64)
    change = np.flatnonzero(np.any(np.diff(key, axis=1) != 0, axis=0)) + 1
    first = np.concatenate([[0], change]).astype(np.int64) if len(moves) else np.zeros(0, np.int64)
    last = np.append(first[1:], len(moves)).astype(np.int64) if len(moves) else first
    piece = np.repeat(np.arange(len(first)), last - first)
    heads = (np.arange(len(moves)) - first[piece]) % RUN == 0 if len(moves) else np.zeros(0, np.bool_)
    heads[1:] |= step[1:] != step[:-1]
    run = np.append(np.flatnonzero(heads), len(moves)).astype(np.int64)
    elements, offset = _elements(moves, start, sweep, heads)
    boxes = _boxes(moves, start, sweep)
    return MoveShapes(moves, step, start, sweep, length, boxes, piece, first, last, run, elements, offset)


def _elements(moves: Moves, start: Floats, sweep: Floats, heads: NDArray[np.bool_]) -> tuple[Elements, Ints]:
    """Return painter path elements of all moves, and where each move's begin: lines one, arcs three a piece, runs one
    more.
    """
    arcs = moves.kind >= MoveKind.ARC_CW
    pieces = np.where(arcs, np.maximum(1, np.ceil(np.abs(sweep) / PIECE - 1e-9)), 0).astype(np.int64)
    offset = np.concatenate([[0], np.cumsum(np.where(arcs, 3 * pieces, 1) + heads)]).astype(np.int64)
    body = offset[:-1] + heads
    elements = np.zeros(int(offset[-1]), dtype=ELEMENT)
    for kind, at, points in ((MOVE_TO, offset[:-1][heads], start[heads]), (LINE_TO, body[~arcs], moves.end[~arcs])):
        elements["kind"][at] = kind
        elements["x"][at], elements["y"][at] = points[:, 0], points[:, 1]
    if arcs.any():
        _fill_arcs(elements, moves, _ArcPieces(start, sweep, pieces), body)
    return elements, offset


class _ArcPieces(NamedTuple):
    """Moves as arcs: where they start, their angles, radians, and the cubics that each becomes (0 = none)."""

    start: Floats
    sweep: Floats
    pieces: Ints


def _fill_arcs(elements: Elements, moves: Moves, arcs: _ArcPieces, body: Ints) -> None:
    start, sweep, pieces = arcs
    rows = np.repeat(np.arange(len(moves)), pieces)
    number = np.arange(len(rows)) - np.repeat(np.cumsum(pieces) - pieces, pieces)
    step = sweep[rows] / pieces[rows]
    centre = moves.centre[rows]
    first = start[rows, :2] - centre
    radius, begin = np.hypot(*first.T), np.arctan2(first[:, 1], first[:, 0])
    handle = 4 / 3 * np.tan(step / 4)
    a, b = begin + step * number, begin + step * (number + 1)
    at = body[rows] + 3 * number
    columns = (
        (CURVE_TO, np.cos(a) - handle * np.sin(a), np.sin(a) + handle * np.cos(a)),
        (CURVE_DATA, np.cos(b) + handle * np.sin(b), np.sin(b) - handle * np.cos(b)),
        (CURVE_DATA, np.cos(b), np.sin(b)),
    )
    for k, (kind, x, y) in enumerate(columns):
        elements["kind"][at + k] = kind
        elements["x"][at + k], elements["y"][at + k] = centre[:, 0] + radius * x, centre[:, 1] + radius * y


def _boxes(moves: Moves, start: Floats, sweep: Floats) -> Floats:
    """Return (n, 4) boxes of the moves, mm; those of arcs reach to the quadrants they pass."""
    a, b = start[:, :2], moves.end[:, :2]
    low, high = np.minimum(a, b), np.maximum(a, b)
    arcs = np.flatnonzero(moves.kind >= MoveKind.ARC_CW)
    if len(arcs):
        centre, turn = moves.centre[arcs], sweep[arcs]
        radius = np.hypot(*(a[arcs] - centre).T)
        begin = np.arctan2(a[arcs, 1] - centre[:, 1], a[arcs, 0] - centre[:, 0])
        for k, (dx, dy) in enumerate(((1, 0), (0, 1), (-1, 0), (0, -1))):
            ahead = (k * math.pi / 2 - begin) * np.sign(turn) % math.tau
            point = np.where((ahead <= np.abs(turn))[:, None], centre + radius[:, None] * np.array([dx, dy]), a[arcs])
            low[arcs], high[arcs] = np.minimum(low[arcs], point), np.maximum(high[arcs], point)
    return np.hstack([low, high])
