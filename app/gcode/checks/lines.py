"""Which motions of a text were written for which moves: by the lines, and within a canned cycle one after the other."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...model.motion import Floats, MotionKind, Motions
from ...model.moves import Moves

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
