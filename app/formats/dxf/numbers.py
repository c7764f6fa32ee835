"""Numbers in the text of a DXF that are none for a parser: decimal commas are read as points, anything else is refused
by line.

A reader that repairs files takes such numbers up to the first letter that it does not know, so that 40,9 becomes 40: a
part of the wrong size. So they are looked at before.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from ...core.errors import InputError

_COMMA = re.compile(rb"\s*[-+]?\d*,\d+(?:[eE][-+]?\d+)?\s*\Z")
_THOUSANDS = re.compile(rb"\s*[-+]?[1-9]\d{0,2},\d{3}\s*\Z")
"""May be a thousand and more, or one and a bit."""
_COORDINATES = (*range(10, 60), *range(210, 240))
"""Group codes of what an entity measures: coordinates, lengths, angles, directions."""
_MEASURED = frozenset((*_COORDINATES, *range(140, 150), *range(1010, 1060)))
_READ = frozenset(b"LINE ARC CIRCLE ELLIPSE LWPOLYLINE POLYLINE VERTEX SPLINE INSERT TEXT MTEXT HATCH POINT".split())
"""Entities that are read; what others say of themselves is not needed."""
_LINE_END = re.compile(rb"\r\n|\n|\r")


@dataclass(frozen=True, slots=True)
class DecimalCommas:
    """What a text reads as.

    Attributes:
        data: the file with points in place of decimal commas.
        count: how many there were. line, value: of the first, 1-based, as written.
    """

    data: bytes
    count: int = 0
    line: int = 0
    value: str = ""


NO_COMMAS = DecimalCommas(b"")


def with_points(data: bytes, name: str) -> DecimalCommas:
    """Return a text DXF with points in place of decimal commas.

    Args:
        data: the whole file, no binary DXF.
        name: for messages.

    Raises:
        InputError: a coordinate is no number, or may be a number of thousands as well, with line and value.
    """
    lines = _LINE_END.split(data)
    doubtful, commas, points = 0, [], False
    for number, code in _values(lines):
        value = lines[number]
        if _COMMA.match(value):
            commas.append(number)
            doubtful = doubtful or (number + 1 if _THOUSANDS.match(value) else 0)
        elif code in _COORDINATES and not _is_number(value):
            raise InputError(
                f"{name}:{number + 1}: the value {_shown(value)} is no number, so what is drawn there is not known; "
                "save the drawing again from the CAD program."
            )
        points |= b"." in value
    if doubtful and points and all(_THOUSANDS.match(lines[k]) for k in commas):
        raise InputError(
            f"{name}:{doubtful}: the value {_shown(lines[doubtful - 1])} has a comma and others have points, so it "
            "may be thousands or a fraction; save the drawing again with points as decimal signs."
        )
    if not commas:
        return DecimalCommas(data)
    first, value = commas[0] + 1, _shown(lines[commas[0]])
    for number in commas:
        lines[number] = lines[number].replace(b",", b".")
    return DecimalCommas(b"\n".join(lines), len(commas), first, value)


def _values(lines: list[bytes]) -> Iterator[tuple[int, int]]:
    """Yield index and group code, 0 in what is not drawn, of the lines that hold numbers; to where codes and values
    lose their step.
    """
    section = entity = b""
    for number in range(1, len(lines), 2):
        try:
            code = int(lines[number - 1])
        except ValueError:
            return
        if code == 2 and lines[number - 2].strip().upper() == b"SECTION":
            section = lines[number].strip().upper()
        entity = lines[number].strip().upper() if code == 0 else entity
        if code in _MEASURED and section in (b"ENTITIES", b"BLOCKS", b"OBJECTS", b"HEADER", b"TABLES"):
            yield number, code if section in (b"ENTITIES", b"BLOCKS") and entity in _READ else 0


def _is_number(value: bytes) -> bool:
    try:
        float(value)
    except ValueError:
        return False
    return True


def _shown(value: bytes) -> str:
    text = value.strip().decode("utf-8", "replace")
    return repr(text if len(text) <= 60 else f"{text[:60]}…")
