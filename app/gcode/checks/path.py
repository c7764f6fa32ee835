"""Where a written path leaves the moves that were meant: ends, straight lines, arcs all along."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...model.motion import Floats, MotionKind, Motions
from ...model.motion_path import ArcPaths, arc_paths
from ...model.moves import MoveKind, Moves

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
        np.maximum.at(found, owned.move[some], _along_arcs(motions, reference, owned.rows[some], owned.move[some]))
    still = np.flatnonzero(arc & (owned.count == 0) & (last >= 0))
    if len(still):
        found[still] = np.maximum(found[still], _still_on_arcs(reached[still], reference, still))
    return found


def _sizes(vectors: Floats) -> Floats:
    return np.asarray(np.sqrt(np.einsum("ij,ij->i", vectors, vectors)))


def _still_on_arcs(places: Floats, reference: ReferencePath, move: Rows) -> Floats:
    """Return a bound for arcs that are nothing after rounding: the tool stands still at a place."""
    from .check_kernels import in_step

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


def _along_arcs(motions: Motions, reference: ReferencePath, rows: Rows, move: Rows) -> Floats:
    """Return a bound for each motion that stands for a stretch of an arc.

    Args:
        rows, move: row and move of each, in their order.
    """
    from .check_kernels import in_step

    written = _written_arcs(motions, rows)
    stops, begins = _fractions(motions, reference, rows, move, written[:, 5])
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
    motions: Motions, reference: ReferencePath, rows: Rows, move: Rows, sweep: Floats
) -> tuple[Floats, Floats]:
    """Return at which fractions of its arc each motion ends and begins.

    Where a motion ends, its angle round the meant centre from where the arc was to begin, and the height it has risen,
    both tell how far along the arc it is; each counts by the square of what it is worth in length. The last motion of a
    move has to end at 1.
    """
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


# How far a path that a control makes from a contour leaves the moves that were meant: across them, not along.
#
# What is rounded on the contour turns the tool's centre by the tool's radius: ends of motions move along the path,
# much farther than the path moves sideways; and a control takes a gentle bend for none. So where two moves go on into
# one another, what an end is off counts across them, and along them only by as much as the path bends away there.


_GENTLE = 0.06
"""Radians; moves that turn less where they meet go on into one another. LinuxCNC takes 0.05 for no corner."""

_LEAST = 1e-9


def beside(
    motions: Motions, reference: ReferencePath, owned: MotionOwners, far: Floats, controlled: NDArray[np.bool_]
) -> Floats:
    """Return (n,) how far the written path may be from each move at most, mm.

    Args:
        far: (n,) as much, of ends and all along; stays for all moves but those of one motion under control.
        controlled: (n,) whether a control makes a move's path from the contour.
    """
    if not controlled.any():
        return far
    found, arc = far.copy(), reference.kind >= MoveKind.ARC_CW
    bend = np.where(arc, _radius(reference, np.arange(len(far))), 0.0) * reference.sweep**2 / 2
    gentle = arc & (np.abs(reference.sweep) <= _GENTLE)
    # a bend that is taken for none: the next motion goes on from here
    passed = controlled & gentle & (owned.count == 0)
    found[passed] = np.minimum(far, bend)[passed]
    own = np.flatnonzero(controlled & (owned.count == 1) & (far > 0) & (reference.kind != MoveKind.RAPID))
    rows = owned.rows[owned.first[own]]
    chord = gentle[own] & (motions.kind[rows] == MotionKind.LINE)
    alike = (motions.kind[rows] == reference.kind[own]) | chord
    own, rows, chord = own[alike], rows[alike], chord[alike]
    if not len(own):
        return found
    line = _off_line(motions, reference, rows, own)
    across = np.where(arc[own], np.where(chord, _off_arc(motions, reference, rows, own), 0.0), line)
    circle = arc[own] & ~chord
    across[circle] = _off_circle(motions, reference, rows[circle], own[circle])
    begin = _at_joint(reference, own - 1, motions.start[rows] - reference.start[own])
    end = _at_joint(reference, own, motions.end[rows] - reference.end[own])
    found[own] = np.minimum(far[own], across + np.maximum(begin, end))
    return found


def _off_arc(motions: Motions, reference: ReferencePath, rows: NDArray[np.intp], own: NDArray[np.intp]) -> Floats:
    """Return how far straight motions are from the circles of their moves at most, mm; height counts whole."""
    meant, found = _radius(reference, own), np.zeros(len(own))
    for place, level in ((motions.start[rows], reference.start[own]), (motions.end[rows], reference.end[own])):
        off = np.linalg.norm(place[:, :2] - reference.centre[own], axis=1) - meant
        found = np.maximum(found, np.hypot(off, place[:, 2] - level[:, 2]))
    size = np.linalg.norm(motions.end[rows] - motions.start[rows], axis=1)
    return np.asarray(found + size**2 / (8 * np.maximum(meant, _LEAST)))


def _off_line(motions: Motions, reference: ReferencePath, rows: NDArray[np.intp], own: NDArray[np.intp]) -> Floats:
    """Return how far both ends of motions are from the lines of their moves at most, mm."""
    way = reference.end[own] - reference.start[own]
    unit = way / np.maximum(np.linalg.norm(way, axis=1), _LEAST)[:, None]
    found = np.zeros(len(own))
    for place in (motions.start[rows], motions.end[rows]):
        off = place - reference.start[own]
        found = np.maximum(found, np.linalg.norm(off - unit * np.einsum("ni,ni->n", off, unit)[:, None], axis=1))
    return found


def _off_circle(motions: Motions, reference: ReferencePath, rows: NDArray[np.intp], own: NDArray[np.intp]) -> Floats:
    """Return how far the circles of motions are from those of their moves at most, mm; height counts whole."""
    apart = np.linalg.norm(motions.centre[rows, :2] - reference.centre[own], axis=1)
    meant = np.linalg.norm(reference.end[own, :2] - reference.centre[own], axis=1)
    found = np.zeros(len(own))
    for place, level in ((motions.start[rows], reference.start[own]), (motions.end[rows], reference.end[own])):
        radius = np.linalg.norm(place[:, :2] - motions.centre[rows, :2], axis=1)
        found = np.maximum(found, np.hypot(apart + np.abs(radius - meant), place[:, 2] - level[:, 2]))
    return np.nan_to_num(found)


def _at_joint(reference: ReferencePath, before: NDArray[np.intp], off: Floats) -> Floats:
    """Return how far a path may leave two moves where its end is off the joint between them, mm.

    Args:
        before: (m,) the move before the joint. off: (m, 3) mm.
    """
    after = np.minimum(before + 1, len(reference.kind) - 1)
    before = np.maximum(before, 0)
    turn = _arriving(reference, before, 1.0) - _arriving(reference, after, 0.0)
    turn = np.abs(turn - 2 * np.pi * np.rint(turn / (2 * np.pi)))
    size = np.linalg.norm(off, axis=1)
    bent = np.minimum(_radius(reference, before), _radius(reference, after))
    gone = size * np.sin(np.minimum(turn, _GENTLE)) + size**2 / (2 * bent)
    return np.asarray(np.where(turn <= _GENTLE, np.minimum(gone, size), size))


def _arriving(reference: ReferencePath, move: NDArray[np.intp], share: float) -> Floats:
    """Return the directions of moves at their start or end, radians."""
    way = reference.end[move] - reference.start[move]
    place = reference.end[move, :2] if share else reference.start[move, :2]
    out = place - reference.centre[move]
    round_ = np.arctan2(out[:, 1], out[:, 0]) + np.copysign(np.pi / 2, reference.sweep[move])
    return np.where(reference.kind[move] >= MoveKind.ARC_CW, round_, np.arctan2(way[:, 1], way[:, 0]))


def _radius(reference: ReferencePath, move: NDArray[np.intp]) -> Floats:
    """Return the radii of moves, mm; inf of straight ones."""
    radius = np.linalg.norm(reference.end[move, :2] - reference.centre[move], axis=1)
    return np.where(reference.kind[move] >= MoveKind.ARC_CW, np.maximum(radius, _LEAST), np.inf)


# Which motions of a text were written for which moves: by the lines, and within a canned cycle one after the other.


Rows = NDArray[np.intp]

Mask = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class ReferencePath:
    """The moves as points in the program's coordinates, mm.

    Attributes:
        start, end: (n, 3). centre: (n, 2). sweep: (n,) radians, counter-clockwise positive.
        kind: (n,) MoveKind.
    """

    start: Floats
    end: Floats
    centre: Floats
    sweep: Floats
    kind: NDArray[np.uint8]

    @staticmethod
    def of(moves: Moves, origin: tuple[float, float, float]) -> ReferencePath:
        """Return those of moves in part coordinates, from the work origin."""
        shift = np.array(origin)
        return ReferencePath(
            moves.start - shift, moves.end - shift, moves.centre - shift[:2], moves.sweeps(), moves.kind
        )


@dataclass(frozen=True, eq=False)
class MotionOwners:
    """Which motions belong to which moves.

    Attributes:
        rows: (m,) the motions that belong to moves, in order.
        move: (m,) index of the move of each, not decreasing.
        first: (n,) place in `rows` of each move's first motion. count: (n,) how many it has; 0 = it is nothing after
            rounding.
        last: (n,) row of the motion after which each move is done: its own last one, else the one before; -1 = there is
            none.
    """

    rows: Rows
    move: Rows
    first: Rows
    count: Rows
    last: Rows


def motion_owners(
    motions: Motions, lines: NDArray[np.int32], begins: Rows, reference: ReferencePath, allowed: Floats
) -> MotionOwners:
    """Tell which motions belong to which moves.

    A move has the motions behind the line of the move before, up to its own line. Of moves that share a line the first
    has them all, the others are nothing after rounding; but where that line does several straight motions it is a
    canned cycle, and moves and motions follow one another, those that are alike together.

    Args:
        motions: as the text was read; their lines do not decrease.
        lines: (n,) of the moves, not decreasing.
        begins: index of the first move of each tool; what stands before its line belongs to no move.
        reference: the moves.
        allowed: (n,) how near to its move's end a motion of a cycle, or round a corner, ends, mm.
    """
    line = motions.line
    move = np.searchsorted(lines, line)
    starting = np.zeros(len(lines) + 1, bool)
    starting[begins] = True
    before = starting[move] & (line < lines[np.minimum(move, len(lines) - 1)])
    rows = np.flatnonzero((move < len(lines)) & ~before)
    rows, mine = _Cycles(motions, lines, reference, allowed).parted(rows, move[rows])
    each = np.arange(len(lines))
    first = np.searchsorted(mine, each)
    count = np.searchsorted(mine, each, side="right") - first
    last = np.full(len(lines), -1)
    last[count > 0] = rows[(first + count - 1)[count > 0]]
    return MotionOwners(rows, mine, first, count, np.maximum.accumulate(last))


@dataclass(frozen=True, eq=False)
class _Cycles:
    """Hands the motions of canned cycles out to the moves that share a line."""

    motions: Motions
    lines: NDArray[np.int32]
    reference: ReferencePath
    allowed: Floats

    def parted(self, rows: Rows, move: Rows) -> tuple[Rows, Rows]:
        """Return motions and their moves again; rapids of a cycle that go nowhere belong to no move."""
        line = self.motions.line[rows]
        own, first, many = np.unique(line, return_index=True, return_counts=True)
        shared = np.searchsorted(self.lines, own, side="right") - np.searchsorted(self.lines, own)
        kept, move = np.ones(len(rows), bool), move.copy()
        for at, begin, count in zip(
            *(column[(many > 1) & (shared > 1)].tolist() for column in (own, first, many)), strict=True
        ):
            places = np.arange(begin, begin + count)
            stays = np.all(self.motions.start[rows[places]] == self.motions.end[rows[places]], axis=1)
            stays &= self.motions.kind[rows[places]] == MotionKind.RAPID
            kept[places[stays]] = False
            move[places[~stays]] = self._handed_out(rows[places[~stays]], at)
        return rows[kept], move[kept]

    def _handed_out(self, rows: Rows, line: int) -> Rows:
        """Return the move of each motion of a cycle, in turn; the first move of the line for all, where they are not
        alike.
        """
        first, stop = (int(np.searchsorted(self.lines, line, side=side)) for side in ("left", "right"))
        found, k = np.full(len(rows), first), first
        for i, row in enumerate(rows):
            while k < stop and not self._alike(int(row), k):
                k += 1
            if k == stop:
                return np.full(len(rows), first)
            found[i] = k
            k += 1
        return found

    def _alike(self, row: int, move: int) -> bool:
        """Tell whether a motion is of a move's kind and ends where it ends."""
        gap = self.motions.end[row] - self.reference.end[move]
        return bool(self.motions.kind[row] == self.reference.kind[move] and np.max(np.abs(gap)) <= self.allowed[move])
