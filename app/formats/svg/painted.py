"""Which outlines of a filled path bound what it paints, where areas are filled by the rule "nonzero"."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import compress

import numpy as np
from numpy.typing import NDArray

from ...geometry.sample import sample
from ...model.curves import Curve

Floats = NDArray[np.float64]

_PROBES = 200
"""Of an outline's chords, the longest ones, so many are looked at on both sides until one is a border."""
_BESIDE = 1e-4
"""How far beside a chord, in its length."""


def bounding(runs: list[list[Curve]]) -> list[list[Curve]]:
    """Return the runs of a path that can be seen as borders of what it paints.

    By the rule "nonzero" a ring that turns the same way as the one round it bounds nothing: both sides of it are
    painted. Rings that cross others are kept, for a part of them is a border, and so are those that lie edge to edge.

    Args:
        runs: of one path, each closed; what a run of no area paints, nobody asks.
    """
    if len(runs) < 2:
        return runs
    rings = [_ring(run) for run in runs]
    boxes = np.array([(*ring.min(axis=0), *ring.max(axis=0)) for ring in rings if len(ring)])
    if len(boxes) < len(rings) or not np.isfinite(boxes).all():
        return runs
    return list(compress(runs, [_is_border(ring, rings, boxes) for ring in rings]))


def _ring(run: Sequence[Curve]) -> Floats:
    """Return the corners (n, 2) of a run in chords, the first one again at the end."""
    return np.concatenate([sample(curve) for curve in run]) if run else np.empty((0, 2))


def _is_border(ring: Floats, rings: Sequence[Floats], boxes: Floats) -> bool:
    """Tell whether somewhere along a ring one side is not painted, or another ring runs along it."""
    along = np.diff(ring, axis=0)
    length = np.hypot(along[:, 0], along[:, 1])
    longest = np.argsort(-length)[:_PROBES]
    for k in longest[length[longest] > 0].tolist():
        middle, aside = (ring[k] + ring[k + 1]) / 2, np.array([-along[k, 1], along[k, 0]]) * _BESIDE
        near = np.flatnonzero((boxes[:, :2] <= middle).all(axis=1) & (boxes[:, 2:] >= middle).all(axis=1))
        one, other = (sum(_turns(rings[j], place) for j in near.tolist()) for place in (middle - aside, middle + aside))
        if one == 0 or other == 0 or one == other:
            return True
    return not length.any()


def _turns(ring: Floats, place: Floats) -> int:
    """Return how often a ring goes round a place, counter-clockwise."""
    (x0, y0), (x1, y1) = (ring[:-1] - place).T, (ring[1:] - place).T
    left = x0 * y1 - x1 * y0
    up, down = (y0 <= 0) & (y1 > 0) & (left > 0), (y0 > 0) & (y1 <= 0) & (left < 0)
    return int(np.count_nonzero(up)) - int(np.count_nonzero(down))
