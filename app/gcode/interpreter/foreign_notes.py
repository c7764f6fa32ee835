"""A tool, and the stock, out of the text of a comment, in the habits of CAM systems and of people."""

from __future__ import annotations

import math
import re

from .own_header import LENGTH, NUMBER, UNIT, StockBoxNote, Three, length_mm
from .program import ToolNote

LARGEST_MM = 500.0
"""Diameter; a larger number in a comment is that of something else."""

_ANY = re.IGNORECASE

_SEP = r"\s{0,3}[-=:]?\s{0,3}"

_KINDS = tuple(
    (re.compile(pattern, _ANY), kind)
    for pattern, kind in (
        (
            r"\btap\b|thread|form ?(?:mill|tool)|lollipop|dovetail|probe|reamer|boring|lathe|turning|torch|laser"
            r"|taper(?:ed)? mill",
            "",
        ),
        (r"\bball|\bspher", "ball"),
        (r"\bbull|toroid", "bull"),
        (r"spot|cent(?:er|re) ?drill", "drill"),
        (r"chamfer|engrav|\bv[ _-]?(?:bit|carve|cutt|tool|mill|groove)|\bvee|counter ?sink|conical|\bv\b", "v"),
        (r"drill|bohrer", "drill"),
        (
            r"end ?mill|\bflat|square|cylindri|face ?mill|slot|straight|router|schaftfr|compression|(?:up|down) ?cut",
            "flat",
        ),
    )
)

_SHAPE = r"(?:flat|ball|bull|v[ -]?bit|square|spot|face|end|drill|chamfer|cent(?:er|re))"

_NUMBERS = tuple(
    re.compile(pattern, _ANY)
    for pattern in (
        r"(?<![a-z])t\s?0{0,3}(\d{1,4})\b(?!\.\d)",
        r"""\btool\s{0,2}(?:number|no\.?|num|#|-|:|=)?\s{0,2}0{0,3}(\d{1,4})\b(?!\s{0,2}(?:\.|/|mm\b|in\b|inch|"|-?flute|dia(?!\D{0,6}\d)))""",
        r"\bnumber\s?=\s?0{0,3}(\d{1,4})\b",
        r"#0{0,3}(\d{1,4})\b",
        r"^\s{0,9}0{0,3}(\d{1,4})\s?=\s?[a-z]",
    )
)

_DIAMETERS = tuple(
    (re.compile(pattern, _ANY), factor)
    for pattern, factor in (
        (rf"(?<![a-z_])d\s?=\s?{LENGTH}", 1.0),
        (
            r"(?<!shank)(?<!shank[ _])(?<!shaft)(?<!shaft[ _])(?<!handle)(?<![a-z])"
            rf"dia(?:m(?:eter)?)?\b\.?{_SEP}{LENGTH}",
            1.0,
        ),
        (rf"[Øø⌀]\s?{LENGTH}", 1.0),
        (rf"\b(?:tool|cutter|bit|mill)[ _]?(?:dia(?:m(?:eter)?)?){_SEP}{LENGTH}", 1.0),
        (rf"\b(?:tool|cutter|bit|mill)[ _]?radius{_SEP}{LENGTH}", 2.0),
        (rf"{LENGTH}\s{{0,3}}-?dia(?:m(?:eter)?)?\b", 1.0),
    )
)

_NO_DIAMETER = (
    rf"(?![\d./])(?!\s{{0,3}}(?:{UNIT})?\s{{0,3}}-?"
    r"(?:shank|shaft|long|length|deep|rad|flute|loc\b|fl\b|stick|corner|deg|°))"
)

_SIZED = re.compile(rf"(?<![\w.#/])(?<![a-z]-){LENGTH}{_NO_DIAMETER}", _ANY)

_BEFORE_SHAPE = re.compile(rf"(?<![\w.#/]){LENGTH}\s{{0,3}}{_SHAPE}", _ANY)

