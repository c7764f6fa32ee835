"""Lines and arcs in a plane that meet without a bend: their joints leave the points and move within the tolerance."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...core.progress import NO_PROGRESS, Progress
from ...model.motion import Floats

Flags = NDArray[np.bool_]
Places = NDArray[np.complex128]

_STARTS = (1.0, 0.9)
"""Pieces are first as long as they are within so much of the limit; what needs the fewest in the end is taken."""
_SURE = 0.985
"""Joints are moved within so much of the limit: they are held to samples, and then looked at whole."""
_ROUNDS = 12
"""Rounds of tuning and fitting anew, at most; a path that is still beyond its limits is not taken."""
_HALVINGS = 7
"""Halvings of the limit, as a factor, for that which gives so many pieces: 400 to within 5 %."""
_PLENTY = 200
"""Of more points only some are tried as joints of what is fitted anew."""
_BLOCK, _OVERLAP = 24, 4
"""Pieces that are tuned together, and how many of them again with the next."""
_EVEN = 3.0
"""A chord may become an arc beside pieces of at least a third of its length: a long side with crumbs stays a side."""
_LEAST_CHORDS = 3
"""An arc stands for so many chords at least: two points and a bend between them are no evidence of one."""
_AS_SHARP = 2.0
"""Times what the polyline itself turns nearby, at most: more is a bend that was made, and not drawn."""
_ROUNDED = 2.0 * math.sqrt(2.0)
"""Ends of two chords of equal length that are off by half a last digit in X and Y turn them by so many of it a length,
at most.
"""
_SLIGHT = 0.1
"""An arc that is no higher over its chord than so much of the limit is a line if that makes nothing worse."""


@dataclass(frozen=True, eq=False)
class TangentPath:
    """A path of m lines and arcs beside a polyline of n points in a plane.

    Attributes:
        s: (m + 1,) of each joint, its distance along the polyline, mm, rising.
        left: (m + 1,) how far left of the polyline it lies, mm.
        half: (m,) half of each piece's sweep, radians, positive to the left; 0 a line.
        bent: (m,) whether it may be an arc.
    """

    s: Floats
    left: Floats
    half: Floats
    bent: Flags

    def __len__(self) -> int:
        return len(self.half)

    def part(self, first: int, stop: int) -> TangentPath:
        """Return some of its pieces."""
        return TangentPath(
            self.s[first : stop + 1].copy(),
            self.left[first : stop + 1].copy(),
            self.half[first:stop],
            self.bent[first:stop],
        )


class PlanarPolyline:
    """n points in a plane, as the kernels want them.

    Attributes:
        points: (n, 3) mm, with a normal of 0. xy: (n,) the same, complex.
        along: (n,) distance from the first, mm. ahead: (n,) unit direction at each point.
        turns: (n,) by how much it bends at each point, radians; 0 at both ends.
    """

    def __init__(self, points: Floats, reach: float, step: float = 0.0) -> None:
        """Take points (n, 2), n >= 2, mm, no two in a row alike; what is no bend over a length, mm, is none.

        Args:
            reach: that length. step: of the last digit that the points are rounded to, mm: what that alone can make is
                no bend.
        """
        self.points = np.ascontiguousarray(np.column_stack([points, np.zeros(len(points))]))
        self.xy: Places = np.ascontiguousarray(points[:, 0] + 1j * points[:, 1])
        steps = np.diff(self.xy)
        ways = steps / np.abs(steps)
        both = np.concatenate([ways[:1], ways[1:] + ways[:-1], ways[-1:]])
        sizes = np.abs(both)
        self.ahead: Places = np.where(sizes > 1e-6, both / np.maximum(sizes, 1e-6), np.append(ways, ways[-1]))
        self.along: Floats = np.concatenate([[0.0], np.cumsum(np.abs(steps))])
        chords = np.concatenate([[0.0], np.abs(np.angle(ways[1:] / ways[:-1])), [0.0]])
        self.turns: Floats = np.minimum(chords, _bends(self.points, reach, step))

    def joints(self, chain: TangentPath) -> Places:
        """Return the places (m + 1,) of a chain's joints."""
        from . import tangent_kernels as kernels

        feet, z = np.empty(len(chain) + 1), np.empty(len(chain) + 1, complex)
        kernels.place(self.xy, self.along, self.ahead, chain.s, chain.left, 0, len(z), feet, z)
        return z

    def nearest(self, s: Floats) -> NDArray[np.int64]:
        """Return the points nearest to distances along."""
        return np.searchsorted((self.along[1:] + self.along[:-1]) / 2, s)


