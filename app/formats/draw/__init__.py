"""Texts of the shape language, `.draw` files."""

from __future__ import annotations

from ...model.part import Part
from ...model.reading import Reading
from ..drawing import Drawing, Written
from ..registry import DrawingFormat, Writer


def _read(name: str, data: bytes, reading: Reading) -> Drawing:
    from .draw import read_draw

    return read_draw(data, name, reading.units, reading.layers)


def _write(part: Part) -> Written:
    from ...drafting.language.write import draw_text

    drawn = draw_text(part)
    return Written(drawn.text.encode(), too_small=drawn.left_out)


DRAW = DrawingFormat((".draw",), _read, writers=(Writer(".draw", "Shape language", _write),))
