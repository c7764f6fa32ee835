"""Random plates as strangers draw them: an outline, holes and pockets in it, islands in these; some outlines in pieces
whose ends miss one another, some drawn twice.
"""

from __future__ import annotations

import math
import random
from collections.abc import Callable
from dataclasses import dataclass, field

import shapely
from shapely import Polygon
from shapely.affinity import rotate, translate

GAP = 0.003
"""mm; ends of pieces lie so far beside where they belong."""
APART = 0.3
"""mm; inner outlines are no nearer to one another."""
ROUND = 128
"""Chords of a quarter turn."""
DRILLED = (0.7, 1.25, 1.5, 2.0, 2.5, 3.0, 3.3, 4.0, 5.0, 6.0, 8.0)
"""mm; radii of holes."""

Points = list[tuple[float, float]]


@dataclass(frozen=True)
class Outline:
    """A closed outline: lines of a drawing, what it bounds, and whether it is a circle as drawn."""

    lines: list[str]
    area: Polygon
    is_circle: bool = False
    islands: list[Outline] = field(default_factory=list)

    @property
    def cut(self) -> shapely.Geometry:
        """What of it is taken away: all but its islands."""
        return self.area - shapely.union_all([island.area for island in self.islands])


@dataclass(frozen=True)
class Plate:
    """An outline and what is cut out within it."""

    outline: Outline
    inner: list[Outline]

    @property
    def drawing(self) -> str:
        """Its text."""
        outlines = [self.outline, *(each for inner in self.inner for each in (inner, *inner.islands))]
        return "\n".join([line for each in outlines for line in each.lines]) + "\n"

    def stands(self, doubt: float) -> shapely.Geometry:
        """Return where nothing may be cut, but for a strip of doubt along every outline, mm."""
        taken = shapely.union_all([inner.area.buffer(doubt) for inner in self.inner])
        islands = [island.area.buffer(-doubt) for inner in self.inner for island in inner.islands]
        return shapely.union_all([self.outline.area.buffer(-doubt) - taken, *islands])


def _ring(radii: list[float], turn: float = 0.0) -> Points:
    angles = [turn + math.tau * k / len(radii) for k in range(len(radii))]
    return [(r * math.cos(angle), r * math.sin(angle)) for r, angle in zip(radii, angles, strict=True)]


def _star(rng: random.Random, size: float) -> Points:
    return _ring([rng.uniform(0.45, 1.0) * size for _ in range(rng.randint(3, 9))], rng.uniform(0, math.tau))


def _rectangle(rng: random.Random, size: float) -> Points:
    wide, high = rng.uniform(0.5, 1.3) * size, rng.uniform(0.4, 1.2) * size
    return list(
        rotate(
            shapely.box(-wide / 2, -high / 2, wide / 2, high / 2), rng.choice([0, rng.uniform(0, 180)])
        ).exterior.coords
    )[:-1]


def _gear(rng: random.Random, size: float) -> Points:
    return _ring([part * size for _ in range(rng.randint(6, 24)) for part in (0.8, 1.0, 1.0, 0.8)])


def _slot(rng: random.Random, size: float) -> Points:
    middle = rotate(shapely.LineString([(-size / 2, 0), (size / 2, 0)]), rng.uniform(0, 180))
    return list(middle.buffer(rng.uniform(0.4, 2.5), 6).exterior.coords)[:-1]


def _ellipse(rng: random.Random, size: float) -> Points:
    flat, count = rng.uniform(0.2, 1.0), rng.choice([12, 60, 200])
    return [(x, y * flat) for x, y in _ring([size] * count)]


_SHAPES: tuple[Callable[[random.Random, float], Points], ...] = (_star, _rectangle, _gear, _slot, _ellipse)


def _circle(x: float, y: float, radius: float) -> Outline:
    return Outline([f"circle {x},{y} {radius}"], shapely.Point(x, y).buffer(radius, ROUND), True)


def _in_pieces(rng: random.Random, points: Points) -> list[str]:
    """Return lines one by one, in any order and direction, whose ends miss one another by up to GAP."""
    lines = []
    for a, b in zip(points, [*points[1:], points[0]], strict=True):
        ends = [a, b] if rng.random() < 0.5 else [b, a]
        moved = [(x + rng.uniform(-GAP, GAP) / 2, y + rng.uniform(-GAP, GAP) / 2) for x, y in ends]
        lines.append("line " + " ".join(f"{x:.4f},{y:.4f}" for x, y in moved))
    rng.shuffle(lines)
    return lines


def _outline(rng: random.Random, x: float, y: float, size: float) -> Outline:
    if rng.random() < 0.2:
        return _circle(x, y, round(size * rng.uniform(0.4, 1.0), 3))
    points = list(translate(Polygon(rng.choice(_SHAPES)(rng, size)), x, y).exterior.coords)[:-1]
    points = [(round(px, 4), round(py, 4)) for px, py in points]
    whole = "polyline " + " ".join(f"{px:.4f},{py:.4f}" for px, py in points) + " close"
    return Outline(_in_pieces(rng, points) if rng.random() < 0.4 else [whole], Polygon(points))


def _inner(rng: random.Random, outline: Polygon) -> Outline:
    """Return a hole or a pocket, and islands in it, about anywhere."""
    x, y = round(rng.uniform(-35, 35), 2), round(rng.uniform(-35, 35), 2)
    if rng.random() < 0.5:
        return _circle(x, y, rng.choice(DRILLED))
    inner = _outline(rng, x, y, rng.uniform(2, 12))
    if inner.area.is_valid and outline.contains(inner.area):
        middle = inner.area.representative_point()
        for _ in range(rng.choice([0, 0, 1, 2])):
            near = (round(middle.x + rng.uniform(-2, 2), 2), round(middle.y + rng.uniform(-2, 2), 2))
            island = _outline(rng, *near, rng.uniform(1, 4))
            room = inner.cut.buffer(-0.5)
            if island.area.is_valid and room.contains(island.area):
                inner.islands.append(island)
    return inner


def any_plate(seed: int) -> Plate:
    """Return a random plate; its outline crosses itself nowhere."""
    rng = random.Random(seed)
    outline = _outline(rng, 0.0, 0.0, rng.uniform(25, 45))
    plate, room = Plate(outline, []), outline.area.buffer(-rng.choice([APART, 1.0, 2.0]))
    for _ in range(rng.randint(0, 9)):
        inner = _inner(rng, room)
        free = not any(inner.area.buffer(APART).intersects(other.area) for other in plate.inner)
        if inner.area.is_valid and room.contains(inner.area) and free:
            plate.inner.append(inner)
    if rng.random() < 0.2:
        outline.lines.extend(outline.lines)
    return plate
