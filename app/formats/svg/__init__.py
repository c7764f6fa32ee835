"""SVG drawings."""

from __future__ import annotations

from dataclasses import replace

from ...model.part import Part
from ...model.reading import ReadingOptions
from ..drawing import Drawing, WrittenDrawing
from ..registry import DrawingFormat, FormatWriter


def _read(name: str, data: bytes, reading: ReadingOptions) -> Drawing:
    from .svg import read_svg

    return read_svg(data, name, reading.units, reading.layers, reading.how)


def _write(part: Part) -> WrittenDrawing:
    from .write import svg_bytes

    return svg_bytes(part)


SVG = DrawingFormat(
    (".svg",),
    _read,
    takes=frozenset({"to_zero", "pixels_per_inch"}),
    foreign=True,
    scaled_page=True,
    writers=(FormatWriter(".svg", "SVG", _write),),
)

SVGZ = replace(SVG, suffixes=(".svgz",), writers=())
"""The same, compressed, which is read alone."""
