"""Values of words: numbers, parameters, expressions in square brackets, functions (RS274/NGC, and Fanuc's macro B).

A value that does not change is a float; any other is a function of the parameters, so that a line is parsed once
however often a loop runs it.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ...model.motion import Floats
from .dialect import DialectRules
from .program import BlockFault

# Parameters: numbers with numbers or names, some of a subroutine alone, some that the control itself sets.


Key = int | str

Assign = Callable[[int, float], bool]
"""Sets a parameter of the control's own; False = it is none that can be set."""

System = Callable[[Key], float | None]
"""What the control says of a parameter of its own; None = it is none."""

PLAIN = 5000
"""Up to this number no parameter is the control's own."""

OWN_NAME = re.compile(
    "_(?:vmajor|vminor|line|motion_mode|plane|ccomp|metric|imperial|absolute|incremental|inverse_time|units_per_minute|"
    "units_per_rev|coord_system|tool_offset|retract_r_plane|retract_old_z|spindle_rpm_mode|spindle_css_mode|"
    "ijk_absolute_mode|lathe_diameter_mode|lathe_radius_mode|spindle_on|spindle_cw|mist|flood|speed_override|"
    "feed_override|adaptive_feed|feed_hold|feed|rpm|[xyzabcuvw]|current_tool|current_pocket|selected_tool|"
    "selected_pocket|call_level|remap_level|task)"
)
"""What LinuxCNC tells by name, and lets nobody set."""

MOST = 200_000
"""So many parameters may be set; a real program sets some hundred."""


class _CallersParameters(NamedTuple):
    """What is kept of a caller while a subroutine runs: its own parameters by name, and those by number."""

    named: dict[str, float]
    numbered: Floats


class Parameters:
    """Values by number or name.

    Attributes:
        plain: (5001,) values by number, NaN = not set; compiled code reads and writes them, too.
        least: the step of a length, in the units that are in force, to which macro B rounds in a word.
        changes: how often a value became another one; alike at two times = nothing has changed between.
    """

    def __init__(self, system: System, assign: Assign, rules: DialectRules, least: Callable[[], float]) -> None:
        """Begin with every parameter 0, or vacant: NaN, as #0 is, which no word takes, which equals nothing but another
        one, and counts as 0 elsewhere.

        Args:
            system: asked first. assign: told first of a value that is set.
            rules: which numbers there are, and whether those that nobody has set are vacant. #1 to #30, in macro B to
                #33, belong to the subroutine that is running.
            least: asked for the step of a length.
        """
        self._unset = math.nan if rules.macro_b else 0.0
        self._largest = rules.parameters
        local_numbers = 33 if rules.fanuc_flow else 30
        self._system, self._assign = system, assign
        self._local = slice(1, local_numbers + 1)
        self.plain: Floats = np.full(PLAIN + 1, math.nan)
        self.least = least
        self._everywhere: dict[Key, float] = {}
        self._here: dict[str, float] = {}
        self._callers: list[_CallersParameters] = []
        self.changes = 0

    def get(self, key: Key) -> float:
        """Return a value.

        Raises:
            Fault: a name that was never set, or a number out of range.
        """
        if isinstance(key, int) and 0 < key <= PLAIN:
            number = float(self.plain[key])
            if math.isnan(number):
                own = self._system(key)  # which is told that somebody asks for what nobody has set
                return self._unset if own is None else own
            return number
        if key == 0 and math.isnan(self._unset):
            return self._unset
        value = self._place(key).get(key)
        own = self._system(key) if value is None or isinstance(key, str) else None
        if own is not None:
            return own
        if value is not None:
            return value
        if isinstance(key, str) and key.startswith(("_hal[", "_ini[")):
            raise BlockFault(f"the value of #<{key}> is known to the machine alone; write a number in its place.")
        if isinstance(key, str):
            raise BlockFault(f"the parameter #<{key}> has no value here; set it before.")
        if not 0 < key <= self._largest:
            raise BlockFault(f"there is no parameter #{key}; use 1 to {self._largest}.")
        return 0.0

    def exists(self, key: str) -> bool:
        """Tell whether a named parameter has a value."""
        return self._system(key) is not None or key in self._place(key)

    def set(self, key: Key, value: float) -> None:
        """Give a parameter a value.

        Raises:
            Fault: the control's own cannot be set; the number is out of range; there are too many.
        """
        if isinstance(key, int) and not 0 < key <= self._largest:
            raise BlockFault(f"there is no parameter #{key} to set; use 1 to {self._largest}.")
        if isinstance(key, str) and (OWN_NAME.fullmatch(key) or self._system(key) is not None):
            raise BlockFault(f"#<{key}> is the control's own and cannot be set.")
        if isinstance(key, int) and key <= PLAIN:
            before = self.plain[key]
            if before != value and not (math.isnan(before) and math.isnan(value)):
                self.changes += 1
                self.plain[key] = value
            return
        value = 0.0 if math.isnan(value) else value
        if isinstance(key, int) and self._assign(key, value):
            self.changes += 1
            return
        place = self._place(key)
        if place.get(key) != value:
            self.changes += 1
            place[key] = value
            if len(place) > MOST:
                raise BlockFault(f"the program sets more than {MOST} parameters; the reader stops here.")

    def values(self) -> tuple[tuple[Key, float], ...]:
        """Return every parameter that the program has set and can use here."""
        numbers = np.flatnonzero(~np.isnan(self.plain))
        plain = zip(numbers.tolist(), self.plain[numbers].tolist(), strict=True)
        return (*plain, *self._everywhere.items(), *self._here.items())

    def enter(self, arguments: dict[Key, float]) -> None:
        """Begin a subroutine with parameters of its own.

        Args:
            arguments: their values, by numbers that belong to the subroutine.
        """
        self._callers.append(_CallersParameters(self._here, self.plain[self._local].copy()))
        self._here = {}
        self.plain[self._local] = math.nan
        for key, value in arguments.items():
            assert isinstance(key, int)
            self.plain[key] = value
        self.changes += 1

    def leave(self) -> None:
        """Go back to the caller's parameters."""
        self._here, self.plain[self._local] = self._callers.pop()
        self.changes += 1

    def _place(self, key: Key) -> dict[Key, float]:
        named_here = isinstance(key, str) and not key.startswith("_")
        return self._here if named_here else self._everywhere  # type: ignore[return-value]  # names alone are kept here


