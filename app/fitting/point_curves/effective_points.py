"""Method D, step S11: which points of a path lie on the true shape.

Points that come from a polyhedron stand for the shape at the borders of its facets only. The path is parted into
ranges, each as far as all points between lie within epsilon of the segment from its first to its last; the ends are
effective.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from ...core.errors import GeometryError, ParameterError
from ...model.motion import Floats

Ints = NDArray[np.int64]


class PointState(IntEnum):
    """What a point is to the final curve."""

    INVALID = 0
    """Within a facet: left out."""
    EFFECTIVE = 1
    CORRECTED = 2
    """Within a facet, and moved to the correction curve."""


class RangeEnds(IntEnum):
    """Which points of a range are effective."""

    OUTER = 0
    """Its first and last alone."""
    RATIO = 1
    """Also those nearer to one of them than a share of the distance between these."""
    DISTANCE = 2
    """Also those nearer to one of them than a distance."""


@dataclass(frozen=True)
class EffectiveOptions:
    """How a path is parted.

    Attributes:
        epsilon: mm, > 0: how far a point may be from the segment of its range.
        ends: which points of a range are effective.
        limit: the share K of RATIO, in [0, 0.5]; the distance d of DISTANCE, mm, >= 0; not looked at for OUTER.
    """

    epsilon: float
    ends: RangeEnds = RangeEnds.OUTER
    limit: float = 0.0

    def __post_init__(self) -> None:
        if not (self.epsilon > 0 and math.isfinite(self.epsilon)):
            raise ParameterError(f"epsilon is {self.epsilon:g} mm; it must be greater than 0.")
        if self.ends == RangeEnds.RATIO and not 0 <= self.limit <= 0.5:
            raise ParameterError(
                f"The share of a range that counts as its end is {self.limit:g}; it must be in 0 to 0.5."
            )
        if self.ends == RangeEnds.DISTANCE and not (self.limit >= 0 and math.isfinite(self.limit)):
            raise ParameterError(
                f"The distance that counts as the end of a range is {self.limit:g} mm; it must be 0 or more."
            )


@dataclass(frozen=True, eq=False)
class EffectivePoints:
    """The ranges of a path of n points.

    Attributes:
        ranges: (r, 2) first and last point of each; where one ends the next begins.
        state: (n,) PointState: EFFECTIVE or INVALID.
    """

    ranges: Ints
    state: NDArray[np.uint8]

    @property
    def passed(self) -> Ints:
        """Numbers of the points that the final curve (S12) goes through or near, in the first embodiment."""
        return np.flatnonzero(self.state)


def effective_points(
    points: Floats,
    options: EffectiveOptions,
    kept: Iterable[int] = (),
    at_bends: bool = False,
    settled: bool = False,
) -> EffectivePoints:
    """Part a path into ranges (S111-S117) and tell its effective points.

    Args:
        points: (n, 2) or (n, 3) mm, n >= 2; a closed path begins and ends with its first point.
        options: epsilon and what counts as the end of a range.
        kept: points, such as corners, beyond which no range goes.
        at_bends: whether a range that bends at one point ends there. Where facets turn by little, as at an inflection,
            the text's range goes on into the next facet as far as epsilon lets it, and ends at a point within that.
        settled: whether ends move to where both ranges beside are clearly straighter, all points within epsilon of
            them still. The text's loop ends a range where the next point is too far, which rounding decides where
            facets bend by a few last decimals.

    Raises:
        GeometryError: fewer than two points, or one without a finite place.
    """
    from . import effective_point_kernels

    flat = in_space(points)
    stop, found = np.zeros(len(flat), np.bool_), np.empty((len(flat), 2), np.int64)
    stop[list(kept)] = True
    count = effective_point_kernels.ranges(flat, options.epsilon, stop, at_bends, found)
    ranges = found[:count].copy()
    if settled:
        ends = np.append(ranges[:, 0], ranges[-1, 1])
        ends = ends[: effective_point_kernels.settle(flat, options.epsilon, stop, ends)]
        ranges, count = np.column_stack([ends[:-1], ends[1:]]), len(ends) - 1
    state = np.full(len(flat), PointState.INVALID, np.uint8)
    state[ranges] = PointState.EFFECTIVE
    if options.ends != RangeEnds.OUTER:
        at = np.minimum(np.searchsorted(ranges[:, 1], np.arange(len(flat))), count - 1)
        first, last = flat[ranges[at, 0]], flat[ranges[at, 1]]
        from_end = np.minimum(np.linalg.norm(flat - first, axis=1), np.linalg.norm(flat - last, axis=1))
        whole = np.linalg.norm(last - first, axis=1) if options.ends == RangeEnds.RATIO else 1.0
        state[from_end < options.limit * whole] = PointState.EFFECTIVE
    return EffectivePoints(ranges, state)


def in_space(points: Floats) -> Floats:
    """Return points (n, 2) or (n, 3) as (n, 3), Z 0 where there was none."""
    if points.ndim != 2 or points.shape[1] not in {2, 3} or len(points) < 2:
        raise GeometryError(f"A path of shape {points.shape}; expected two or more points in the plane or in space.")
    if not np.isfinite(points).all():
        worst = int(np.flatnonzero(~np.isfinite(points).all(axis=1))[0])
        raise GeometryError(f"Point {worst} of a path is at {points[worst].tolist()}; expected finite coordinates.")
    space = np.zeros((len(points), 3))
    space[:, : points.shape[1]] = points
    return space
