"""Moves in the program's own coordinates: from the work origin, in out units, rounded once."""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ...core.errors import GeometryError
from ...model.moves import MoveKind, Moves
from ...model.part import Units
from ..posts import Post, WordDecimals
from .block_kernels import NO_FEED
from .template_fields import Position, whole


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
        kind=moves.kind,
        purpose=moves.purpose,
        tool=moves.tool,
        operation=moves.operation,
        end=np.column_stack(columns),
        z=end[:, 2].copy(),
        feed=np.maximum(1, whole(moves.feed / units.value, digits.F)),
        arc_rows=rows,
        arcs=_meant_arcs(moves, rows, origin, units),
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


# Arcs under rounding: what G2 and G3 blocks to write so that the control's arc is the one that was meant.
#
# A control knows an arc by its rounded start, its rounded end and a rounded centre. Rounding each by itself makes the
# two radii differ, and turns an arc whose ends round to one point into a full circle or into nothing. So the centre is
# solved again from the rounded ends, every written arc is measured against the meant one, and what does not fit is
# split in halves, down to pieces so flat that a line is as good. Controls take arcs of less than about 1e-6 rad for
# full circles; such an arc is flat in this sense for any radius below 1e8 mm.


Grid = tuple[int, int]
"""A point as counts of the last decimal of X and Y."""

Whole = NDArray[np.int64]

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class ReferenceArc:
    """An arc as the tool path has it, out units.

    Attributes:
        centre: as a complex number.
        start_radius, end_radius: distances of the ends from the centre; alike but for the path's own rounding.
        start_angle: radians.
        sweep: radians, counter-clockwise positive, not 0, at most a full turn.
    """

    centre: complex
    start_radius: float
    end_radius: float
    start_angle: float
    sweep: float

    def at(self, fraction: float) -> complex:
        """Return the point at a fraction in [0, 1] of the sweep."""
        radius = self.start_radius + (self.end_radius - self.start_radius) * fraction
        return self.centre + cmath.rect(radius, self.start_angle + self.sweep * fraction)


_STEPS = 2.0
"""Steps of the last decimal that an arc of rounded ends may be from the meant one, where nothing closer is asked."""


@dataclass(frozen=True, slots=True)
class ArcRules:
    """What a written arc must keep to.

    Attributes:
        decimals: of X and Y.
        centre_decimals: of I and J, not less.
        tolerance: largest distance between the written and the meant arc, point by point, out units.
        largest_sweep: radians, < 2 pi.
        smallest_radius, largest_radius: out units; the smallest is > 0.
        radius_mismatch: largest difference of the two radii, out units.
    """

    decimals: int
    centre_decimals: int
    tolerance: float
    largest_sweep: float
    smallest_radius: float
    largest_radius: float
    radius_mismatch: float

    @classmethod
    def of(cls, post: Post, units: Units, tolerance: float | None = None) -> ArcRules:
        """Return those of a post for a program in units; `tolerance`: as above, None = `_STEPS`."""
        digits, arcs, unit = post.digits(units), post.arcs, units.value
        return cls(
            digits.X,
            digits.I,
            _STEPS * 10.0**-digits.X if tolerance is None else tolerance,
            math.radians(arcs.largest_sweep_deg),
            arcs.smallest_radius_mm / unit,
            arcs.largest_radius_mm / unit,
            arcs.radius_mismatch_mm / unit,
        )

    def row(self) -> Floats:
        """Return (8,) what the compiled core is given."""
        return np.array(
            (
                10.0**-self.decimals,
                10.0**self.decimals,
                10.0**self.centre_decimals,
                self.tolerance,
                self.largest_sweep,
                self.smallest_radius,
                self.largest_radius,
                self.radius_mismatch,
            )
        )


@dataclass(frozen=True, slots=True)
class ArcBlock:
    """One block: an arc, or a line where `centre` is None.

    Attributes:
        end: counts of the last decimal.
        fraction: of the whole arc that is done at the end, in (0, 1].
        centre: from the block's start to the centre, counts of the last decimal of I and J.
    """

    end: Grid
    fraction: float
    centre: Grid | None = None


@dataclass(frozen=True, eq=False)
class ArcBlocks:
    """The blocks of many arcs, one arc after the other.

    Attributes:
        end, centre: (m, 2) as in a `ArcBlock`; the centre of a line is 0, 0.
        round: (m,) False for lines.
        fraction: (m,) of its arc that is done at the end of each block, in (0, 1].
        stops: (n,) how many blocks the arcs up to each one have, itself counted.
    """

    end: Whole
    centre: Whole
    round: NDArray[np.bool_]
    fraction: Floats
    stops: Whole


def all_pieces(arcs: Floats, ends: Whole, rules: ArcRules) -> ArcBlocks:
    """Return the blocks that cut arcs, each between its rounded ends.

    Each block's path stays within `rules.tolerance` of its stretch of the meant arc, and is swept in step with it, so
    that neither can leave the other. An arc smaller than the last decimal gives no block at all.

    Args:
        arcs: (n, 6) the fields of `ReferenceArc`, the centre as x and y.
        ends: (n, 4) where the control is and has to be, the nearest grid points to each arc's ends.
        rules: tolerance and limits.

    Raises:
        GeometryError: the numbers of an arc are none, or so large that no block of the last decimal is near enough.
    """
    from .arc_kernels import write_pieces  # compiled code: loaded where it is used

    room, first, stops = 2 * len(arcs) + 16, 0, np.zeros(len(arcs), np.int64)
    pieces, fraction = np.empty((room, 5), np.int64), np.empty(room)
    while (first := write_pieces(arcs, ends, rules.row(), first, pieces, fraction, stops)) < len(arcs):
        if first < 0:
            x, y, radius = arcs[-1 - first, :3].tolist()
            raise GeometryError(
                f"The arc round X{x:g} Y{y:g} of radius {radius:g} cannot be written within {rules.tolerance:g}; "
                "write more decimals, or make the drawing smaller."
            )
        pieces, fraction = (
            np.concatenate([pieces, np.empty_like(pieces)]),
            np.concatenate([fraction, np.empty_like(fraction)]),
        )
    count = int(stops[-1]) if len(stops) else 0
    pieces = pieces[:count]
    return ArcBlocks(pieces[:, :2], pieces[:, 2:4], pieces[:, 4] == 1, fraction[:count], stops)


def written_pieces(arc: ReferenceArc, start: Grid, end: Grid, rules: ArcRules) -> list[ArcBlock]:
    """Return the blocks that cut one arc between its rounded ends; see `all_pieces`.

    Args:
        arc: the meant arc.
        start, end: where the control is and has to be, the nearest grid points to the arc's ends.
        rules: tolerance and limits.
    """
    row = (arc.centre.real, arc.centre.imag, arc.start_radius, arc.end_radius, arc.start_angle, arc.sweep)
    found = all_pieces(np.array([row]), np.array([(*start, *end)], np.int64), rules)
    columns = (found.end.tolist(), found.fraction.tolist(), found.centre.tolist(), found.round.tolist())
    return [
        ArcBlock((x, y), fraction, (i, j) if bent else None)
        for (x, y), fraction, (i, j), bent in zip(*columns, strict=True)
    ]
