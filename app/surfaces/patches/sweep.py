"""Swept surfaces: a profile moved along a guide, parallel to itself (exactly) or turning with the guide (within a
tolerance).

The turning frame is that which turns least about the guide (rotation-minimising), found by double reflection:
Wang, Jüttler, Zheng, Liu: Computation of rotation minimizing frames, ACM Trans. Graph. 27(1), 2008.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ...core.errors import GeometryError
from ...model.motion import Nurbs
from .nurbs_curve import homogeneous, spline_of, through, unit_knots
from .patch import BsplineSurface

Floats = NDArray[np.float64]

TOLERANCE = 1e-6
"""mm; a turning sweep is no farther off the true one, as measured between its sections."""

_STEPS = 512
"""Frames along each span of the guide; their error falls with the fourth power of this."""


def parallel_sweep(profile: Nurbs, guide: Nurbs) -> BsplineSurface:
    """Return a profile moved along a guide without turning, exactly: u goes along the profile, v along the guide."""
    points = profile.points[:, None] + (guide.points - guide.points[0])[None]
    weights = profile.weights[:, None] * guide.weights[None]
    return BsplineSurface(
        points, weights, unit_knots(profile.knots), unit_knots(guide.knots), profile.degree, guide.degree
    )


def following_sweep(profile: Nurbs, guide: Nurbs) -> tuple[BsplineSurface, ...]:
    """Return a profile that turns with a guide: one surface for each span between the guide's knots, joined without
    gaps.

    Raises:
        GeometryError: the guide has a corner, or turns too sharply for TOLERANCE.
    """
    made = []
    turn = np.eye(3)
    breaks = np.unique(guide.knots)
    before: Floats | None = None
    for low, high in pairwise(breaks):
        at = np.linspace(low, high, _STEPS + 1)
        places, tangents = _places(guide, at, (low, high))
        if before is not None and np.linalg.norm(before - tangents[0]) > 1e-6:
            x, y, z = places[0]
            raise GeometryError(
                f"The guide of a sweep has a corner at {x:g}, {y:g}, {z:g}; round it, or keep the profile parallel."
            )
        turns = _turns(places, tangents, turn)
        made.append(_span(profile, guide.points[0], places, turns))
        turn, before = turns[-1], tangents[-1]
    return tuple(made)


def _places(guide: Nurbs, at: Floats, span: tuple[float, float]) -> tuple[Floats, Floats]:
    """Return places (n, 3) and unit tangents (n, 3) of a guide within one span of its knots."""
    spline = spline_of(homogeneous(guide), guide.knots, guide.degree)
    low, high = span
    # derivatives of this span, not of the next
    inner = np.clip(at, low + 1e-12 * (high - low), high - 1e-12 * (high - low))
    rows, slopes = spline(at), spline.derivative()(inner)
    places = rows[:, :3] / rows[:, 3:]
    steep = slopes[:, :3] - places * slopes[:, 3:]
    lengths = np.linalg.norm(steep, axis=1)
    if not (lengths > 1e-12 * max(float(lengths.max()), 1e-9)).all():
        x, y, z = places[int(lengths.argmin())]
        raise GeometryError(f"The guide of a sweep stands still at {x:g}, {y:g}, {z:g}; take doubled points out.")
    return places, steep / lengths[:, None]


def _turns(places: Floats, tangents: Floats, first: Floats) -> Floats:
    """Return rotations (n, 3, 3) that carry vectors from the guide's start along, beginning with `first`."""
    turns = np.empty((len(places), 3, 3))
    turns[0] = first
    for k in range(len(places) - 1):
        v1 = places[k + 1] - places[k]
        c1 = v1 @ v1
        frame = turns[k].T - np.outer(2 / c1 * (turns[k].T @ v1), v1)
        tangent = tangents[k] - 2 / c1 * (v1 @ tangents[k]) * v1
        v2 = tangents[k + 1] - tangent
        c2 = v2 @ v2
        if c2 > 0:
            frame = frame - np.outer(2 / c2 * (frame @ v2), v2)
        turns[k + 1] = frame.T
    return turns


def _span(profile: Nurbs, start: Floats, places: Floats, turns: Floats) -> BsplineSurface:
    """Return the surface of one span, with as many sections as TOLERANCE needs."""
    out = profile.points - start
    sections = places[:, None] + np.einsum("nij,kj->nki", turns, out)
    at = np.linspace(0.0, 1.0, len(places))
    step = _STEPS // 4
    while step > 1:
        control, knots, degree = through(sections[::step], at[::step], 3)
        off = np.linalg.norm(spline_of(control, knots, degree)(at) - sections, axis=2).max()
        if off <= TOLERANCE:
            weights = np.repeat(profile.weights[:, None], len(control), axis=1)
            return BsplineSurface(
                control.transpose(1, 0, 2), weights, unit_knots(profile.knots), knots, profile.degree, degree
            )
        step //= 2
    x, y, z = places[len(places) // 2]
    raise GeometryError(
        f"The guide of a sweep turns too sharply about {x:g}, {y:g}, {z:g}; give it more points, or larger radii."
    )
