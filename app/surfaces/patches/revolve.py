"""Surfaces of revolution, exactly: every control point of a profile becomes those of an arc about the axis."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ...model.motion import Nurbs
from .nurbs_curve import arc_knots, unit_arc, unit_knots
from .patch import BsplineSurface

Floats = NDArray[np.float64]


def revolved(profile: Nurbs, centre: Floats, axis: Floats, turn: tuple[float, float]) -> BsplineSurface:
    """Return a profile turned about an axis: u goes along the profile, v about the axis.

    Args:
        profile: mm. Where it touches the axis, a side of the surface is one point.
        centre, axis: a place on the axis, mm, and its direction, of any length.
        turn: from and to, radians, counter-clockwise as seen from the axis's end; 0 leaves the profile where it is.
    """
    along = axis / np.linalg.norm(axis)
    from_centre = profile.points - centre
    height = from_centre @ along
    feet = centre + height[:, None] * along
    out = profile.points - feet
    side = np.cross(along, out)
    arc = unit_arc(*turn)
    points = feet[:, None] + arc[None, :, :1] * out[:, None] + arc[None, :, 1:2] * side[:, None]
    weights = profile.weights[:, None] * arc[None, :, 2]
    return BsplineSurface(points, weights, unit_knots(profile.knots), arc_knots(len(arc)), profile.degree, 2)


def upper_side(axis: Floats) -> Floats:
    """Return the direction from which angles about an axis count: its upper side, or +X about an upright one; a unit
    vector.
    """
    along = axis / np.linalg.norm(axis)
    upright = math.hypot(along[0], along[1]) <= 1e-9
    up = np.array([1.0, 0.0, 0.0] if upright else [0.0, 0.0, 1.0])
    out = up - (up @ along) * along
    made: Floats = out / np.linalg.norm(out)
    return made
