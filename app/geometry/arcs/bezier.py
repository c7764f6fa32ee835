"""Ellipses and splines as rational Bézier pieces: points, tangents, and bounds on distance that hold between
samples.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np
from numpy.typing import NDArray

from ...model.curves import Ellipse, Spline
from . import bezier_kernels as kernels

Floats = NDArray[np.float64]
_CORNER = 1e-4
"""A turn of the tangent between two pieces by more than this, radians, is a corner."""
_STILL = 1e-9
"""A piece no larger than this, mm, is a point."""


@dataclass(frozen=True)
class BezierCurve:
    """A plane curve of n rational Bézier pieces of one degree p; its parameter u runs from 0 to n.

    Attributes:
        control: (n, p + 1, 3) homogeneous control points (w x, w y, w), mm.
    """

    control: Floats

    def __len__(self) -> int:
        return len(self.control)

    @property
    def degree(self) -> int:
        """Degree p."""
        return int(self.control.shape[1]) - 1

    @cached_property
    def polygon(self) -> Floats:
        """Control points (n, p + 1, 2), mm."""
        points: Floats = self.control[..., :2] / self.control[..., 2:]
        return points

    @cached_property
    def still(self) -> float:
        """A chord no longer than this, mm, has no direction."""
        return max(1e-9 * float(np.ptp(self.polygon)), 1e-12)

    def at(self, u: Floats) -> tuple[Floats, Floats]:
        """Return points (m, 2), mm, and vectors along the tangent (m, 2) of any length, for parameters (m,)."""
        piece = np.clip(u.astype(np.int64), 0, len(self) - 1)
        t = (u - piece)[:, None, None]
        b = self.control[piece]
        while b.shape[1] > 2:
            b = b[:, :-1] * (1 - t) + b[:, 1:] * t
        along = b[:, 1] - b[:, 0]
        here = b[:, 0] + along * t[:, 0]
        points = here[:, :2] / here[:, 2:]
        return points, along[:, :2] - points * along[:, 2:]

    def corners(self) -> list[float]:
        """Return 0, the parameters of corners, and n."""
        ends, starts = self._directions(self.polygon[:-1, ::-1]), -self._directions(self.polygon[1:])
        turns = np.arctan2(ends[:, 0] * starts[:, 1] - ends[:, 1] * starts[:, 0], (ends * starts).sum(axis=1))
        return [0.0, *(np.flatnonzero(np.abs(turns) > _CORNER) + 1.0).tolist(), float(len(self))]

    def _directions(self, polygons: Floats) -> Floats:
        """Return (n, 2) unit vectors towards the first of polygons (n, k, 2) from what follows it; (0, 0) where nothing
        does.
        """
        chords = polygons[:, :1] - polygons[:, 1:]
        lengths = np.hypot(chords[..., 0], chords[..., 1])
        rows, first = np.arange(len(chords)), np.argmax(lengths > self.still, axis=1)
        length = lengths[rows, first]
        there = (length > self.still)[:, None]
        return np.where(there, chords[rows, first] / np.where(there, length[:, None], 1.0), 0.0)

    def cut(self, first: Floats, last: Floats) -> BezierCurve:
        """Return the stretches from `first` (m,) to `last` (m,), each within one piece."""
        k = np.clip(((first + last) / 2).astype(np.int64), 0, len(self) - 1)
        s, e = (first - k)[:, None, None], (last - k)[:, None, None]
        columns = []
        for j in range(self.degree + 1):
            b = self.control[k]
            for level in range(self.degree):
                t = e if level < j else s
                b = b[:, :-1] * (1 - t) + b[:, 1:] * t
            columns.append(b[:, 0])
        return BezierCurve(np.stack(columns, axis=1))

    def off_circles(self, on: Floats, centre: Floats) -> Floats:
        """Return for each piece a bound (n,) of its distance from the circle round centre (n, 2) through `on` (n, 2).

        The squared distance from the centre is a polynomial over the squared weight; its Bernstein
        coefficients enclose it, so nothing between samples can escape.
        """
        w = self.control[..., 2]
        z = self.control[..., :2] - w[..., None] * on[:, None]
        towards = np.einsum("nkd,nd->nk", z, on - centre)
        table = products(self.degree)
        gap = np.einsum("ni,nj,ijk->nk", z[..., 0], z[..., 0], table) + np.einsum(
            "ni,nj,ijk->nk", z[..., 1], z[..., 1], table
        )
        gap += 2 * np.einsum("ni,nj,ijk->nk", w, towards, table)
        gap /= (w.min(axis=1) ** 2)[:, None]
        radius = np.hypot(*(on - centre).T)[:, None]
        bound: Floats = np.abs(gap / (np.sqrt(np.maximum(radius**2 + gap, 0.0)) + radius)).max(axis=1)
        return bound


@cache
def products(degree: int) -> Floats:
    """Return the (p + 1, p + 1, 2 p + 1) table that multiplies two polynomials in Bernstein form."""
    table = np.zeros((degree + 1, degree + 1, 2 * degree + 1))
    for i in range(degree + 1):
        for j in range(degree + 1):
            table[i, j, i + j] = math.comb(degree, i) * math.comb(degree, j) / math.comb(2 * degree, i + j)
    return table


def pieces_of(curve: Ellipse | Spline) -> BezierCurve:
    """Return the same curve, exactly, as Bézier pieces in its direction of travel; pieces that stand still are left
    out.
    """
    if isinstance(curve, Spline) and not curve.weights and _is_one_piece(curve.knots, curve.degree):
        return _of_control_points(curve)
    pieces = _of_ellipse(curve) if isinstance(curve, Ellipse) else _of_spline(curve)
    extent = np.ptp(pieces.polygon, axis=1).max(axis=1)
    return BezierCurve(pieces.control[extent > _STILL])


def _is_one_piece(knots: Sequence[float] | Floats, degree: int) -> bool:
    """Tell whether a B-spline is a Bézier piece already, as letters' curves are."""
    return len(knots) == 2 * degree + 2 and bool(knots[0] == knots[degree] < knots[degree + 1] == knots[-1])


