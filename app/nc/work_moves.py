"""Moves in the program's own coordinates: from the work origin, in out units, rounded once."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from app.model.moves import MoveKind, Moves
from app.model.part import Units
from app.nc.arcs import MeantArc
from app.nc.grid import Position, counts
from app.nc.post import WordDecimals


@dataclass(frozen=True)
class WorkMoves:
    """Columns of a program's moves, ready to be spelled.

    Attributes:
        kind, purpose, tool, operation: as in the moves.
        end: X, Y, Z as counts of the last decimal.
        z: heights before rounding, out units.
        feed: counts of the last decimal of F, at least one, as controls refuse F0.
        arcs: the meant arc of each arc move, by index.
    """

    kind: list[MoveKind]
    purpose: list[int]
    tool: list[int]
    operation: list[int]
    end: list[Position]
    z: list[float]
    feed: list[int]
    arcs: dict[int, MeantArc]

    def __len__(self) -> int:
        """Return the number of moves."""
        return len(self.kind)


def work_moves(moves: Moves, origin: tuple[float, float, float], units: Units, digits: WordDecimals) -> WorkMoves:
    """Return the moves shifted to the work origin, scaled to the units and rounded to the digits."""
    end = (moves.end - np.array(origin)) / units.value
    columns = [counts(column, decimals) for column, decimals in zip(end.T, (digits.X, digits.Y, digits.Z), strict=True)]
    return WorkMoves(
        kind=[MoveKind(kind) for kind in moves.kind.tolist()],
        purpose=moves.purpose.tolist(),
        tool=moves.tool.tolist(),
        operation=moves.operation.tolist(),
        end=list(zip(*columns, strict=True)),
        z=end[:, 2].tolist(),
        feed=[max(1, feed) for feed in counts(moves.feed / units.value, digits.F)],
        arcs=_meant_arcs(moves, origin, units),
    )


def _meant_arcs(moves: Moves, origin: tuple[float, float, float], units: Units) -> dict[int, MeantArc]:
    """Return the arcs as the tool path has them; one that ends exactly where it starts is a full turn."""
    rows = np.flatnonzero(moves.kind >= MoveKind.ARC_CW)
    centre = moves.centre[rows]
    first, last = moves.start[rows, :2] - centre, moves.end[rows, :2] - centre
    columns = (
        ((centre - np.array(origin[:2])) / units.value) @ np.array([1, 1j]),
        np.hypot(*first.T) / units.value,
        np.hypot(*last.T) / units.value,
        np.arctan2(first[:, 1], first[:, 0]),
        moves.sweeps()[rows],
    )
    arcs = (MeantArc(*row) for row in zip(*(column.tolist() for column in columns), strict=True))
    return dict(zip(rows.tolist(), arcs, strict=True))