@dataclass(frozen=True, eq=False)
class TangentFit:
    """How few lines and arcs stand for a polyline, tangent where they meet or nearly so.

    Attributes:
        line: the polyline.
        limit: how far they may be apart at its points, mm, > 0.
        bend: pieces may turn by so much where they meet, radians, > 0; or by twice as much as the polyline does along
            both of them, but by no more than it does anywhere.
        largest: radius of arcs, mm.
        swell: the squared limit half way between two points exceeds that at them by so many times that.
    """

    line: PlanarPolyline
    limit: float
    bend: float
    largest: float
    swell: float = 0.0

    def chain(self, fewer_than: int, progress: Progress = NO_PROGRESS) -> TangentPath | None:
        """Return the pieces; None where it does not come about.

        Args:
            fewer_than: so many or more are of no use.
            progress: told of how much is done.

        Raises:
            Cancelled: the job was asked to stop.
        """
        best: TangentPath | None = None
        for k, start in enumerate(_STARTS):
            plain = self.longest(start)
            if len(plain) < fewer_than:
                made = self._repaired(plain, fewer_than, progress.part(k / len(_STARTS), (k + 1) / len(_STARTS)))
                best, fewer_than = (made, len(made)) if made is not None else (best, fewer_than)
        return best

    def longest(self, share: float = 1.0) -> TangentPath:
        """Return the longest pieces from point to point that keep to a share of the limit, with bends where they
        meet.
        """
        return self._greedy(self.line, share * self.limit)

    def _repaired(self, chain: TangentPath, fewer_than: int, progress: Progress) -> TangentPath | None:
        """Return pieces whose joints were moved; where they cannot be moved well enough there is one more, until there
        are too many.
        """
        chain.bent[self._round(chain)] = True
        dirty, off = np.ones(len(chain), bool), np.zeros(len(chain))
        for n in range(_ROUNDS):
            share = progress.part(n / _ROUNDS, (n + 1) / _ROUNDS)
            self._tune(chain, dirty, off, share)
            bad = self._bad(chain, off)
            if not bad.any():
                straighter = self._straighter(
                    chain, off, np.abs(chain.half) * self._sizes(chain) < 4 * _SLIGHT * self.limit, share
                )
                chain = chain if straighter is None else straighter
                too_flat = chain.bent & (np.abs(np.sin(chain.half)) * 2 * self.largest < self._sizes(chain))
                return self._straighter(chain, off, too_flat, share) if too_flat.any() else chain
            chain, dirty, off = self._anew(chain, bad, off, more=n > 0)
            if len(chain) >= fewer_than:
                break
        return None

    def _straighter(self, chain: TangentPath, off: Floats, flat: Flags, progress: Progress) -> TangentPath | None:
        """Return a chain whose flat pieces are lines, None where it would be bad then."""
        straight, off = (
            replace(chain.part(0, len(chain)), half=np.where(flat, 0.0, chain.half), bent=chain.bent & ~flat),
            off.copy(),
        )
        self._tune(straight, flat & chain.bent, off, progress)
        return None if self._bad(straight, off).any() else straight

    def _sizes(self, chain: TangentPath) -> Floats:
        sizes: Floats = np.abs(np.diff(self.line.joints(chain)))
        return sizes

    def _round(self, chain: TangentPath) -> Flags:
        """Tell which lines may as well be arcs: about as long as both neighbours, with bends that an arc takes within
        the limit.
        """
        sizes, at = self._sizes(chain), self.line.nearest(chain.s)
        shorter = np.minimum(np.append(sizes[1:], np.inf), np.append(np.inf, sizes[:-1]))
        wide = self.limit * math.sqrt(1 + self.swell)
        turn = np.maximum(self.line.turns[at[1:]], self.line.turns[at[:-1]])
        some: Flags = (
            (np.diff(at) < _LEAST_CHORDS) & (sizes <= _EVEN * shorter) & (turn > self.bend) & (sizes * turn <= 8 * wide)
        )
        return some

    def _tune(self, chain: TangentPath, dirty: Flags, off: Floats, progress: Progress) -> None:
        """Move the joints of dirty pieces and of those about them, in place."""
        from . import tangent_kernels as kernels

        line = self.line
        for first, stop in _stretches(_beside(dirty, _OVERLAP)):
            begin = end = first
            while end < stop:
                end = min(begin + _BLOCK, stop)
                progress.step(begin / len(chain), "Moving joints")
                kernels.tune(
                    line.xy,
                    line.along,
                    line.ahead,
                    chain.s,
                    chain.left,
                    chain.half,
                    chain.bent,
                    begin,
                    end,
                    _SURE * self.limit,
                    self.swell,
                    off,
                )
                begin = end - _OVERLAP

    def _bad(self, chain: TangentPath, off: Floats) -> Flags:
        """Tell which pieces are beyond the limit or meet another with too much of a bend."""
        from . import tangent_kernels as kernels

        turns, line = np.empty(len(chain) + 1), self.line
        kernels.bends(line.joints(chain), chain.half, turns)
        allowed = np.full(len(turns), self.bend)
        if len(chain) > 1:
            near = line.nearest(chain.s)
            there = np.maximum.reduceat(line.turns, np.column_stack([np.maximum(near[:-2] - 1, 0), near[2:]]).ravel())[
                ::2
            ]
            allowed[1:-1] = np.maximum(self.bend, np.minimum(_AS_SHARP * there, line.turns.max()))
        sharp = turns > allowed
        bad: Flags = (off > self.limit) | sharp[:-1] | sharp[1:]
        return bad

    def _anew(self, chain: TangentPath, bad: Flags, off: Floats, more: bool) -> tuple[TangentPath, Flags, Floats]:
        """Return a chain whose bad pieces are fitted anew, as many or one more in a row; what is new, and how far all
        are off.
        """
        sizes, chords = self._sizes(chain), np.diff(self.line.nearest(chain.s))
        longer = np.maximum(np.append(sizes[1:], 0.0), np.append(0.0, sizes[:-1]))
        may = bad & ~chain.bent & ((chords >= _LEAST_CHORDS) | (sizes <= _EVEN * longer))
        chain.bent[may] = True
        again = bad & ~_beside(may, 1)
        edges = _stretches(again if more else _beside(again, 1))
        parts: list[TangentPath] = []
        news: list[Flags] = []
        offs: list[Floats] = []
        at = 0
        for first, stop in [*edges, (len(chain), len(chain))]:
            parts.append(chain.part(at, first))
            if stop > first:
                parts.append(self._evenly(chain.part(first, stop), stop - first + int(more)))
            news += [may[at:first], np.ones(len(parts[-1]) if stop > first else 0, bool)]
            offs += [off[at:first], np.zeros(len(news[-1]))]
            at = stop
        return joined(parts), np.concatenate(news), np.concatenate(offs)

    def _evenly(self, old: TangentPath, count: int) -> TangentPath:
        """Return no more pieces than a count between the ends of others, all within as little as can be."""
        first, stop = self.line.nearest(old.s[[0, -1]]).tolist()
        if stop <= first:
            return old
        some = np.unique(np.linspace(first, stop, min(stop - first + 1, _PLENTY)).astype(np.int64))
        few = PlanarPolyline(self.line.points[some, :2], self.limit)
        low, high = 1e-2 * self.limit, 4.0 * self.limit
        best = self._greedy(few, self.limit)
        for _ in range(_HALVINGS):
            middle = math.sqrt(low * high)
            made = self._greedy(few, middle)
            if len(made) <= count:
                best, high = made, middle
            else:
                low = middle
        best = replace(best, s=self.line.along[some[few.nearest(best.s)]])
        for end in (0, -1):
            best.s[end], best.left[end] = old.s[end], old.left[end]
        return best

    def _greedy(self, line: PlanarPolyline, limit: float) -> TangentPath:
        """Return the longest lines and arcs from point to point."""
        from . import arc_fit_kernels as kernels

        stop = len(line.xy) - 1
        rows, heights = np.empty((stop, 3), np.int64), np.empty(stop)
        count = kernels.greedy(line.points[None], 0, stop, limit, self.swell, self.largest, 1, rows, heights)
        at = np.concatenate([[0], rows[:count, 0]])
        bent = rows[:count, 1] == kernels.ARC
        half = np.where(bent, -2 * np.arctan2(heights[:count], 0.5 * np.abs(np.diff(line.xy[at]))), 0.0)
        return TangentPath(line.along[at], np.zeros(count + 1), half, bent)


