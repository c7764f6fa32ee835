"""Where along its path a cutter is looked at: places in the order of cutting, and the cells of path that they stand
for.

A chain is a run of cutting moves that go somewhere in the plane, without a lift between them. It is divided by its own
length, wherever its moves begin and end: into blocks, and these into cells, each looked at in its middle. So a path
that is cut into more moves is looked at in the same places.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...geometry.primitives import CX, CY, TURN, Rows, lengths, points_at
from ...model.moves import MoveKind, Moves
from ...model.tool import Tool
from ...model.tool_kind import ToolKind
from ..coverage.areas import move_rows

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]

BLOCK = 1 / 2
"""Radii; the least length of a block, for which one feed is chosen."""

CELL = 1 / 8
"""Radii; the largest length of a cell."""

MOST_PLACES = 1 << 18
"""Places that are prepared together, unless a single chain has more."""

_GAP = 4.0  # radii between chains on the scale of positions: more than any lag
_CORNER = 1e-3  # radians; where a path turns by less, the discs beside the joint cover what the one at the joint would
_SLACK = 1e-6
"""Rounding, of a share: what comes to a whole number of cells but for that is one."""


@dataclass(frozen=True, eq=False)
class PathPlaces:
    """A run of cutting moves of one tool.

    Positions are lengths in the plane along the path, mm, with a gap between chains.

    Attributes:
        moves: (k,) indices of the moves.
        begin, end: (k,) their positions; alike for those that go straight down.
        rows: (n, 6) x, y, z, position, direction of travel (0, 0 = only cut there), in the order of cutting, and one at
            the end that lies behind all others, so that these are all cut.
        seen: (m,) rows that have a direction, one a cell.
        first, last: (m,) positions between which each cell lies.
        block: (m,) number of its block, from 0, not falling.
        owner: (m,) the move (index into all moves) in its middle.
    """

    moves: Indices
    begin: Floats
    end: Floats
    rows: Floats
    seen: Indices
    first: Floats
    last: Floats
    block: Indices
    owner: Indices


def cutting_radius(tool: Tool, depth: float) -> float:
    """Return how wide a tool cuts at the top of metal that its tip is `depth` mm below, as a radius, mm, > 0.

    Args:
        depth: > 0.
    """
    radius = tool.radius
    if tool.kind is ToolKind.BALL:
        return math.sqrt(depth * (tool.diameter - depth)) if depth < radius else radius
    if tool.tip_angle:
        return min(radius, tool.tip_diameter / 2 + depth * math.tan(tool.tip_angle / 2))
    return radius


def runs(moves: Moves, cell: dict[int, float]) -> Iterator[Indices]:
    """Yield the cutting moves of one tool after the other, in pieces of about MOST_PLACES that begin where chains do.

    Args:
        cell: length of a cell by T number, mm.
    """
    chosen = np.flatnonzero(moves.kind != MoveKind.RAPID)
    if not len(chosen):
        return
    flat = lengths(move_rows(moves, chosen))
    tool, begins = moves.tool[chosen], chain_begins(chosen, flat)
    changed = np.concatenate([[True], tool[1:] != tool[:-1]])
    count = np.cumsum(flat / np.array([cell[int(number)] for number in tool]) + 2)
    start, cuts = 0, []
    for k in np.flatnonzero(begins | changed)[1:]:
        if changed[k] or count[k - 1] - (count[start - 1] if start else 0.0) > MOST_PLACES:
            cuts.append(k)
            start = int(k)
    yield from np.split(chosen, cuts)


def chain_begins(chosen: Indices, flat: Floats) -> NDArray[np.bool_]:
    """Tell which of some cutting moves (indices in order, lengths in the plane) begin a chain; one straight down is
    alone.
    """
    still = flat <= 0
    apart = np.diff(chosen) != 1
    return np.concatenate([[True], apart | still[1:] | still[:-1]])


def places(moves: Moves, chosen: Indices, radius: float) -> PathPlaces:
    """Return where to look at cutting moves of one tool.

    Args:
        chosen: (k,) indices of the moves, in order, k >= 1.
        radius: of the cutter, mm.
    """
    rows = move_rows(moves, chosen)
    flat = lengths(rows)
    begins = chain_begins(chosen, flat)
    chain = np.cumsum(begins) - 1
    end = np.cumsum(flat) + (chain + 1) * _GAP * radius
    begin = end - flat
    starts = np.flatnonzero(begins)
    stops = np.append(starts[1:], len(chosen)) - 1
    first, size, block = _cells(begin[starts], end[stops] - begin[starts], radius)
    middle = first + size / 2
    going = np.flatnonzero(flat > 0)
    own = (
        going[np.minimum(np.searchsorted(end[going], middle), max(len(going) - 1, 0))]
        if len(going)
        else np.zeros(0, np.int64)
    )
    at = np.clip((middle - begin[own]) / flat[own], 0.0, 1.0) if len(own) else np.zeros(0)
    looks = _looks(rows[own], at, _heights(moves, chosen[own], at), middle)
    stamps = _stamps(moves, chosen, _Chains(rows, flat, begins, begin, end))
    every = np.concatenate([looks, stamps])
    order = np.argsort(every[:, 3], kind="stable")
    tail = np.array([[0.0, 0.0, 0.0, math.inf, 0.0, 0.0]])
    seen = np.empty(len(order), np.int64)
    seen[order] = np.arange(len(order))
    return PathPlaces(
        moves=chosen,
        begin=begin,
        end=end,
        rows=np.concatenate([every[order], tail]),
        seen=seen[: len(looks)],
        first=first,
        last=first + size,
        block=block,
        owner=chosen[own],
    )


class _ChainCells(NamedTuple):
    """Cells of chains: where each begins, its size, and the number of its block."""

    begin: Floats
    size: Floats
    block: Indices


def _cells(begin: Floats, length: Floats, radius: float) -> _ChainCells:
    """Return the cells of some chains."""
    going = length > 0
    begin, length = begin[going], length[going]
    blocks = np.maximum(1, np.floor(length / (BLOCK * radius) + _SLACK)).astype(np.int64)
    each = np.maximum(1, np.ceil(length / blocks / (CELL * radius) - _SLACK)).astype(np.int64)
    count = blocks * each
    chain = np.repeat(np.arange(len(begin)), count)
    number = np.arange(len(chain)) - np.repeat(np.cumsum(count) - count, count)
    size = (length / count)[chain]
    block = (np.cumsum(blocks) - blocks)[chain] + number // each[chain]
    return _ChainCells(begin[chain] + number * size, size, block)


def _heights(moves: Moves, index: Indices, fraction: Floats) -> Floats:
    start, end = moves.start[index, 2], moves.end[index, 2]
    return np.asarray(start + (end - start) * fraction)


def _looks(rows: Rows, fraction: Floats, z: Floats, position: Floats) -> Floats:
    """Return the places in the middle of cells."""
    points = points_at(rows, fraction) if len(rows) else np.zeros((0, 2))
    return np.column_stack([points, z, position, _ahead(rows, points)])


def _ahead(rows: Rows, points: Floats) -> Floats:
    """Return the direction of travel (n, 2) at points of rows, unit vectors."""
    arm = points - rows[:, [CX, CY]]
    across = np.column_stack([-arm[:, 1], arm[:, 0]]) * rows[:, [TURN]]
    ahead = np.where(rows[:, [TURN]] == 0, rows[:, 2:4] - rows[:, :2], across)
    return np.asarray(ahead / np.maximum(np.hypot(*ahead.T), 1e-300)[:, None])


class _Chains(NamedTuple):
    """Cutting moves as chains: rows, lengths in the plane, which begin a chain, positions of their ends."""

    rows: Rows
    flat: Floats
    begins: NDArray[np.bool_]
    begin: Floats
    end: Floats


def _stamps(moves: Moves, chosen: Indices, chains: _Chains) -> Floats:
    """Return the places that are only cut: ends of chains, corners, and what goes straight down."""
    rows, flat, begins, begin, end = chains
    last = np.append(begins[1:], True)
    setting_out, arriving = _ahead(rows, rows[:, :2]), _ahead(rows, rows[:, 2:4])
    turn = np.abs(
        np.arctan2(
            arriving[:-1, 0] * setting_out[1:, 1] - arriving[:-1, 1] * setting_out[1:, 0],
            np.sum(arriving[:-1] * setting_out[1:], axis=1),
        )
    )
    corner = np.append(turn > _CORNER, False) & ~last
    going = flat > 0
    at_start, at_end = begins & going, (last & going) | corner | ~going
    z0, z1 = moves.start[chosen, 2], moves.end[chosen, 2]
    lowest = np.where(going, z1, np.minimum(z0, z1))
    count = int(at_start.sum() + at_end.sum())
    return np.column_stack(
        [
            np.concatenate([rows[at_start, :2], rows[at_end, 2:4]]),
            np.concatenate([z0[at_start], lowest[at_end]]),
            np.concatenate([begin[at_start], end[at_end]]),
            np.zeros((count, 2)),
        ]
    )
