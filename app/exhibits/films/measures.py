"""Distances in space by the plain formula, for the figures of the films."""

from __future__ import annotations

import numpy as np

from ...model.motion import Floats

_ROOM = 2_000_000
"""Pairs of a place and a chord that are looked at at a time."""


def distances_to_polyline(places: Floats, points: Floats) -> Floats:
    """Return how far each place (k, 3) is from a polyline (n, 3), n >= 2, mm."""
    return np.asarray(np.linalg.norm(places - feet_on_polyline(places, points), axis=1))


def feet_on_polyline(places: Floats, points: Floats) -> Floats:
    """Return the place of a polyline (n, 3), n >= 2, nearest to each place (k, 3), mm."""
    start, chord = points[:-1], np.diff(points, axis=0)
    squares = np.maximum(np.sum(chord**2, axis=1), 1e-300)
    step = max(1, _ROOM // len(start))
    found = np.empty((len(places), 3))
    for first in range(0, len(places), step):
        part = places[first : first + step, None] - start
        share = np.clip(np.sum(part * chord, axis=2) / squares, 0.0, 1.0)
        best = np.argmin(np.sum((part - share[..., None] * chord) ** 2, axis=2), axis=1)
        near = share[np.arange(len(part)), best]
        found[first : first + step] = start[best] + near[:, None] * chord[best]
    return found