def _of_control_points(curve: Spline) -> BezierCurve:
    """A page of letters has tens of thousands of such pieces, for each of which arrays take ten times as long."""
    x, y = zip(*curve.control_points, strict=True)
    if max(max(x) - min(x), max(y) - min(y)) <= _STILL:
        return BezierCurve(np.zeros((0, len(x), 3)))
    return BezierCurve(np.array([[(px, py, 1.0) for px, py in curve.control_points]]))


def _of_ellipse(curve: Ellipse) -> BezierCurve:
    """A quarter turn or less is a rational quadratic whose middle weight is the cosine of half its angle."""
    first, last = curve.start_parameter, curve.end_parameter
    count = max(1, math.ceil((last - first) / (math.pi / 2) - 1e-9))
    edges = np.linspace(first, last, count + 1)
    if not curve.ccw:
        edges = edges[::-1]
    half = abs(last - first) / count / 2
    angles = np.stack([edges[:-1], (edges[:-1] + edges[1:]) / 2, edges[1:]], axis=1)
    stretch = np.array([1.0, 1.0 / math.cos(half), 1.0])
    major = np.array(curve.major)
    minor = np.array((-curve.major[1], curve.major[0])) * curve.ratio
    points = (
        np.array(curve.centre)
        + (np.cos(angles) * stretch)[..., None] * major
        + (np.sin(angles) * stretch)[..., None] * minor
    )
    weights = np.broadcast_to(np.array([1.0, math.cos(half), 1.0]), angles.shape)[..., None]
    return BezierCurve(np.concatenate([points * weights, weights], axis=2))


def _of_spline(curve: Spline) -> BezierCurve:
    weights = np.array(curve.weights or (1.0,) * len(curve.control_points))
    points = np.column_stack([np.array(curve.control_points) * weights[:, None], weights])
    return BezierCurve(cut_at_knots(points, np.array(curve.knots), curve.degree))


def cut_at_knots(points: Floats, knots: Floats, degree: int) -> Floats:
    """Return the Bézier pieces of a B-spline, from knot to knot; spans that are empty are left out.

    Args:
        points: (k, d) control points, homogeneous where the spline is rational.
        knots: (k + degree + 1,) not decreasing.
        degree: p >= 1, < k.

    Returns:
        (spans, p + 1, d) control points.
    """
    p = degree
    if _is_one_piece(knots, p):
        return points[None].astype(np.float64)
    spans = np.flatnonzero(np.diff(knots[p : len(points) + 1]) > 1e-12 * max(1e-300, knots[-1] - knots[0])) + p
    result = np.empty((len(spans), p + 1, points.shape[1]))
    kernels.blossoms(np.ascontiguousarray(points, np.float64), np.ascontiguousarray(knots, np.float64), spans, result)
    return result


def elevated(control: Floats, degree: int) -> Floats:
    """Return Bézier control points (n, p + 1, ...) of the same curves at a degree >= p.

    Point k of one degree more lies between points k - 1 and k, at k / (p + 1) of the way back.
    """
    while (p := control.shape[1] - 1) < degree:
        share = (np.arange(1, p + 1) / (p + 1)).reshape(-1, *[1] * (control.ndim - 2))
        inner = control[:, :-1] * share + control[:, 1:] * (1 - share)
        control = np.concatenate([control[:, :1], inner, control[:, -1:]], axis=1)
    return control
