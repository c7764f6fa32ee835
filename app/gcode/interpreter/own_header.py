"""What the header of our own programs tells (`app.gcode.writer.header`): a key and its values in each comment."""

from __future__ import annotations

import bisect
import math
import re
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from ...core.errors import ParameterError
from ...model.curve_selectors import on_layers
from ...model.entry import LONGEST_LEAD
from ...model.fields import parameters_of
from ...model.job import Copies
from ...model.moves import DogBone, Tab
from ...model.operation import Operation, Side
from ...model.operation_kinds import OPERATION_KINDS
from ...model.part import Units
from ...model.read_options import LEAST_PER_INCH, MOST_PER_INCH, DrawingOptions
from .. import operation_notes
from ..operation_notes import unspelled
from .program import HeaderNote, KeepOutNote, OperationNote, PlungeRateNote, StockNote, ToolNote

MARK, MARK_ON = b"hitofude:", b"hitofude+"

_HEAD = 1 << 20
"""Bytes in which our header stands."""

_WEAR = re.compile(rb"hitofude: registers=wear\b", re.IGNORECASE)
"""What the comments of the header begin with, and those that go on with the one before."""

_DIAMETER = re.compile(rb"hitofude: register_mm=(\d{1,9}),(\d{1,9}(?:\.\d{1,9})?)\b", re.IGNORECASE)

_MOST = 20_000
"""Comments of a header that are looked at: each tab and each dog-bone has one."""


class NotedValues(NamedTuple):
    """A comment's values, and its 1-based line."""

    line: int
    values: list[str]


class _KeyedValues(NamedTuple):
    """A comment: its key in lower case, and what it says."""

    key: str
    said: NotedValues


class _CommentText(NamedTuple):
    """What a comment says behind its mark, with those that go on with it; the line of the first."""

    line: int
    text: str


class ProgramNotes(NamedTuple):
    """What comments tell: tools in the order of the text, the stock, and the header where it is our own."""

    tools: tuple[ToolNote, ...] = ()
    stock: StockNote | None = None
    header: HeaderNote | None = None


def registers_hold_wear(data: bytes) -> bool:
    """Tell whether a program of our own says that its registers hold the wear of tools, from 0 on, and no diameters."""
    return _WEAR.search(data[:_HEAD]) is not None


def register_diameters(data: bytes) -> dict[int, float]:
    """Return the diameters, mm, that a program of our own says to stand in registers, by the number of their D word."""
    return {int(number): float(diameter) for number, diameter in _DIAMETER.findall(data[:_HEAD])}


def own_notes(comments: Comments) -> ProgramNotes:
    """Return what a program with our own header tells; values that are not as they are written are passed over."""
    noted: dict[str, list[NotedValues]] = {}
    for key, values in _told(comments):
        noted.setdefault(key, []).append(values)
    origin = next((triple for _, values in noted.get("origin_mm", []) if (triple := _triple(values)) is not None), None)
    header = HeaderNote(
        origin=origin,
        operations=tuple(_operations(noted)),
        drawing_units=_units(noted.get("drawing_units", [])),
        layers=tuple(_name(values) for _, values in noted.get("layer", [])),
        join_tolerance=_first(noted.get("join_tolerance_mm", [])),
        path_tolerance=_first(noted.get("path_tolerance_mm", [])),
        allowance=_first(noted.get("allowance_mm", [])),
        copies=_copies(noted.get("copies", [])),
        keep_out=KeepOutNote(
            tuple(_name(values) for _, values in noted.get("keep_out", [])),
            _first(noted.get("keep_out_height_mm", [])) or 0.0,
        ),
        tabs=tuple(_tabs(noted.get("tab", []))),
        dog_bones=tuple(DogBone(*numbers) for numbers in _fives(noted.get("dog_bone", []))),
        reading=_reading(noted),
        plunge_rates=tuple(
            PlungeRateNote(int(numbers[0]), numbers[1])
            for _, values in noted.get("plunge_mm_min", [])
            if len(numbers := _floats(values)) == 2
        ),
        under=max(_first(noted.get("under_mm", [])) or 0.0, 0.0),
        above=max(_first(noted.get("above_mm", [])) or 0.0, 0.0),
    )
    return ProgramNotes(
        tuple(_tools(noted.get("tool", []))), _stock(noted.get("stock_mm", []), origin or (0.0, 0.0, 0.0)), header
    )