Value = float | Callable[[Parameters], float]

NUMBER = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)")
NAME = re.compile(r"<((?:_(?:hal|ini)\[[\w.\-:]{1,150}\])?[^<>\[\]()#]{0,200})(?<!<)>")
FUNCTION = re.compile(r"(atan|abs|acos|asin|cos|exp|fix|fup|round|ln|sin|sqrt|tan|exists)\[")

_DASHES = "\u2010\u2011\u2012\u2013\u2014\u2212"
"""Signs that programs for writing put in the place of minus."""

_LENGTHS = frozenset("abcefijkqruvwxyz")
"""Words in which ROUND of macro B goes to the step of a length or an angle; elsewhere it goes to a whole number."""

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


def _of_bits(function: Callable[[int, int], int]) -> Callable[[float, float], float]:
    """Return an operator of macro B, which joins whole numbers bit by bit."""
    return lambda a, b: float(function(whole(a, "what is joined bit by bit"), whole(b, "what is joined bit by bit")))


def _remainder(a: float, b: float) -> float:
    """The remainder with the sign of what is divided, as in macro B."""
    if b == 0:
        raise BlockFault("the expression divides by zero in MOD.")
    return math.fmod(a, b)


_BINARY_IN_MACRO_B = _BINARY | {
    "and": _of_bits(lambda a, b: a & b),
    "or": _of_bits(lambda a, b: a | b),
    "xor": _of_bits(lambda a, b: a ^ b),
    "mod": _remainder,
}

_RANK_IN_MACRO_B = _RANK | {"and": 4, "or": 3, "xor": 3}

_UNARY_IN_MACRO_B = _UNARY | {
    "fix": lambda a: float(math.trunc(a)),
    "fup": lambda a: math.copysign(math.ceil(abs(a)), a),
}
"""FIX drops what is behind the point, FUP goes on to the next whole number away from 0."""


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
    if math.isnan(value):
        raise BlockFault(f"{what} is a parameter that nobody has set; it must be a whole number.")
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
        letter: of the word whose value is read; "" = it is no word's.
    """

    def __init__(self, code: str, nesting: int, macro_b: bool = False) -> None:
        """Begin at the block's first character.

        Args:
            code: of the block.
            nesting: how deep brackets may go.
            macro_b: operators and functions are those of Fanuc's and Haas' macro B.
        """
        self.code, self.at, self.letter, self._left = code, 0, "", nesting
        self._macro_b = macro_b
        self._ranks = _RANK_IN_MACRO_B if macro_b else _RANK
        self._binary = _BINARY_IN_MACRO_B if macro_b else _BINARY
        self._unary = _UNARY_IN_MACRO_B if macro_b else _UNARY

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
            if found is None or self._ranks[found[0]] < rank:
                return left
            self.at = found.end()
            right = self._term(self._ranks[found[0]] + 1)
            left = _joined(self._binary[found[0]], left, right)

    def _function(self) -> Value:
        found = FUNCTION.match(self.code, self.at)
        if found is None:
            raise self._fault("expected a number, #, [ or a function")
        self.at = found.end() - 1
        if found[1] == "exists":
            return self._exists()
        value = self._bracket()
        if found[1] == "round" and self._macro_b and self.letter in _LENGTHS:
            return _rounded_to_least(value)
        if found[1] != "atan":
            return _applied(self._unary[found[1]], value)
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
        letter, self.letter = self.letter, ""
        value = self.value()
        self.letter = letter
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
    return lambda parameters: _computed(function, _number_of(value(parameters)))


def _rounded_to_least(value: Value) -> Value:
    """Return a value rounded to the step of a length, as macro B rounds what a word says."""
    nearest = _UNARY["round"]
    return lambda parameters: _computed(
        lambda a, step: nearest(a / step) * step, _number_of(evaluated(value, parameters)), parameters.least()
    )


def _joined(function: Callable[[float, float], float], left: Value, right: Value) -> Value:
    if isinstance(left, float) and isinstance(right, float):
        return _computed(function, left, right)
    return lambda parameters: _of_both(function, evaluated(left, parameters), evaluated(right, parameters))


def _of_both(function: Callable[[float, float], float], left: float, right: float) -> float:
    """Return a function of two values; a vacant one equals another vacant one alone, and is 0 to all but EQ and NE."""
    vacant = math.isnan(left), math.isnan(right)
    if any(vacant) and function in (_BINARY["eq"], _BINARY["ne"]):
        return float(all(vacant) == (function is _BINARY["eq"]))
    return _computed(function, _number_of(left), _number_of(right))


def _number_of(value: float) -> float:
    return 0.0 if math.isnan(value) else value
