"""Expressions of the shape language to numbers, points and curves."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

from ...model.curves import Point
from . import syntax as s
from .functions import call
from .units import ALL_UNITS, ANGLE_UNITS, LENGTH_UNITS
from .values import Curves, Length, Scope, Value, kind_of, wrong

_LARGEST = 1e7
"""Of a number of the language; coordinates and lengths beyond that lose their micrometres."""


def number_of(expression: s.Expression, scope: Scope) -> float:
    """Return the number that an expression states.

    Raises:
        CommandError: it is none, or beyond 10 km.
    """
    value = value_of(expression, scope)
    if not isinstance(value, float):
        raise wrong(f"This is {kind_of(value)}; a number such as 12.5 is wanted.", expression.place)
    return value


def length_of(expression: s.Expression, scope: Scope) -> Length:
    """Return the length that an expression states, mm; one without a unit counts in the unit of the scope.

    Raises:
        CommandError: it is none, or beyond 10 km.
    """
    return scope.length(number_of(expression, scope))


def point_of(expression: s.Expression, scope: Scope) -> Point:
    """Return the point that an expression states, mm.

    Raises:
        CommandError: it is none.
    """
    value = value_of(expression, scope)
    if not isinstance(value, tuple):
        raise wrong(f"This is {kind_of(value)}; a point such as 10,20, @dx,dy or @r<angle is wanted.", expression.place)
    return value


def value_of(expression: s.Expression, scope: Scope) -> Value:
    """Return what an expression stands for.

    Raises:
        CommandError: a name is unknown, a unit does not belong here, an operand is no number, a result has no finite
            size.
    """
    match expression:
        case s.Quantity():
            value: Value = _with_unit(expression.value, expression.unit, expression.place, scope)
        case s.Name():
            value = _named(expression, scope)
        case s.Negation():
            value = _signed(value_of(expression.operand, scope), expression.place)
        case s.OperatorChain():
            value = _chained(expression, scope)
        case s.Bracketed():
            value = _grouped(expression, scope)
        case s.Coordinates():
            value = _point(expression, scope)
        case s.Call():
            value = call(expression, [value_of(a, scope) for a in expression.arguments], scope)
        case s.QuotedText():
            raise wrong(f'"{expression.text}" is a text; a number or a point is wanted.', expression.place)
    return _checked(value, expression.place)


def _checked(value: Value, place: s.TextSpan) -> Value:
    numbers: Sequence[float] = () if isinstance(value, Curves) else (value,) if isinstance(value, float) else value
    if not all(abs(number) <= _LARGEST for number in numbers):
        raise wrong("The value is too large; numbers go up to 10 000 000.", place)
    return value


def _with_unit(value: float, unit: str, place: s.TextSpan, scope: Scope) -> float:
    value *= _unit(unit, place, scope)
    return Length(value) if unit in LENGTH_UNITS else value


def _unit(unit: str, place: s.TextSpan, scope: Scope) -> float:
    units = ALL_UNITS if scope.units is None else scope.units
    if unit and unit not in units:
        raise wrong(f"'{unit}' does not fit here; use one of {', '.join(units)}.", place)
    return units[unit] if unit else 1.0


def _named(name: s.Name, scope: Scope) -> Value:
    if scope.names is not None and name.text in scope.names:
        return scope.names[name.text]
    if name.text == "pi":
        return math.pi
    if scope.names is None:
        raise wrong(f"'{name.text}' is no number; write a number such as 12.5 or 1in+8mm.", name.place)
    raise wrong(
        f"'{name.text}' has no value; say let {name.text} = … before, or write a number or a point.", name.place
    )


def _signed(value: Value, place: s.TextSpan) -> Value:
    if isinstance(value, Curves):
        raise wrong("A curve has no negative; a number or a point is wanted.", place)
    return (-value[0], -value[1]) if isinstance(value, tuple) else _like(value, -value)


def _like(value: float, result: float) -> float:
    """Return a result as a length where the value that it comes from is one."""
    return Length(result) if isinstance(value, Length) else result


def _grouped(group: s.Bracketed, scope: Scope) -> Value:
    if len(group.items) == 1:
        value = value_of(group.items[0], scope)
        if not group.unit:
            return value
        if not isinstance(value, float):
            raise wrong(f"A unit belongs to a number; this is {kind_of(value)}.", group.place)
        return _with_unit(value, group.unit, group.place, scope)
    if group.unit:
        raise wrong("A unit belongs to a number; write it behind each of the two.", group.place)
    return (float(length_of(group.items[0], scope)), float(length_of(group.items[1], scope)))


def _point(written: s.Coordinates, scope: Scope) -> Point:
    first = float(length_of(written.first, scope))
    polar = written.frame in (s.CoordinateMode.POLAR, s.CoordinateMode.POLAR_FROM_LAST)
    units = ANGLE_UNITS if polar and scope.units is not None else scope.units
    second = float((number_of if polar else length_of)(written.second, replace(scope, units=units)))
    if polar:
        turn = math.radians(second)
        first, second = first * math.cos(turn), first * math.sin(turn)
    if written.frame in (s.CoordinateMode.FROM_LAST, s.CoordinateMode.POLAR_FROM_LAST):
        return (scope.last[0] + first, scope.last[1] + second)
    return (first, second)


def _chained(chain: s.OperatorChain, scope: Scope) -> Value:
    value = value_of(chain.operands[0], scope)
    before = chain.operands[0]
    for operator, operand in zip(chain.operators, chain.operands[1:], strict=True):
        if (
            operator == "/"
            and _is_plain(before)
            and isinstance(operand, s.Quantity)
            and operand.unit
            and isinstance(value, float)
        ):
            size = number_of(operand, scope)  # 1/4in is a quarter of an inch, as on a drill's box
            value = _like(size, _quotient(value, operand.value, operand.place) * (size / operand.value))
        elif operator == "/":
            value = _divided(value, operand, scope)
        else:
            value = _joined(operator, value, operand, scope)
        before = operand
    return value


def _is_plain(operand: s.Expression) -> bool:
    if isinstance(operand, s.Negation):
        return _is_plain(operand.operand)
    return isinstance(operand, s.Quantity) and not operand.unit


def _quotient(value: float, divisor: float, place: s.TextSpan) -> float:
    if divisor == 0:
        raise wrong("Division by zero; write another divisor.", place)
    return value / divisor


def _divided(value: Value, operand: s.Expression, scope: Scope) -> Value:
    divisor = number_of(operand, scope)
    if isinstance(value, Curves):
        raise wrong("A curve cannot be divided; a number or a point is wanted.", operand.place)
    if isinstance(value, tuple):
        return (_quotient(value[0], divisor, operand.place), _quotient(value[1], divisor, operand.place))
    quotient = _quotient(value, divisor, operand.place)
    return quotient if isinstance(divisor, Length) else _like(value, quotient)


def _joined(operator: str, a: Value, operand: s.Expression, scope: Scope) -> Value:
    b = value_of(operand, scope)
    if operator == "*" and isinstance(a, float) and isinstance(b, tuple):
        a, b = b, a
    match operator, a, b:
        case "*", (x, y), float():
            return (x * b, y * b)
        case "+" | "-", (x, y), (u, v):
            return (x + u, y + v) if operator == "+" else (x - u, y - v)
        case _, float(), float():
            if not isinstance(a, Length) and not isinstance(b, Length):
                return _calculated(operator, a, b, operand.place)
            if operator in "+-":
                a, b = scope.length(a), scope.length(b)
            return Length(_calculated(operator, a, b, operand.place))
    raise wrong(f"'{operator}' does not go between {kind_of(a)} and {kind_of(b)}.", operand.place)


def _calculated(operator: str, a: float, b: float, place: s.TextSpan) -> float:
    if operator != "^":
        return a * b if operator == "*" else a + b if operator == "+" else a - b
    try:
        return math.pow(a, b)
    except (OverflowError, ZeroDivisionError, ValueError):
        raise wrong(f"{a:g} ^ {b:g} has no value.", place) from None