def _reading(noted: dict[str, list[NotedValues]]) -> DrawingOptions:
    """Return how the drawing was read."""
    without_layers, without_types, layouts = (
        tuple(_name(values) for _, values in noted.get(key, [])) for key in ("skip_layer", "skip_type", "layout")
    )
    density = _first(noted.get("px_per_inch", []))
    in_range = density is not None and LEAST_PER_INCH <= density <= MOST_PER_INCH
    return DrawingOptions(
        _first(noted.get("overrule_units", [])) == 1,
        layouts[0] if layouts else "",
        _first(noted.get("to_zero", [])) == 1,
        density if in_range else None,
        without_layers,
        without_types,
    )


def _told(comments: Comments) -> Iterator[_KeyedValues]:
    """Yield every key in lower case, with its line and its values, comments that go on with another put behind it."""
    whole: list[_CommentText] = []
    line, last = 1, 0
    for at, comment in sorted(comments.texts((MARK, MARK_ON), _MOST)):
        mark, text = comment.strip()[: len(MARK)].lower().encode("ascii", "replace"), comment.strip()[len(MARK) :]
        if mark == MARK_ON and whole:
            whole[-1] = whole[-1]._replace(text=whole[-1].text + text)
        elif mark == MARK:
            line, last = line + comments.data.count(b"\n", last, at), at
            whole.append(_CommentText(line, text))
    for line, text in whole:
        name, _, values = text.partition("=")
        yield _KeyedValues(name.strip().lower(), NotedValues(line, values.split(",")))


def _tools(noted: list[NotedValues]) -> Iterator[ToolNote]:
    """Yield tools: number, kind, diameter, and of some corner radius, tip diameter and tip angle in degrees."""
    for line, values in noted:
        numbers = _floats([*values[:1], *values[2:]])
        if len(numbers) in (2, 5):
            corner, tip, angle = numbers[2:] or [0.0] * 3
            yield ToolNote(
                int(numbers[0]), values[1].strip().lower(), numbers[1], corner, math.radians(angle), line, tip
            )


def _stock(noted: list[NotedValues], origin: tuple[float, float, float]) -> StockNote | None:
    """Return the stock less the work origin, which is in the coordinates of the part too."""
    for line, values in noted:
        corners = _floats(values)
        if len(corners) == 6:
            program = [corner - origin[k % 3] for k, corner in enumerate(corners)]
            return StockBoxNote(low=program[:3], high=program[3:]).note(line)
    return None


def _operations(noted: dict[str, list[NotedValues]]) -> Iterator[OperationNote]:
    """Yield operations, as they are written now or were by earlier versions."""
    for number, (_, values) in enumerate(noted.get("operation", []), 1):
        kind = OPERATION_KINDS.get(values[0].strip().lower())
        if kind is not None:
            read = (
                operation_notes.read(kind, values[1:])
                if "=" in values[-1]
                else _earlier(kind, values[1:], _EarlierNotes(noted, number))
            )
            if read is not None:
                yield OperationNote(kind, tuple(read.items()))


class _EarlierNotes:
    """What comments beside that of the N-th operation told of it in programs of earlier versions."""

    def __init__(self, noted: dict[str, list[NotedValues]], number: int) -> None:
        self._told, self._number = noted, number

    def numbers(self, key: str, count: int) -> list[float]:
        """Return the numbers behind the operation's own; none where there are not so many."""
        lists = (_floats(values) for _, values in self._told.get(key, []))
        return next((numbers[1:] for numbers in lists if len(numbers) == count + 1 and numbers[0] == self._number), [])

    def layers(self) -> tuple[str, ...]:
        """Return the layers that it alone machines."""
        named = (values for _, values in self._told.get("operation_layer", []) if values[0].strip().isdecimal())
        return tuple(_name(values[1:]) for values in named if int(values[0]) == self._number)


def _earlier(kind: type[Operation], values: list[str], beside: _EarlierNotes) -> dict[str, Any] | None:
    """Return the parameters of an operation that is told as tool, depth, stock to leave, and the side of a contour."""
    numbers, side = _floats(values[:3]), [value.strip().lower() for value in values[3:]]
    sides = {each.value: each for each in Side}
    if len(numbers) != 3 or len(side) > 1 or not set(side) <= sides.keys():
        return None
    noted: dict[str, Any] = {"tool": int(numbers[0]), "depth": numbers[1], "curves": on_layers(beside.layers())}
    (left,), (lead,) = (beside.numbers(key, 1) or [0.0] for key in ("floor_to_leave_mm", "leads_mm"))
    least, most, through = beside.numbers("holes_mm", 3) or [0.0] * 3
    noted |= {"stock_to_leave": numbers[2], "floor_to_leave": left, "side": sides[side[0]] if side else Side.INSIDE}
    noted |= {
        "lead_radius": min(lead, LONGEST_LEAD) or None,
        "least": least or None,
        "most": most or None,
        "through": through,
    }
    return {key: value for key, value in noted.items() if key in parameters_of(kind)}


