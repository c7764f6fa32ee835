"""DXF drawings."""

from __future__ import annotations

from functools import partial

from ...model.part import Part
from ...model.reading import ReadingOptions
from ..drawing import Drawing, WrittenDrawing
from ..registry import DrawingFormat, FormatWriter

_VERSIONS = {
    "R2010": "DXF, AutoCAD 2010 and later",
    "R2018": "DXF 2018",
    "R2013": "DXF 2013",
    "R2007": "DXF 2007",
    "R2004": "DXF 2004",
    "R2000": "DXF 2000",
    "R12": "DXF R12, lines and arcs alone",
}


def _read(name: str, data: bytes, reading: ReadingOptions) -> Drawing:
    from .dxf import read_dxf

    return read_dxf(data, name, reading.units, reading.layers, reading.how)


def _write(version: str, part: Part) -> WrittenDrawing:
    from .write import DxfVersion, dxf_bytes

    return dxf_bytes(part, DxfVersion[version])


DXF = DrawingFormat(
    (".dxf",),
    _read,
    takes=frozenset({"layout", "without_types", "to_zero"}),
    foreign=True,
    writers=tuple(FormatWriter(version, words, partial(_write, version)) for version, words in _VERSIONS.items()),
)
