"""A spline as lines and arcs so near to it that another control drives the same within its last decimals."""

from __future__ import annotations

import math

import numpy as np

from ...fitting.line_arcs.arc_fit import ArcOptions, fit_arcs
from ...model.motion import Motions, Nurbs
from ...model.motion_path import fine_spline_points

_NEAR, _SAG = 0.6, 0.05
"""Of the last decimal: how far lines and arcs may be from the points of a spline, and its chords from it."""
_MOST = 1 << 18
"""Chords of a spline, never more."""


def near_arcs(spline: Nurbs, step: float, largest: float) -> Motions:
    """Return lines and arcs along a spline.

    Args:
        step: the last decimal, mm; what is made is proven when it is read back.
        largest: radius of an arc of the control, mm; what is flatter is a line.
    """
    points = fine_spline_points(spline, _SAG * step, _MOST)
    far = np.concatenate([[True], np.any(np.diff(points, axis=0) != 0, axis=1)])
    return fit_arcs(points[far], ArcOptions(_NEAR * step, math.pi / 6, largest)).motions
