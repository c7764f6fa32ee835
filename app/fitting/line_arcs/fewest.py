"""The fewest lines and arcs along a polyline in a plane, whose joints lie within the tolerance and bend by no more than
is allowed.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...model.motion import Floats
from .tangent import PlanarPolyline, TangentPath, joined

Ints = NDArray[np.int64]

_STATES = 12
"""Places along each of the longest pieces where others may meet."""
_ASIDE = np.array([0.0, 0.485, -0.485, 0.97, -0.97])
"""Of the limit: so far left of each of them pieces may meet; with more places no fewer pieces were found."""
_PIECES = 256
"""Of so many of the longest pieces in a row joints are searched together; what is kept of a search grows with them."""
_FINE = 16
"""A chord has a sample each sixteenth of the longest piece there: on a long side few points alone do not hold an
arc.
"""
_SAGITTA = 0.16
"""Else between two samples an arc leaves the chord by no more than an eighth of this, in limits, on its inner side."""
_MOST = 16
"""Parts of a chord at most. Where the limit swells between points each chord has so many: its middle may hold what its
ends do not.
"""
_DENSE = 16
"""Of more samples than twice so many from state to state only the outermost ones of so many stretches are looked at."""
_SLIGHT = 0.1
"""An arc that is no higher over its chord than so much of the limit is a line if it may."""
_ANY = 10.0
"""Directions between minus and plus so many radians are all there are."""


@dataclass(frozen=True, eq=False)
class FewestPieces:
    """The shortest path over places along a polyline of n points, each a joint that lines and arcs may have.

    It is shortest over these places, pieces between them being held to samples; what is found is to be proven.

    Attributes:
        line: the polyline.
        limit: how far pieces may be from its points, mm.
        bends: (n,) by how much pieces may turn at each point, radians; pi: anyhow.
        largest: radius of arcs, mm.
        swell: the squared limit half way between two points exceeds that at them by so many times that.
    """

    line: PlanarPolyline
    limit: float
    bends: Floats
    largest: float
    swell: float = 0.0

    def chain(self, rough: Ints) -> TangentPath | None:
        """Return the pieces; None where there are none.

        Args:
            rough: (m + 1,) the points between which the longest pieces run, 0 and n - 1 the outer ones.
        """
        parts: list[TangentPath] = []
        leaving = (-_ANY, _ANY)
        for k in range(0, len(rough) - 1, _PIECES):
            part = self._part(rough[k : k + _PIECES + 1], leaving)
            if part is None:
                return None
            parts.append(part)
            arrives = self._arrival(part)
            leaving = (arrives, arrives)
        return joined(parts)

    def _part(self, rough: Ints, leaving: tuple[float, float]) -> TangentPath | None:
        """Return pieces over some of the longest ones, that set out as what came before arrives, give or take the bend
        there.
        """
        from . import fewest_kernels as kernels

        shares = np.linspace(0.0, 1.0, _STATES + 1)
        points = np.unique((rough[:-1, None] + np.diff(rough)[:, None] * shares).astype(np.int64))
        samples, at = self._samples(rough, points)
        states, total = self._states(points), len(points) * len(_ASIDE)
        counts = np.tile([len(self.line.xy), 0], (total, 1))
        directions, before = np.empty((total, kernels.MOST, 2)), np.zeros((total, kernels.MOST), np.int64)
        counts[0], directions[0, 0] = (0, 1), leaving
        kernels.search(samples, at, states, points, _ASIDE, self.limit, counts, directions, before)
        rows, left, half = np.empty(len(points), np.int64), np.empty(len(points)), np.empty(len(points))
        count = kernels.trace(
            states, _ASIDE, self.largest, _SLIGHT * self.limit, counts, directions, before, rows, left, half
        )
        if count == 0:
            return None
        ends = np.append(points[rows[:count][::-1]], points[-1])
        aside = np.append(left[:count][::-1], 0.0) * self.limit
        return TangentPath(self.line.along[ends], aside, half[:count][::-1].copy(), half[:count][::-1] != 0.0)

    def _states(self, points: Ints) -> Floats:
        """Return the states (s, 6) of points, see the kernels."""
        at, aside = self.line.xy[points], 1j * self.line.ahead[points] * self.limit
        aside /= np.maximum(np.abs(self.line.ahead[points]), 1e-300)
        chords = np.append(0.0, np.maximum.reduceat(np.diff(self.line.along[: points[-1] + 1]), points[:-1]))
        return np.column_stack([at.real, at.imag, aside.real, aside.imag, self.bends[points], chords])

    def _samples(self, rough: Ints, points: Ints) -> tuple[Floats, Ints]:
        """Return samples (m, 3), place and limit, between the outer ones of the longest pieces, and those that states
        are.
        """
        line, first, last = self.line, int(rough[0]), int(rough[-1])
        steps = np.diff(line.xy[first : last + 1])
        sizes = np.abs(steps)
        pieces = np.repeat(np.diff(line.along[rough]), np.diff(rough))
        turns = np.maximum(line.turns[first:last], line.turns[first + 1 : last + 1])
        fine = np.maximum(np.sqrt(sizes * turns / (_SAGITTA * self.limit)), _FINE * sizes / pieces)
        parts = np.clip(np.ceil(fine), _MOST if self.swell else 1, _MOST).astype(np.int64)
        owner = np.repeat(np.arange(len(sizes)), parts)
        begin = np.concatenate([[0], np.cumsum(parts)])
        share = (np.arange(len(owner)) - begin[owner]) / parts[owner]
        places = line.xy[first + owner] + share * steps[owner]
        limits = self.limit * np.sqrt(1.0 + 4.0 * self.swell * share * (1.0 - share))
        places, limits, at = np.append(places, line.xy[last]), np.append(limits, self.limit), begin[points - first]
        if len(places) > 2 * _DENSE * len(points):
            kept = _outermost(places, at)
            places, limits, at = places[kept], limits[kept], np.searchsorted(kept, at)
        return np.column_stack([places.real, places.imag, limits]), at

    def _arrival(self, chain: TangentPath) -> float:
        """Return the direction in which the last piece arrives, radians."""
        z = self.line.joints(chain)[-2:]
        return float(np.angle(z[1] - z[0]) + chain.half[-1])


def _outermost(places: NDArray[np.complex128], at: Ints) -> Ints:
    """Return the numbers of the samples that do for all: those farthest to either side in each short stretch between
    two states.

    Over so short a stretch a piece is straight but for next to nothing; what is between the outermost samples is within
    the limit with them. It is their places that are looked at from then on, so the search takes no longer the denser
    the points are.

    Args:
        places: (m,) samples. at: (n,) of each state its sample, rising.
    """
    number = np.arange(at[0], at[-1])
    gap = np.searchsorted(at, number, side="right") - 1
    begin, size = at[gap], at[gap + 1] - at[gap]
    chord = places[at[gap + 1]] - places[begin]
    aside = ((places[number] - places[begin]) * chord.conjugate()).imag
    stretch = gap * _DENSE + (number - begin) * _DENSE // size
    order = np.lexsort((aside, stretch))
    ends = np.flatnonzero(np.diff(stretch[order]))
    outer = number[order[np.concatenate([[0], ends, ends + 1, [len(order) - 1]])]]
    return np.unique(np.concatenate([outer, at]))
