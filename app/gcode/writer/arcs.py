"""Arcs under rounding: what G2 and G3 blocks to write so that the control's arc is the one that was meant.

A control knows an arc by its rounded start, its rounded end and a rounded centre. Rounding each by itself makes the
two radii differ, and turns an arc whose ends round to one point into a full circle or into nothing. So the centre is
solved again from the rounded ends, every written arc is measured against the meant one, and what does not fit is
split in halves, down to pieces so flat that a line is as good. Controls take arcs of less than about 1e-6 rad for
full circles; such an arc is flat in this sense for any radius below 1e8 mm.
"""

from __future__ import annotations

import cmath
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core.errors import GeometryError

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
