"""Which outlines of a filled path bound what it paints, where areas are filled by the rule "nonzero"."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import compress

import numpy as np
from numpy.typing import NDArray

from ...geometry.sample import sample
from ...model.curves import Curve, Line

Floats = NDArray[np.float64]

_PROBES = 200
"""Of an outline's chords, the longest ones, so many are looked at on both sides until one is a border."""
_BANDS, _CHORDS_A_BAND, _BANDS_A_CHORD = 1024, 8, 4
"""Bands of a ring, at most; chords for which there is one; and how many a chord crosses on average, at most."""
_MOST_RUNS = 20_000
"""Of a path; each is compared with the boxes of all others, and of more than these all are taken for borders."""
_BESIDE = 1e-4
"""How far beside a chord, in its length."""


def closed_by_line(run: list[Curve]) -> list[Curve]:
    """Return the outline of what a fill paints: an open run is closed by a line, unless it is but one line itself."""
    if not run or run[0].start == run[-1].end or (len(run) == 1 and isinstance(run[0], Line)):
        return run
    return [*run, Line(run[-1].end, run[0].start)]


def bounding(runs: list[list[Curve]]) -> list[list[Curve]]:
    """Return the runs of a path that can be seen as borders of what it paints.

    By the rule "nonzero" a ring that turns the same way as the one round it bounds nothing: both sides of it are
    painted. Rings that cross others are kept, for a part of them is a border, and so are those that lie edge to edge.

    Args:
        runs: of one path, each closed; what a run of no area paints, nobody asks.
    """
    if not 2 <= len(runs) <= _MOST_RUNS:
        return runs
    corners = [_corners(run) for run in runs]
    boxes = np.array([(*each.min(axis=0), *each.max(axis=0)) for each in corners if len(each)])
    if len(boxes) < len(corners) or not np.isfinite(boxes).all():
        return runs
    rings = [_ChordRing(each) for each in corners]
    return list(compress(runs, [_is_border(ring, rings, boxes) for ring in rings]))


def _corners(run: Sequence[Curve]) -> Floats:
    """Return the corners (n, 2) of a run in chords, the first one again at the end."""
    return np.concatenate([sample(curve) for curve in run]) if run else np.empty((0, 2))


class _ChordRing:
    """A ring of chords that are kept by bands of Y, so that few are asked at each place."""

    def __init__(self, corners: Floats) -> None:
        """Take its corners (n, 2), the first one again at the end."""
        self.corners = corners
        low, high = np.sort(np.column_stack([corners[:-1, 1], corners[1:, 1]]), axis=1).T
        self._low, self._count = float(low.min()), min(_BANDS, len(low) // _CHORDS_A_BAND + 1)
        most = max(float(high.max()) - self._low, np.finfo(float).tiny)
        self._step = max(most / self._count, float((high - low).mean()) / _BANDS_A_CHORD)
        first, last = self._band(low), self._band(high)
        spans = last - first + 1
        bands = np.repeat(first - np.cumsum(spans) + spans, spans) + np.arange(spans.sum())
        order = np.argsort(bands, kind="stable")
        self._chords = np.repeat(np.arange(len(low)), spans)[order]
        self._begins = np.searchsorted(bands[order], np.arange(self._count + 2))

    def _band(self, y: Floats) -> NDArray[np.int64]:
        return np.clip((y - self._low) / self._step, 0, self._count).astype(np.int64)

    def turns(self, place: Floats) -> int:
        """Return how often the ring goes round a place, counter-clockwise."""
        band = int(self._band(place[1:])[0])
        chords = self._chords[self._begins[band] : self._begins[band + 1]]
        (x0, y0), (x1, y1) = (self.corners[chords] - place).T, (self.corners[chords + 1] - place).T
        left = x0 * y1 - x1 * y0
        up, down = (y0 <= 0) & (y1 > 0) & (left > 0), (y0 > 0) & (y1 <= 0) & (left < 0)
        return int(np.count_nonzero(up)) - int(np.count_nonzero(down))


def _is_border(ring: _ChordRing, rings: Sequence[_ChordRing], boxes: Floats) -> bool:
    """Tell whether somewhere along a ring one side is not painted, or another ring runs along it."""
    corners = ring.corners
    along = np.diff(corners, axis=0)
    length = np.hypot(along[:, 0], along[:, 1])
    longest = np.argsort(-length)[:_PROBES]
    for k in longest[length[longest] > 0].tolist():
        middle, aside = (corners[k] + corners[k + 1]) / 2, np.array([-along[k, 1], along[k, 0]]) * _BESIDE
        near = np.flatnonzero((boxes[:, :2] <= middle).all(axis=1) & (boxes[:, 2:] >= middle).all(axis=1))
        one, other = (sum(rings[j].turns(place) for j in near.tolist()) for place in (middle - aside, middle + aside))
        if one == 0 or other == 0 or one == other:
            return True
    return not length.any()