def _copies(noted: list[NotedValues]) -> Copies | None:
    """Return the copies of the part; None where nothing is told that can be."""
    for _, values in noted:
        numbers = _floats(values)
        if len(numbers) == 4:
            with suppress(ParameterError):
                return Copies(int(numbers[0]), int(numbers[1]), numbers[2], numbers[3])
    return None


def _tabs(noted: list[NotedValues]) -> Iterator[Tab]:
    """Yield tabs: five numbers, and a sixth one, 0, where what they hold is waste; earlier versions wrote none."""
    for _, values in noted:
        numbers = _floats(values)
        if len(numbers) in (5, 6):
            x, y, width, top, diameter = numbers[:5]
            yield Tab(x, y, width, top, diameter, holds_part=len(numbers) == 5 or numbers[5] != 0)


def _fives(noted: list[NotedValues]) -> Iterator[list[float]]:
    """Yield values that are five numbers."""
    return (numbers for _, values in noted if len(numbers := _floats(values)) == 5)


def _units(noted: list[NotedValues]) -> Units | None:
    names = [values[0].strip().upper() for _, values in noted]
    return next((Units[name] for name in names if name in Units.__members__), None)


def _triple(values: list[str]) -> tuple[float, float, float] | None:
    numbers = _floats(values)
    return (numbers[0], numbers[1], numbers[2]) if len(numbers) == 3 else None


def _first(noted: list[NotedValues]) -> float | None:
    return next((numbers[0] for _, values in noted if len(numbers := _floats(values)) == 1), None)


def _name(values: list[str]) -> str:
    """Return a name as it was before it was spelled in safe characters."""
    return unspelled(",".join(values).strip())


def _floats(values: list[str]) -> list[float]:
    """Return plain numbers; none at all where one of the values is not."""
    plain = [value.strip() for value in values]
    return (
        [float(value) for value in plain]
        if all(re.fullmatch(r"-?\d{1,9}(\.\d{1,9})?", value) for value in plain)
        else []
    )


# Where comments stand in a program, and the lengths that they tell. All patterns are bounded, so no text can hang
# them.


LONGEST = 400
"""Characters of a comment that are looked at."""

MOST_HITS = 1000
"""Places of one word that are looked at."""

MOST_BYTES = 1 << 25
"""How much of a program is looked at."""

NUMBER = r"(?:\d{1,3}[ -])?\d{1,3}/\d{1,3}(?![\d/])|\d{1,7}(?:\.(?!\.)\d{0,9})?|\.\d{1,9}"

UNIT = r"""mm\b|millim\w{0,7}|cm\b|inch(?:es)?\b|in\b|"|''|″"""

LENGTH = rf"({NUMBER})\s{{0,3}}({UNIT})?"
"""Two groups: number and unit, for `length_mm`."""

_GOES_ON = {b".", *(b"%d" % digit for digit in range(10))}


def length_mm(number: str, unit: str | None, program_mm: float) -> float:
    """Return a length in mm; without a unit, a fraction is in inches and any other number in the program's unit.

    Args:
        number: "6", ".5", "1/4", "1-1/4".
        unit: "mm", "in", '"' and the like, or None.
        program_mm: mm of the program's unit.
    """
    whole, _, rest = number.replace("-", " ").rpartition(" ")
    above, _, below = rest.partition("/")
    divisor = float(below or 1)
    value = float(whole or 0) + float(above) / divisor if divisor else 0.0
    sign = (unit or "").lower()
    if sign.startswith(("mm", "milli")):
        return value
    if sign == "cm":
        return value * 10.0
    return value * (25.4 if sign or below else program_mm)


Three = list[float]
"""X, Y and Z, mm."""


def _unknown() -> Three:
    return [math.nan] * 3


