"""How smooth a path is: the largest bend and the largest step of its curvature, where one piece meets the next."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...geometry.coincident_points import near
from ...model.motion import Floats
from .space_curve import DEGREE, SpaceCurve

_CORNER = 1e-3
"""A place so near to a corner, mm, is it."""


@dataclass(frozen=True, slots=True)
class Smoothness:
    """Largest values along a path, its kept corners left out.

    Attributes:
        bend: change of direction at one place, radians.
        curvature_step: change of curvature at one place, 1/mm.
    """

    bend: float
    curvature_step: float


def of_points(points: Floats, corners: Floats) -> Smoothness:
    """Return that of a polyline; its curvature at a point is the bend there over the mean of both chords.

    Args:
        points: (n, 3) mm, no two in a row alike.
        corners: (k, 3) places where bends are meant.
    """
    steps = np.diff(points, axis=0)
    sizes = np.linalg.norm(steps, axis=1)
    bends = _angles(steps[:-1], steps[1:])
    curvature = bends / ((sizes[:-1] + sizes[1:]) / 2) if len(bends) else bends
    smooth = ~near(points[1:-1], corners, _CORNER)
    both = smooth[:-1] & smooth[1:]
    return Smoothness(_most(bends[smooth]), _most(np.abs(np.diff(curvature))[both]))


def of_curve(curve: SpaceCurve, corners: Floats) -> Smoothness:
    """Return that of a curve, between its pieces; a piece itself is a polynomial.

    Args:
        curve: of any making.
        corners: (k, 3) places where bends are meant.
    """
    control = curve.control
    out, into = _ends(control), _ends(control[:, ::-1])
    bends = _angles(-into[0][:-1], out[0][1:])
    smooth = ~near(control[1:, 0], corners, _CORNER)
    return Smoothness(_most(bends[smooth]), _most(np.abs(into[1][:-1] - out[1][1:])[smooth]))


@dataclass(frozen=True, slots=True)
class CurveJoint:
    """Where one motion of a path goes over into the next.

    Attributes:
        place: mm.
        bend: change of direction, radians.
        curvature_step: change of curvature, 1/mm.
    """

    place: tuple[float, float, float]
    bend: float
    curvature_step: float


def joints_of(curve: SpaceCurve) -> tuple[CurveJoint, ...]:
    """Return the places where one motion ends and the next begins, in order; within one it is a polynomial, or smooth
    as a spline is.
    """
    control = curve.control
    at = np.flatnonzero(np.diff(curve.owner) != 0)
    out, into = _ends(control[at + 1]), _ends(control[at][:, ::-1])
    bends, steps = _angles(-into[0], out[0]), np.abs(into[1] - out[1])
    places = control[at + 1, 0].tolist()
    return tuple(
        CurveJoint((x, y, z), bend, step)
        for (x, y, z), bend, step in zip(places, bends.tolist(), steps.tolist(), strict=True)
    )


def _ends(control: Floats) -> tuple[Floats, Floats]:
    """Return the direction (m, 3) in which each piece sets out, and its curvature there, 1/mm."""
    first, second = control[:, 1] - control[:, 0], control[:, 2] - 2 * control[:, 1] + control[:, 0]
    size = np.linalg.norm(first, axis=1)
    bent = np.linalg.norm(np.cross(first, second), axis=1) * (DEGREE - 1) / DEGREE
    return first, bent / np.where(size > 0, size, np.inf) ** 3


def _angles(one: Floats, other: Floats) -> Floats:
    cross = np.linalg.norm(np.cross(one, other), axis=1)
    angles: Floats = np.arctan2(cross, np.einsum("ij,ij->i", one, other))
    return angles


def _most(values: Floats) -> float:
    return float(values.max()) if len(values) else 0.0
