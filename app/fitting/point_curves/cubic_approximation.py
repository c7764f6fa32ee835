"""Splines of degree 5 as controls take them, none of which knows more than cubics: as cubics near them."""

from __future__ import annotations

import numpy as np

from ...core.errors import InputError
from ...core.options import option
from ...model.motion import Floats, Nurbs

_CUBIC, _QUINTIC = 3, 5
"""Degrees: what controls take, and what is approximated."""
_ROUNDS = 16
"""Rounds of halving spans at most: a cubic is off by the fourth power of its span."""
_AT = np.arange(_QUINTIC + 1) / _QUINTIC
"""Parameters of a span at which a piece of degree 5 is known by its values: as many as it has coefficients."""
_BINOMIAL = np.array([1, 5, 10, 10, 5, 1])
"""Of degree 5: the weights of its control points."""
_CONTROL = np.linalg.inv(_BINOMIAL * _AT[:, None] ** np.arange(6) * (1 - _AT[:, None]) ** np.arange(5, -1, -1))
"""From a quintic's values at six even parameters to its control points."""


def cubic_near(curve: Nurbs, near: float) -> Nurbs:
    """Return a cubic spline, smooth of the second order, that is nowhere farther than `near` from one of degree 5.

    It goes through the spline at its own knots, with its tangents at both ends; a span in which it is farther away,
    which the control points of their difference bound at every parameter, is halved.

    Args:
        curve: of degree 5, all weights 1, its knots clamped.
        near: mm, > 0.

    Raises:
        InputError: rounding alone is more than `near`.
    """
    from scipy.interpolate import BSpline, make_interp_spline

    given = BSpline(curve.knots, curve.points, _QUINTIC)
    slopes = given.derivative()
    breaks: Floats = np.unique(curve.knots)
    for _ in range(_ROUNDS):
        ends = [[(1, slopes(end))] for end in breaks[[0, -1]]]
        cubic = make_interp_spline(breaks, given(breaks), _CUBIC, bc_type=tuple(ends))
        at = breaks[:-1, None] + np.diff(breaks)[:, None] * _AT
        apart = np.einsum("ij,njk->nik", _CONTROL, given(at) - cubic(at))
        far = np.flatnonzero(np.sqrt(np.sum(apart**2, axis=2)).max(axis=1) > near)
        if len(far) == 0:
            points = np.array(cubic.c)
            points[[0, -1]] = curve.points[[0, -1]]
            return Nurbs(points, np.ones(len(points)), np.array(cubic.t), _CUBIC)
        breaks = np.insert(breaks, far + 1, (breaks[far] + breaks[far + 1]) / 2)
    raise InputError(
        f"No cubics come within {near:g} mm of a spline of degree 5; use {option('degree', '3')}, or a larger "
        "tolerance."
    )