_SHORT_D = re.compile(rf"(?<!\w)d{LENGTH}", _ANY)

_CORNER = re.compile(rf"(?:\bcr|corner[ _]?rad(?:ius)?|torus_radius|nose[ _]?rad(?:ius)?){_SEP}{LENGTH}", _ANY)

_SHORT_R = re.compile(rf"(?<!\w)r\s?{LENGTH}", _ANY)

_TAPER = re.compile(r"taper\s?=\s?(\d{1,3}(?:\.\d{1,4})?)", _ANY)

_ANGLE = re.compile(r"(\d{1,3}(?:\.\d{1,4})?)\s{0,2}-?(?:deg|°|º)|angle\s{0,2}[=:]\s{0,2}(\d{1,3}(?:\.\d{1,4})?)", _ANY)

_NAMED = re.compile(r"tool|cutter|end ?mill|mill\b|\bbit|drill bit|\b[tT]\s?\d|^\s{0,9}\d{1,4}\s?=", _ANY)

_OF_THE_WORK = re.compile(
    r"depth|deep|hole|step|stock|pocket|within|above|below|clearance|height|length of|rapid|probe", _ANY
)


def tool_of(text: str, program_mm: float, at_change: bool) -> ToolNote:
    """Return what a comment tells of a tool; nothing told is 0 and "".

    Args:
        text: of the comment, not longer than `LONGEST`.
        program_mm: mm of the program's unit.
        at_change: the comment stands at a tool change, so that a bare size is a diameter.
    """
    kind, (number, rest) = _kind(text), _number(text)
    diameter = (
        _diameter(rest, program_mm, bool(kind), at_change)
        if at_change or _NAMED.search(text)
        else _worded(rest, program_mm)
    )
    corner = _first(_CORNER, text, program_mm)
    if kind == "bull" and not corner:
        corner = _first(_SHORT_R, text, program_mm)
    if kind == "flat" and corner and "cylindr" not in text.lower():
        kind = "bull"
    return ToolNote(number, kind, diameter, corner, _angle(text, kind))


def _kind(text: str) -> str:
    return next((kind for pattern, kind in _KINDS if pattern.search(text)), "")


def _number(text: str) -> tuple[int, str]:
    """Return the tool's number, 0 = none, and the text without it."""
    for pattern in _NUMBERS:
        match = pattern.search(text)
        if match:
            return int(match[1]), f"{text[: match.start()]} | {text[match.end() :]}"
    return 0, text


def _worded(text: str, program_mm: float) -> float:
    """Return the diameter that a word says to be one, or twice the radius."""
    found = (factor * _first(pattern, text, program_mm) for pattern, factor in _DIAMETERS)
    return next((value for value in found if value), 0.0)


def _diameter(text: str, program_mm: float, shaped: bool, at_change: bool) -> float:
    """Return the diameter by its word; else by a size in a text that speaks of the tool and not of the work."""
    value = _worded(text, program_mm)
    if value or _OF_THE_WORK.search(text):
        return value
    sizes = (match for match in _SIZED.finditer(text) if match[2] or (at_change and "/" in match[1]))
    value = next((length for match in sizes if (length := _length(match, program_mm))), 0.0)
    value = value or _first(_BEFORE_SHAPE, text, program_mm)
    return value or (_first(_SHORT_D, text, program_mm) if shaped else 0.0)


def _first(pattern: re.Pattern[str], text: str, program_mm: float) -> float:
    match = pattern.search(text)
    return _length(match, program_mm) if match else 0.0


def _length(match: re.Match[str], program_mm: float) -> float:
    value = length_mm(match[1], match[2], program_mm)
    return value if 0.0 < value <= LARGEST_MM else 0.0


