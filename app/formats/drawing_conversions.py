"""What all writers of drawings need: a box round the part, curves as lines and arcs, a
count of both.
"""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

from ..core import tolerances
from ..geometry.arcs.arcs import lines_and_arcs
from ..geometry.primitives import boxes, curve_rows
from ..model.curves import Curve, Ellipse, Primitive, Spline
from ..model.part import Entity
from .drawing import ConvertedCurves


class Conversions:
    """Turns curves into lines and arcs, and keeps count."""

    def __init__(self, tolerance: float = tolerances.CURVE) -> None:
        self._tolerance = tolerance
        self._found: dict[str, ConvertedCurves] = {}

    def primitives(self, curve: Ellipse | Spline) -> tuple[Primitive, ...]:
        """Return lines and arcs within the tolerance of a curve, each beginning where the one before ends.

        Raises:
            GeometryError: the curve cannot be followed.
        """
        made = lines_and_arcs(curve, self._tolerance)
        kind = type(curve).__name__.lower()
        before = self._found.get(kind, ConvertedCurves(kind, 0, 0.0))
        self._found[kind] = ConvertedCurves(kind, before.count + 1, max(before.deviation, made.deviation))
        return made.primitives

    @property
    def converted(self) -> tuple[ConvertedCurves, ...]:
        """All so far, by kind."""
        return tuple(self._found[kind] for kind in sorted(self._found))


def box_round(entities: Iterable[Entity]) -> tuple[float, float, float, float] | None:
    """Return x0, y0, x1, y1 that hold all curves, mm, wider than need be round parts of ellipses and splines; None for
    no curves.
    """
    found = [_box(entity.curve) for entity in entities]
    if not found:
        return None
    x0, y0, x1, y1 = zip(*found, strict=True)
    return min(x0), min(y0), max(x1), max(y1)


def _box(curve: Curve) -> tuple[float, float, float, float]:
    if isinstance(curve, Spline):
        xs, ys = zip(*curve.control_points, strict=True)
        return min(xs), min(ys), max(xs), max(ys)
    if isinstance(curve, Ellipse):
        (x, y), (a, b), ratio = curve.centre, curve.major, curve.ratio
        across, up = math.hypot(a, b * ratio), math.hypot(b, a * ratio)
        return x - across, y - up, x + across, y + up
    around = boxes(np.array(curve_rows(curve)))
    (x0, y0), (x1, y1) = around[:, :2].min(axis=0), around[:, 2:].max(axis=0)
    return float(x0), float(y0), float(x1), float(y1)
