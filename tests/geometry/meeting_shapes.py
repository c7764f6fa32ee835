"""Drawings that meet in every way that is hard to decide: kinds of contact, times offsets, times poses; and lattices of
them.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from app.geometry.outlines import polygon_contour, reversed_contour
from app.geometry.primitives import boxes, contour_rows
from app.model.curves import Arc, Circle, Line, Point, Primitive
from app.model.part import Contour

Shapes = list[Contour]

OFFSETS = (0.0, *(sign * size * 10.0**-power for power in range(3, 14) for size in (1.0, 3.3) for sign in (1, -1)))
"""mm; by how much things that should touch overlap or miss."""

STEP = 64.0
"""mm between cases that stand side by side, at least."""


def disc(x: float, y: float, radius: float) -> Contour:
    """Return a circle."""
    return Contour((Circle((x, y), radius),))


def box(x0: float, y0: float, x1: float, y1: float) -> Contour:
    """Return a rectangle."""
    return polygon_contour([(x0, y0), (x1, y0), (x1, y1), (x0, y1)])


def tilted(x0: float, y0: float, x1: float, y1: float, angle: float) -> Contour:
    """Return a rectangle turned about its first corner."""
    c, s = math.cos(angle), math.sin(angle)
    corners = [(0.0, 0.0), (x1 - x0, 0.0), (x1 - x0, y1 - y0), (0.0, y1 - y0)]
    return polygon_contour([(x0 + c * x - s * y, y0 + s * x + c * y) for x, y in corners])


def rounded(x0: float, y0: float, x1: float, y1: float, r: float) -> Contour:
    """Return a rectangle with round corners; a slot where they are half as wide as it."""
    sides = [
        ((x0 + r, y0), (x1 - r, y0)),
        ((x1, y0 + r), (x1, y1 - r)),
        ((x1 - r, y1), (x0 + r, y1)),
        ((x0, y1 - r), (x0, y0 + r)),
    ]
    centres = [(x1 - r, y0 + r), (x1 - r, y1 - r), (x0 + r, y1 - r), (x0 + r, y0 + r)]
    curves: list[Primitive] = []
    for k, ((a, b), centre) in enumerate(zip(sides, centres, strict=True)):
        if math.dist(a, b) > 1e-9:
            curves.append(Line(a, b))
        else:
            b = a
        curves.append(Arc(curves[-1].end if curves else b, sides[(k + 1) % 4][0], centre))
    first = curves[0]
    curves[-1] = replace(curves[-1], end=first.start)  # type: ignore[type-var]
    return Contour(tuple(curves))


def slot(x0: float, y0: float, x1: float, width: float) -> Contour:
    """Return a level slot of a width from x0 to x1, its lower side at y0."""
    return rounded(x0, y0, x1, y0 + width, width / 2)


def _pencil(e: float) -> Shapes:
    return [disc(-10, 0, 10), disc(-5 + e, 0, 5), disc(-3, 0, 3)]


def _fan(e: float) -> Shapes:
    """Circles of one size through one point."""
    return [disc(5 * math.cos(a), 5 * math.sin(a) + (e if k == 1 else 0), 5) for k, a in enumerate((0.1, 2.2, 4.3))]


def _triangle(e: float) -> Shapes:
    side = 10 - e
    return [disc(0, 0, 5), disc(side, 0, 5), disc(side / 2, side * math.sqrt(0.75), 5)]


KINDS: dict[str, Callable[[float], Shapes]] = {
    "circles outside": lambda e: [disc(0, 0, 10), disc(20 - e, 0, 10)],
    "circles outside, unlike": lambda e: [disc(0, 0, 10), disc(13 - e, 0, 3)],
    "small circle on a large one": lambda e: [disc(0, 0, 120), disc(120.5 - e, 0, 0.5)],
    "circle inside": lambda e: [disc(0, 0, 10), disc(6 + e, 0, 4)],
    "circle inside, nearly as large": lambda e: [disc(0, 0, 10), disc(0.01 + e, 0, 9.99)],
    "equal circles": lambda e: [disc(0, 0, 10), disc(e, 0, 10)],
    "circles of one centre": lambda e: [disc(0, 0, 10), disc(0, 0, 10 + e)],
    "circle at a side": lambda e: [box(0, 0, 30, 20), disc(15, -5 + e, 5)],
    "circle inside at a side": lambda e: [box(0, 0, 30, 20), disc(15, 5 - e, 5)],
    "circle at the end of a side": lambda e: [box(0, 0, 30, 20), disc(0, -5 + e, 5)],
    "circle at a corner": lambda e: [box(0, 0, 30, 20), disc(-5 / math.sqrt(2) + e, -5 / math.sqrt(2) + e, 5)],
    "circle on a corner": lambda e: [box(0, 0, 30, 20), disc(e, e, 5)],
    "circle in a square": lambda e: [box(-5, -5, 5, 5), disc(0, 0, 5 + e)],
    "circle round a square": lambda e: [box(-5, -5, 5, 5), disc(0, 0, 5 * math.sqrt(2) + e)],
    "rectangles by an edge": lambda e: [box(0, 0, 10, 10), box(10 - e, 3, 20, 7)],
    "rectangles by an edge of one length": lambda e: [box(0, 0, 10, 10), box(10 - e, 0, 20, 10)],
    "rectangle inside by an edge": lambda e: [box(0, 0, 20, 20), box(-e, 5, 8, 12)],
    "equal rectangles": lambda e: [box(0, 0, 10, 10), box(e, e, 10 + e, 10 + e)],
    "rectangle grown": lambda e: [box(0, 0, 10, 10), box(-e, -e, 10 + e, 10 + e)],
    "rectangle tilted": lambda e: [box(0, 0, 10, 10), tilted(0, 0, 10, 10, e / 7)],
    "rectangle tilted at an edge": lambda e: [box(0, -10, 10, 0), tilted(0, 0, 7, 10, e / 7)],
    "rectangles by a corner": lambda e: [box(0, 0, 10, 10), box(10 - e, 10 - e, 20, 20)],
    "slots side by side": lambda e: [slot(0, 0, 30, 6), slot(0, 6 - e, 30, 6)],
    "slots end to end": lambda e: [slot(0, 0, 30, 6), slot(30 - e, 0, 60, 6)],
    "slot moved along": lambda e: [slot(0, 0, 30, 6), slot(5, e, 35, 6)],
    "slot moved by a hair": lambda e: [slot(0, 0, 30, 6), slot(e, 0, 30 + e, 6)],
    "slot thicker": lambda e: [slot(0, 0, 30, 6), slot(-e, -e, 30 + e, 6 + 2 * e)],
    "slot across": lambda e: [slot(0, 0, 30, 6), box(3 + e, -5, 27 - e, 15)],
    "round corners over round corners": lambda e: [rounded(0, 0, 20, 12, 3), rounded(e, e, 20, 12, 3)],
    "round corners over sharp ones": lambda e: [rounded(0, 0, 20, 12, 3), box(0, 0, 20 + e, 12 - e)],
    "bow tie": lambda e: [polygon_contour([(0, 0), (10, 10 + e), (10, 0), (0, 10)])],
    "spike": lambda e: [
        polygon_contour([(0, 0), (20, 0), (20, 5), (30, 5), (20, 5 + abs(e) + 1e-15), (20, 10), (0, 10)])
    ],
    "slit": lambda e: [
        polygon_contour([(0, 0), (20, 0), (20, 5), (8, 5), (20, 5 + abs(e) + 1e-15), (20, 10), (0, 10)])
    ],
    "vertex on the opposite side": lambda e: [polygon_contour([(0, 0), (20, 0), (20, 10), (10, e), (0, 10)])],
    "hole by a bridge": lambda e: [
        polygon_contour(
            [
                (0, 0),
                (20, 0),
                (20, 20),
                (10, 20),
                (10, 15 + e),
                (15, 15),
                (15, 5),
                (5, 5),
                (5, 15),
                (10, 15),
                (10, 20),
                (0, 20),
            ]
        )
    ],
    "chain of circles": lambda e: [disc(0, 0, 5), disc(10 - e, 0, 5), disc(20 - 2 * e, 0, 5)],
    "triangle of circles": _triangle,
    "circles through a point": _fan,
    "pencil of circles": _pencil,
    "pencil of circles, both sides": lambda e: [*_pencil(e), disc(4, 0, 4)],
    "rectangles over one edge": lambda e: [box(0, 0, 10, 10), box(0, e, 10, 10 + e), box(5, 0, 15, 10)],
    "rectangles that share an edge": lambda e: [box(0, 0, 10, 10), box(10, 0, 20, 10), box(5 + e, 0, 15, 10)],
    "four squares round a point": lambda e: [
        box(0, 0, 10, 10),
        box(-10, 0, e, 10),
        box(-10, -10, 0, e),
        box(0, -10, 10, 0),
    ],
    "a circle three times": lambda e: [disc(0, 0, 10), disc(e, 0, 10), disc(0, e, 10)],
    "circle along two sides": lambda e: [box(0, 0, 30, 10), disc(12, 5 + e, 5)],
}
"""By name: shapes that touch, or should, for an offset in mm."""


@dataclass(frozen=True)
class Pose:
    """Where shapes stand: turned about zero (radians), then moved (mm)."""

    angle: float = 0.0
    dx: float = 0.0
    dy: float = 0.0

    def at(self, point: Point) -> Point:
        """Return where a point comes to lie."""
        c, s = math.cos(self.angle), math.sin(self.angle)
        return c * point[0] - s * point[1] + self.dx, s * point[0] + c * point[1] + self.dy

    def of(self, contour: Contour) -> Contour:
        """Return where a contour comes to lie."""
        if self == Pose():
            return contour
        made: list[Primitive] = []
        for each in contour.primitives:
            if isinstance(each, Circle):
                made.append(Circle(self.at(each.centre), each.radius, each.ccw))
            elif isinstance(each, Arc):
                made.append(Arc(self.at(each.start), self.at(each.end), self.at(each.centre), each.ccw))
            else:
                made.append(Line(self.at(each.start), self.at(each.end)))
        return replace(contour, primitives=tuple(made))


def any_pose(rng: np.random.Generator) -> Pose:
    """Return a pose: as drawn, turned, turned and moved, or far off."""
    far = float(rng.choice([0.0, 0.0, 100.0, 3000.0]))
    angle = float(rng.choice([0.0, math.pi / 4, math.pi / 2, rng.uniform(0, math.tau)]))
    return Pose(angle, float(rng.uniform(-far, far)), float(rng.uniform(-far, far)))


def posed(shapes: Shapes, rng: np.random.Generator) -> Shapes:
    """Return shapes in some pose, some of them the other way round, in some order."""
    pose = any_pose(rng)
    placed = [pose.of(shape) for shape in shapes]
    placed = [reversed_contour(shape) if rng.random() < 0.3 else shape for shape in placed]
    return [placed[k] for k in rng.permutation(len(placed))]


def any_case(rng: np.random.Generator) -> Shapes:
    """Return shapes of some kind at some offset in some pose."""
    kind = str(rng.choice(list(KINDS)))
    return posed(KINDS[kind](float(rng.choice(OFFSETS))), rng)


def side_by_side(cases: list[Shapes]) -> list[Shapes]:
    """Return cases moved along x, by multiples of STEP, until each has a strip of its own."""
    placed, end = [], 0.0
    for shapes in cases:
        around = boxes(np.concatenate([contour_rows(shape) for shape in shapes]))
        left, right = float(around[:, 0].min()), float(around[:, 2].max())
        shift = STEP * math.ceil((end - left) / STEP)
        placed.append([Pose(0.0, shift).of(shape) for shape in shapes])
        end = right + shift + STEP
    return placed


def lattice(rng: np.random.Generator) -> Shapes:
    """Return 3 to 16 shapes with sizes and places on a lattice of 5 mm, each number moved by a hair."""
    e = float(rng.choice(OFFSETS))

    def some(low: int, high: int) -> float:
        return 5.0 * int(rng.integers(low, high)) + float(rng.choice([0.0, e, -e, e * rng.random()]))

    shapes: Shapes = []
    for _ in range(int(rng.integers(3, 17))):
        x, y, wide, high = some(0, 8), some(0, 8), some(1, 5), some(1, 5)
        match int(rng.integers(4)):
            case 0:
                shape = disc(x, y, wide)
            case 1:
                shape = box(x, y, x + wide, y + high)
            case 2:
                shape = slot(x, y, x + wide + high + 5, min(wide, high))
            case _:
                shape = rounded(x, y, x + wide + 5, y + high + 5, min(wide, high) / 2)
        if rng.random() < 0.2:
            shape = Pose(float(rng.choice([math.pi / 4, math.pi / 2])) + e / 100, x, y).of(Pose(0, -x, -y).of(shape))
        shapes.append(shape)
    return posed(shapes, rng)
