"""Values of words: numbers, parameters, expressions in square brackets, functions (RS274/NGC, and Fanuc's macro B).

A value that does not change is a float; any other is a function of the parameters, so that a line is parsed once
however often a loop runs it.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable

from .block_fault import BlockFault
from .parameters import Key, Parameters

Value = float | Callable[[Parameters], float]

NUMBER = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)")
NAME = re.compile(r"<((?:_(?:hal|ini)\[[\w.\-:]{1,150}\])?[^<>\[\]()#]{0,200})(?<!<)>")
FUNCTION = re.compile(r"(atan|abs|acos|asin|cos|exp|fix|fup|round|ln|sin|sqrt|tan|exists)\[")
_DASHES = "\u2010\u2011\u2012\u2013\u2014\u2212"
"""Signs that programs for writing put in the place of minus."""

OPERATOR = re.compile(r"\*\*|[-+*/]|mod|and|xor|or|eq|ne|gt|ge|lt|le")

ALIKE = 1e-4
"""Comparisons take numbers for equal that differ by less, as LinuxCNC does."""

_RANK = {
    "**": 5,
    "*": 4,
    "/": 4,
    "mod": 4,
    "+": 3,
    "-": 3,
    "eq": 2,
    "ne": 2,
    "gt": 2,
    "ge": 2,
    "lt": 2,
    "le": 2,
    "and": 1,
    "or": 1,
    "xor": 1,
}


def _divided(a: float, b: float) -> float:
    if b == 0:
        raise BlockFault("the expression divides by zero.")
    return a / b


def _modulo(a: float, b: float) -> float:
    """The remainder with the sign of the divisor's size: never negative, as in NGC."""
    if b == 0:
        raise BlockFault("the expression divides by zero in MOD.")
    return math.fmod(a, b) + (abs(b) if math.fmod(a, b) < 0 else 0.0)


_BINARY: dict[str, Callable[[float, float], float]] = {
    "**": lambda a, b: float(a**b),
    "*": lambda a, b: a * b,
    "/": _divided,
    "mod": _modulo,
    "+": lambda a, b: a + b,
    "-": lambda a, b: a - b,
    "eq": lambda a, b: float(abs(a - b) < ALIKE),
    "ne": lambda a, b: float(abs(a - b) >= ALIKE),
    "gt": lambda a, b: float(a > b),
    "ge": lambda a, b: float(a >= b),
    "lt": lambda a, b: float(a < b),
    "le": lambda a, b: float(a <= b),
    "and": lambda a, b: float(a != 0 and b != 0),
    "or": lambda a, b: float(a != 0 or b != 0),
    "xor": lambda a, b: float((a != 0) != (b != 0)),
}

_UNARY: dict[str, Callable[[float], float]] = {
    "abs": abs,
    "acos": lambda a: math.degrees(math.acos(a)),
    "asin": lambda a: math.degrees(math.asin(a)),
    "cos": lambda a: math.cos(math.radians(a)),
    "exp": math.exp,
    "fix": lambda a: float(math.floor(a)),
    "fup": lambda a: float(math.ceil(a)),
    "round": lambda a: math.copysign(math.floor(abs(a) + 0.5), a),
    "ln": math.log,
    "sin": lambda a: math.sin(math.radians(a)),
    "sqrt": math.sqrt,
    "tan": lambda a: math.tan(math.radians(a)),
}


def evaluated(value: Value, parameters: Parameters) -> float:
    """Return what a value is now.

    Raises:
        Fault: it is no number.
    """
    return value if isinstance(value, float) else value(parameters)


def whole(value: float, what: str) -> int:
    """Return a value that has to be a whole number.

    Raises:
        Fault: it is none.
    """
    if abs(value - round(value)) > ALIKE:
        raise BlockFault(f"{what} is {value:g}; it must be a whole number.")
    return round(value)


def _computed(function: Callable[..., float], *arguments: float) -> float:
    """Return a function's value, or say why there is none."""
    try:
        value = function(*arguments)
    except (ValueError, OverflowError, ZeroDivisionError, TypeError):
        value = math.nan
    if not math.isfinite(value):
        raise BlockFault("the expression has no value: " + ", ".join(f"{a:g}" for a in arguments) + " is out of range.")
    return value


