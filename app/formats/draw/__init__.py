"""Texts of the shape language, `.draw` files."""

from __future__ import annotations

from ...model.part import Part
from ...model.reading import ReadingOptions
from ..drawing import Drawing, WrittenDrawing
from ..registry import DrawingFormat, FormatWriter


def _read(name: str, data: bytes, reading: ReadingOptions) -> Drawing:
    from .draw import read_draw

    return read_draw(data, name, reading.units, reading.layers)


def _write(part: Part) -> WrittenDrawing:
    from ...drafting.language.write import draw_text

    drawn = draw_text(part)
    return WrittenDrawing(drawn.text.encode(), too_small=drawn.left_out)


DRAW = DrawingFormat((".draw",), _read, writers=(FormatWriter(".draw", "Shape language", _write),))
