"""The command `measure`: distance and direction between points; length, area, centroid and extent of curves."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ...core.wording import counted
from ...geometry.sample import Box, bounds, spline_points, union
from ...model.curves import Arc, Circle, Curve, Ellipse, Point, Primitive, Spline
from ...model.part import Contour
from ..curves.area import enclosed_area
from ..curves.chains import CurveChain, chained
from ..curves.shapes import curve_length
from ..expressions.arguments import Arguments
from .command import DraftingSession
from .command_curves import chosen_curves
from .explode import simple

_CHORDS = 256
"""Of an ellipse, or of one span of a spline."""


@dataclass(frozen=True, slots=True)
class MeasureCommand:
    """Tell a measure; the drawing stays as it is."""

    reply: str
    name: str = "Measure"

    def carried_out(self, session: DraftingSession) -> DraftingSession:
        """Return the session as it is."""
        return session


@dataclass(frozen=True, slots=True)
class Measurements:
    """What curves measure together.

    Attributes:
        length: mm.
        closed: how many closed contours they form.
        area: within these by the even-odd rule, islands taken off, mm2; 0.0 where nothing is closed.
        centroid: of that area; None where there is none, mm.
        extent: x0, y0, x1, y1, mm.
    """

    length: float
    closed: int
    area: float
    centroid: Point | None
    extent: Box


def measures(curves: Mapping[int, Curve]) -> Measurements:
    """Return what one or more curves measure; extent and centroid of ellipses and splines by arcs within 1 µm of
    them.
    """
    length = sum(map(_length, curves.values()))
    loops = [chain for chain in chained(curves) if chain.closed]
    area, centroid = _areas(loops) if loops else (0.0, None)
    extent = union([bounds(piece) for curve in curves.values() for piece in simple(curve) or (curve,)])
    assert extent is not None
    return Measurements(length, len(loops), area, centroid, extent)


def _length(curve: Curve) -> float:
    """Return the length of a curve, mm; of an ellipse or a spline from chords, and half as many, to 1e-9 of its
    size.
    """
    if not isinstance(curve, Ellipse | Spline):
        return curve_length(curve)
    if isinstance(curve, Ellipse):
        t = np.linspace(curve.start_parameter, curve.end_parameter, _CHORDS + 1)[None]
        (ax, ay), ratio = curve.major, curve.ratio
        points = np.stack([np.cos(t) * ax - np.sin(t) * ratio * ay, np.cos(t) * ay + np.sin(t) * ratio * ax], axis=-1)
    else:
        knots = np.unique(curve.knots)
        t = np.linspace(knots[:-1], knots[1:], _CHORDS + 1, axis=1)
        points = spline_points(curve, t.ravel()).reshape(*t.shape, 2)
    fine, coarse = (float(np.hypot(*np.moveaxis(np.diff(points[:, ::step], axis=1), -1, 0)).sum()) for step in (1, 2))
    return fine + (fine - coarse) / 3


def _areas(loops: list[CurveChain]) -> tuple[float, Point | None]:
    """Return the area within closed chains, islands taken off, and its centroid."""
    from ...geometry.outlines import nest  # not when the window opens

    around = [tuple(piece for curve in loop.curves for piece in simple(curve)) for loop in loops]
    contours = [Contour(pieces, entity_ids=(at,)) for at, pieces in enumerate(around)]
    total, mx, my = 0.0, 0.0, 0.0
    for region in nest([contour for contour in contours if contour.primitives]):
        for number, contour in enumerate(region.contours):
            swept, place = _swept(contour.primitives)
            exact = enclosed_area(loops[contour.entity_ids[0]].curves)
            share = (abs(swept) if exact is None else exact) * (-1 if number else 1)
            total, mx, my = total + share, mx + share * place[0], my + share * place[1]
    return total, (mx / total, my / total) if total > 0 else None


def _swept(pieces: tuple[Primitive, ...]) -> tuple[float, Point]:
    """Return the signed area, mm2, and the centroid of what lines and arcs enclose: a polygon and segments of
    circles.
    """
    if isinstance(whole := pieces[0], Circle):
        return math.pi * whole.radius**2, whole.centre
    ox, oy = pieces[0].start
    points = np.array([piece.start for piece in pieces]) - (ox, oy)
    x, y = points.T
    xs, ys = np.roll(x, -1), np.roll(y, -1)
    cross = x * ys - xs * y
    area, mx, my = cross.sum() / 2, ((x + xs) * cross).sum() / 6, ((y + ys) * cross).sum() / 6
    for piece in pieces:
        if isinstance(piece, Arc):
            sweep, r = piece.sweep, piece.radius
            segment = r * r * (sweep - math.sin(sweep)) / 2
            moment, middle = 2 / 3 * r**3 * math.sin(sweep / 2) ** 3, piece.start_angle + sweep / 2
            area += segment
            mx += segment * (piece.centre[0] - ox) + moment * math.cos(middle)
            my += segment * (piece.centre[1] - oy) + moment * math.sin(middle)
    return float(area), (float(mx / area) + ox, float(my / area) + oy) if area else (ox, oy)


def measure(words: Arguments, session: DraftingSession) -> MeasureCommand:
    """Tell the way between two points, or what curves measure."""
    if words.is_point():
        return MeasureCommand(_between(words.point(), words.point("the other point x,y")))
    curves = chosen_curves(words, session, "measure")
    return MeasureCommand(_told(curves, measures(curves)))


def _between(a: Point, b: Point) -> str:
    dx, dy = b[0] - a[0], b[1] - a[1]
    angle = math.degrees(math.atan2(dy, dx)) % 360
    return f"Distance {math.dist(a, b):.3f} mm, across {dx:.3f}, up {dy:.3f}, angle {angle:.3f}°."


def _told(curves: Mapping[int, Curve], found: Measurements) -> str:
    words = [f"{counted(len(curves), 'curve')}: length {found.length:.3f} mm"]
    if len(curves) == 1 and isinstance(curve := next(iter(curves.values())), Arc | Circle):
        words.append(f"radius {curve.radius:.3f}")
    if found.centroid is not None:
        (x, y), many = found.centroid, f" within {found.closed} contours" if found.closed > 1 else ""
        words.append(f"area {found.area:.3f} mm²{many}, centroid {x:.3f},{y:.3f}")
    x0, y0, x1, y1 = found.extent
    words.append(f"extent {x1 - x0:.3f} by {y1 - y0:.3f} mm from {x0:.3f},{y0:.3f} to {x1:.3f},{y1:.3f}")
    return f"{', '.join(words)}."
