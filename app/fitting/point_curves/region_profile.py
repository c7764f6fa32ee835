"""Any region of revolution that somebody asks for, r = f(z): by a table or a formula, and the judge of curves in it.

z is the share of the chord's length, 0 at one point and 1 at the next. What is proven is proven in a region of steps
that lies within the one asked for: on each of `CELLS` stretches of z as wide as f is there at least.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from ...core.errors import ParameterError
from ...model.motion import Floats
from .profile_bounds import IntervalArray, formula_bounds
from .space_curve import SpaceCurve
from .spheroid import RevolvedOutline, lies_within
from .tube import ToleranceTube, TubeAnswer, TubeJudgement, judge

CELLS = 1024
"""Stretches of z; what the steps take off f is its slope over so many."""
_LEAST, _MOST = 1e-4, 10.0
"""mm; radii that regions may have: less is below what controls write, more is no tolerance."""
_SHARES = (1.0, 0.5, 0.25)
"""Of what an outline is wider than at the points, that barrels are tried to be fitted with."""


@dataclass(frozen=True, eq=False)
class RegionProfile:
    """A region's outline, r = f(z).

    Attributes:
        text: as it was asked for.
        low: (CELLS,) what f is at least on each stretch of z, mm, > 0.
        high: (CELLS,) what it is at most, mm.
        ends: f(0) and f(1), mm.
    """

    text: str
    low: Floats = field(repr=False)
    high: Floats = field(repr=False)
    ends: tuple[float, float]

    @property
    def radius(self) -> float:
        """At the points, mm: the smaller end."""
        return min(self.ends)

    @property
    def widest(self) -> float:
        """What f is nowhere more than, mm."""
        return float(self.high.max())

    @cached_property
    def outline(self) -> RevolvedOutline:
        """The region of steps within it, for the spheroid test."""
        return RevolvedOutline(self._radius, self._lowest)

    @property
    def inscribed(self) -> ToleranceTube:
        """The widest cylinder that lies within it."""
        return ToleranceTube(min(self.radius, float(self.low.min())))

    @property
    def envelope(self) -> ToleranceTube:
        """A cylinder that holds it."""
        return ToleranceTube(self.widest)

    @property
    def tried(self) -> tuple[ToleranceTube, ...]:
        """Barrels to fit curves in: those that use it well first, at last the cylinder that is surely within it."""
        sure = self.inscribed
        spans = [(self.radius, max(self.widest, self.radius))] if self.widest > sure.radius else []
        wide = [ToleranceTube(low, low + share * (high - low)) for low, high in spans for share in _SHARES]
        return (*wide, sure)

    def _radius(self, share: float) -> float:
        if share <= 0.0 or share >= 1.0:
            return self.ends[0] if share <= 0.0 else self.ends[1]
        return float(self.low[min(int(share * CELLS), CELLS - 1)])

    def _lowest(self, first: float, last: float) -> float:
        begin = min(max(int(first * CELLS), 0), CELLS - 1)
        stop = min(max(math.ceil(last * CELLS), begin + 1), CELLS)
        return float(self.low[begin:stop].min())


def profile_of_formula(text: str) -> RegionProfile:
    """Return the region whose outline is a formula in z, z in [0, 1], mm.

    Raises:
        ParameterError: it is no formula, or not between 0.0001 and 10 mm everywhere.
    """
    edges = np.arange(CELLS + 1) / CELLS
    found = formula_bounds(text, edges)
    ends = formula_bounds(text, np.array([0.0, 0.0])), formula_bounds(text, np.array([1.0, 1.0]))
    return _checked(text, found, (float(ends[0].low[0]), float(ends[1].low[0])))


def profile_of_table(text: str) -> RegionProfile:
    """Return the region whose outline is straight between places that are given: "0=0.01,0.5=0.03,1=0.01".

    Raises:
        ParameterError: it is no such table, does not go from 0 to 1, or is not between 0.0001 and 10 mm everywhere.
    """
    try:
        rows = [(float(z), float(r)) for z, r in (entry.split("=") for entry in text.split(","))]
    except ValueError as error:
        raise ParameterError(f"'{text}' is no table of z=r; write 0=0.01,0.5=0.03,1=0.01.") from error
    z, r = np.array(rows).T
    if not (len(z) >= 2 and z[0] == 0.0 and z[-1] == 1.0 and np.all(np.diff(z) > 0)):
        raise ParameterError(f"the places {', '.join(f'{each:g}' for each in z)} of a table; use 0, rising, up to 1.")
    edges = np.arange(CELLS + 1) / CELLS
    at_edges = np.interp(edges, z, r)
    low, high = np.minimum(at_edges[:-1], at_edges[1:]), np.maximum(at_edges[:-1], at_edges[1:])
    cell = np.clip((z * CELLS).astype(np.int64), 0, CELLS - 1)
    np.minimum.at(low, cell, r)
    np.maximum.at(high, cell, r)
    return _checked(text, IntervalArray(low, high), (float(r[0]), float(r[-1])))


def _checked(text: str, found: IntervalArray, ends: tuple[float, float]) -> RegionProfile:
    wrong = np.flatnonzero(~((found.low >= _LEAST) & (found.high <= _MOST)))
    if len(wrong):
        at = int(wrong[0])
        raise ParameterError(
            f"the region's radius '{text}' may be {found.low[at]:g} to {found.high[at]:g} mm at z = {at / CELLS:g}; "
            f"use {_LEAST:g} to {_MOST:g} mm everywhere."
        )
    return RegionProfile(text, found.low, found.high, ends)


def judge_in_profile(curve: SpaceCurve, points: Floats, profile: RegionProfile) -> TubeJudgement:
    """Return whether a whole curve and a polyline keep within a region of any outline of one another, in order.

    A curve that is inside the inscribed cylinder is inside. Another one is inside if its feet in the region's envelope,
    or those nearest to the points, cut it into stretches that the spheroid test finds in the regions of their chords.

    Args:
        curve: of any making.
        points: (n, 3) mm, n >= 2; it runs in the same sense.
        profile: of the region round every chord.

    References:
        JP 2014-242013, figures 3 and 6 to 8.
    """
    sure = judge(curve, points, profile.inscribed)
    if sure.answer is TubeAnswer.INSIDE:
        return sure
    wide = judge(curve, points, profile.envelope)
    if wide.answer is not TubeAnswer.INSIDE or wide.feet is None:
        return wide
    answer, at = lies_within(curve, points, profile.outline, wide.feet)
    if answer is TubeAnswer.INSIDE:
        return wide
    near = _settled(curve, points, wide.feet)
    again, at = lies_within(curve, points, profile.outline, near)
    if again is TubeAnswer.INSIDE:
        return wide
    place = curve.at(np.array([at]))[0].tolist()
    return replace(wide, answer=again, bound=math.inf, parameter=at, place=(place[0], place[1], place[2]), feet=None)


def _settled(curve: SpaceCurve, points: Floats, feet: Floats) -> Floats:
    """Return the feet nearest to their points, in order."""
    from . import tube_feet_kernels as kernels

    near = feet.copy()
    for _ in range(2):
        kernels.settle(curve.control, np.ascontiguousarray(points), near)
    near[0], near[-1] = 0.0, float(len(curve))
    ordered: Floats = np.maximum.accumulate(near)
    return ordered
