"""Curves and notes of a project file, one a line: in the words of the shape language, and exact to the last digit.

A line `#17` gives the next one its number; without it a line's number is one more than that of the line before. A line
`layer "name"` puts what follows on a layer, and `layer "name" letters` says that it is strokes of letters, which bound
nothing. An ellipse is written by its ratio and a part of it by radians, because the language's own form would round
them.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from itertools import pairwise
from typing import Generic, NamedTuple, TypeVar

from ...core.errors import InputError
from ...model.curves import Arc, Circle, Curve, Ellipse, Line, Point, Spline
from ...model.notes import Dimension, DimensionKind, Guide, Mark, Note, Shape
from ...model.part import Entity

MOST_THINGS = 500_000
"""Curves and notes together; more than any drawing, and few enough for the memory."""

FARTHEST = 1e15
"""No number of a curve is greater; what the language draws ends far below, and a window can show it."""

_HIGHEST, _MOST_TURN = 10**12, 100.0
"""The largest number of a curve, and how far an ellipse may turn, radians."""

Made = TypeVar("Made")
_LAYER, _LETTERS = "layer ", " letters"


class TextBlock(NamedTuple):
    """Lines of curves or notes in a file: its name, the number of the first line, and the lines; places for errors."""

    file: str
    first_line: int
    text: str


class _NumberedLine(NamedTuple):
    """A curve or note as it is written: its number, the line that names its layer, its own line."""

    number: int
    layer: str
    text: str


class _ReadShape(NamedTuple, Generic[Made]):
    """A curve or a note as it was read; `lettering`: it is a stroke of a letter."""

    number: int
    shape: Made
    layer: str
    lettering: bool


def curve_lines(entities: Iterable[Entity]) -> Iterator[str]:
    """Yield the lines of curves."""
    return _lines(
        _NumberedLine(entity.id, _sheet(entity.layer, entity.lettering), _curve_text(entity.curve))
        for entity in entities
    )


def note_lines(notes: Iterable[Note]) -> Iterator[str]:
    """Yield the lines of notes."""
    return _lines(_NumberedLine(note.id, _sheet(note.layer), _note_text(note.shape)) for note in notes)


def read_curves(block: TextBlock) -> tuple[Entity, ...]:
    """Return the curves of lines that `curve_lines` has written.

    Raises:
        InputError: the first line that is no curve.
    """
    return tuple(Entity(*found) for found in _read(block, _CURVES))


def read_notes(block: TextBlock) -> tuple[Note, ...]:
    """Return the notes of lines that `note_lines` has written; errors as for `read_curves`."""
    return tuple(Note(each.number, each.shape, each.layer) for each in _read(block, _NOTES))


def _lines(things: Iterable[_NumberedLine]) -> Iterator[str]:
    before, current = 0, None
    for number, sheet, text in things:
        if sheet != current:
            current = sheet
            yield sheet
        if number != before + 1:
            yield f"#{number}"
        before = number
        yield text


def _sheet(layer: str, lettering: bool = False) -> str:
    return _LAYER + _quoted(layer) + _LETTERS * lettering


def _quoted(name: str) -> str:
    """Return a name in double quotes, on one line and without single quotes, whatever is in it."""
    return json.dumps(name, ensure_ascii=not name.isprintable()).replace("'", "\\u0027")


def _number(value: float) -> str:
    if not abs(value) <= FARTHEST:
        raise InputError(f"A curve or a note goes to {value:g} mm, and a project holds up to {FARTHEST:g}; delete it.")
    return repr(float(value)).removesuffix(".0")


def _point(point: Point) -> str:
    return f"{_number(point[0])},{_number(point[1])}"


def _curve_text(curve: Curve) -> str:
    turn = "" if getattr(curve, "ccw", True) else " cw"
    match curve:
        case Line():
            return f"line {_point(curve.start)} {_point(curve.end)}"
        case Arc():
            return f"arc {_point(curve.start)} {_point(curve.end)} centre {_point(curve.centre)}{turn}"
        case Circle():
            return f"circle {_point(curve.centre)} {_number(curve.radius)}{turn}"
        case Ellipse():
            ends = (curve.start_parameter, curve.end_parameter)
            part = "" if ends == (0.0, math.tau) else f" from {_number(ends[0])}rad to {_number(ends[1])}rad"
            return f"ellipse {_point(curve.centre)} @{_point(curve.major)} ratio {_number(curve.ratio)}{part}{turn}"
        case Spline():
            words = [
                "spline degree",
                str(curve.degree),
                *map(_point, curve.control_points),
                "knots",
                *map(_number, curve.knots),
            ]
            return " ".join(words + (["weights", *map(_number, curve.weights)] if curve.weights else []))


def _note_text(shape: Shape) -> str:
    match shape:
        case Mark():
            return f"point {_point(shape.at)}"
        case Guide():
            return f"guide {_point(shape.through)} {_number(shape.angle)}rad"
        case Dimension():
            return " ".join(
                ["dimension", shape.measure.value, *map(_point, shape.points), "place", _point(shape.place)]
            )


def _read(block: TextBlock, readers: Mapping[str, Callable[[list[str]], Made]]) -> Iterator[_ReadShape[Made]]:
    """Yield what every line says."""
    name = block.file
    number, layer, lettering, used = 0, "0", False, set[int]()
    for row, line in enumerate(block.text.split("\n"), block.first_line):
        try:
            if line.startswith("#"):
                number = int(line[1:]) - 1
            elif line.startswith(_LAYER):
                layer, lettering = _layer(line)
            elif line:
                word, *rest = line.removesuffix("\r").split(" ")
                number += 1
                made = readers[word](rest)
                if not 0 < number < _HIGHEST or number in used:
                    raise InputError(f"{name}:{row}: number {number} is there twice, or is too large or none; {REMEDY}")
                used.add(number)
                if len(used) > MOST_THINGS:
                    raise InputError(f"{name}:{row}: the drawing has more than {MOST_THINGS} curves; part it.")
                yield _ReadShape(number, made, layer, lettering)
        except (KeyError, ValueError, IndexError, TypeError) as error:
            raise InputError(f"{name}:{row}: '{line[:60]}' cannot be read ({_why(error)}); {REMEDY}") from error


REMEDY = "mend the line, or open a backup of the file."


def _why(error: Exception) -> str:
    return (
        f"{error} is no word for it"
        if isinstance(error, KeyError)
        else "numbers are missing"
        if isinstance(error, IndexError)
        else str(error)
    )


def _layer(line: str) -> tuple[str, bool]:
    name, end = json.JSONDecoder().raw_decode(line, len(_LAYER))
    rest = line[end:].rstrip()
    if not isinstance(name, str):
        raise ValueError("a layer's name stands in quotes")
    _expect(rest in ("", _LETTERS), f"{rest.strip()} is too much")
    return name, rest == _LETTERS


def _value(text: str) -> float:
    value = float(text)
    if not abs(value) <= FARTHEST:
        raise ValueError(f"{text} is no length, or larger than {FARTHEST:g}")
    return value


def _xy(text: str) -> Point:
    x, y = text.split(",")
    return _value(x), _value(y)


def _expect(true: bool, what: str) -> None:
    if not true:
        raise ValueError(what)


def _ccw(rest: list[str]) -> bool:
    _expect(rest in ([], ["cw"]), f"{' '.join(rest)} is too much")
    return not rest


def _line(words: list[str]) -> Line:
    _expect(len(words) == 2, "a line has two points")
    return Line(_xy(words[0]), _xy(words[1]))


def _arc(words: list[str]) -> Arc:
    _expect(words[2] == "centre", "centre is missing")
    return Arc(_xy(words[0]), _xy(words[1]), _xy(words[3]), _ccw(words[4:]))


def _circle(words: list[str]) -> Circle:
    radius = _value(words[1])
    _expect(radius >= 0, "the radius is less than 0")
    return Circle(_xy(words[0]), radius, _ccw(words[2:]))


def _radians(text: str) -> float:
    _expect(text.endswith("rad"), f"{text} is no angle")
    return _value(text[:-3])


def _ellipse(words: list[str]) -> Ellipse:
    _expect(words[1][:1] == "@" and words[2] == "ratio", "an ellipse is: centre @major ratio number")
    centre, major, ratio, rest = _xy(words[0]), _xy(words[1][1:]), _value(words[3]), words[4:]
    _expect(0 < ratio <= 1 and major != (0.0, 0.0), "the ratio is not in (0, 1], or the axis has no length")
    if rest[:1] != ["from"]:
        return Ellipse(centre, major, ratio, ccw=_ccw(rest))
    first, last = _radians(rest[1]), _radians(rest[3])
    _expect(rest[2] == "to" and 0 < last - first <= _MOST_TURN, "the part is: from start to end, a few turns at most")
    return Ellipse(centre, major, ratio, first, last, _ccw(rest[4:]))


def _spline(words: list[str]) -> Spline:
    _expect(words[0] == "degree" and "knots" in words, "degree or knots are missing")
    at = words.index("knots")
    weighted = words.index("weights") if "weights" in words else len(words)
    degree, points = int(words[1]), tuple(map(_xy, words[2:at]))
    knots, weights = tuple(map(_value, words[at + 1 : weighted])), tuple(map(_value, words[weighted + 1 :]))
    _expect(
        1 <= degree < len(points) and len(knots) == len(points) + degree + 1,
        "points and knots do not go with the degree",
    )
    _expect(all(b >= a for a, b in pairwise(knots)) and knots[-1] > knots[0], "the knots fall")
    _expect(
        weighted == len(words) or (len(weights) == len(points) and min(weights) > 0),
        "each point wants a weight greater than 0",
    )
    return Spline(degree, points, knots, weights)


def _dimension(words: list[str]) -> Dimension:
    measure = DimensionKind(words[0])
    points = tuple(map(_xy, words[1:-2]))
    _expect(
        words[-2] == "place" and len(points) == (3 if measure is DimensionKind.ANGLE else 2),
        "points or place are missing",
    )
    return Dimension(measure, points, _xy(words[-1]))


def _mark(words: list[str]) -> Mark:
    _expect(len(words) == 1, "a point is one place")
    return Mark(_xy(words[0]))


def _guide(words: list[str]) -> Guide:
    _expect(len(words) == 2, "a guide is a point and an angle")
    return Guide(_xy(words[0]), _radians(words[1]))


_CURVES: Mapping[str, Callable[[list[str]], Curve]] = {
    "line": _line,
    "arc": _arc,
    "circle": _circle,
    "ellipse": _ellipse,
    "spline": _spline,
}
_NOTES: Mapping[str, Callable[[list[str]], Shape]] = {"point": _mark, "guide": _guide, "dimension": _dimension}
