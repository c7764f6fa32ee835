"""What a formula r = f(z) is at least and at most on short stretches of z, by interval arithmetic, not by samples."""

from __future__ import annotations

import ast
import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ...core.errors import ParameterError
from ...model.motion import Floats

_ROUNDING = 1e-12
"""Of a bound's size: what floating point may have taken off it."""

_USE = "use z, numbers, pi, + - * / **, sin, cos, exp, sqrt, abs, min, max"


@dataclass(frozen=True, eq=False)
class IntervalArray:
    """Intervals, none empty.

    Attributes:
        low, high: (n,) ends.
    """

    low: Floats
    high: Floats

    def widened(self) -> IntervalArray:
        """Return the same with room for rounding."""
        room = _ROUNDING * np.maximum(np.abs(self.low), np.abs(self.high)) + 1e-300
        return IntervalArray(self.low - room, self.high + room)


def formula_bounds(text: str, edges: Floats) -> IntervalArray:
    """Return what a formula in z is at least and at most between neighbouring places.

    Args:
        text: of z: numbers, pi, + - * / **, sin, cos, exp, sqrt, abs, min, max.
        edges: (n + 1,) rising values of z.

    Raises:
        ParameterError: it is no such formula, or is not finite somewhere there.

    References:
        Moore, "Interval Analysis" (1966): the bounds of a sum, product or function of intervals hold for all values in
        them.
    """
    try:
        tree = ast.parse(text.strip(), mode="eval")
    except (SyntaxError, ValueError, MemoryError, RecursionError) as error:
        raise ParameterError(f"'{text}' is no formula in z; {_USE}.") from error
    with np.errstate(all="ignore"):
        try:
            found = _bounds(tree.body, IntervalArray(edges[:-1], edges[1:]))
        except RecursionError as error:
            raise ParameterError(f"'{text[:40]}...' is nested too deeply; use a shorter formula.") from error
    low, high = np.broadcast_to(found.low, len(edges) - 1), np.broadcast_to(found.high, len(edges) - 1)
    wrong = np.flatnonzero(~(np.isfinite(low) & np.isfinite(high)))
    if len(wrong):
        raise ParameterError(
            f"'{text}' is not surely a number for z between {edges[wrong[0]]:g} and "
            f"{edges[wrong[0] + 1]:g}; change the formula so that it is."
        )
    return IntervalArray(low.astype(np.float64), high.astype(np.float64))


def _bounds(node: ast.expr, z: IntervalArray) -> IntervalArray:
    """Return the bounds of a part of a formula."""
    if isinstance(node, ast.Constant) and isinstance(node.value, int | float) and not isinstance(node.value, bool):
        return _constant(_number(node.value))
    if isinstance(node, ast.Name) and node.id in ("z", "pi"):
        return z if node.id == "z" else _constant(math.pi).widened()
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub | ast.UAdd):
        inner = _bounds(node.operand, z)
        return inner if isinstance(node.op, ast.UAdd) else IntervalArray(-inner.high, -inner.low)
    if isinstance(node, ast.BinOp):
        return _operation(node, z).widened()
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and not node.keywords:
        return _call(node.func.id, [_bounds(each, z) for each in node.args]).widened()
    raise ParameterError(f"'{ast.unparse(node)}' is nothing that a formula in z may hold; {_USE}.")


def _number(value: int | float) -> float:
    try:
        return float(value)
    except OverflowError as error:
        raise ParameterError(
            "a number of more than 300 digits is none of a formula in z; write a smaller one."
        ) from error


def _constant(value: float) -> IntervalArray:
    return IntervalArray(np.array([value]), np.array([value]))


