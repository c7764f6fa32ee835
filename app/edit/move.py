"""Curves shifted in the plane."""

from __future__ import annotations

from dataclasses import replace

from app.model.curves import Arc, Circle, Curve, Ellipse, Line, Point


def moved_curve(curve: Curve, by: Point) -> Curve:
    """Return the curve shifted by a vector, mm."""
    def shift(point: Point) -> Point:
        return (point[0] + by[0], point[1] + by[1])

    if isinstance(curve, Line):
        return Line(shift(curve.start), shift(curve.end))
    if isinstance(curve, Arc):
        return Arc(shift(curve.start), shift(curve.end), shift(curve.centre), curve.ccw)
    if isinstance(curve, Circle | Ellipse):
        return replace(curve, centre=shift(curve.centre))
    return replace(curve, control_points=tuple(shift(p) for p in curve.control_points))
