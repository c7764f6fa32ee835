"""Sentences about open contours: which end nearly meets which, what joins them, and whole layers of lines in one
line.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...core import tolerances
from ...model.curves import Point
from ...model.finding import Finding, FindingKind
from ...model.job import LARGEST_JOIN
from ...model.part import Contour
from ..near_points import nearest
from .findings import at, limited, named, rounded_up, size_of
from .pieces import length_of

_SHORT, _SHORT_BETWEEN = 0.1, 0.02
"""A gap of less than this share of a contour's length was not meant: between its own ends, and to another's, as lines
side by side have.
"""
_MANY = 4
"""So many contours of a layer that no end comes near are lines that bound nothing, and one line names them."""


@dataclass(frozen=True, slots=True)
class _End:
    """A loose end, the nearest other one, and how far apart they are, mm; `own`: that is the contour's own."""

    place: Point
    other: Point
    gap: float
    own: bool


def open_findings(contours: Sequence[Contour], join_tolerance: float = 0.0) -> list[Finding]:
    """Return findings on all open contours: where their loose ends are, what is nearest to them, what to do.

    Args:
        contours: closed ones are passed over.
        join_tolerance: that was used, mm; no greater one than the largest that is allowed is ever advised.
    """
    loose = [contour for contour in contours if not contour.closed]
    near = [_joinable(contour, ends, join_tolerance) for contour, ends in zip(loose, _ends(loose), strict=True)]
    alone = defaultdict(list)
    for contour, ends in zip(loose, near, strict=True):
        if not ends:
            alone[contour.layer].append(contour)
    bounding = {contour.layer for contour in contours if contour.closed}
    found = [
        _nearly_closed(contour, ends) if ends else _unfinished(contour, bounding)
        for contour, ends in zip(loose, near, strict=True)
        if ends or len(alone[contour.layer]) < _MANY
    ]
    lines = [_bounding_nothing(alone[layer], bounding) for layer in alone if len(alone[layer]) >= _MANY]
    return [*limited(found, "open contours"), *lines]


def _ends(loose: Sequence[Contour]) -> list[list[_End]]:
    """Return both ends of each contour with the nearest other end."""
    if not loose:
        return []
    places = [place for contour in loose for place in (contour.primitives[0].start, contour.primitives[-1].end)]
    points = np.array(places)
    count = min(3, len(points))
    _, index = nearest(points, points, count)
    found = []
    for k, place in enumerate(places):
        other = min((int(j) for j in index[k] if j != k), key=lambda j: math.dist(place, places[j]))
        found.append(_End(place, places[other], math.dist(place, places[other]), other == (k ^ 1)))
    return [found[k : k + 2] for k in range(0, len(found), 2)]


def _joinable(contour: Contour, ends: list[_End], join_tolerance: float) -> list[_End]:
    """Return the ends that a greater tolerance would join."""
    length = sum(length_of(primitive) for primitive in contour.primitives)
    least = max(join_tolerance, tolerances.WELD)
    return [
        end
        for end in ends
        if least < end.gap < length * (_SHORT if end.own else _SHORT_BETWEEN)
        and float(rounded_up(end.gap)) <= LARGEST_JOIN
    ]


def _nearly_closed(contour: Contour, ends: list[_End]) -> Finding:
    widest = max(ends, key=lambda end: end.gap)
    if widest.own:
        start, end = contour.primitives[0].start, contour.primitives[-1].end
        where = f"is open by {widest.gap:.3g} mm: its loose ends are at {at(start)} and {at(end)}"
    else:
        where = (
            f"is open: its loose end at {at(widest.place)} is {widest.gap:.3g} mm from that of another at "
            f"{at(widest.other)}"
        )
    text = f"{named(contour)} {where}. Join with tolerance {rounded_up(widest.gap)} or edit the ends."
    return Finding(FindingKind.OPEN_CONTOUR, text, *widest.place, True, contour.entity_ids, widest.gap)


def _unfinished(contour: Contour, bounding: set[str]) -> Finding:
    start, end = contour.primitives[0].start, contour.primitives[-1].end
    gap = math.dist(start, end)
    text = (
        f"{named(contour)} is open by {gap:.3g} mm: its loose ends are at {at(start)} and {at(end)}. "
        f"Complete it, or {_leaving('it', contour.layer, bounding)}."
    )
    return Finding(
        FindingKind.OPEN_CONTOUR, text, *start, True, contour.entity_ids, gap, layer=_spare(contour.layer, bounding)
    )


def _bounding_nothing(lines: Sequence[Contour], bounding: set[str]) -> Finding:
    """Return one finding on the lines of a layer that bound nothing, such as centre and section lines."""
    longest = max(lines, key=lambda contour: sum(length_of(primitive) for primitive in contour.primitives))
    start, end = longest.primitives[0].start, longest.primitives[-1].end
    text = (
        f"Layer {longest.layer} has {len(lines)} lines that bound nothing, the longest {size_of(longest)} at "
        f"{at(start)}. Complete them, or {_leaving('them', longest.layer, bounding)}."
    )
    ids = tuple(dict.fromkeys(number for contour in lines for number in contour.entity_ids))
    return Finding(
        FindingKind.OPEN_CONTOUR, text, *start, True, ids, math.dist(start, end), layer=_spare(longest.layer, bounding)
    )


def _spare(layer: str, bounding: set[str]) -> str:
    """Return a layer that may be left out as a whole, or ""; `bounding` are those that must stay."""
    return "" if layer in bounding else layer


def _leaving(what: str, layer: str, bounding: set[str]) -> str:
    """Return how to leave lines out; `bounding` are the layers that must stay, for closed contours lie on them."""
    if layer in bounding:
        return f"draw {what} on a layer of {'its' if what == 'it' else 'their'} own, which --skip-layer leaves out"
    quoted = layer if layer.isalnum() else f'"{layer}"'
    return f"leave the layer out: --skip-layer {quoted}"
