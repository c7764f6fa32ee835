"""Random parts as bad drawings have them: tiny primitives, tangent and nearly tangent joins, slivers, touching and
crossing outlines, fine polylines, many islands. Closed contours that do not cross, as `nest` wants them.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from app.geometry.outlines import polygon_contour
from app.geometry.overlay.overlay import without_crossings
from app.model.part import Contour
from tests.part_shapes import bulged, circle, random_star, square


def star_points(rng: np.random.Generator, count: int, low: float, high: float) -> np.ndarray:
    """Corners (count, 2) of a polygon about the origin that does not cross itself."""
    angles = (np.arange(count) + rng.uniform(-0.3, 0.3, count)) * math.tau / count
    return rng.uniform(low, high, count)[:, None] * np.stack([np.cos(angles), np.sin(angles)], 1)


def _contour(points: np.ndarray) -> Contour:
    return polygon_contour([(float(x), float(y)) for x, y in points])


def tiny_primitives(rng: np.random.Generator) -> list[Contour]:
    """A star whose corners are chains of lines 1 to 10 µm long."""
    points: list[np.ndarray] = []
    for corner in star_points(rng, int(rng.integers(4, 12)), 8, 25):
        steps = rng.uniform(1e-3, 1e-2, int(rng.integers(1, 7)))[:, None] * _unit(
            rng.uniform(0, 1.2) + np.arctan2(corner[1], corner[0]) + math.pi / 2 + np.sort(rng.uniform(-0.6, 0.6, 1))
        )
        points += [corner, *(corner + np.cumsum(steps, axis=0))]
    return [_contour(np.array(points))]


def _unit(angle: np.ndarray) -> np.ndarray:
    return np.stack([np.cos(angle), np.sin(angle)], -1)


def rounded(rng: np.random.Generator) -> list[Contour]:
    """A star with rounded corners, whose arcs touch their lines to within some billionths or millionths of a radian."""
    corners = star_points(rng, int(rng.integers(4, 9)), 12, 25)
    off = float(rng.choice([0.0, 1e-9, 1e-7, 1e-5]))
    points: list[tuple[float, float, float]] = []
    for before, corner, after in zip(np.roll(corners, 1, axis=0), corners, np.roll(corners, -1, axis=0), strict=True):
        back, ahead = before - corner, after - corner
        back, ahead = back / np.hypot(*back), ahead / np.hypot(*ahead)
        turn = math.atan2(-back[0] * ahead[1] + back[1] * ahead[0], -back @ ahead)
        reach = min(float(rng.uniform(0.2, 3)), 0.3 * np.hypot(*(before - corner)), 0.3 * np.hypot(*(after - corner)))
        start, end = corner + reach * back, corner + reach * ahead
        points += [
            (float(start[0]), float(start[1]), math.tan(turn / 4) + off * float(rng.normal())),
            (float(end[0]), float(end[1]), 0.0),
        ]
    return [bulged(points)]


def slivers(rng: np.random.Generator) -> list[Contour]:
    """A square with slots from a tenth of a micrometre to 50 µm wide, and islands as near to one another."""
    points = [(0.0, 0.0), (30.0, 0.0), (30.0, 30.0)]
    x = 28.0
    while x > 3:
        width, depth = float(10 ** rng.uniform(-4, -1.3)), float(rng.uniform(1, 20))
        points += [(x, 30.0), (x - width * float(rng.uniform(0, 1)), 30 - depth), (x - width, 30.0)]
        x -= float(rng.uniform(1, 6))
    gap = float(10 ** rng.uniform(-5, -2))
    return [
        polygon_contour([*points, (0.0, 30.0)]),
        square(3, 4, 2),
        square(3, 7 + gap, 2),
        circle(1.5, 8.5 + gap, 6.5 + 1e-4),
    ]


def touching(rng: np.random.Generator) -> list[Contour]:
    """Islands that touch the wall, one another, or overlap."""
    size = float(rng.uniform(1, 4))
    islands = [
        circle(size, 10, 10),
        circle(size, 10 + 2 * size, 10),
        square(4, 36, 20),
        circle(2, 2, 30),
        random_star(rng, (20, 28), (2, 6), 0.3),
        random_star(rng, (24, 26), (2, 6), 0.3),
        circle(3, 20, 3 + float(rng.choice([0.0, 1e-9, 1e-7]))),
    ]
    return list(without_crossings([square(40), *islands]).contours)


def crossing(rng: np.random.Generator) -> list[Contour]:
    """Stars with bulging edges that cross themselves and one another."""
    return list(
        without_crossings([random_star(rng, (0, 0), (5, 30), 0.6), random_star(rng, (4, 3), (5, 30), 0.3)]).contours
    )


def fine_polyline(rng: np.random.Generator) -> list[Contour]:
    """An outline of hundreds of short lines, smooth or rough, as exporters of curves and tracers of pictures write
    them.
    """
    count = int(rng.integers(200, 900))
    angle = np.arange(count) * math.tau / count
    radius = 20 + sum(rng.uniform(0, 2.5) * np.sin(k * angle + rng.uniform(0, 6)) for k in (2, 3, 5, 17))
    radius += rng.normal(0, 1, count) * float(rng.choice([0.0, 1e-4, 1e-3, 0.05]))
    return [_contour(radius[:, None] * _unit(angle))]


def many_islands(rng: np.random.Generator) -> list[Contour]:
    """A sheet with a hundred to four hundred holes of all kinds."""
    count = int(rng.integers(10, 21))
    islands = []
    for i in range(count):
        for j in range(count):
            x, y = 6.0 * i + float(rng.uniform(-1, 1)), 6.0 * j + float(rng.uniform(-1, 1))
            islands.append(
                circle(float(rng.uniform(0.3, 1.9)), x, y)
                if rng.random() < 0.5
                else random_star(rng, (x, y), (0.5, 1.9), 0.0)
            )
    return [square(6.0 * count + 2, -4, -4), *islands]


KINDS: tuple[Callable[[np.random.Generator], list[Contour]], ...] = (
    tiny_primitives,
    rounded,
    slivers,
    touching,
    crossing,
    fine_polyline,
    many_islands,
)


def rough_part(seed: int) -> list[Contour]:
    """Return the part of a number; kinds take turns."""
    return KINDS[seed % len(KINDS)](np.random.default_rng(seed))
