"""How far a bicubic surface of heights may be from a straight chord between two of its places: proven, not sampled.

Along a chord the surface's height is a function of t in [0, 1] whose second derivative is
f_uu du^2 + 2 f_uv du dv + f_vv dv^2. All three derivatives are splines themselves, and in each patch between knots a
spline lies within the hull of the control points that act there. A function that is 0 at both ends of [0, 1] is nowhere
more than an eighth of the greatest amount of its second derivative; for a paraboloid that is exact.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from ...model.motion import Floats
from .height_spline import HeightSpline


@dataclass(frozen=True, eq=False)
class _PatchBounds:
    """Of one second derivative, in each patch (p, q): its least and its greatest value are in between, 1/mm."""

    least: Floats
    greatest: Floats

    @staticmethod
    def of(net: Floats, acting: tuple[int, int]) -> _PatchBounds:
        """Return the hulls of control points, of which so many along u and v act in each patch."""
        windows = sliding_window_view(net, acting)
        return _PatchBounds(windows.min(axis=(2, 3)), windows.max(axis=(2, 3)))


def chord_bounds(spline: HeightSpline, starts: Floats, ends: Floats) -> Floats:
    """Return how far a surface may be from chords between its places at most, along Z, mm, (k,).

    Args:
        spline: the surface. starts, ends: (k, 2) places in its box, mm.

    References:
        |g(t)| <= max |g''| / 8 on [0, 1] for g(0) = g(1) = 0; convex hull property of B-splines.
    """
    if not len(starts):
        return np.zeros(0)
    low = np.array([spline.knots_u[3], spline.knots_v[3]])
    size = np.array([spline.knots_u[4], spline.knots_v[4]]) - low
    patches = np.floor((np.stack([starts, ends]) - low) / size).astype(np.int64)
    patches = np.clip(patches, 0, np.array(spline.control.shape) - 4)
    first, counts = patches.min(axis=0), np.ptp(patches, axis=0) + 1
    number = counts.prod(axis=1)
    begin = np.cumsum(number) - number
    chord = np.repeat(np.arange(len(starts)), number)
    at = np.arange(len(chord)) - begin[chord]
    u, v = first[chord, 0] + at // counts[chord, 1], first[chord, 1] + at % counts[chord, 1]
    du, dv = (ends - starts)[chord].T
    weighed = [
        (share * each.least[u, v], share * each.greatest[u, v])
        for share, each in zip((du * du, 2 * du * dv, dv * dv), _second_derivatives(spline, size), strict=True)
    ]
    highest = sum(np.maximum(one, other) for one, other in weighed)
    lowest = sum(np.minimum(one, other) for one, other in weighed)
    bounds: Floats = np.maximum.reduceat(np.maximum(highest, -lowest), begin) / 8
    return bounds


def _second_derivatives(spline: HeightSpline, size: NDArray[np.float64]) -> tuple[_PatchBounds, ...]:
    """Return f_uu, f_uv and f_vv in each patch of so much along u and v, mm."""
    control, (along, across) = spline.control, size.tolist()
    mixed = np.diff(np.diff(control, axis=0), axis=1) / (along * across)
    return (
        _PatchBounds.of(np.diff(control, 2, axis=0) / along**2, (2, 4)),
        _PatchBounds.of(mixed, (3, 3)),
        _PatchBounds.of(np.diff(control, 2, axis=1) / across**2, (4, 2)),
    )