def _operation(node: ast.BinOp, z: IntervalArray) -> IntervalArray:
    one = _bounds(node.left, z)
    if isinstance(node.op, ast.Pow):
        return _power(one, node.right)
    other = _bounds(node.right, z)
    if isinstance(node.op, ast.Add):
        return IntervalArray(one.low + other.low, one.high + other.high)
    if isinstance(node.op, ast.Sub):
        return IntervalArray(one.low - other.high, one.high - other.low)
    if isinstance(node.op, ast.Mult):
        return _product(one, other)
    if isinstance(node.op, ast.Div):
        if bool(np.any((other.low <= 0) & (other.high >= 0))):
            raise ParameterError(f"'{ast.unparse(node)}' may divide by 0; change the formula so that it cannot.")
        return _product(one, IntervalArray(1 / other.high, 1 / other.low))
    raise ParameterError(f"'{ast.unparse(node)}' is nothing that a formula in z may hold; {_USE}.")


def _product(one: IntervalArray, other: IntervalArray) -> IntervalArray:
    corners = [a * b for a in (one.low, one.high) for b in (other.low, other.high)]
    return IntervalArray(np.minimum.reduce(corners), np.maximum.reduce(corners))


def _power(base: IntervalArray, node: ast.expr) -> IntervalArray:
    """Return a whole power, or one of a base that is nowhere negative."""
    value = node.value if isinstance(node, ast.Constant) else None
    if not (isinstance(value, int | float) and not isinstance(value, bool) and 0 <= value <= 100):
        raise ParameterError(f"a power is '{ast.unparse(node)}'; use a number from 0 to 100.")
    power = float(value)
    if not power.is_integer() and bool(np.any(base.low < 0)):
        raise ParameterError(f"a power is {power:g}, of something that may be below 0; use a whole one.")
    ends = base.low**power, base.high**power
    low, high = np.minimum(*ends), np.maximum(*ends)
    if power.is_integer() and power % 2 == 0 and power > 0:
        low = np.where((base.low < 0) & (base.high > 0), 0.0, low)
    return IntervalArray(low, high)


def _rising(function: Callable[[Floats], Floats]) -> Callable[[list[IntervalArray]], IntervalArray]:
    return lambda given: IntervalArray(function(given[0].low), function(given[0].high))


def _cosine(given: list[IntervalArray]) -> IntervalArray:
    """Return the bounds of a cosine: 1 and -1 where it turns within an interval."""
    low, high = given[0].low, given[0].high
    ends = np.cos(low), np.cos(high)
    tops = np.floor(high / (2 * math.pi)) >= np.ceil(low / (2 * math.pi))
    bottoms = np.floor((high - math.pi) / (2 * math.pi)) >= np.ceil((low - math.pi) / (2 * math.pi))
    return IntervalArray(np.where(bottoms, -1.0, np.minimum(*ends)), np.where(tops, 1.0, np.maximum(*ends)))


def _sine(given: list[IntervalArray]) -> IntervalArray:
    return _cosine([IntervalArray(given[0].low - math.pi / 2, given[0].high - math.pi / 2).widened()])


def _absolute(given: list[IntervalArray]) -> IntervalArray:
    ends = np.abs(given[0].low), np.abs(given[0].high)
    across = (given[0].low < 0) & (given[0].high > 0)
    return IntervalArray(np.where(across, 0.0, np.minimum(*ends)), np.maximum(*ends))


def _least(given: list[IntervalArray]) -> IntervalArray:
    return IntervalArray(*(np.minimum(getattr(given[0], side), getattr(given[1], side)) for side in ("low", "high")))


def _greatest(given: list[IntervalArray]) -> IntervalArray:
    return IntervalArray(*(np.maximum(getattr(given[0], side), getattr(given[1], side)) for side in ("low", "high")))


_FUNCTIONS: dict[str, tuple[int, Callable[[list[IntervalArray]], IntervalArray]]] = {
    "sqrt": (1, _rising(np.sqrt)),
    "exp": (1, _rising(np.exp)),
    "cos": (1, _cosine),
    "sin": (1, _sine),
    "abs": (1, _absolute),
    "min": (2, _least),
    "max": (2, _greatest),
}


def _call(name: str, given: list[IntervalArray]) -> IntervalArray:
    if name not in _FUNCTIONS or len(given) != _FUNCTIONS[name][0]:
        raise ParameterError(f"'{name}' with {len(given)} values is no function of a formula in z; {_USE}.")
    return _FUNCTIONS[name][1](given)
