"""Where a written path leaves the moves that were meant: ends, straight lines, arcs all along."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...model.motion import Floats, Motions
from ...model.motion_path import ArcPaths, arc_paths
from ...model.moves import MoveKind
from .lines import MotionOwners, ReferencePath, Rows

NOTHING = 1e-9
"""mm; a rise or radius below which it tells nothing of how far along an arc a point is."""

_AT_A_TIME = 100_000
"""Motions that are compared with arcs together: what is reckoned of each takes several times what it is."""


def distances(motions: Motions, reference: ReferencePath, owned: MotionOwners) -> Floats:
    """Return (n,) how far the written path may be from each move at most, mm: a bound both ways, all along the move.

    A straight move and a straight motion are nowhere farther apart than at their ends. An arc is compared point by
    point with the motions that stand for it, each with the stretch between the two points of the arc that its own ends
    mean.
    """
    last = owned.last
    reached = motions.end[last] if len(motions) else np.full_like(reference.end, np.inf)
    found = np.where(last >= 0, _sizes(reached - reference.end), np.inf)
    arc = reference.kind >= MoveKind.ARC_CW
    mine = arc[owned.move]
    for some in _portions(owned.move, np.flatnonzero(mine)):
        np.maximum.at(found, owned.move[some], _along_arcs(motions, reference, (owned.rows[some], owned.move[some])))
    still = np.flatnonzero(arc & (owned.count == 0) & (last >= 0))
    if len(still):
        found[still] = np.maximum(found[still], _still_on_arcs(reached[still], reference, still))
    return found


def _sizes(vectors: Floats) -> Floats:
    return np.asarray(np.sqrt(np.einsum("ij,ij->i", vectors, vectors)))


def _still_on_arcs(places: Floats, reference: ReferencePath, move: Rows) -> Floats:
    """Return a bound for arcs that are nothing after rounding: the tool stands still at a place."""
    from .arc_distance_kernels import in_step

    flat, whole = np.empty(len(move)), np.tile([0.0, 1.0], (len(move), 1))
    in_step(
        np.zeros((len(move), 6)),
        np.column_stack([places[:, :2], places[:, :2]]),
        _meant_arcs(reference, move),
        whole,
        flat,
    )
    heights = np.maximum(np.abs(places[:, 2] - reference.start[move, 2]), np.abs(places[:, 2] - reference.end[move, 2]))
    return np.asarray(np.hypot(flat, heights))


def _portions(move: Rows, mine: Rows) -> Iterator[Rows]:
    """Yield some motions in portions; those of one move stay together."""
    begins = np.flatnonzero(np.diff(move[mine], prepend=-1))
    first = 0
    while first < len(mine):
        at = np.searchsorted(begins, first + _AT_A_TIME)
        stop = int(begins[at]) if at < len(begins) else len(mine)
        yield mine[first:stop]
        first = stop


def _along_arcs(motions: Motions, reference: ReferencePath, at: tuple[Rows, Rows]) -> Floats:
    """Return a bound for each motion that stands for a stretch of an arc.

    Args:
        at: row and move of each, in their order.
    """
    from .arc_distance_kernels import in_step

    rows, move = at
    written = _written_arcs(motions, rows)
    stops, begins = _fractions(motions, reference, at, written[:, 5])
    flat, ends = np.empty(len(rows)), np.column_stack([motions.start[rows, :2], motions.end[rows, :2]])
    in_step(written, ends, _meant_arcs(reference, move), np.column_stack([begins, stops]), flat)
    rise = reference.end[move, 2] - reference.start[move, 2]
    heights = [
        points[rows, 2] - reference.start[move, 2] - rise * at
        for points, at in ((motions.start, begins), (motions.end, stops))
    ]
    return np.asarray(np.hypot(flat, np.max(np.abs(heights), axis=0)))


def _meant_arcs(reference: ReferencePath, move: Rows) -> Floats:
    """Return (m, 6) the circle of each move."""
    first, last = reference.start[move, :2] - reference.centre[move], reference.end[move, :2] - reference.centre[move]
    angle = np.arctan2(first[:, 1], first[:, 0])
    return np.column_stack([reference.centre[move], _sizes(first), _sizes(last), angle, reference.sweep[move]])


def _written_arcs(motions: Motions, rows: Rows) -> Floats:
    """Return (m, 6) the circle of each motion; sweep 0 where it is straight."""
    first, stop = int(rows.min()), int(rows.max()) + 1
    arcs: ArcPaths = arc_paths(motions, first, stop)
    place = np.full(stop - first, -1)
    place[arcs.rows - first] = np.arange(len(arcs))
    chosen = place[rows - first]
    written = np.zeros((len(rows), 6))
    round_ = chosen >= 0
    k = chosen[round_]
    written[round_] = np.column_stack(
        [arcs.centre[k], arcs.start_radius[k], arcs.end_radius[k], arcs.angle[k], arcs.sweep[k]]
    )
    return written


def _fractions(
    motions: Motions, reference: ReferencePath, at: tuple[Rows, Rows], sweep: Floats
) -> tuple[Floats, Floats]:
    """Return at which fractions of its arc each motion ends and begins.

    Where a motion ends, its angle round the meant centre from where the arc was to begin, and the height it has risen,
    both tell how far along the arc it is; each counts by the square of what it is worth in length. The last motion of a
    move has to end at 1.
    """
    rows, move = at
    centre = reference.centre[move]
    first, last = motions.start[rows, :2] - centre, motions.end[rows, :2] - centre
    turn = np.arctan2(last[:, 1], last[:, 0]) - np.arctan2(first[:, 1], first[:, 0])
    turn += 2 * np.pi * np.rint((sweep - turn) / (2 * np.pi))
    done = np.cumsum(turn)
    new = np.append(True, move[1:] != move[:-1])
    meant_first = reference.start[move, :2] - centre
    begun = np.arctan2(first[:, 1], first[:, 0]) - np.arctan2(meant_first[:, 1], meant_first[:, 0])
    begun -= 2 * np.pi * np.rint(begun / (2 * np.pi))
    base = (done - turn - begun)[new][np.cumsum(new) - 1]
    rise = reference.end[move, 2] - reference.start[move, 2]
    around = reference.sweep[move] * _sizes(reference.start[move, :2] - centre)
    worth = np.maximum(around**2 + rise**2, NOTHING**2)
    angular = around**2 * (done - base) / reference.sweep[move]
    stops = (angular + rise * (motions.end[rows, 2] - reference.start[move, 2])) / worth
    final = np.append(new[1:], True)
    stops[final] = 1.0
    begins = np.where(new, 0.0, np.concatenate([[0.0], stops[:-1]]))
    return stops, begins