@dataclass
class StockBoxNote:
    """A box as far as it is told, mm: corners and size, NaN where they are not."""

    low: Three = field(default_factory=_unknown)
    high: Three = field(default_factory=_unknown)
    size: Three = field(default_factory=_unknown)

    def is_known(self) -> bool:
        """Whether anything is."""
        return any(not math.isnan(value) for value in (*self.low, *self.high, *self.size))

    def merged(self, other: StockBoxNote) -> StockBoxNote:
        """Return the box with what another tells beside it."""
        return StockBoxNote(
            *(
                [b if math.isnan(a) else a for a, b in zip(mine, theirs, strict=True)]
                for mine, theirs in ((self.low, other.low), (self.high, other.high), (self.size, other.size))
            )
        )

    def note(self, line: int) -> StockNote:
        """Return the note, with what follows: of low, high and size two give the third."""
        low, high, size = list(self.low), list(self.high), list(self.size)
        for k in range(3):
            size[k] = high[k] - low[k] if math.isnan(size[k]) else size[k]
            low[k] = high[k] - size[k] if math.isnan(low[k]) else low[k]
            high[k] = low[k] + size[k] if math.isnan(high[k]) else high[k]
        return StockNote((low[0], low[1], low[2]), (high[0], high[1], high[2]), (size[0], size[1], size[2]), line)


@dataclass(frozen=True)
class Comments:
    """A program whose comments are asked for by the words in them.

    Attributes:
        data: bytes, lines ended by line feeds.
        lower: the same in lower case.
        encoding: of the bytes.
    """

    data: bytes
    lower: bytes
    encoding: str

    def places(self, words: tuple[bytes, ...], most: int = MOST_HITS) -> Iterator[int]:
        """Yield where words stand, lower case; not more than `most` of each."""
        for word in words:
            at = self.lower.find(word)
            for _ in range(most):
                if at < 0:
                    break
                yield at
                at = self.lower.find(word, at + len(word))

    def around(self, at: int) -> tuple[int, int] | None:
        """Return the begin and end of the comment's text that a place is in, None where it is in none."""
        begin = self.line_begin(at)
        before = self.data[begin:at]
        semicolon, bracket = before.find(b";"), before.rfind(b"(")
        if semicolon >= 0 and (bracket < 0 or semicolon < bracket):
            return begin + semicolon + 1, self.line_end(at)
        if bracket < 0 or b")" in before[bracket:]:
            return None
        close = self.data.find(b")", at, self.line_end(at))
        return begin + bracket + 1, close if close >= 0 else self.line_end(at)

    def texts(self, words: tuple[bytes, ...], most: int = MOST_HITS) -> Iterator[tuple[int, str]]:
        """Yield each comment that has one of the words, once: where it begins, and its text; looks at `most` places of
        each.
        """
        seen = set()
        for at in self.places(words, most):
            place = self.around(at)
            if place is not None and place[0] not in seen:
                seen.add(place[0])
                yield place[0], self.text(*place)

    def text(self, begin: int, end: int) -> str:
        """Return a stretch of the program."""
        return self.data[begin : min(end, begin + LONGEST)].decode(self.encoding, "replace")

    def line_begin(self, at: int) -> int:
        """Return where the line begins, but not more than `LONGEST` before a place."""
        return max(self.data.rfind(b"\n", max(0, at - LONGEST), at) + 1, at - LONGEST, 0)

    def line_end(self, at: int) -> int:
        """Return where the line ends, but not more than `LONGEST` after a place."""
        end = self.data.find(b"\n", at, at + LONGEST)
        return end if end >= 0 else min(len(self.data), at + LONGEST)

    def line(self, at: int) -> int:
        """Return the 1-based number of a place's line."""
        return self.data.count(b"\n", 0, at) + 1


class ProgramUnits:
    """What a length of the program means, place by place: G20 and G21 outside of comments."""

    def __init__(self, comments: Comments, unnamed: Units) -> None:
        """Look for the changes of units; `unnamed` are those of a program that names none."""
        self._unnamed = unnamed.value
        found = sorted(at for at in comments.places((b"g20", b"g21")) if self._changes(comments, at))
        self._at = found
        self._mm = [25.4 if comments.lower[at : at + 3] == b"g20" else 1.0 for at in found]

    @staticmethod
    def _changes(comments: Comments, at: int) -> bool:
        """Tell whether a word is G20 or G21, not G210 or G20.1, and not in a comment."""
        return comments.lower[at + 3 : at + 4] not in _GOES_ON and comments.around(at) is None

    def mm_at(self, at: int) -> float:
        """Return the mm of a unit: by the change before a place, else by the first after it, else as unnamed."""
        if not self._at:
            return self._unnamed
        return self._mm[max(0, bisect.bisect(self._at, at) - 1)]
