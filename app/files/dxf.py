"""DXF in: curves in mm, layers, units, and an account of everything that is left out."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable
from pathlib import PurePath
from typing import Any

from app import tolerances
from app.errors import InputError
from app.files.drawing import Drawing
from app.files.dxf_affine import scaled, transformed
from app.files.dxf_blocks import Sheet, Walker
from app.files.dxf_load import load
from app.geometry.chain_pieces import straightened, within_reach
from app.model.curves import Arc, Circle, Curve, Ellipse, Line, Point
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
    entities, without_length = _entities(sheet, factor, _spelling(document), left_out)
    if not entities:
        raise InputError(f"{name}: the drawing has no lines, arcs or curves to machine{_listed(left_out, '; left out: ')}.")
    part = Part(name=PurePath(name).stem, units=shown, layers=_layers(document)).with_entities(entities)
    part = _on_layers(part, layers, name)
    findings = [*_unit_findings(units, shown, named), *_damage(repaired), *_nothing(without_length), *_heights(sheet, factor),
                *_switched_off(part, layers), *_left_out(left_out)]
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


def _entities(
    sheet: Sheet, factor: float, spelling: dict[str, str], left_out: Counter[str],
) -> tuple[tuple[Entity, ...], list[Point | None]]:
    """Return all curves that have a length, in mm and numbered from 1, and the places of those that have none.

    Curves that are not within 1 km are counted in `left_out`.
    """
    to_mm = scaled(factor)
    entities: list[Entity] = []
    nothing = [None if p is None else to_mm.point(p) for p in sheet.without_length]
    for curve, layer in sheet.curves:
        drawn = transformed(curve, to_mm) if factor != 1.0 else curve
        drawn = drawn if drawn is None else straightened(drawn)
        if drawn is None or (within_reach(drawn) and not _has_length(drawn)):
            nothing.append(None if drawn is None else drawn.start)
            continue
        if not within_reach(drawn):
            left_out["curve beyond 1 km or without a place"] += 1
            continue
        entities.append(Entity(len(entities) + 1, drawn, spelling.get(layer.casefold(), layer)))
    return tuple(entities), nothing


def _has_length(curve: Curve) -> bool:
    """True for a curve that is longer than WELD."""
    if isinstance(curve, Line | Arc):
        return math.dist(curve.start, curve.end) >= tolerances.WELD
    if isinstance(curve, Circle):
        return curve.radius >= tolerances.WELD
    if isinstance(curve, Ellipse):
        return math.hypot(*curve.major) * (curve.end_parameter - curve.start_parameter) >= tolerances.WELD
    first = curve.control_points[0]
    return max(math.dist(first, p) for p in curve.control_points) >= tolerances.WELD


def _layers(document: Any) -> tuple[Layer, ...]:
    found = [Layer(layer.dxf.name, _colour(layer), not (layer.is_off() or layer.is_frozen()), layer.is_locked())
             for layer in document.layers]
    return tuple(found) or (Layer(),)


def _colour(layer: Any) -> str:
    """Return "#rrggbb", or "" for colour 7, which is black or white as the ground demands."""
    from ezdxf.colors import aci2rgb

    if layer.rgb is not None:
        return "#{:02x}{:02x}{:02x}".format(*layer.rgb)
    index = abs(layer.dxf.color)
    return "" if index == 7 or not 1 <= index <= 255 else "#{:02x}{:02x}{:02x}".format(*aci2rgb(index))


def _on_layers(part: Part, layers: tuple[str, ...], name: str) -> Part:
    if not layers:
        return part
    known = {layer.name.casefold() for layer in part.layers}
    missing = [layer for layer in layers if layer.casefold() not in known]
    if missing:
        raise InputError(f"{name}: there is no layer {missing[0]}; the drawing has {', '.join(layer.name for layer in part.layers)}.")
    wanted = {layer.casefold() for layer in layers}
    kept = tuple(entity for entity in part.entities if entity.layer.casefold() in wanted)
    if not kept:
        raise InputError(f"{name}: layer {', '.join(layers)} has no lines, arcs or curves; choose another.")
    return Part(kept, part.layers, part.units, part.name)


def _unit_findings(given: Units | None, shown: Units, named: bool) -> Iterable[Finding]:
    word = shown.name.lower()
    if not named and given is None:
        text = f"The drawing names no units; {word} is assumed. If it is in inches, say --units in, or choose them on opening."
        yield Finding(FindingKind.UNITS_ASSUMED, text, counts=False)
    elif named and given is not None and given is not shown:
        yield _remark(f"The drawing names its own units, {word}; the units given, {given.name.lower()}, are not used.")


def _remark(text: str, amount: float | None = None) -> Finding:
    return Finding(FindingKind.LEFT_OUT, text, counts=False, amount=amount)


def _damage(repaired: int) -> Iterable[Finding]:
    if repaired:
        text = f"The DXF is damaged; {repaired} faults were repaired on reading. Compare it with the original."
        yield Finding(FindingKind.LEFT_OUT, text, amount=float(repaired))


def _nothing(places: list[Point | None]) -> Iterable[Finding]:
    if places:
        known = [p for p in places if p is not None and all(map(math.isfinite, p))]
        x, y = known[0] if known else (None, None)
        where = f", the first at ({x:.3f}, {y:.3f})" if known else ""
        what = "1 entity has" if len(places) == 1 else f"{len(places)} entities have"
        yield Finding(FindingKind.TINY_ENTITY, f"{what} no length{where}; left out.", x, y, False, (), float(len(places)))


def _heights(sheet: Sheet, factor: float) -> Iterable[Finding]:
    low, high = (z * factor for z in sheet.heights)
    if high - low > tolerances.CURVE:
        yield _remark(f"The drawing is not flat, its Z runs from {low:g} to {high:g} mm; it is read as seen from above.", high - low)


def _switched_off(part: Part, asked: tuple[str, ...]) -> Iterable[Finding]:
    """Name the layers that have curves but are off or frozen, unless layers were asked for by name."""
    hidden = {layer.name for layer in part.layers if not layer.visible}
    curves = Counter(entity.layer for entity in part.entities if entity.layer in hidden)
    if asked or not curves:
        return
    count = curves.total()
    who = f"Layers {', '.join(curves)} are" if len(curves) > 1 else f"Layer {next(iter(curves))} is"
    what = f"{count} curves on {'them' if len(curves) > 1 else 'it'} are" if count > 1 else "1 curve on it is"
    advice = f"Say --layer {next(iter(curves))} to machine {'one' if len(curves) > 1 else 'it'}."
    yield _remark(f"{who} switched off or frozen; {what} not machined. {advice}", float(count))


def _left_out(left_out: Counter[str]) -> Iterable[Finding]:
    if left_out:
        yield _remark(f"{_listed(left_out, 'Left out: ')}.", float(left_out.total()))


def _listed(left_out: Counter[str], before: str) -> str:
    return before + ", ".join(f"{count} {kind}" for kind, count in sorted(left_out.items())) if left_out else ""
