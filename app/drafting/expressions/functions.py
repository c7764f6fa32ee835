"""The functions of the shape language: of numbers, of points, of curves."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from ...core.errors import InputError
from ...core.toml_tables import known_words
from ...geometry.transform import mirroring, turn
from ...model.curves import Curve, Point
from ..curves.intersections import intersection_points, nearest_point, tangent_points
from ..curves.shapes import centre_of, curve_length, middle_of, radius_of
from . import syntax as s
from .values import Curves, Length, Scope, Value, kind_of, wrong

Given = float | Point | Curve


@dataclass(frozen=True, slots=True)
class Function:
    """One function.

    Attributes:
        takes: one letter an argument: n number, l length, p point, c curve, e curve or construction line;
            a last "+" repeats the letter before it.
        shown: how it is written, for errors and help.
        gives_length: its number is a length; a number of lengths alone is one anyway where `keeps_length`.
    """

    takes: str
    shown: str
    does: Callable[..., Value]
    gives_length: bool = False
    keeps_length: bool = False


def _between(a: Point, b: Point, share: float) -> Point:
    return (a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1]))


def _nearest(points: list[Point], near: Point, what: str) -> Point:
    if not points:
        raise InputError(f"There is no {what}; move one of the curves, or leave this out.")
    return min(points, key=lambda p: (math.dist(p, near), p))


def _polar(centre: Point, radius: float, angle: float) -> Point:
    return (centre[0] + radius * math.cos(math.radians(angle)), centre[1] + radius * math.sin(math.radians(angle)))


def _heading(a: Point, b: Point) -> float:
    return math.degrees(math.atan2(b[1] - a[1], b[0] - a[0])) % 360


FUNCTIONS: Mapping[str, Function] = {
    "sin": Function("n", "sin(angle)", lambda a: math.sin(math.radians(a))),
    "cos": Function("n", "cos(angle)", lambda a: math.cos(math.radians(a))),
    "tan": Function("n", "tan(angle)", lambda a: math.tan(math.radians(a))),
    "asin": Function("n", "asin(number)", lambda v: math.degrees(math.asin(v))),
    "acos": Function("n", "acos(number)", lambda v: math.degrees(math.acos(v))),
    "atan": Function("n", "atan(number)", lambda v: math.degrees(math.atan(v))),
    "atan2": Function("nn", "atan2(dy, dx)", lambda y, x: math.degrees(math.atan2(y, x))),
    "sqrt": Function("n", "sqrt(number)", math.sqrt, keeps_length=True),
    "abs": Function("n", "abs(number)", abs, keeps_length=True),
    "min": Function("n+", "min(a, b, …)", lambda *v: min(v), keeps_length=True),
    "max": Function("n+", "max(a, b, …)", lambda *v: max(v), keeps_length=True),
    "floor": Function("n", "floor(number)", lambda v: float(math.floor(v)), keeps_length=True),
    "ceil": Function("n", "ceil(number)", lambda v: float(math.ceil(v)), keeps_length=True),
    "round": Function("n", "round(number)", lambda v: float(round(v)), keeps_length=True),
    "mod": Function("nn", "mod(number, divisor)", lambda a, b: a % b, keeps_length=True),
    "x": Function("p", "x(point)", lambda p: p[0], gives_length=True),
    "y": Function("p", "y(point)", lambda p: p[1], gives_length=True),
    "dist": Function("pp", "dist(a, b)", math.dist, gives_length=True),
    "angle": Function("pp", "angle(from, to)", _heading),
    "mid": Function("pp", "mid(a, b)", lambda a, b: _between(a, b, 0.5)),
    "between": Function("ppn", "between(a, b, share)", _between),
    "polar": Function("pln", "polar(centre, radius, angle)", _polar),
    "rotate": Function("ppn", "rotate(point, centre, angle)", lambda p, centre, angle: turn(centre, angle)(p)),
    "mirror": Function("ppp", "mirror(point, a, b)", lambda p, a, b: mirroring(a, b)(p)),
    "start": Function("c", "start(curve)", lambda c: c.start),
    "finish": Function("c", "finish(curve)", lambda c: c.end),
    "middle": Function("c", "middle(curve)", middle_of),
    "centre": Function("c", "centre(curve)", centre_of),
    "radius": Function("c", "radius(curve)", radius_of, gives_length=True),
    "length": Function("c", "length(curve)", curve_length, gives_length=True),
    "foot": Function("pe", "foot(point, curve)", lambda p, c: nearest_point(c, p)),
    "meet": Function(
        "eep",
        "meet(curve, curve, near)",
        lambda a, b, near: _nearest(intersection_points(a, b), near, "place where both curves meet"),
    ),
    "tangent": Function(
        "pcp",
        "tangent(from, curve, near)",
        lambda p, c, near: _nearest(tangent_points(c, p), near, "tangent from this point"),
    ),
}
"""Every function by its name; angles in degrees."""


def call(written: s.Call, values: Sequence[Value], scope: Scope) -> Value:
    """Return the value of a function.

    Args:
        values: one for each argument that is written.

    Raises:
        CommandError: no such function, other arguments than it takes, or a result that there is not.
    """
    function = FUNCTIONS.get(written.function.text)
    if function is None:
        word = written.function.text
        raise wrong(
            f"'{word}' is no function; use one of {known_words(word, list(FUNCTIONS))}.", written.function.place
        )
    given = _taken(function, written, _alike(list(values), scope) if function.keeps_length else list(values), scope)
    try:
        value = function.does(*given)
    except (ValueError, ZeroDivisionError, OverflowError):
        raise wrong(f"{function.shown} has no value for these numbers.", written.place) from None
    except InputError as error:
        raise wrong(str(error), written.place) from None
    if isinstance(value, int | float):
        return (
            Length(value)
            if function.gives_length or (function.keeps_length and isinstance(given[0], Length))
            else float(value)
        )
    return value


def _alike(values: list[Value], scope: Scope) -> list[Value]:
    """Return numbers as lengths where one of them is a length."""
    if not any(isinstance(value, Length) for value in values):
        return values
    return [scope.length(value) if isinstance(value, float) else value for value in values]


def _named_curve(value: Value) -> Curves | None:
    """Return the curves that a name or a number stands for."""
    if isinstance(value, float):
        return Curves((int(value),)) if value >= 1 and value == int(value) else None
    return value if isinstance(value, Curves) else None


def _taken(function: Function, written: s.Call, values: list[Value], scope: Scope) -> list[Given]:
    """Return the arguments as the function takes them; two numbers in a row may stand for a point."""
    places = [argument.place for argument in written.arguments]
    takes, given = function.takes.rstrip("+"), list[Given]()
    while values and (len(given) < len(takes) or function.takes.endswith("+")):
        requested = takes[min(len(given), len(takes) - 1)]
        place, value = places[-len(values)], values.pop(0)
        following = values[0] if values else None
        if requested == "p" and isinstance(value, float) and isinstance(following, float):
            value = (float(scope.length(value)), float(scope.length(following)))
            del values[0]
        if requested == "l" and isinstance(value, float):
            given.append(scope.length(value))
        elif (requested == "n" and isinstance(value, float)) or (requested == "p" and isinstance(value, tuple)):
            given.append(value)
        elif requested in "ce" and (named := _named_curve(value)) is not None:
            given.append(scope.curve(named, place) if requested == "c" else scope.edge(named, place))
        else:
            raise wrong(f"{function.shown}: this is {kind_of(value)}.", place)
    if values or len(given) < len(takes):
        raise wrong(f"Write {function.shown}.", written.place)
    return given
