"""Shapes for tests: known parts and random ones, closed contours ready for `nest`."""

from __future__ import annotations

import math

import numpy as np

from app.geometry.outlines import polygon_contour
from app.model.curves import Arc, Circle, Line, Point
from app.model.part import Contour, Entity, Layer, Part

FIG2_OUTER = [
    (6, 6, 0),
    (60, 6, 0),
    (68, 14, 0),
    (68, 30, 1.0),
    (68, 46, 0),
    (68, 60, 0),
    (60, 60, 0),
    (60, 70, 0),
    (44, 70, -1.0),
    (28, 70, 0),
    (20, 76, 0),
    (6, 76, 0),
    (6, 50, 0),
    (14, 44, 0),
    (14, 34, 0),
    (6, 28, 0),
]


def square(size: float = 20.0, x: float = 0.0, y: float = 0.0) -> Contour:
    return polygon_contour([(x, y), (x + size, y), (x + size, y + size), (x, y + size)])


def circle(radius: float, x: float = 0.0, y: float = 0.0) -> Contour:
    return Contour((Circle((x, y), radius),))


def bulged(points: list[tuple[float, float, float]]) -> Contour:
    """Closed contour through (x, y, bulge of the edge that starts here); bulge = tan(sweep / 4)."""
    curves: list[Line | Arc] = []
    for (ax, ay, bulge), (bx, by, _) in zip(points, points[1:] + points[:1], strict=True):
        a, b = (float(ax), float(ay)), (float(bx), float(by))
        curves.append(Arc(a, b, _centre(a, b, bulge), bulge > 0) if bulge else Line(a, b))
    return Contour(tuple(curves))


def _centre(a: Point, b: Point, bulge: float) -> Point:
    away = (1 / bulge - bulge) / 4
    return ((a[0] + b[0]) / 2 - (b[1] - a[1]) * away, (a[1] + b[1]) / 2 + (b[0] - a[0]) * away)


def fig2() -> list[Contour]:
    return [bulged(FIG2_OUTER), polygon_contour([(24, 20), (48, 20), (36, 44)]), circle(12, 84, 84)]


def random_star(rng: np.random.Generator, centre: Point, radii: tuple[float, float], bulge: float) -> Contour:
    """A star with 3 to 20 corners, some of its edges arcs; with bulge it may cross itself."""
    count = int(rng.integers(3, 21))
    angles = (np.arange(count) + rng.uniform(-0.24, 0.24, count)) * math.tau / count
    radius = rng.uniform(*radii, count)
    x, y = centre[0] + radius * np.cos(angles), centre[1] + radius * np.sin(angles)
    bulges = np.where(rng.random(count) < 0.5, rng.uniform(-bulge, bulge, count), 0.0)
    return bulged([(float(a), float(b), float(c)) for a, b, c in zip(x, y, bulges, strict=True)])


def random_steps(rng: np.random.Generator, unit: float = 2.0) -> Contour:
    """A rectilinear skyline on a grid: walls that face each other at whole multiples of `unit`."""
    count = int(rng.integers(2, 8))
    x = np.concatenate([[0], np.cumsum(rng.integers(1, 4, count))]) * unit
    y = rng.integers(2, 10, count) * unit
    points = [(float(x[0]), 0.0)]
    for k in range(count):
        points += [(float(x[k]), float(y[k])), (float(x[k + 1]), float(y[k]))]
    points.append((float(x[-1]), 0.0))
    return polygon_contour([p for k, p in enumerate(points) if k == 0 or p != points[k - 1]][::-1])


def random_part(seed: int) -> tuple[list[Contour], bool]:
    """Return (contours, whether they may cross one another or themselves)."""
    rng = np.random.default_rng(seed)
    match seed % 5:
        case 0:
            return [random_star(rng, (0, 0), (8, 30), 0.0)], False
        case 1:
            return [random_steps(rng)], False
        case 2:
            return [
                square(40),
                *(circle(float(rng.integers(1, 5)), 10 + 10 * i, 10 + 10 * j) for i in range(3) for j in range(3)),
            ], False
        case 3:
            islands = [random_star(rng, (8 * i - 4, 8 * j - 4), (1, 3), 0.5) for i in range(2) for j in range(2)]
            return [random_star(rng, (0, 0), (20, 30), 0.2), *islands], True
        case _:
            return [random_star(rng, (0, 0), (5, 30), 0.6), random_star(rng, (4, 3), (5, 30), 0.3)], True


def layered_part(layers: dict[str, list[Contour]], hidden: tuple[str, ...] = ()) -> Part:
    """A drawing with contours on layers, of which some are switched off."""
    curves = [
        (curve, name) for name, contours in layers.items() for contour in contours for curve in contour.primitives
    ]
    entities = tuple(Entity(number, curve, name) for number, (curve, name) in enumerate(curves, 1))
    return Part(entities, tuple(Layer(name, visible=name not in hidden) for name in layers))
