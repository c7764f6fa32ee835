"""DXF out, R12 to R2018: every entity by itself and in order, layers with names, colours, visibility and lock."""

from __future__ import annotations

import io
import logging
import math
import re
from enum import Enum
from typing import Any

from ...core import tolerances
from ...geometry.affine import scaled, transformed
from ...model.curves import Arc, Circle, Curve, Ellipse, Line, Spline
from ...model.part import Layer, Part, Units
from ..drawing import WrittenDrawing
from ..drawing_conversions import Conversions, box_round
from .curves import polar
from .load import load_ezdxf


class DxfVersion(Enum):
    """Versions of DXF that can be written; the value is the word in the file."""

    R12 = "AC1009"
    R2000 = "AC1015"
    R2004 = "AC1018"
    R2007 = "AC1021"
    R2010 = "AC1024"
    R2013 = "AC1027"
    R2018 = "AC1032"


_CODES = {Units.MM: 4, Units.INCH: 1, Units.CM: 5, Units.M: 6, Units.FOOT: 2, Units.MICRON: 13}
"""$INSUNITS."""
_ANGLE = 1e-10
"""An ARC whose ends come back farther off than this, mm, becomes a polyline with a bulge, which keeps its ends."""
logging.getLogger("ezdxf").addHandler(logging.NullHandler())  # it would warn that R12 has no units
_FORBIDDEN = re.compile(r'[<>/\\":;?*|=`,\x00-\x1f\x7f\ud800-\udfff]')
_FORBIDDEN_OF_OLD = re.compile(r"[^\w$-]|[\ud800-\udfff]")
_BEYOND = re.compile("[\U00010000-\U0010ffff]")
"""Letters for which text before R2007 has no code."""
_LONGEST, _LONGEST_OF_OLD = 255, 31
"""Letters of the name of a layer, since R2000 and in R12."""
_INK = 7
"""The colour that is black or white as the ground demands."""


def dxf_bytes(
    part: Part, version: DxfVersion = DxfVersion.R2010, tolerance: float = tolerances.CURVE
) -> WrittenDrawing:
    """Return the part as a DXF text file.

    All curves are kept to rounding, but for R12, which has neither ellipses nor splines: there each becomes one
    polyline of lines and arcs within `tolerance`, mm. Arcs, circles and ellipses run counter-clockwise, as DXF has it.
    Coordinates are in the part's units, which the header names; R12 cannot name units and is in mm. Colours are exact
    since R2004, the nearest of AutoCAD's index before. Names that the version forbids are changed, and listed.

    Raises:
        GeometryError: a curve cannot be followed in R12.
    """
    load_ezdxf()
    from ezdxf.filemanagement import new

    part, old = part.with_entities(part.entities), version is DxfVersion.R12
    units = Units.MM if old else part.units
    document = new(version.name)
    if not old:
        document.header["$INSUNITS"] = _CODES[units]
        document.header["$MEASUREMENT"] = 0 if units in (Units.INCH, Units.FOOT) else 1
    document.layers.remove("Defpoints")
    names = _names(part.layers, version)
    for layer in part.layers:
        _add_layer(document, layer, names[layer.name], version)
    table = document.layers.entries
    for key in [document.layers.key(name) for name in names.values()]:  # layer 0, which every file has, takes its place
        table[key] = table.pop(key)
    pen, to_file = _DxfPen(document.modelspace(), old, tolerance), scaled(1 / units.value)
    for entity in part.entities:
        curve = entity.curve if units is Units.MM else transformed(entity.curve, to_file)
        if curve is not None:
            pen.draw(curve, {"layer": names[entity.layer]})
    _show_all(document, part, units)
    renamed = tuple((layer, name) for layer, name in names.items() if layer != name)
    return WrittenDrawing(_text(document), pen.conversions.converted, renamed, notes_left_out=len(part.notes))


def _names(layers: tuple[Layer, ...], version: DxfVersion) -> dict[str, str]:
    """Return for each layer a name that the version allows; in any case no two are alike."""
    forbidden, longest = (_FORBIDDEN_OF_OLD, _LONGEST_OF_OLD) if version is DxfVersion.R12 else (_FORBIDDEN, _LONGEST)
    names: dict[str, str] = {}
    taken: set[str] = set()
    for layer in layers:
        plain = forbidden.sub("_", layer.name)[:longest] or "_"
        plain = _BEYOND.sub("_", plain) if version.value < DxfVersion.R2007.value else plain
        name, number = plain, 1
        while name.casefold() in taken or (name == "0" and layer.name != "0"):
            number += 1
            name = f"{plain[: longest - len(str(number)) - 1]}_{number}"
        names[layer.name] = name
        taken.add(name.casefold())
    return names