def _angle(text: str, kind: str) -> float:
    """Return the full angle of the tip; TAPER of a chamfer mill is half of it."""
    taper, angle = _TAPER.search(text), _ANGLE.search(text)
    degrees = 0.0
    if taper:
        degrees = float(taper[1]) * {"v": 2.0, "drill": 1.0}.get(kind, 0.0)
    elif angle and kind in ("v", "drill"):
        degrees = float(angle[1] or angle[2])
    return math.radians(degrees) if degrees < 180.0 else 0.0


# The stock out of the text of a comment.


_SIGNED = rf"([-+]?)\s?({NUMBER})\s{{0,3}}({UNIT})?"

_TIMES = r"\s{0,3}(?:x|\*|\u00d7|by)\s{0,3}"

_WORD = r"[xyz]?\s{0,2}[=:]?\s{0,2}"

_SIZE = re.compile(rf"(?<![\w.])[x]?\s?{_SIGNED}{_TIMES}{_WORD}{_SIGNED}{_TIMES}{_WORD}{_SIGNED}", re.IGNORECASE)

_TO = r"\s{0,3}(?:to|\.\.\.?|…)\s{0,3}"

_AXIS = re.compile(rf"(?<![a-z])([xyz])\s{{0,2}}[=:]?\s{{0,2}}{_SIGNED}(?:{_TO}[xyz]?\s?{_SIGNED})?", re.IGNORECASE)

_TOP = re.compile(
    rf"top of (?:the )?(?:stock|material|workpiece)\b[^()]{{0,20}}?z\s{{0,2}}[=:]?\s{{0,2}}{_SIGNED}", re.IGNORECASE
)

_BOUND = re.compile(rf"(min|max)([xyz])\s?=\s?{_SIGNED}", re.IGNORECASE)


def box_of(text: str, program_mm: float) -> StockBoxNote:
    """Return what a comment about the stock tells.

    Args:
        text: not longer than `LONGEST`.
        program_mm: mm of the program's unit.
    """
    top = _TOP.search(text)
    if top:
        return StockBoxNote(high=[math.nan, math.nan, _signed(top.groups(), program_mm)])
    size = _SIZE.search(text)
    if size:
        return StockBoxNote(size=_sizes(size.groups(), program_mm))
    return _by_axes(text, program_mm)


def bounds_of(text: str) -> StockBoxNote:
    """Return the box of PyCAM's settings: minx = ..., maxz = ..., in mm."""
    box = StockBoxNote()
    for end, axis, *number in _BOUND.findall(text):
        (box.low if end.lower() == "min" else box.high)["xyz".index(axis.lower())] = _signed(number, 1.0)
    return box


def _signed(groups: tuple[str | None, ...] | list[str], program_mm: float) -> float:
    """Return the value of a sign, a number and a unit."""
    sign, number, unit = groups
    value = length_mm(number or "0", unit or None, program_mm)
    return -value if sign == "-" else value


def _sizes(groups: tuple[str | None, ...], program_mm: float) -> Three:
    """Return three sizes; a unit behind the last one holds for those that have none."""
    last = groups[8]
    return [abs(_signed((*groups[k : k + 2], groups[k + 2] or last), program_mm)) for k in (0, 3, 6)]


def _by_axes(text: str, program_mm: float) -> StockBoxNote:
    """Return the box by X, Y, Z words: ranges or two of each are corners; one of each is a size, unless one is <= 0."""
    values: list[Three] = [[], [], []]
    for match in _AXIS.finditer(text):
        found = match.groups()
        axis = "xyz".index((found[0] or "").lower())
        values[axis].append(_signed(found[1:4], program_mm))
        if found[5] is not None:
            values[axis].append(_signed(found[4:7], program_mm))
    if not all(values):
        return StockBoxNote()
    if all(len(of_axis) >= 2 for of_axis in values):
        return StockBoxNote(low=[min(of_axis) for of_axis in values], high=[max(of_axis) for of_axis in values])
    firsts = [of_axis[0] for of_axis in values]
    return StockBoxNote(size=firsts) if min(firsts) > 0 else StockBoxNote(low=firsts)
