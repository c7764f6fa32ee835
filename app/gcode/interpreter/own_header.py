"""What the header of our own programs tells (`app.gcode.writer.header_notes`): a key and its values in each comment."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from contextlib import suppress
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
from ..note_texts import unspelled
from .notes_words import Comments, StockBoxNote
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
        origin,
        tuple(_operations(noted)),
        _units(noted.get("drawing_units", [])),
        tuple(_name(values) for _, values in noted.get("layer", [])),
        _first(noted.get("join_tolerance_mm", [])),
        _first(noted.get("path_tolerance_mm", [])),
        _first(noted.get("allowance_mm", [])),
        _copies(noted.get("copies", [])),
        KeepOutNote(
            tuple(_name(values) for _, values in noted.get("keep_out", [])),
            _first(noted.get("keep_out_height_mm", [])) or 0.0,
        ),
        tuple(Tab(*numbers) for numbers in _fives(noted.get("tab", []))),
        tuple(DogBone(*numbers) for numbers in _fives(noted.get("dog_bone", []))),
        _reading(noted),
        tuple(
            PlungeRateNote(int(numbers[0]), numbers[1])
            for _, values in noted.get("plunge_mm_min", [])
            if len(numbers := _floats(values)) == 2
        ),
        max(_first(noted.get("under_mm", [])) or 0.0, 0.0),
        max(_first(noted.get("above_mm", [])) or 0.0, 0.0),
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
