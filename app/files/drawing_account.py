"""What every reader of drawings does with its curves: to mm, numbered, chosen by layer, and an account of the rest."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Iterator

from app import tolerances
from app.errors import InputError
from app.files.dxf_affine import Affine, transformed
from app.geometry.chain_pieces import straightened, within_reach
from app.model.curves import Arc, Circle, Curve, Ellipse, Line, Point
from app.model.finding import Finding, FindingKind
from app.model.part import Entity, Part, Units

MOST_CURVES = 500_000
"""A drawing that unfolds to more curves than this is refused before it fills the memory."""


def entities_of(
    curves: Iterable[tuple[Curve, str]], to_mm: Affine | None, left_out: Counter[str],
) -> tuple[tuple[Entity, ...], list[Point | None]]:
    """Return all curves that have a length, in mm and numbered from 1, and the places of those that have none.

    Args:
        curves: with the names of their layers.
        to_mm: from the curves' units; None: they are in mm.
        left_out: curves that are not within 1 km are counted here.
    """
    entities: list[Entity] = []
    nothing: list[Point | None] = []
    for curve, layer in curves:
        drawn = transformed(curve, to_mm) if to_mm is not None else curve
        drawn = drawn if drawn is None else straightened(drawn)
        if drawn is None or (within_reach(drawn) and not has_length(drawn)):
            nothing.append(None if drawn is None else drawn.start)
            continue
        if not within_reach(drawn):
            left_out["curve beyond 1 km or without a place"] += 1
            continue
        entities.append(Entity(len(entities) + 1, drawn, layer))
    return tuple(entities), nothing


def has_length(curve: Curve) -> bool:
    """Return True for a curve that is longer than WELD."""
    if isinstance(curve, Line):
        return math.dist(curve.start, curve.end) >= tolerances.WELD
    if isinstance(curve, Arc):  # one that is nearly a circle has its ends close together
        return curve.start != curve.end and abs(curve.sweep) * curve.radius >= tolerances.WELD
    if isinstance(curve, Circle):
        return curve.radius >= tolerances.WELD
    if isinstance(curve, Ellipse):
        return math.hypot(*curve.major) * (curve.end_parameter - curve.start_parameter) >= tolerances.WELD
    first = curve.control_points[0]
    return max(math.dist(first, p) for p in curve.control_points) >= tolerances.WELD


def on_layers(part: Part, layers: tuple[str, ...], name: str) -> Part:
    """Return the part with only the curves on some layers, named in any case; empty = all.

    Raises:
        InputError: there is no such layer, or nothing on it.
    """
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


def remark(text: str, amount: float | None = None) -> Finding:
    """Return a finding on what was left out that counts for nothing."""
    return Finding(FindingKind.LEFT_OUT, text, counts=False, amount=amount)


def other_units(given: Units | None, shown: Units) -> Iterator[Finding]:
    """Say that the units given are not those that the drawing names."""
    if given is not None and given is not shown:
        yield remark(f"The drawing names its own units, {shown.name.lower()}; the units given, {given.name.lower()}, are not used.")


def without_length(places: list[Point | None]) -> Iterator[Finding]:
    """Count what has no length, and say where the first is."""
    if places:
        known = [p for p in places if p is not None and all(map(math.isfinite, p))]
        x, y = known[0] if known else (None, None)
        where = f", the first at ({x:.3f}, {y:.3f})" if known else ""
        what = "1 entity has" if len(places) == 1 else f"{len(places)} entities have"
        yield Finding(FindingKind.TINY_ENTITY, f"{what} no length{where}; left out.", x, y, False, (), float(len(places)))


def switched_off(part: Part, asked: tuple[str, ...]) -> Iterator[Finding]:
    """Name the layers that have curves but are not shown, unless layers were asked for by name."""
    hidden = {layer.name for layer in part.layers if not layer.visible}
    curves = Counter(entity.layer for entity in part.entities if entity.layer in hidden)
    if asked or not curves:
        return
    count = curves.total()
    who = f"Layers {', '.join(curves)} are" if len(curves) > 1 else f"Layer {next(iter(curves))} is"
    what = f"{count} curves on {'them' if len(curves) > 1 else 'it'} are" if count > 1 else "1 curve on it is"
    advice = f"Say --layer {next(iter(curves))} to machine {'one' if len(curves) > 1 else 'it'}."
    yield remark(f"{who} switched off or frozen; {what} not machined. {advice}", float(count))


def all_left_out(left_out: Counter[str]) -> Iterator[Finding]:
    """Count what is no curve, by type."""
    if left_out:
        yield remark(f"{listed(left_out, 'Left out: ')}.", float(left_out.total()))


def listed(left_out: Counter[str], before: str) -> str:
    """Return "before 2 TEXT, 1 IMAGE", or nothing."""
    return before + ", ".join(f"{count} {kind}" for kind, count in sorted(left_out.items())) if left_out else ""
