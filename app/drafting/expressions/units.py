"""Units that can be typed behind a number."""

from __future__ import annotations

import math
from collections.abc import Mapping

LENGTH_UNITS: Mapping[str, float] = {
    "mm": 1.0,
    "cm": 10.0,
    "m": 1000.0,
    "um": 1e-3,
    "µm": 1e-3,
    "in": 25.4,
    '"': 25.4,
    "ft": 304.8,
    "thou": 0.0254,
    "mil": 0.0254,
}
"""Size of each length unit, mm."""

ANGLE_UNITS: Mapping[str, float] = {"deg": 1.0, "°": 1.0, "rad": 180.0 / math.pi}
"""Size of each angle unit, degrees."""

ALL_UNITS: Mapping[str, float] = {**LENGTH_UNITS, **ANGLE_UNITS}
