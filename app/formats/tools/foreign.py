"""Tools of other programs' files: what is common to them, whatever each calls it."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from itertools import count
from pathlib import PurePath
from typing import Any

from ...core.errors import HitofudeError, InputError, printable
from ...core.toml_tables import QUOTED, brief
from ...model.tool import FeedRow, Tool, ToolMaterial
from .library import ReadTools, ToolLibrary

INCH = 25.4
EDGES = {
    "hss": ToolMaterial.HSS,
    "high speed steel": ToolMaterial.HSS,
    "cobalt": ToolMaterial.HSS,
    "carbide": ToolMaterial.CARBIDE,
}
_QUANTITY = re.compile(r"\s*([+-]?(?:\d+[.,]?\d*|[.,]\d+)(?:[eE][+-]?\d+)?)\s*(mm|cm|m|in|\"|″|thou|deg|°|rad)?\s*")
_LENGTHS = {None: 1.0, "mm": 1.0, "cm": 10.0, "m": 1000.0, "in": INCH, '"': INCH, "″": INCH, "thou": INCH / 1000}
_ANGLES = {None: math.pi / 180, "deg": math.pi / 180, "°": math.pi / 180, "rad": 1.0}


class NotUnderstoodError(Exception):
    """Something of a file is not understood; the text says what, without a full stop."""


@dataclass(frozen=True)
class ForeignTool:
    """A tool as another program's file has it.

    Attributes:
        label: what its file calls it.
        number: T number there; 0 = none.
        values: fields of `Tool`, all but the number; those of 0 are not known.
        assumed: what was taken without being sure, sentences without their beginning and full stop.
    """

    label: str
    number: int
    values: Mapping[str, Any]
    assumed: tuple[str, ...] = ()


@dataclass(frozen=True)
class Unreadable:
    """An entry that makes no tool: what it is called, and why, without a full stop."""

    label: str
    why: str


def library_of(file: str, entries: Iterable[ForeignTool | Unreadable]) -> ReadTools:
    """Return the tools of a file, and a sentence for each thing in it that is left out or assumed.

    A number that is none, or taken, gives way to the next free one.

    Raises:
        InputError: none is left.
    """
    entries = list(entries)
    taken = {each.number for each in entries if isinstance(each, ForeignTool)}
    tools: list[Tool] = []
    told: list[str] = []
    for each in entries:
        if isinstance(each, Unreadable):
            told.append(f"{each.label} is left out: {each.why}.")
            continue
        used = {tool.number for tool in tools}
        number = each.number
        if not 1 <= number <= 9999 or number in used:
            number = next(free for free in count(1) if free not in used | taken)
            if each.number:
                told.append(f"{each.label} is T{number}: T{each.number} is taken, or no number of a tool.")
        try:
            tools.append(Tool(number, **{key: value for key, value in each.values.items() if value}))
        except (HitofudeError, TypeError) as error:
            told.append(f"{each.label} is left out: {str(error).rstrip('.')}.")
        else:
            told += [f"{each.label}: {what}." for what in each.assumed]
    sentences = tuple(printable(f"{file}: {brief(sentence)}") for sentence in told)
    if not tools:
        raise InputError(sentences[0] if sentences else f"{file}: there is no tool in this file.")
    return ReadTools(ToolLibrary(PurePath(file).stem, tuple(tools)), sentences)


def label_of(name: Any, number: int) -> str:
    """Return what to call an entry: its name, else its number."""
    text = " ".join(str(name).split()) if isinstance(name, str) else ""
    return brief(text, QUOTED) or (f"T{number}" if number else "a tool without a name")


def is_number(value: Any) -> bool:
    """Tell whether a value of a file is a number that a float may be; whole numbers may have any number of digits."""
    try:
        return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)
    except OverflowError:
        return False


def number_in(table: Mapping[str, Any], key: str) -> float:
    """Return a number of a table; 0 where it has none.

    Raises:
        NotUnderstoodError: what stands there is no number.
    """
    value = table.get(key)
    if value is None or value == "":
        return 0.0
    if not is_number(value):
        raise NotUnderstoodError(f"its {key} is {brief(repr(value), QUOTED)}, which is no number")
    return float(value)


def whole_in(table: Mapping[str, Any], key: str) -> int:
    """Return a whole number of a table; 0 where it has none, or none that is whole."""
    try:
        value = number_in(table, key)
    except NotUnderstoodError:
        return 0
    return int(value) if value == int(value) and abs(value) < 1e9 else 0


def quantity(value: Any, what: str, angle: bool = False) -> float:
    """Return a length in mm, or an angle in radians, of a number or a text such as "5,00 mm" or "90 °"; 0 where there
    is none.

    Raises:
        NotUnderstoodError: it is neither, or its unit is none of these.
    """
    if value is None or value == "":
        return 0.0
    match = _QUANTITY.fullmatch(value) if isinstance(value, str) else None
    unit = match[2] if match else None
    units: Mapping[str | None, float] = _ANGLES if angle else _LENGTHS
    if is_number(value):
        return float(value) * units[None]
    if match is None or unit not in units:
        raise NotUnderstoodError(
            f"its {what} is {brief(repr(value), QUOTED)}, which is no {'angle' if angle else 'length'}"
        )
    return float(match[1].replace(",", ".")) * units[unit]


def edges_of(word: Any) -> ToolMaterial:
    """Return what a word says that edges are made of."""
    return EDGES.get(str(word).strip().lower(), ToolMaterial.UNKNOWN)


@dataclass(frozen=True, slots=True)
class Rates:
    """Speed and feeds: rpm, mm/min; 0 = not told."""

    speed: float = 0.0
    feed: float = 0.0
    plunge: float = 0.0

    @property
    def values(self) -> dict[str, float]:
        """Fields of `Tool`."""
        return {"spindle_speed": self.speed, "feed_rate": self.feed, "plunge_rate": self.plunge}

    def row(self, material: str, diameter: float, flutes: int) -> FeedRow | None:
        """Return the row of feeds that comes to these for a material; None where speed or feed is not told."""
        if not (material.strip() and self.speed > 0 and self.feed > 0 and diameter > 0 and flutes > 0):
            return None
        share = min(self.plunge / self.feed, 1.0) if self.plunge > 0 else 0.3
        try:
            return FeedRow(
                material.strip(), math.pi * diameter * self.speed / 1000, self.feed / (self.speed * flutes), share
            )
        except HitofudeError:
            return None