def _add_layer(document: Any, layer: Layer, name: str, version: DxfVersion) -> None:
    rgb = (int(layer.colour[1:3], 16), int(layer.colour[3:5], 16), int(layer.colour[5:7], 16)) if layer.colour else None
    entry = document.layers.get(name) if name in document.layers else document.layers.add(name)
    entry.color = _INK if rgb is None else _nearest(rgb)
    if rgb is not None and version.value >= DxfVersion.R2004.value:
        entry.rgb = rgb
    if not layer.visible:
        entry.off()
    if layer.locked:
        entry.lock()


def _nearest(rgb: tuple[int, int, int]) -> int:
    """Return the index of AutoCAD's colour that is nearest, never the one that depends on the ground."""
    from ezdxf.colors import aci2rgb

    return min((index for index in range(1, 256) if index != _INK), key=lambda index: math.dist(aci2rgb(index), rgb))


class _DxfPen:
    """Draws in a space of a document."""

    def __init__(self, space: Any, old: bool, tolerance: float) -> None:
        self._space, self._old = space, old
        self.conversions = Conversions(tolerance)

    def draw(self, curve: Curve, where: dict[str, str]) -> None:
        """Add one entity; `where` is its attributes."""
        if isinstance(curve, Line):
            self._space.add_line(curve.start, curve.end, where)
        elif isinstance(curve, Circle):
            self._space.add_circle(curve.centre, curve.radius, where)
        elif isinstance(curve, Arc):
            self._arc(curve, where)
        elif self._old:
            self._converted(curve, where)
        elif isinstance(curve, Ellipse):
            self._space.add_ellipse(
                curve.centre, curve.major, curve.ratio, curve.start_parameter, curve.end_parameter, where
            )
        else:
            spline = self._space.add_spline(degree=curve.degree, dxfattribs=where)
            spline.control_points, spline.knots = [(*p, 0.0) for p in curve.control_points], curve.knots
            spline.weights = curve.weights

    def _arc(self, arc: Arc, where: dict[str, str]) -> None:
        start, end = (arc.start, arc.end) if arc.ccw else (arc.end, arc.start)
        first, last = (math.degrees(math.atan2(y - arc.centre[1], x - arc.centre[0])) for x, y in (start, end))
        back = [polar(arc.centre, arc.radius, angle) for angle in (first, last)]
        if max(math.dist(back[0], start), math.dist(back[1], end)) <= _ANGLE:
            self._space.add_arc(arc.centre, arc.radius, first, last, dxfattribs=where)
        else:
            self._polyline([arc], where)

    def _converted(self, curve: Ellipse | Spline, where: dict[str, str]) -> None:
        made = self.conversions.primitives(curve)
        chain = [primitive for primitive in made if not isinstance(primitive, Circle)]
        for primitive in made:
            if isinstance(primitive, Circle):
                self.draw(primitive, where)
        if chain:
            self._polyline(chain, where)

    def _polyline(self, chain: list[Line | Arc], where: dict[str, str]) -> None:
        """Add lines and arcs that follow one another as one polyline."""
        vertices: list[tuple[float, float, float]] = [
            (*piece.start, math.tan(piece.sweep / 4) if isinstance(piece, Arc) else 0.0) for piece in chain
        ]
        closed = chain[-1].end == chain[0].start
        vertices += [] if closed else [(*chain[-1].end, 0.0)]
        add = self._space.add_polyline2d if self._old else self._space.add_lwpolyline
        add(vertices, format="xyb", close=closed, dxfattribs=where)


def _show_all(document: Any, part: Part, units: Units) -> None:
    """Let programs that open the file show all of it."""
    box = box_round(part.entities)
    if box is None:
        return
    x0, y0, x1, y1 = (v / units.value for v in box)
    document.header["$EXTMIN"], document.header["$EXTMAX"] = (x0, y0, 0.0), (x1, y1, 0.0)
    document.set_modelspace_vport(1.1 * max(x1 - x0, y1 - y0, 1e-6), ((x0 + x1) / 2, (y0 + y1) / 2))


def _text(document: Any) -> bytes:
    stream = io.StringIO()
    document.write(stream)
    return stream.getvalue().encode(document.output_encoding, "dxfreplace")
