"""Moves cut where their engagement goes from one step to another, so that each stretch of a path has the colour of its
own share.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from .....geometry.primitives import points_at
from .....model.moves import Moves
from .....toolpath.coverage.areas import move_rows
from .engagement_colours import STEPS

if TYPE_CHECKING:
    from .....toolpath.engagement.engagement import EngagementSamples

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

SWAY = 0.02
"""Share of the diameter by which a measured one may be too large: a step begins above its limit and twice this, and
ends below its limit and this, so that a stepover of just half is at most half, and does not flicker.
"""

_HAIR = 1e-6  # parts of a move: less is no stretch


@dataclass(frozen=True, eq=False)
class EngagementRuns:
    """What is painted of a program.

    Attributes:
        moves: n of them, each with one step. step: (n,) of engagement, see `engaged`.
    """

    moves: Moves
    step: Ints


def engagement_runs(moves: Moves, seen: EngagementSamples) -> EngagementRuns:
    """Return moves cut where the engagement that was seen along them changes its step."""
    if not len(seen.share):
        return EngagementRuns(moves, np.zeros(len(moves), np.int64))
    steps = steady_steps(seen.share, np.append(True, seen.first[1:] > seen.last[:-1] + _HAIR))
    going = np.flatnonzero(seen.end > seen.begin)
    changes = seen.first[1:][np.diff(steps) != 0]
    owner = going[np.minimum(np.searchsorted(seen.end[going], changes), len(going) - 1)]
    part = (changes - seen.begin[owner]) / (seen.end[owner] - seen.begin[owner])
    within = (part > _HAIR) & (part < 1 - _HAIR)
    cut, parts = _cut(moves, owner[within], part[within])
    middle = seen.begin[cut] + (seen.end[cut] - seen.begin[cut]) * parts.mean(axis=1)
    step = steps[np.minimum(np.searchsorted(seen.last, middle), len(steps) - 1)]
    return EngagementRuns(_moves(moves, cut, parts[:, 1]), np.where(seen.end[cut] > seen.begin[cut], step, 0))


def steady_steps(share: Floats, begins: NDArray[np.bool_]) -> Ints:
    """Return the step (m,) of each share (m,), which holds until a limit is clearly passed; it begins anew where
    `begins` (m,).
    """
    place = np.arange(len(share))
    step = np.zeros(len(share), np.int64)
    for limit in STEPS:
        above = share > limit + 2 * SWAY
        decided = np.maximum.accumulate(np.where(above | (share < limit + SWAY) | begins, place, 0))
        step += above[decided]
    return step


def _cut(moves: Moves, owner: Ints, part: Floats) -> tuple[Ints, Floats]:
    """Return (move that each stretch is of (n,), where it begins and ends on it as parts (n, 2)); owners do not
    fall.
    """
    each = 1 + np.bincount(owner, minlength=len(moves))
    cut = np.repeat(np.arange(len(moves)), each)
    ends = np.ones(len(cut))
    ends[owner + np.arange(len(owner))] = part
    begins = np.concatenate([[0.0], ends[:-1]])
    begins[np.cumsum(each) - each] = 0.0
    return cut, np.column_stack([begins, ends])


def _moves(moves: Moves, cut: Ints, part: Floats) -> Moves:
    """Return the moves of stretches that end at a part (n,) of moves `cut` (n,)."""
    made = Moves(**{name: column[cut] for name, column in moves.columns().items()})  # type: ignore[arg-type]
    inner = np.flatnonzero(part < 1)
    which = cut[inner]
    end, start, last = made.end.copy(), moves.start[which, 2], moves.end[which, 2]
    end[inner, :2] = points_at(move_rows(moves)[which], part[inner])
    end[inner, 2] = start + (last - start) * part[inner]
    return replace(made, end=end)
