"""The boxes of a question: the values that can be typed at the pointer, and how pointer and values make a point."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from enum import Enum, auto

from ....core.tolerances import WELD
from ....model.curves import Point

Held = Sequence[float | None]
"""A value for each box of a question; None where the pointer sets it."""


class ValueKind(Enum):
    """What a box counts: mm, degrees, whole numbers from 1, or times."""

    LENGTH = auto()
    ANGLE = auto()
    COUNT = auto()
    FACTOR = auto()


@dataclass(frozen=True, slots=True)
class NamedValue:
    """One value: its name, in English, and what it counts."""

    name: str
    quantity: ValueKind = ValueKind.LENGTH


@dataclass(frozen=True, slots=True)
class PointBoxes:
    """Values that make a point.

    Attributes:
        boxes: what can be typed, in the order of Tab.
        values: of the point `pointer`, seen from `base`, one a box; None where the point leaves one open.
        point: where values that are held and the pointer for the rest lead, from `base`, mm.
        quiet: shown only while something is typed.
        zero: no distance is one as well.
        either: the boxes are one value said in several ways, so that one that is typed replaces another.
    """

    boxes: tuple[NamedValue, ...]
    values: Callable[[Point, Point], Held]
    point: Callable[[Point, Point, Held], Point]
    quiet: bool = False
    zero: bool = False
    either: bool = False

    def named(self, *names: str) -> PointBoxes:
        """Return the same boxes, the first ones under other names."""
        renamed = [replace(box, name=name) for box, name in zip(self.boxes, names, strict=False)]
        return replace(self, boxes=(*renamed, *self.boxes[len(names) :]))

    def open(self, base: Point, pointer: Point, held: Held) -> int | None:
        """Return the first box that neither the pointer nor a value sets, or None where all are."""
        if self.quiet:
            return None
        free = [part for part, value in enumerate(held) if value is None]
        seen = self.values(base, pointer)
        if self.either:
            return 0 if len(free) == len(held) and seen[0] is None else None
        lost = [part for part in free if seen[part] is None]
        if lost:
            return lost[0]
        return free[0] if free and math.dist(base, self.point(base, pointer, held)) < WELD else None


@dataclass(frozen=True, slots=True)
class ValueBox:
    """One value that is itself the answer.

    Attributes:
        measure: the value that a point means, None where a point means something else.
    """

    box: NamedValue
    measure: Callable[[Point], float] | None = None


def direction(base: Point, pointer: Point) -> float | None:
    """Return the direction of a point from another, degrees in [0, 360), or None where they are one."""
    if math.dist(base, pointer) < WELD:
        return None
    return math.degrees(math.atan2(pointer[1] - base[1], pointer[0] - base[0])) % 360


def along(base: Point, towards: Point, length: float) -> Point:
    """Return the point at a length, mm, from one point towards another, which is not the same."""
    away = math.dist(base, towards)
    return (base[0] + (towards[0] - base[0]) / away * length, base[1] + (towards[1] - base[1]) / away * length)


def _place_point(base: Point, pointer: Point, held: Held) -> Point:
    x, y = held
    return (pointer[0] if x is None else x, pointer[1] if y is None else y)


def _span_values(base: Point, pointer: Point) -> Held:
    angle = direction(base, pointer)
    return (None if angle is None else math.dist(base, pointer), angle)


def _span_point(base: Point, pointer: Point, held: Held) -> Point:
    """A typed angle is a ray on which the pointer sets the length; behind the base it counts as before it."""
    length, angle = held
    if angle is None:
        return pointer if length is None or math.dist(base, pointer) < WELD else along(base, pointer, length)
    turn = math.radians(angle)
    if length is None:
        length = abs((pointer[0] - base[0]) * math.cos(turn) + (pointer[1] - base[1]) * math.sin(turn))
    return (base[0] + length * math.cos(turn), base[1] + length * math.sin(turn))


def _size_values(base: Point, pointer: Point) -> Held:
    return tuple(abs(p - b) if abs(p - b) >= WELD else None for b, p in zip(base, pointer, strict=True))


def _size_point(base: Point, pointer: Point, held: Held) -> Point:
    """A typed size lies on the side of the pointer; a negative one on the other."""
    x, y = (
        p if size is None else b + math.copysign(1.0, p - b if abs(p - b) >= WELD else 1.0) * size
        for b, p, size in zip(base, pointer, held, strict=True)
    )
    return (x, y)


def _step_values(base: Point, pointer: Point) -> Held:
    return (pointer[0] - base[0], pointer[1] - base[1])


def _step_point(base: Point, pointer: Point, held: Held) -> Point:
    x, y = (p if step is None else b + step for b, p, step in zip(base, pointer, held, strict=True))
    return (x, y)


def _radius_values(base: Point, pointer: Point) -> Held:
    radius = math.dist(base, pointer)
    return (radius, 2 * radius) if radius >= WELD else (None, None)


def _radius_point(base: Point, pointer: Point, held: Held) -> Point:
    radius, diameter = held
    if radius is None and diameter is None:
        return pointer
    length = radius if radius is not None else (diameter or 0.0) / 2
    return along(base, pointer, length) if math.dist(base, pointer) >= WELD else (base[0] + length, base[1])


ANGLE = NamedValue("Angle", ValueKind.ANGLE)
FACTOR = NamedValue("Factor", ValueKind.FACTOR)

PLACE = PointBoxes(
    (NamedValue("X"), NamedValue("Y")), lambda base, pointer: pointer, _place_point, quiet=True, zero=True
)
"""Coordinates, where there is nothing yet to start from."""

SPAN = PointBoxes((NamedValue("Length"), ANGLE), _span_values, _span_point)
"""How far and in which direction from the point before."""

SIZE = PointBoxes((NamedValue("Width"), NamedValue("Height")), _size_values, _size_point)
"""Across and up, on the pointer's side of the point before."""

STEP = PointBoxes((NamedValue("Step across"), NamedValue("Step up")), _step_values, _step_point, zero=True)
"""Across and up with their signs."""

RADIUS = PointBoxes((NamedValue("Radius"), NamedValue("Diameter")), _radius_values, _radius_point, either=True)
"""The radius of a circle round the point before, or its diameter."""


def sweep(centre: Point, start: Point, turn: float) -> PointBoxes:
    """Return the box of how far an arc goes round, degrees; a typed one goes the way that the pointer has gone.

    Args:
        turn: how far the pointer has gone round from the start, radians, counter-clockwise positive.
    """
    first = math.atan2(start[1] - centre[1], start[0] - centre[0])
    sense = -1.0 if turn < 0 else 1.0

    def values(_: Point, pointer: Point) -> Held:
        if math.dist(centre, pointer) < WELD:
            return (None,)
        end = math.atan2(pointer[1] - centre[1], pointer[0] - centre[0])
        return (math.degrees(sense * (end - first)) % 360,)

    def point(_: Point, pointer: Point, held: Held) -> Point:
        (angle,) = held
        if angle is None:
            return pointer
        radius, end = math.dist(centre, start), first + sense * math.radians(angle)
        return (centre[0] + radius * math.cos(end), centre[1] + radius * math.sin(end))

    return PointBoxes((NamedValue("Sweep", ValueKind.ANGLE),), values, point)
