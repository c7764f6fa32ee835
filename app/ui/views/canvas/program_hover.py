"""Which move lies under the mouse, and what there is to say about it."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ....model.curves import Point
from ....model.job import Job
from ....model.moves import MoveKind, Purpose
from .painting.move_shapes import MoveShapes

_NAMES = {
    Purpose.RAPID: "Rapid",
    Purpose.PLUNGE: "Plunge",
    Purpose.CONTOUR: "Contour",
    Purpose.POCKET: "Pocket",
    Purpose.LINK: "Link",
    Purpose.LEAD: "Lead",
    Purpose.DRILL: "Drill",
    Purpose.TAB: "Tab",
    Purpose.DOG_BONE: "Dog-bone",
}


def nearest_move(shapes: MoveShapes, at: Point, reach: float, purposes: frozenset[Purpose]) -> int | None:
    """Return the number of the move nearest to a point, or None.

    Args:
        at: mm.
        reach: largest distance, mm.
        purposes: moves for other purposes are passed over.
    """
    boxes = shapes.boxes
    near = (
        (boxes[:, 0] <= at[0] + reach)
        & (boxes[:, 2] >= at[0] - reach)
        & (boxes[:, 1] <= at[1] + reach)
        & (boxes[:, 3] >= at[1] - reach)
    )
    rows = np.flatnonzero(near)
    rows = rows[np.isin(shapes.moves.purpose[rows], [int(p) for p in purposes])]
    if not len(rows):
        return None
    distance = _distances(shapes, rows, at)
    best = int(np.argmin(distance))
    return int(rows[best]) if distance[best] <= reach else None


def describe(shapes: MoveShapes, move: int, job: Job) -> str:
    """Return what a move is: operation, tool, feed, length, Z."""
    moves = shapes.moves
    piece = shapes.piece[move]
    whole = float(shapes.length[shapes.first[piece] : shapes.last[piece]].sum())
    number = int(moves.tool[move])
    tool = next((f"T{number} {t.label}" for t in job.tools if t.number == number), f"T{number}")
    words = [_name(int(moves.operation[move]), Purpose(int(moves.purpose[move])), job), tool]
    if moves.region[move] > 0:
        words.append(f"region {int(moves.region[move])}")
    if moves.kind[move] != MoveKind.RAPID:
        words.append(f"F {moves.feed[move]:g}")
    words.append(
        f"{shapes.length[move]:.3f}" + (f" of {whole:.3f} mm" if whole > shapes.length[move] + 5e-4 else " mm")
    )
    if moves.kind[move] >= MoveKind.ARC_CW:
        words.append(f"R {math.dist(moves.end[move, :2], moves.centre[move]):.3f}")
    return " · ".join([*words, f"Z {moves.end[move, 2]:.3f}"])


def _name(operation: int, purpose: Purpose, job: Job) -> str:
    """Return the purpose, with the operation's name where that is another."""
    name = _NAMES[purpose]
    if purpose in (Purpose.CONTOUR, Purpose.POCKET) or not 0 <= operation < len(job.operations):
        return name
    return f"{name} of {job.operations[operation].WORD}"


def _distances(shapes: MoveShapes, rows: NDArray[np.int64], at: Point) -> NDArray[np.float64]:
    """Return the exact distance in the plane of a point from each of these moves, mm."""
    p = np.asarray(at)
    a, b = shapes.start[rows, :2], shapes.moves.end[rows, :2]
    d = b - a
    square = np.einsum("ij,ij->i", d, d)
    share = np.clip(np.einsum("ij,ij->i", p - a, d) / np.where(square > 0, square, 1.0), 0.0, 1.0)
    distance = np.hypot(*(a + share[:, None] * d - p).T)
    arcs = np.flatnonzero(shapes.moves.kind[rows] >= MoveKind.ARC_CW)
    if len(arcs):
        centre, sweep = shapes.moves.centre[rows[arcs]], shapes.sweep[rows[arcs]]
        radius = np.hypot(*(a[arcs] - centre).T)
        begin = np.arctan2(*(a[arcs] - centre).T[::-1])
        here = np.arctan2(*(p - centre).T[::-1])
        within = ((here - begin) * np.sign(sweep)) % math.tau <= np.abs(sweep)
        ends = np.minimum(np.hypot(*(a[arcs] - p).T), np.hypot(*(b[arcs] - p).T))
        distance[arcs] = np.where(within, np.abs(np.hypot(*(p - centre).T) - radius), ends)
    return np.asarray(distance)
