"""Ruled surfaces: straight lines between like parameters of two curves, exactly."""

from __future__ import annotations

import numpy as np

from ...model.motion import Nurbs
from .nurbs_curve import compatible, even_knots
from .patch import BsplineSurface


def ruled(first: Nurbs, second: Nurbs) -> BsplineSurface:
    """Return the straight lines from one curve to another: u goes along the curves, v along the lines."""
    rows, knots, degree = compatible((first, second))
    control = np.stack(rows, axis=1)
    return BsplineSurface(
        control[..., :3] / control[..., 3:], control[..., 3].copy(), knots, even_knots(2, 1), degree, 1
    )
