"""Method D as a whole: which points of a path the final curve goes by (first embodiment), or where they are moved to
(second).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ...core.errors import ParameterError
from ...model.motion import Floats
from .arc_joints import ArcJoint, arc_joints
from .correction import CorrectionCurve, CorrectionMove, CorrectionOptions, CorrectionScope, corrected
from .effective_points import EffectiveOptions, EffectivePoints, PointState, RangeEnds, effective_points
from .facets import facets_of_rows
from .line_joints import LineJoint
from .through_points import joints_beside, sides_among

_DEFAULTS = CorrectionOptions()

_PASS = 3
"""Chords of a run that is a pass, at least: shorter ones lead from pass to pass."""
_DIGITS = 4.0
"""Points are off by 0.71 of a last decimal in a plane, and ends of blocks by as much again; arcs need some room."""
_OF_EPSILON = 0.05
"""Of the sag that is taken for one facet: where the digits are fine, curves of few blocks matter more than they."""


@dataclass(frozen=True, eq=False)
class PointClasses:
    """What n points of a path are to the final curve.

    Attributes:
        state: (n,) PointState.
        places: (n, 3) mm: where the curve is asked to go by; those left out are where they were.
        off: how far the points lie from the path by these places at most, mm.
        ranges: (r, 2) first and last point of each range; where one ends the next begins.
        moved: (n,) how far each point is from where it was, mm.
        sides: (r,) which ranges are sides of the true shape, whose chords stay; None where `passed` are ends of ranges
            alone, which tell it themselves.
    """

    state: NDArray[np.uint8]
    places: Floats
    off: float
    ranges: NDArray[np.int64]
    moved: Floats
    sides: NDArray[np.bool_] | None = None

    @property
    def passed(self) -> Floats:
        """The places (m, 3) that the final curve goes by, mm."""
        return np.ascontiguousarray(self.places[self._numbers])

    @property
    def passed_sides(self) -> NDArray[np.bool_] | None:
        """Which chords (m - 1,) between the places that the curve goes by are sides, where ranges tell it."""
        if self.sides is None:
            return None
        within = np.searchsorted(self.ranges[:, 0], self._numbers[1:]) - 1
        return np.asarray(self.sides[within])

    @property
    def _numbers(self) -> NDArray[np.int64]:
        """Numbers of the points whose places the curve goes by, none that is where the one before it is."""
        at = np.flatnonzero(self.state != PointState.INVALID)
        return at[moving(self.places[at])]


@dataclass(frozen=True)
class EffectiveMethod:
    """Curves go by the points that lie on the true shape, and not by those within facets.

    Attributes:
        choose: which points these are.
        correct: how the others, and these, are moved first (second embodiment); None: the others are left out (first).
        across: points are told apart by the facets of the surface that neighbouring passes lie on, not by the ranges of
            each path alone.
        nearness: how far from the points that it goes by the curve may be, mm, > 0; None: see `nearness_for`. The
            tolerance, which holds the sag of the facets, is no freedom to stray from them.
    """

    choose: EffectiveOptions
    correct: CorrectionOptions | None = None
    nearness: float | None = None
    across: bool = False

    def __post_init__(self) -> None:
        if self.nearness is not None and not self.nearness > 0:
            raise ParameterError(f"a nearness of {self.nearness:g} mm; use more than 0.")

    @property
    def on_shape(self) -> bool:
        """Whether all points that the curve goes by are meant to lie on the true shape, or on one curve: then a spline
        through them is nearer to it than chords are.
        """
        return self.choose.ends is RangeEnds.OUTER or self.correct is not None

    def nearness_for(self, digit: float) -> float:
        """Return how far from its points the curve may be, mm.

        Where nothing was asked for: as far as rounding to the last decimal of a program may have moved them and what is
        written, or a small share of epsilon; all of it where points beside the ends of ranges are effective, too, which
        lie within facets.

        Args:
            digit: the last decimal of a program's words, mm.
        """
        share = _OF_EPSILON if self.choose.ends is RangeEnds.OUTER else 1.0
        return self.nearness if self.nearness is not None else max(_DIGITS * digit, share * self.choose.epsilon)

    def stray_for(self, digit: float, own: float) -> float:
        """Return how far a cubic nearest to effective points may be from them to correct any, mm.

        Rounding moves points by 0.71 of a decimal, and a cubic that is farther off does not follow the shape.

        Args:
            digit: the last decimal of what is written, mm. own: the last one that the points are told with, mm.
        """
        return max(own, self.nearness_for(digit) / _DIGITS)

    def classes(
        self,
        points: Floats,
        corners: NDArray[np.int64],
        state: NDArray[np.uint8] | None = None,
        stray: float = math.inf,
    ) -> PointClasses:
        """Return what the points (n, 3) of a path are, its corners by number being effective and unmoved.

        Args:
            state: (n,) what each is by the facets of its surface; None: by the ranges of the path.
            stray: how far a cubic nearest to effective points may be from them to correct any, mm, >= 0.
        """
        # a correction curve is told by the points inside a range, too, and loses those that lie behind a bend: within a
        # facet that holds the joint of a line and an arc it came out 0.0124 mm off, where 0.0038 holds without
        kept, at_bends = corners.tolist(), self.correct is None
        effective = effective_points(points, self.choose, kept, at_bends, settled=True)
        if state is not None:
            known = state.copy()
            known[corners] = PointState.EFFECTIVE
            at = np.flatnonzero(known)
            effective = EffectivePoints(np.column_stack([at[:-1], at[1:]]), known)
        if self.correct is None:
            return PointClasses(effective.state, points, self.choose.epsilon, effective.ranges, np.zeros(len(points)))
        # ends of ranges alone: points within a facet are as far apart as a program happens to have them
        at = np.append(effective.ranges[:, 0], effective.ranges[-1, 1])
        along = sides_among(points[at])
        sides = np.flatnonzero(along)  # lines of the true shape: no facet is corrected across one
        joints = _joints_over_chords(points[at], along, self.choose.epsilon)
        whole = np.concatenate([sides, np.array([k for _, k in joints], np.int64)])
        kept = np.unique(np.concatenate([corners, at[whole], at[whole + 1]]))
        moved = corrected(points, effective.state, replace(self.correct, stray=stray), kept.tolist())
        state = moved.state.copy()
        for k in sides.tolist():
            inner = np.arange(at[k] + 1, at[k + 1])
            state[inner[state[inner] == PointState.CORRECTED]] = PointState.INVALID
        places = moved.places.copy()
        for joint, k in joints:  # its correction curve has two parts
            inner = np.arange(at[k] + 1, at[k + 1])
            inner = inner[state[inner] == PointState.CORRECTED]
            places[inner] = joint.nearest(points[inner])
        far = np.linalg.norm(places - points, axis=1)
        return PointClasses(state, places, self.choose.epsilon + float(far.max()), effective.ranges, far, along)


def _joints_over_chords(
    points: Floats, sides: NDArray[np.bool_], within: float
) -> list[tuple[LineJoint | ArcJoint, int]]:
    """Return the joints of lines and arcs of the true shape, each with the chord between points (n, 3) that it is in.

    Args:
        sides: (n - 1,) chords that are lines of the true shape. within: how far points may be from arcs, mm.
    """
    lines = joints_beside(points, sides, within)
    arcs, chords = arc_joints(points, sides, within)
    found: list[tuple[LineJoint | ArcJoint, int]] = [*zip(lines.joints, lines.chords.tolist(), strict=True)]
    return [*found, *zip(arcs, chords.tolist(), strict=True)]


def states_across(
    paths: Sequence[Floats], corners: Sequence[NDArray[np.int64]], epsilon: float
) -> tuple[NDArray[np.uint8], ...]:
    """Return of each path what its points are by the facets of the surface that neighbouring passes lie on.

    A pass is a run from corner to corner of four points or more; what is between passes is effective as it is.

    Args:
        paths: (n, 3) mm each. corners: of each, numbers of its points, the outer ones among them. epsilon: mm, > 0.
    """
    states = tuple(np.full(len(points), PointState.EFFECTIVE, np.uint8) for points in paths)
    runs = [
        (number, first, last + 1)
        for number, at in enumerate(corners)
        for first, last in pairwise(at.tolist())
        if last - first >= _PASS
    ]
    if len(runs) < 2:
        return states
    found = facets_of_rows([paths[number][first:stop] for number, first, stop in runs], epsilon).state
    begin = 0
    for number, first, stop in runs:
        states[number][first:stop] = found[begin : begin + stop - first]
        begin += stop - first
    return states


def second_embodiment(
    select: tuple[CorrectionScope, float] | None = None,
    before: int | None = None,
    after: int | None = None,
    move: CorrectionMove = CorrectionMove.NEAREST,
) -> CorrectionOptions:
    """Return how points are corrected as users ask for it: to cubics near the effective points, which move these too
    (S23).

    Args:
        select: which points, and the limit; None: all.
        before, after: effective points about a gap; None: as many as is usual.
        move: where to on the curve.

    Raises:
        ParameterError: it cannot be so.
    """
    kind, limit = select or (_DEFAULTS.select, _DEFAULTS.limit)
    return CorrectionOptions(
        limit,
        kind,
        _DEFAULTS.before if before is None else before,
        _DEFAULTS.after if after is None else after,
        CorrectionCurve.NEAR,
        move,
    )


def without_repeats(points: Floats) -> Floats:
    """Return points (n, 3), none twice in a row."""
    return np.ascontiguousarray(points[moving(points)])


def moving(points: Floats) -> NDArray[np.bool_]:
    """Tell which points (n, 3) are not where the one before is; the first always is not."""
    return np.concatenate([[True], np.any(np.diff(points, axis=0) != 0, axis=1)])
