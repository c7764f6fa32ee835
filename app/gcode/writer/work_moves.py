"""Moves in the program's own coordinates: from the work origin, in out units, rounded once."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ...model.moves import MoveKind, Moves
from ...model.part import Units
from ..posts.post import WordDecimals
from .arcs import ArcRules, Floats, Whole, all_pieces
from .block_kernels import NO_FEED
from .grid import Position, whole


@dataclass(frozen=True, slots=True)
class MoveLists:
    """Columns of a program's moves as lists, for who looks at single ones; see `WorkMoves`."""

    kind: list[MoveKind]
    purpose: list[int]
    tool: list[int]
    operation: list[int]
    end: list[Position]
    feed: list[int]

    def __len__(self) -> int:
        """Return the number of moves."""
        return len(self.kind)


@dataclass(frozen=True, eq=False)
class WorkMoves:
    """Columns of a program's n moves, ready to be spelled.

    Attributes:
        kind, purpose, tool, operation: (n,) as in the moves.
        end: (n, 3) X, Y, Z as counts of the last decimal.
        z: (n,) heights before rounding, out units.
        feed: (n,) counts of the last decimal of F, at least one, as controls refuse F0.
        arc_rows: (k,) which moves are arcs.
        arcs: (k, 6) the meant arcs, see `all_pieces`.
    """

    kind: NDArray[np.uint8]
    purpose: NDArray[np.uint8]
    tool: NDArray[np.int16]
    operation: NDArray[np.int16]
    end: Whole
    z: Floats
    feed: Whole
    arc_rows: NDArray[np.intp]
    arcs: Floats

    def __len__(self) -> int:
        """Return the number of moves."""
        return len(self.kind)

    @cached_property
    def lists(self) -> MoveLists:
        """The columns as lists."""
        return MoveLists(
            [MoveKind(kind) for kind in self.kind.tolist()],
            self.purpose.tolist(),
            self.tool.tolist(),
            self.operation.tolist(),
            [(x, y, z) for x, y, z in self.end.tolist()],
            self.feed.tolist(),
        )


@dataclass(frozen=True, eq=False)
class MotionRows:
    """Moves as the motions that the control is told of.

    Attributes:
        rows: (m, 7) see `write_blocks`. A move's last row goes straight to its end: what the pieces of an arc lack of
            it.
        stops: (n,) how many rows the moves up to each one have, itself counted.
    """

    rows: Whole
    stops: Whole

    @staticmethod
    def none() -> MotionRows:
        """Return those of no moves."""
        return MotionRows(np.zeros((0, 7), np.int64), np.zeros(0, np.int64))


def work_moves(moves: Moves, origin: tuple[float, float, float], units: Units, digits: WordDecimals) -> WorkMoves:
    """Return the moves shifted to the work origin, scaled to the units and rounded to the digits."""
    end = (moves.end - np.array(origin)) / units.value
    columns = [whole(column, decimals) for column, decimals in zip(end.T, (digits.X, digits.Y, digits.Z), strict=True)]
    rows = np.flatnonzero(moves.kind >= MoveKind.ARC_CW)
    return WorkMoves(
        moves.kind,
        moves.purpose,
        moves.tool,
        moves.operation,
        np.column_stack(columns),
        end[:, 2].copy(),
        np.maximum(1, whole(moves.feed / units.value, digits.F)),
        rows,
        _meant_arcs(moves, rows, origin, units),
    )


def _meant_arcs(moves: Moves, rows: NDArray[np.intp], origin: tuple[float, float, float], units: Units) -> Floats:
    """Return the arcs as the tool path has them; one that ends exactly where it starts is a full turn."""
    centre = moves.centre[rows]
    first, last = moves.start[rows, :2] - centre, moves.end[rows, :2] - centre
    return np.column_stack(
        [
            (centre - np.array(origin[:2])) / units.value,
            np.hypot(*first.T) / units.value,
            np.hypot(*last.T) / units.value,
            np.arctan2(first[:, 1], first[:, 0]),
            moves.sweeps()[rows],
        ]
    )


def motion_rows(moves: WorkMoves, span: tuple[int, int], rules: ArcRules, z_scale: float) -> MotionRows:
    """Return the motions of some moves, arcs as pieces that the control can do.

    Args:
        moves: the program's.
        span: the first of them, and the one behind the last.
        rules: of its arcs.
        z_scale: counts of the last decimal of Z in an out unit.

    Raises:
        GeometryError: an arc cannot be written.
    """
    first, stop = span
    chosen = slice(*np.searchsorted(moves.arc_rows, span).tolist())
    arcs = moves.arc_rows[chosen]
    pieces = all_pieces(moves.arcs[chosen], np.column_stack([moves.end[arcs - 1, :2], moves.end[arcs, :2]]), rules)
    many = np.diff(pieces.stops, prepend=0)
    count = np.ones(stop - first, np.int64)
    count[arcs - first] += many
    stops = np.cumsum(count)
    rows = np.zeros((int(stops[-1]), 7), np.int64)
    kind = moves.kind[first:stop]
    rows[stops - 1, 0] = np.minimum(kind, MoveKind.LINE)
    rows[stops - 1, 1:4] = moves.end[first:stop]
    rows[stops - 1, 6] = np.where(kind == MoveKind.RAPID, NO_FEED, moves.feed[first:stop])
    inner = np.ones(len(rows), bool)
    inner[stops - 1] = False
    of, at = np.repeat(arcs, many), pieces.fraction
    z = np.rint((moves.z[of - 1] + (moves.z[of] - moves.z[of - 1]) * at) * z_scale)
    rows[inner] = np.column_stack(
        [
            np.where(pieces.round, moves.kind[of], MoveKind.LINE),
            pieces.end,
            np.where(at == 1.0, moves.end[of, 2], z.astype(np.int64)),
            pieces.centre,
            moves.feed[of],
        ]
    )
    return MotionRows(rows, stops)
