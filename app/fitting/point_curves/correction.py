"""Method D's second embodiment (S21-S23): points within facets are moved to smooth curves by the effective points.

A gap is what lies between two effective points, one after the other. Its correction curve goes through, or by least
squares near, the effective points about it: so many before its first, that one, and so many after. It is C2 there; from
gap to gap only points are handed on, and an effective one moves by the mean of what the two gaps beside it ask for.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from ...core.errors import ParameterError
from ...model.motion import Floats
from .effective_points import PointState, in_space

Ints = NDArray[np.int64]
_MOST = 50
"""Effective points on one side of a correction curve."""


class CorrectionCurve(IntEnum):
    """What a correction curve is."""

    THROUGH = 0
    """The cubic spline through its points: effective points stay where they are."""
    NEAR = 1
    """The one cubic nearest to its points by least squares, where it follows them: effective points move too."""


class CorrectionMove(IntEnum):
    """Where a point moves to on its correction curve."""

    NEAREST = 0
    PERPENDICULAR = 1
    """At right angles to the chord of the gap; to the nearest place where the curve has none there."""


class CorrectionScope(IntEnum):
    """Which of the points between effective ones are corrected; the others are left out of the final curve."""

    RATIO = 0
    """Those no further from an end of their gap than a share (Kr) of its chord."""
    DISTANCE = 1
    """Those that move no further than a distance (epsilon i)."""


@dataclass(frozen=True)
class CorrectionOptions:
    """How points are corrected.

    Attributes:
        limit: the share of RATIO, in [0, 1] (at 1 all are), or the distance of DISTANCE, mm, >= 0.
        select: which points between effective ones are corrected.
        before: effective points before the first of a gap that its curve goes by, 0 to 50.
        after: effective points after it, 1 to 50; the second of the gap is one of them.
        curve: through its points or near them.
        move: where points move to.
        stray: how far from its points a curve NEAR them may be, mm, >= 0. One cubic does not follow a bend of few
            facets; where it would be farther, the curve goes through its points.
    """

    limit: float = 1.0
    select: CorrectionScope = CorrectionScope.RATIO
    before: int = 2
    after: int = 3
    curve: CorrectionCurve = CorrectionCurve.THROUGH
    move: CorrectionMove = CorrectionMove.NEAREST
    stray: float = math.inf

    def __post_init__(self) -> None:
        if not 0 <= self.before <= _MOST:
            raise ParameterError(f"{self.before} effective points before a gap; the number must be in 0 to {_MOST}.")
        if not 1 <= self.after <= _MOST:
            raise ParameterError(
                f"{self.after} effective points after the first of a gap; the number must be in 1 to {_MOST}."
            )
        if self.select == CorrectionScope.RATIO and not 0 <= self.limit <= 1:
            raise ParameterError(
                f"Points are corrected up to a share {self.limit:g} of their gap; it must be in 0 to 1."
            )
        if self.select == CorrectionScope.DISTANCE and not 0 <= self.limit < np.inf:
            raise ParameterError(f"Points are corrected that move {self.limit:g} mm at most; it must be 0 or more.")


@dataclass(frozen=True, eq=False)
class Correction:
    """A path of n points after correction.

    Attributes:
        places: (n, 2 or 3) mm, as the points came: new places; those left out are where they were.
        state: (n,) PointState.
        moved: (n,) mm.
    """

    places: Floats
    state: NDArray[np.uint8]
    moved: Floats

    @property
    def passed(self) -> Ints:
        """Numbers of the points whose places the final curve (S12) goes through or near, in the second embodiment."""
        return np.flatnonzero(self.state)


def corrected(
    points: Floats, state: NDArray[np.uint8], options: CorrectionOptions, kept: Iterable[int] = ()
) -> Correction:
    """Move points to correction curves.

    Args:
        points: (n, 2) or (n, 3) mm, n >= 2.
        state: (n,) PointState of each; the outer ones are effective and do not move.
        options: how.
        kept: points, such as corners, that do not move, and beyond which no correction curve looks; effective ones.

    Raises:
        ParameterError: an outer or a kept point that is not effective.
    """
    from . import correction_kernels

    flat = in_space(points)
    effective = np.flatnonzero(state == PointState.EFFECTIVE)
    held = np.zeros(len(flat), np.bool_)
    held[[0, -1, *kept]] = True
    if (state[held] != PointState.EFFECTIVE).any():
        raise ParameterError("The first and the last point of a path and those that are kept must be effective.")
    places = np.empty_like(flat)
    stray = options.stray if options.curve == CorrectionCurve.NEAR else 0.0
    ways = stray, options.move == CorrectionMove.PERPENDICULAR
    correction_kernels.correct(flat, effective, held[effective], options.before, options.after, *ways, places)
    moved = np.linalg.norm(places - flat, axis=1)
    chosen = (
        moved <= options.limit
        if options.select == CorrectionScope.DISTANCE
        else _near_ends(flat, effective, options.limit)
    )
    left_out = ~chosen & (state != PointState.EFFECTIVE)
    places[left_out], moved[left_out] = flat[left_out], 0.0
    after = np.full(len(flat), PointState.CORRECTED, np.uint8)
    after[left_out], after[effective] = PointState.INVALID, PointState.EFFECTIVE
    return Correction(places[:, : points.shape[1]].copy(), after, moved)


def _near_ends(points: Floats, effective: Ints, share: float) -> NDArray[np.bool_]:
    """Return which points lie no further from an end of their gap than a share of its chord."""
    gap = np.clip(np.searchsorted(effective, np.arange(len(points))) - 1, 0, len(effective) - 2)
    first, last = points[effective[gap]], points[effective[gap + 1]]
    from_end = np.minimum(np.linalg.norm(points - first, axis=1), np.linalg.norm(points - last, axis=1))
    near: NDArray[np.bool_] = from_end <= share * np.linalg.norm(last - first, axis=1)
    return near
