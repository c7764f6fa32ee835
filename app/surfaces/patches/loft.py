"""Lofted and ruled surfaces: sections in one space of splines, and their control points interpolated across (skinning).

The surface holds every section exactly, but for rounding; between them it is what a spline of the chosen degree makes
of it. Piegl & Tiller, The NURBS Book, 10.3.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ...core.errors import GeometryError
from ...model.motion import Nurbs
from .nurbs_curve import checked, compatible, even_knots, through, unit_knots
from .patch import BsplineSurface

Floats = NDArray[np.float64]


def lofted(curves: Sequence[Nurbs], degree: int, closed: bool = False) -> BsplineSurface:
    """Return the surface through curves: u goes along them, v across.

    Args:
        curves: 2 or more, 3 where it is closed.
        degree: across them; lower with fewer sections.
        closed: smoothly from the last on to the first.

    Raises:
        GeometryError: neighbouring curves are the same, or too different rational ones.
    """
    rows, knots, along = compatible(curves)
    sections = np.array([*rows, rows[0]] if closed else rows)
    control, across, degree = through(sections, section_parameters(sections), degree, closed)
    control = control.transpose(1, 0, 2)
    checked(control[..., 3], "A loft")
    points = control[..., :3] / control[..., 3:]
    return BsplineSurface(points, control[..., 3].copy(), knots, unit_knots(across), along, degree)


def section_parameters(sections: Floats) -> Floats:
    """Return parameters from 0 to 1 of sections (n, k, 4): chord lengths of their control points, the mean of all that
    move.

    Raises:
        GeometryError: two neighbouring sections are the same.
    """
    places = sections[..., :3] / sections[..., 3:]
    steps = np.linalg.norm(np.diff(places, axis=0), axis=2)
    if not (steps.max(axis=1) > 1e-9 * max(float(np.ptp(places)), 1e-9)).all():
        at = int(steps.max(axis=1).argmin()) + 1
        raise GeometryError(f"Sections {at} and {at + 1} of a loft are the same; take one out.")
    whole = steps.sum(axis=0)
    moving = whole > 1e-9 * whole.max()
    share: Floats = np.concatenate([[0.0], np.cumsum((steps[:, moving] / whole[moving]).mean(axis=1))])
    return unit_knots(share)


def ruled(first: Nurbs, second: Nurbs) -> BsplineSurface:
    """Return the straight lines from one curve to another: u goes along the curves, v along the lines."""
    rows, knots, degree = compatible((first, second))
    control = np.stack(rows, axis=1)
    return BsplineSurface(
        control[..., :3] / control[..., 3:], control[..., 3].copy(), knots, even_knots(2, 1), degree, 1
    )
