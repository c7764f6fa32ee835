"""Rational B-splines in space: points, and chords that are proven to be near enough."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ...model.motion import Nurbs
from .bezier import cut_at_knots

Floats = NDArray[np.float64]

_FINEST = 1e-9
"""Chords are not asked to be nearer than this share of the curve's extent; rounding would keep them from it."""
_AT_ONCE = 512
"""Pieces that are halved together; it bounds the memory that a long curve takes."""
_MOST_HALVINGS = 60
"""Enough for weights that differ by a factor of 1e9 and more."""


def flattened(curve: Nurbs, tolerance: float) -> Floats:
    """Return points on a curve; see `flattened_all`."""
    return flattened_all([curve], tolerance)[0]


def flattened_all(curves: Sequence[Nurbs], tolerance: float) -> list[Floats]:
    """Return for each curve points on it, its ends included, whose chords are nowhere farther from it than a tolerance.

    Proof: between two points the curve lies in the hull of its Bézier control points, and the distance from the chord
    is convex, so that no point of the curve is farther from it than the farthest control point.

    Args:
        tolerance: mm, > 0; counts as at least a thousand-millionth of the curve's extent.

    Returns:
        (n, 3) mm each, n >= 2, in order along the curve.
    """
    found: list[Floats] = [curve.points[[0, -1]] for curve in curves]
    for degree in {curve.degree for curve in curves}:
        chosen = [k for k, curve in enumerate(curves) if curve.degree == degree]
        cut = [_pieces(curves[k]) for k in chosen]
        counts = [len(pieces) for pieces in cut]
        ends, owner = _ends_of_chords(np.concatenate(cut), np.repeat(np.arange(len(chosen)), counts), tolerance)
        edges = np.searchsorted(owner, np.arange(len(chosen) + 1))
        for k, first, last in zip(chosen, edges[:-1], edges[1:], strict=True):
            found[k] = np.concatenate((curves[k].points[:1], ends[first:last])) if last > first else found[k]
    return found


def _pieces(curve: Nurbs) -> Floats:
    """Return the curve's Bézier pieces (n, degree + 1, 4)."""
    points = _homogeneous(curve)
    return points[None] if len(points) == curve.degree + 1 else cut_at_knots(points, curve.knots, curve.degree)


def _ends_of_chords(pieces: Floats, owner: NDArray[np.int64], tolerance: float) -> tuple[Floats, NDArray[np.int64]]:
    """Return the ends (n, 3) of chords near enough to their pieces, and whose they are (n,); some pieces at a time."""
    portions = [slice(k, k + _AT_ONCE) for k in range(0, max(1, len(pieces)), _AT_ONCE)]
    done = [_halved_until(pieces[portion], owner[portion], tolerance) for portion in portions]
    return np.concatenate([ends for ends, _ in done]), np.concatenate([owners for _, owners in done])


def _halved_until(pieces: Floats, owner: NDArray[np.int64], tolerance: float) -> tuple[Floats, NDArray[np.int64]]:
    """Halve pieces until each is near its chord; return the chords' ends and whose they are."""
    limit = np.maximum(tolerance, _FINEST * np.ptp(pieces[..., :3] / pieces[..., 3:], axis=1).max(axis=1, initial=0.0))
    for _ in range(_MOST_HALVINGS):
        far = _off_chord(pieces) > limit
        if not far.any():
            break
        times = np.where(far, 2, 1)
        pieces, owner, limit = _halved(pieces, far), np.repeat(owner, times), np.repeat(limit, times)
    return _ends(pieces, -1), owner


def _homogeneous(curve: Nurbs) -> Floats:
    """Return control points (k, 4): w x, w y, w z, w; the largest weight counts as 1."""
    weights = (curve.weights / curve.weights.max())[:, None]
    return np.hstack([curve.points * weights, weights])


def _ends(pieces: Floats, which: int) -> Floats:
    ends: Floats = pieces[:, which, :3] / pieces[:, which, 3:]
    return ends


def _off_chord(pieces: Floats) -> Floats:
    """Return for each piece the distance (n,) of its farthest control point from its chord."""
    arms = pieces[..., :3] / pieces[..., 3:] - _ends(pieces, 0)[:, None]
    chord = arms[:, -1]
    square = np.einsum("nd,nd->n", chord, chord)
    share = np.einsum("nkd,nd->nk", arms, chord) / np.where(square > 0.0, square, 1.0)[:, None]
    aside = arms - np.clip(share, 0.0, 1.0)[..., None] * chord[:, None]
    farthest: Floats = np.sqrt(np.einsum("nkd,nkd->nk", aside, aside).max(axis=1))
    return farthest


def _halved(pieces: Floats, chosen: NDArray[np.bool_]) -> Floats:
    """Return the pieces in order, with those chosen in two halves each."""
    row, left, right = pieces[chosen], [], []
    while row.shape[1]:
        left.append(row[:, 0])
        right.append(row[:, -1])
        row = (row[:, :-1] + row[:, 1:]) / 2
    halves = np.stack([np.stack(left, axis=1), np.stack(right[::-1], axis=1)], axis=1)
    result = np.repeat(pieces, np.where(chosen, 2, 1), axis=0)
    result[np.repeat(chosen, np.where(chosen, 2, 1))] = halves.reshape(-1, *pieces.shape[1:])
    return result
