"""Analytic surfaces, exactly: flat ones, quadrics and tori as rational B-splines, and B-splines as they are given."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ...model.motion import Nurbs
from ...model.scene_shapes import (
    BicubicShape,
    BilinearShape,
    BsplineShape,
    ConeShape,
    CylinderShape,
    PlaneShape,
    SphereShape,
    TorusShape,
)
from .nurbs_curve import arc_knots, even_knots, unit_arc
from .patch import BsplineSurface
from .revolve import revolved, upper_side

Floats = NDArray[np.float64]


def spanned(points: Floats) -> BsplineSurface:
    """Return the polynomial Bézier patch of control points (p + 1, q + 1, 3)."""
    p, q = points.shape[0] - 1, points.shape[1] - 1
    return BsplineSurface(points, np.ones(points.shape[:2]), even_knots(p + 1, p), even_knots(q + 1, q), p, q)


def plane(shape: PlaneShape) -> BsplineSurface:
    """Return a parallelogram."""
    corner, along, across = np.array(shape.corner), np.array(shape.along), np.array(shape.across)
    return spanned(np.array([[corner, corner + across], [corner + along, corner + along + across]]))


def bilinear(shape: BilinearShape) -> BsplineSurface:
    """Return the surface of four corners, which go round it."""
    a, b, c, d = shape.corners
    return spanned(np.array([[a, d], [b, c]]))


def bicubic(shape: BicubicShape) -> BsplineSurface:
    """Return a bicubic patch."""
    return spanned(np.array(shape.points))


def bspline(shape: BsplineShape) -> BsplineSurface:
    """Return a B-spline surface."""
    points = np.array(shape.points)
    nu, nv, _ = points.shape
    knots_u = np.array(shape.knots_u) if shape.knots_u else even_knots(nu, shape.degree_u)
    knots_v = np.array(shape.knots_v) if shape.knots_v else even_knots(nv, shape.degree_v)
    weights = np.array(shape.weights) if shape.weights else np.ones((nu, nv))
    return BsplineSurface(points, weights, knots_u, knots_v, shape.degree_u, shape.degree_v)


def sphere(shape: SphereShape) -> BsplineSurface:
    """Return a sphere: half a circle turned about the upright axis, its poles at both ends of u."""
    centre = np.array(shape.centre)
    arc = unit_arc(-math.pi / 2, math.pi / 2)
    return revolved(
        _arc(arc, centre, shape.radius * np.eye(3)[0], shape.radius * np.eye(3)[2]),
        centre,
        np.eye(3)[2],
        (0.0, math.tau),
    )


def torus(shape: TorusShape) -> BsplineSurface:
    """Return a torus: the tube's circle turned about the axis."""
    centre, axis = np.array(shape.centre), np.array(shape.axis)
    along, out = axis / np.linalg.norm(axis), upper_side(axis)
    tube = _arc(unit_arc(0.0, math.tau), centre + shape.major * out, shape.minor * out, shape.minor * along)
    return revolved(tube, centre, axis, (0.0, math.tau))


def cylinder(shape: CylinderShape) -> BsplineSurface:
    """Return a cylinder, or what a part of the turn leaves of it, without its ends."""
    return _cone(np.array(shape.start), np.array(shape.end), (shape.radius, shape.radius), shape.turn_deg)


def cone(shape: ConeShape) -> BsplineSurface:
    """Return a cone or a frustum, or what a part of the turn leaves of it, without its ends."""
    return _cone(np.array(shape.start), np.array(shape.end), (shape.start_radius, shape.end_radius), shape.turn_deg)


def _cone(start: Floats, end: Floats, radii: tuple[float, float], turn_deg: tuple[float, float]) -> BsplineSurface:
    out = upper_side(end - start)
    line = Nurbs(np.array([start + radii[0] * out, end + radii[1] * out]), np.ones(2), even_knots(2, 1), 1)
    return revolved(line, start, end - start, (math.radians(turn_deg[0]), math.radians(turn_deg[1])))


def _arc(arc: Floats, centre: Floats, x: Floats, y: Floats) -> Nurbs:
    """Return an arc of the unit circle in a plane: about a centre, with vectors of radius length as axes."""
    return Nurbs(centre + arc[:, :1] * x + arc[:, 1:2] * y, arc[:, 2], arc_knots(len(arc)), 2)
