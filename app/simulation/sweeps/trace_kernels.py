# mypy: allow-untyped-defs
"""What a swept run does to cells: their heights, the motion that cut them last, and how much it took, without a branch.

Sums go lane by lane in float32, which keeps them vectors, and are gathered in float64 before they can grow wrong.
"""

from __future__ import annotations

import math

import numpy as np

from ...core.jit import kernel
from .run_kernels import LANES, ball_height

NOTES = 7
"""Numbers that are noted of a piece, see `ask`."""

PENDING = 32
"""Blocks of cells after which float32 sums are gathered, so that they stay right to some millionths."""

_F = np.float32
# mm; a motion that lowers a cell by no more only rounds otherwise, so the cell stays its former owner's
_TRIFLE = _F(1e-5)
_ZERO, _ONE, _STEP, _NEVER = _F(0.0), _F(1.0), _F(LANES), _F(math.inf)
"""In float32, since a number of Python would make all a run computes float64: nought, one, cells a step, and what is
higher than any metal.
"""
_CELLS = "float32[::1], int32[::1]"


@kernel("Tuple((float32, int32, float32, float32))(float32, int32, float32, float32, int32)")
def lowered(old, mine, z, floor, owner):
    """Return a cell's height and owner after a motion, by how much it was lowered, and 1 if it changes its owner, else
    0.

    Args:
        old, mine: its height and owner before.
        z: height of the sweep, NaN where it does not come. floor: no metal is lower.
        owner: the motion.
    """
    z = floor if z < floor else z
    depth = old - z
    depth = depth if depth > _ZERO else _ZERO
    changes = (mine != owner) & (depth > (_TRIFLE if mine >= 0 else _ZERO))
    return z if z < old else old, owner if changes else mine, depth, _ONE if changes else _ZERO


@kernel(
    f"void({_CELLS}, float32[::1], int64, int64, UniTuple(float32, 5), UniTuple(float32, 6), float32, int32)",
    counts=False,
)
def ball_trace(line, owners, sums, first, blocks, where, move, floor, owner):
    """Lower a run under a ball as `ball_run` does, and note what that takes as `take` does."""
    a0, b0, c0, da, dc = where
    for _ in range(blocks):
        part, mine = line[first : first + LANES], owners[first : first + LANES]
        for k in range(LANES):
            x = _F(k)
            z = ball_height(a0 + da * x, b0 + da * x, c0 + dc * x, move)
            part[k], mine[k], depth, change = lowered(part[k], mine[k], z, floor, owner)
            sums[k] += depth
            sums[k + LANES] += change
        first += LANES
        # places go on by addition: a run is at most a tile long, too short for float32 to drift
        a0, b0, c0 = a0 + _STEP * da, b0 + _STEP * da, c0 + _STEP * dc


@kernel(f"void({_CELLS}, float32[::1], float32[::1], int64, int64, float32, int32)", counts=False)
def take(line, owners, sums, swept, first, blocks, floor, owner):
    """Lower a run to swept heights, and note what that takes.

    Args:
        line, owners: heights of cells, and the motions that cut them last.
        sums: by how much cells were lowered, and how many changed their owner, each lane for itself; added to.
        swept: heights of the sweep over the run.
        first: the run's first cell. blocks: its sixteens of cells.
        floor: no metal is lower. owner: the motion.
    """
    at = 0
    for _ in range(blocks):
        part, mine, new = line[first : first + LANES], owners[first : first + LANES], swept[at : at + LANES]
        for k in range(LANES):
            part[k], mine[k], depth, change = lowered(part[k], mine[k], new[k], floor, owner)
            sums[k] += depth
            sums[k + LANES] += change
        first += LANES
        at += LANES


@kernel("void(float32[::1], float32[::1], float64[::1], int64, int64)", counts=False)
def ask(line, swept, notes, first, cells):
    """Note how deep a run is swept in metal, which stays.

    Args:
        line, swept, first: as for `take`. cells: of the run.
        notes: depths in all, cells, the greatest depth, its place, the height that is reached there, added to; floor,
            and the depth from which it is told of.
    """
    floor, slack = _F(notes[5]), _F(notes[6])
    for k in range(cells):
        z = swept[k] if swept[k] > floor else floor
        depth = line[first + k] - z
        if depth > slack:
            notes[0] += depth
            notes[1] += 1.0
            if depth > notes[2]:
                notes[2], notes[3], notes[4] = depth, first + k, z


@kernel("void(float32[::1], float64[::1])", counts=False)
def gather(sums, notes):
    """Add what was noted lane by lane to a piece's notes: depths and cells."""
    for k in range(LANES):
        notes[0] += sums[k]
        notes[1] += sums[k + LANES]
    sums[:] = _ZERO


@kernel("boolean(float32[::1], float32[::1], int64, int64, float32)", counts=False)
def lowers(heights, swept, first, cells, slack):
    """Return whether any cell of a run is swept more than slack below its height."""
    old, new, lower = heights[first : first + cells], swept[:cells], 0
    for k in range(len(old)):
        # counted, not asked one by one: no early end, so the compiler compares many cells at once
        lower += 1 if new[k] < old[k] - slack else 0
    return lower > 0


@kernel(f"void({_CELLS}, float32[::1], float32[::1], float64[::1], int64, int64, int64)", counts=False)
def settle(heights, owners, swept, sums, notes, first, blocks, owner):
    """Compare swept heights with a tile's, and note what comes of it.

    Args:
        heights, owners: of the tile.
        swept: heights of a run; infinite again afterwards.
        sums, notes: as for `take` and `ask`.
        first: the run's first cell in the tile. blocks: its sixteens of cells.
        owner: number of the motion; -1: it only asks, and heights stay.
    """
    cells = blocks * LANES
    if lowers(heights, swept, first, cells, _F(notes[6]) if owner < 0 else _ZERO):
        if owner < 0:
            ask(heights, swept, notes, first, cells)
        else:
            take(heights, owners, sums, swept, first, blocks, _F(notes[5]), np.int32(owner))
    swept[:cells] = _NEVER
