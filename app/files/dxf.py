"""DXF in: curves in mm, layers, units, and an account of everything that is left out."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from pathlib import PurePath
from typing import Any

from app import tolerances
from app.errors import InputError
from app.files.drawing import Drawing
from app.files.drawing_account import all_left_out, entities_of, listed, on_layers, other_units, remark, switched_off, without_length
from app.files.dxf_affine import scaled
from app.files.dxf_blocks import Sheet, Walker
from app.files.dxf_load import load
from app.model.finding import Finding, FindingKind
from app.model.part import Entity, Layer, Part, Units

_NAMED_UNITS: dict[int, tuple[float, Units]] = {
    1: (25.4, Units.INCH), 2: (304.8, Units.FOOT), 3: (1609344.0, Units.FOOT), 4: (1.0, Units.MM), 5: (10.0, Units.CM),
    6: (1000.0, Units.M), 7: (1e6, Units.M), 8: (25.4e-6, Units.INCH), 9: (25.4e-3, Units.INCH), 10: (914.4, Units.FOOT),
    11: (1e-7, Units.MICRON), 12: (1e-6, Units.MICRON), 13: (1e-3, Units.MICRON), 14: (100.0, Units.CM), 15: (1e4, Units.M),
    16: (1e5, Units.M), 21: (1200 / 3937 * 1000, Units.FOOT), 22: (100 / 3937 * 1000, Units.INCH),
    23: (3600 / 3937 * 1000, Units.FOOT),
}
"""$INSUNITS codes: size in mm, and the nearest unit to show the drawing in."""


def read_dxf(data: bytes, name: str = "drawing.dxf", units: Units | None = None, layers: tuple[str, ...] = ()) -> Drawing:
    """Return the curves of a DXF's model space in mm, and what was left out.

    Curves of inserted blocks are put in place. Text, dimensions, hatches, points, solids and paper space are counted,
    not read. Units come from $INSUNITS alone ($MEASUREMENT only chooses hatch patterns); a drawing that names none is
    in `units`, or in mm.

    Args:
        data: the whole file, ASCII or binary DXF, R12 or later.
        name: for messages and titles.
        units: of a drawing that names none; one that does keeps its own.
        layers: names of layers (in any case) whose curves are kept; empty = all.

    Raises:
        InputError: the file is no usable DXF, has no curves, or has not one of the layers.
    """
    document, repaired = load(data, name)
    factor, shown, named = _units(document, data, units)
    sheet = Walker(document, name).sheet(document.modelspace())
    left_out = sheet.left_out + _paper(document)
    spelling, to_mm = _spelling(document), scaled(factor)
    curves = ((curve, spelling.get(layer.casefold(), layer)) for curve, layer in sheet.curves)
    entities, nothing = entities_of(curves, to_mm if factor != 1.0 else None, left_out)
    if not entities:
        raise InputError(f"{name}: the drawing has no lines, arcs or curves to machine{listed(left_out, '; left out: ')}.")
    part = Part(name=PurePath(name).stem, units=shown, layers=_layers(document, entities)).with_entities(entities)
    part = on_layers(part, layers, name)
    nothing = [None if p is None else to_mm.point(p) for p in sheet.without_length] + nothing
    findings = [*_unit_findings(units, shown, named), *_damage(repaired), *without_length(nothing), *_heights(sheet, factor),
                *switched_off(part, layers), *all_left_out(left_out)]
    return Drawing(part, tuple(findings), tuple(sorted(left_out.items())), named)


def _units(document: Any, data: bytes, given: Units | None) -> tuple[float, Units, bool]:
    """Return the size of the drawing's unit in mm, the unit to show, and whether the file names it.

    The library gives a file without a header one of its own, in metres; so the word must stand in the file itself.
    """
    code = document.header.get("$INSUNITS", 0) if b"$INSUNITS" in data else 0
    if code in _NAMED_UNITS:
        return *_NAMED_UNITS[code], True
    unit = given or Units.MM
    return unit.value, unit, False


def _paper(document: Any) -> Counter[str]:
    """Count what lies in paper space, without its viewports, which only look at the model."""
    counts: Counter[str] = Counter()
    for layout in document.layouts:
        if not layout.is_modelspace:
            counts["paper space entity"] += sum(entity.dxftype() != "VIEWPORT" for entity in layout)
    return +counts


def _spelling(document: Any) -> dict[str, str]:
    """Return each layer name as the table spells it, by its name in lower case; DXF tells no difference."""
    return {layer.dxf.name.casefold(): layer.dxf.name for layer in document.layers}


def _layers(document: Any, entities: tuple[Entity, ...]) -> tuple[Layer, ...]:
    """Return the layers; the one for points of dimensions, which the library adds to every file, only where it has curves."""
    used = {entity.layer for entity in entities}
    found = [Layer(layer.dxf.name, _colour(layer), not (layer.is_off() or layer.is_frozen()), layer.is_locked())
             for layer in document.layers if layer.dxf.name in used or layer.dxf.name.casefold() != "defpoints"]
    return tuple(found) or (Layer(),)


def _colour(layer: Any) -> str:
    """Return "#rrggbb", or "" for colour 7, which is black or white as the ground demands."""
    from ezdxf.colors import aci2rgb

    if layer.rgb is not None:
        return "#{:02x}{:02x}{:02x}".format(*layer.rgb)
    index = abs(layer.dxf.color)
    return "" if index == 7 or not 1 <= index <= 255 else "#{:02x}{:02x}{:02x}".format(*aci2rgb(index))


def _unit_findings(given: Units | None, shown: Units, named: bool) -> Iterable[Finding]:
    word = shown.name.lower()
    if not named and given is None:
        text = f"The drawing names no units; {word} is assumed. If it is in inches, say --units in, or choose them on opening."
        yield Finding(FindingKind.UNITS_ASSUMED, text, counts=False)
    elif named:
        yield from other_units(given, shown)


def _damage(repaired: int) -> Iterable[Finding]:
    if repaired:
        text = f"The DXF is damaged; {repaired} faults were repaired on reading. Compare it with the original."
        yield Finding(FindingKind.LEFT_OUT, text, amount=float(repaired))


def _heights(sheet: Sheet, factor: float) -> Iterable[Finding]:
    low, high = (z * factor for z in sheet.heights)
    if high - low > tolerances.CURVE:
        yield remark(f"The drawing is not flat, its Z runs from {low:g} to {high:g} mm; it is read as seen from above.", high - low)