def _bends(points: Floats, reach: float, step: float) -> Floats:
    """Return by how much a polyline bends at its points, chord by chord or over a length where chords are shorter,
    radians.

    A curve turns half as much over half the length, where a bend turns as much: so narrow curves bend by next to
    nothing, and chords that rounding has turned by no more than it can turn them.
    """
    from ..point_curves import corner_kernels

    along, near, wide = np.empty(len(points)), np.empty(len(points)), np.empty(len(points))
    corner_kernels.turns(points, reach / 2, along, near)
    corner_kernels.turns(points, reach, along, wide)
    chords = np.diff(along)
    shorter = np.minimum(np.append(chords, np.inf), np.append(np.inf, chords))
    of_near, of_wide = (_ROUNDED * step / np.maximum(shorter, length) for length in (reach / 2, reach))
    of_both = np.where(shorter >= reach, of_wide, 2 * of_near + of_wide)
    bends: Floats = np.maximum(np.minimum(wide - of_wide, 2 * near - wide - of_both), 0.0)
    return bends


def joined(parts: list[TangentPath]) -> TangentPath:
    """Return chains one after the other as one; where one ends the next begins."""
    s, left, half, bent = (
        np.concatenate([getattr(part, name)[: len(part)] for part in parts]) for name in ("s", "left", "half", "bent")
    )
    last = parts[-1]
    return TangentPath(np.append(s, last.s[-1]), np.append(left, last.left[-1]), half, bent)


def _beside(flags: Flags, reach: int) -> Flags:
    """Tell what is flagged or at most so far from a flagged one."""
    near: Flags = np.convolve(flags, np.ones(2 * reach + 1))[reach : reach + len(flags)] > 0.5
    return near


def _stretches(flags: Flags) -> list[tuple[int, int]]:
    """Return first and stop of flags that follow one another."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], flags, [False]])))
    return [(first, stop) for first, stop in edges.reshape(-1, 2).tolist()]
