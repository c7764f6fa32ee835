"""Curves as painter paths in mm: circles and arcs stay smooth at every zoom, for their pieces are at most 45 degrees.

A cubic of 45 degrees differs from its circle by 4e-6 of the radius.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QByteArray, QDataStream, QIODevice
from PySide6.QtGui import QPainterPath

from .....geometry.sample import sample, spline_points
from .....model.curves import Arc, Circle, Curve, Ellipse, Line, Point, Spline

PIECE = math.pi / 4
MOVE_TO, LINE_TO, CURVE_TO, CURVE_DATA = 0, 1, 2, 3
ELEMENT = np.dtype([("kind", ">i4"), ("x", ">f8"), ("y", ">f8")])
"""One element of a painter path as QDataStream writes it."""

Elements = NDArray[np.void]

MANY = 5000
"""A scene with more elements in view is painted with pens of one px, which Qt strokes about eight times as fast."""


def add_curves(path: QPainterPath, curves: Iterable[Curve]) -> None:
    """Add curves to a path in mm; one that begins where the one before ends is joined to it, which looks finer and
    paints faster.
    """
    at: Point | None = None
    for curve in curves:
        if curve.start != at:
            path.moveTo(*curve.start)
        _continue(path, curve)
        at = curve.end
        if isinstance(curve, Circle):
            path.closeSubpath()
            at = None


def curve_path(*curves: Curve) -> QPainterPath:
    """Return the painter path in mm of some curves."""
    path = QPainterPath()
    add_curves(path, curves)
    return path


def chain_path(curves: tuple[Curve, ...], path: QPainterPath) -> None:
    """Add curves that join end to end as one closed outline that can be filled."""
    path.moveTo(*curves[0].start)
    for curve in curves:
        _continue(path, curve)
    path.closeSubpath()


def path_of(*runs: bytes) -> QPainterPath:
    """Return the painter path made of the bytes of runs of elements (dtype ELEMENT), each begun by MOVE_TO."""
    path = QPainterPath()
    count = sum(map(len, runs)) // ELEMENT.itemsize
    if count == 0:
        return path
    data = QByteArray(b"".join([struct.pack(">i", count), *runs, struct.pack(">ii", 0, 0)]))
    stream = QDataStream(data, QIODevice.OpenModeFlag.ReadOnly)  # the stream only points to the data: keep it
    stream >> path
    return path


def _continue(path: QPainterPath, curve: Curve) -> None:
    """Add a curve to a path that has come to its start."""
    if isinstance(curve, Line):
        path.lineTo(*curve.end)
    elif isinstance(curve, Arc):
        _add_turn(path, curve.centre, (curve.radius, 0.0), 1.0, (curve.start_angle, curve.sweep))
        path.lineTo(*curve.end)
    elif isinstance(curve, Circle):
        _add_turn(path, curve.centre, (curve.radius, 0.0), 1.0, (0.0, math.tau if curve.ccw else -math.tau))
    elif isinstance(curve, Ellipse):
        first, last = curve.start_parameter, curve.end_parameter
        span = (first, last - first) if curve.ccw else (last, first - last)
        _add_turn(path, curve.centre, curve.major, curve.ratio, span)
    else:
        _add_spline(path, curve)


def _add_turn(path: QPainterPath, centre: Point, major: Point, ratio: float, span: tuple[float, float]) -> None:
    """Add an arc of an ellipse from parameter span[0] over span[1] radians."""
    (x, y), (ax, ay) = centre, major
    count = max(1, math.ceil(abs(span[1]) / PIECE - 1e-9))
    step = span[1] / count
    handle = 4 / 3 * math.tan(step / 4)

    def at(c: float, s: float) -> Point:
        return (x + c * ax - ratio * s * ay, y + c * ay + ratio * s * ax)

    c0, s0 = math.cos(span[0]), math.sin(span[0])
    for k in range(1, count + 1):
        t = span[0] + step * k
        c1, s1 = math.cos(t), math.sin(t)
        path.cubicTo(*at(c0 - handle * s0, s0 + handle * c0), *at(c1 + handle * s1, s1 - handle * c1), *at(c1, s1))
        c0, s0 = c1, s1


def _add_spline(path: QPainterPath, spline: Spline) -> None:
    """Add a spline as cubics, eight to a knot span, with slopes by differences."""
    if spline.degree == 1:
        for x, y in sample(spline):
            path.lineTo(x, y)
        return
    knots = np.unique(spline.knots)
    t = np.append(np.linspace(knots[:-1], knots[1:], 8, endpoint=False, axis=1).ravel(), knots[-1])
    width = np.diff(t)[:, None]
    a, b = t[:-1] + 1e-5 * width[:, 0], t[1:] - 1e-5 * width[:, 0]
    points = spline_points(spline, t)
    first = points[:-1] + (spline_points(spline, a) - points[:-1]) / 3e-5
    second = points[1:] - (points[1:] - spline_points(spline, b)) / 3e-5
    for p, q, end in zip(first, second, points[1:], strict=True):
        path.cubicTo(*p, *q, *end)
