"""An operation in one comment of a program's header, written and read: its kind, then its parameters, `key=value` each.

    operation=contour,tool=2,depth=2,stock_to_leave=0,side=outside,tab_places=10 0/50 0

Lengths are in mm, angles in degrees, shares parts of 1; lists have slashes between their items, and what is not said
has its default. Programs of earlier versions say KIND,TOOL,DEPTH,STOCK_TO_LEAVE[,SIDE] instead, and the rest in
comments of their own.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sequence
from enum import Enum
from typing import Any

from ..core.errors import ParameterError
from ..model.curve_selectors import Selector, on_layers, read_selectors
from ..model.fields import ParameterPlace, Unit, parameters_of
from ..model.operation import Operation

# Numbers and names as any control takes them in a comment, and names back again.


ALLOWED = frozenset("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789 _.,+-/")

_SPELLED = re.compile(r"\+([0-9A-F]{1,6})\+", re.IGNORECASE)


def plain_numbers(*values: float, decimals: int = 6) -> str:
    """Return numbers with at most so many decimals, in 0 ... 9, and no zeros behind, joined by commas."""
    return ",".join(f"{round(value, decimals) + 0.0:.{decimals}f}".rstrip("0").rstrip(".") for value in values)


def spelled(text: str, allowed: frozenset[str] = ALLOWED) -> str:
    """Return a text in allowed characters from which it can be read again: others become their code point, "+DF+"."""
    return "".join(c if c in allowed and c != "+" else f"+{ord(c):X}+" for c in text)


def unspelled(text: str) -> str:
    """Return a text as it was before it was spelled."""
    return _SPELLED.sub(lambda match: chr(min(int(match[1], 16), 0x10FFFF)), text)


_ALWAYS = ("tool", "depth", "stock_to_leave")

_DECIMALS = 9
"""Of a number in a note: more than any length or angle is asked with."""

_NUMBER = re.compile(r"-?\d{1,9}(\.\d{1,9})?")


def written(operation: Operation) -> str:
    """Return an operation as the value of its comment."""
    said = ((key, placed, placed.of(operation)) for key, placed in parameters_of(type(operation)).items())
    items = [
        f"{key}={_text(placed, value)}" for key, placed, value in said if key in _ALWAYS or value != placed.default
    ]
    return ",".join((operation.WORD, *items))


def read(kind: type[Operation], items: Sequence[str]) -> dict[str, Any] | None:
    """Return the parameters that a comment tells, by key; None where one is not as it is written. Strange keys are
    passed over.
    """
    known, values = parameters_of(kind), {}
    for item in items:
        key, _, text = item.partition("=")
        if key.strip().lower() == "layers":  # as earlier versions told them
            values["curves"] = on_layers(unspelled(name) for name in text.strip().split("/"))
        placed = known.get(key.strip().lower())
        if placed is not None:
            value = _READERS[placed.parameter.unit](text.strip(), placed)
            if value is None:
                return None
            values[placed.key] = value
    return values if "tool" in values else None


_IN_LISTS = ALLOWED - {",", "/"}


def _text(placed: ParameterPlace, value: Any) -> str:
    unit = placed.parameter.unit
    if isinstance(value, Enum):
        return str(value.value)
    if unit is Unit.FLAG:
        return str(int(value))
    if unit is Unit.CURVES:
        return "/".join(spelled(each.text, _IN_LISTS) for each in value)
    if unit is Unit.POINTS:
        return "/".join(plain_numbers(*point, decimals=_DECIMALS).replace(",", " ") for point in value)
    return plain_numbers(math.degrees(value) if unit is Unit.ANGLE else value, decimals=_DECIMALS)


def _number(text: str, _: ParameterPlace) -> float | None:
    return float(text) if _NUMBER.fullmatch(text) else None


def _angle(text: str, placed: ParameterPlace) -> float | None:
    degrees = _number(text, placed)
    return None if degrees is None else math.radians(degrees)


def _count(text: str, _: ParameterPlace) -> int | None:
    return int(text) if re.fullmatch(r"\d{1,9}", text) else None


def _flag(text: str, _: ParameterPlace) -> bool | None:
    return {"0": False, "1": True}.get(text)


def _choice(text: str, placed: ParameterPlace) -> Enum | None:
    assert placed.enum is not None
    return next((each for each in placed.enum if each.value.lower() == text.lower()), None)


def _curves(text: str, _: ParameterPlace) -> tuple[Selector, ...] | None:
    try:
        return read_selectors(unspelled(each) for each in text.split("/"))
    except ParameterError:
        return None


def _points(text: str, _: ParameterPlace) -> tuple[tuple[float, float], ...] | None:
    pairs = [point.split() for point in text.split("/")]
    if not all(len(pair) == 2 and all(_NUMBER.fullmatch(number) for number in pair) for pair in pairs):
        return None
    return tuple((float(x), float(y)) for x, y in pairs)


_READERS: dict[Unit, Callable[[str, ParameterPlace], Any]] = {
    Unit.LENGTH: _number,
    Unit.SHARE: _number,
    Unit.TIME: _number,
    Unit.ANGLE: _angle,
    Unit.COUNT: _count,
    Unit.FLAG: _flag,
    Unit.CHOICE: _choice,
    Unit.CURVES: _curves,
    Unit.POINTS: _points,
}
