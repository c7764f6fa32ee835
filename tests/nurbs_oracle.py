"""Points of rational B-splines, by scipy."""

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import BSpline

from app.model.motion import Nurbs


def nurbs_points(curve: Nurbs, parameters: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return points (n, 3), mm, for parameters (n,) between the first and the last knot."""
    control = np.hstack([curve.points * curve.weights[:, None], curve.weights[:, None]])
    homogeneous = BSpline(curve.knots, control, curve.degree)(parameters)
    return homogeneous[:, :3] / homogeneous[:, 3:]