class ValueReader:
    """Reads values out of a block.

    Attributes:
        code: of the block, as `text.code_of` gives it.
        at: index of the next character.
    """

    def __init__(self, code: str, nesting: int) -> None:
        """Begin at the block's first character; `nesting` is how deep brackets may go."""
        self.code, self.at, self._left = code, 0, nesting

    def value(self) -> Value:
        """Read a value.

        Raises:
            Fault: there is none here, or it is wrong.
        """
        number = NUMBER.match(self.code, self.at)
        if number is not None:
            self.at = number.end()
            return self.finite(float(number[0]))
        self._left -= 1
        if self._left < 0:
            raise self._fault("brackets or parameters stand too deep within one another")
        value = self._composed()
        self._left += 1
        return value

    def _composed(self) -> Value:
        sign = self._peek()
        if sign == "[":
            return self._bracket()
        if sign == "#":
            self.at += 1
            return self._parameter()
        if sign and sign in "+-":
            self.at += 1
            value = self.value()
            return value if sign == "+" else (-value if isinstance(value, float) else _negative(value))
        return self._function()

    def expression(self) -> Value:
        """Read values joined by operators, as they stand within brackets.

        Raises:
            Fault: there is none here, or it is wrong.
        """
        return self._term(1)

    def _bracket(self) -> Value:
        self.at += 1
        value = self.expression()
        if self._peek() != "]":
            raise self._fault("expected ] or an operator")
        self.at += 1
        return value

    def _term(self, rank: int) -> Value:
        """Read operands joined by operators of this rank or higher, from the left."""
        left = self.value()
        while True:
            found = OPERATOR.match(self.code, self.at)
            if found is None or _RANK[found[0]] < rank:
                return left
            self.at = found.end()
            right = self._term(_RANK[found[0]] + 1)
            left = _joined(_BINARY[found[0]], left, right)

    def _function(self) -> Value:
        found = FUNCTION.match(self.code, self.at)
        if found is None:
            raise self._fault("expected a number, #, [ or a function")
        self.at = found.end() - 1
        if found[1] == "exists":
            return self._exists()
        value = self._bracket()
        if found[1] != "atan":
            return _applied(_UNARY[found[1]], value)
        if self.code[self.at : self.at + 2] != "/[":
            raise self._fault("expected / and [ behind ATAN[...]")
        self.at += 1
        return _joined(lambda y, x: math.degrees(math.atan2(y, x)), value, self._bracket())

    def _exists(self) -> Value:
        if self.code[self.at : self.at + 2] != "[#":
            raise self._fault("expected a parameter, as in EXISTS[#<name>]")
        self.at += 2
        key = self.key()
        if self._peek() != "]":
            raise self._fault("expected ] behind the parameter")
        self.at += 1
        if isinstance(key, str):
            return lambda parameters: float(parameters.exists(key))
        return 1.0  # every number has a value, 0 where nobody has set it

    def _parameter(self) -> Value:
        key = self.key()
        if not callable(key):
            return lambda parameters: parameters.get(key)
        return lambda parameters: parameters.get(key(parameters))

    def key(self) -> Key | Callable[[Parameters], Key]:
        """Read what stands behind a #: a name, or a value that numbers the parameter."""
        named = NAME.match(self.code, self.at)
        if named is not None:
            self.at = named.end()
            return named[1]
        value = self.value()
        if isinstance(value, float):
            return whole(value, "the number of a parameter")
        return lambda parameters: whole(value(parameters), "the number of a parameter")

    def _peek(self) -> str:
        return self.code[self.at : self.at + 1]

    def finite(self, value: float) -> float:
        """Return a number that was read.

        Raises:
            Fault: it is too large.
        """
        if not abs(value) < 1e15:
            raise self._fault("the number is too large")
        return value

    def _fault(self, text: str) -> BlockFault:
        """Return a fault here; a negative column is an index of the code, which the reader turns into a column."""
        found = self._peek()
        what = repr(found) if found else "the end of the line"
        remedy = "; write minus as -" if found and found in _DASHES else ""
        return BlockFault(f"{text}, found {what}{remedy}.", column=-1 - self.at)


def _negative(value: Callable[[Parameters], float]) -> Value:
    return lambda parameters: -value(parameters)


def _applied(function: Callable[[float], float], value: Value) -> Value:
    if isinstance(value, float):
        return _computed(function, value)
    return lambda parameters: _computed(function, value(parameters))


def _joined(function: Callable[[float, float], float], left: Value, right: Value) -> Value:
    if isinstance(left, float) and isinstance(right, float):
        return _computed(function, left, right)
    return lambda parameters: _computed(function, evaluated(left, parameters), evaluated(right, parameters))
