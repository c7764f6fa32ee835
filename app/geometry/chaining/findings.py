"""Sentences about what chaining removed, joined, or left open."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ...core import tolerances
from ...core.options import option
from ...core.wording import in_plane, trimmed
from ...model.curves import Circle, Line, Point, Primitive
from ...model.finding import Finding, FindingKind
from ...model.job import LARGEST_JOIN
from ...model.part import Contour
from ..near_points import nearest
from ..primitives import boxes, contour_rows
from .pieces import ChainPiece, Overlap, length_of
from .trace import Junction

LIMIT = 20
"""So many places of one kind are named one by one; the rest is counted."""

_SHORT, _SHORT_BETWEEN = 0.1, 0.02
"""A gap of less than this share of a contour's length was not meant: between its own ends, and to another's, as lines
side by side have.
"""

_MANY = 4
"""So many contours of a layer that no end comes near are lines that bound nothing, and one line names them."""


def at(point: Point) -> str:
    """Return a place as text, mm."""
    return in_plane(*point)


def size_of(contour: Contour) -> str:
    """Return how wide and high a contour is, as text, mm."""
    (x0, y0), (x1, y1) = _corners(contour)
    return f"{trimmed(x1 - x0, 3)} x {trimmed(y1 - y0, 3)} mm"


def named(contour: Contour) -> str:
    """Return what a contour is called: by its layer, its size and its lower left corner, for these are what a CAD
    program shows.
    """
    return f"The contour on layer {contour.layer}, {size_of(contour)} from {at(_corners(contour)[0])},"


def _corners(contour: Contour) -> tuple[Point, Point]:
    around = boxes(contour_rows(contour))
    (x0, y0), (x1, y1) = around[:, :2].min(axis=0).tolist(), around[:, 2:].max(axis=0).tolist()
    return (x0, y0), (x1, y1)


def limited(findings: Sequence[Finding], what: str) -> list[Finding]:
    """Return the first findings of a kind and one more that counts the rest."""
    rest = findings[LIMIT:]
    if not rest:
        return list(findings)
    ids = tuple(dict.fromkeys(k for finding in rest for k in finding.entity_ids))
    more = Finding(
        rest[0].kind,
        f"{len(rest)} more {what}.",
        rest[0].x,
        rest[0].y,
        any(f.counts for f in rest),
        ids,
        float(len(rest)),
    )
    return [*findings[:LIMIT], more]


def _lower(name: str) -> str:
    return name[0].lower() + name[1:].rstrip(",")


def _noun(primitive: Primitive) -> str:
    return "line" if isinstance(primitive, Line) else "circle" if isinstance(primitive, Circle) else "arc"


def _names(a: ChainPiece, b: ChainPiece) -> str:
    one, other = _noun(a.primitives[0]), _noun(b.primitives[0])
    if one == other:
        return f"{one.capitalize()}s {a.entity} and {b.entity}"
    return f"{one.capitalize()} {a.entity} and {other} {b.entity}"


@dataclass(frozen=True, slots=True)
class SharedPiece:
    """An overlap and the pieces that it joins."""

    first: ChainPiece
    second: ChainPiece
    overlap: Overlap


def overlap_findings(
    shared: Iterable[SharedPiece], contours: Sequence[Contour], join_tolerance: float
) -> list[Finding]:
    """Return a finding for each overlap; one that was removed, joined, or is the wall of two outlines is a remark."""
    place = {entity: contour for contour in contours for entity in contour.entity_ids}
    found = []
    for each in shared:
        a, b, overlap = each.first, each.second, each.overlap
        done = _removed(each) or _shared(each, place, join_tolerance)
        if not done and not (a.entity in place and b.entity in place):
            continue
        middle = ((overlap.start[0] + overlap.end[0]) / 2, (overlap.start[1] + overlap.end[1]) / 2)
        what = done or _to_trim(overlap)
        text = (
            f"{_names(a, b)} overlap by {overlap.length:.3f} mm from {at(overlap.start)} to {at(overlap.end)}; {what}"
        )
        found.append(Finding(FindingKind.OVERLAP, text, *middle, not done, (a.entity, b.entity), overlap.length))
    return limited(found, "overlapping curves")


def _removed(shared: SharedPiece) -> str:
    """Return what was taken away of an overlap, or ""."""
    if shared.overlap.removed:
        return f"{_noun(shared.second.primitives[0])} {shared.second.entity} adds nothing and is left out."
    return "one was cut to where the other ends." if shared.overlap.trimmed else ""


def _shared(shared: SharedPiece, place: Mapping[int, Contour], join_tolerance: float) -> str:
    """Return why nothing is to be done about an overlap of contours, or "".

    Args:
        place: the contour of each entity that is in one. join_tolerance: mm.
    """
    one, other = place.get(shared.first.entity), place.get(shared.second.entity)
    if one is None or other is None:
        return ""
    if one is not other and one.closed and other.closed:
        return f"{_lower(named(one))} and {_lower(named(other))} share this stretch."
    return "their ends were joined." if shared.overlap.length <= join_tolerance + tolerances.WELD else ""


def _to_trim(overlap: Overlap) -> str:
    """Return what to do about an overlap."""
    length = rounded_up(overlap.length)
    joined = f", or join with a tolerance of {length} mm if that is small enough for the part"
    return f"trim one{joined * (float(length) <= LARGEST_JOIN)}."


def repeat_findings(doubles: Sequence[tuple[Contour, Contour]]) -> list[Finding]:
    """Return a remark for each closed contour that was drawn twice, (kept, removed)."""
    found = []
    for _, double in doubles:
        x, y = double.primitives[0].start
        length = sum(length_of(p) for p in double.primitives)
        found.append(
            Finding(
                FindingKind.OVERLAP,
                f"The contour at {at((x, y))}, {length:.3f} mm long, is drawn twice; one is left out.",
                x,
                y,
                False,
                double.entity_ids,
                length,
            )
        )
    return limited(found, "contours that are drawn twice")


class ClosedGap(NamedTuple):
    """A gap that was closed: its width, mm, and where."""

    width: float
    place: Point


def gap_findings(gaps: Sequence[ClosedGap]) -> list[Finding]:
    """Return one remark on all gaps that were closed."""
    if not gaps:
        return []
    widest, place = max(gaps)
    count = "1 gap was" if len(gaps) == 1 else f"{len(gaps)} gaps were"
    return [
        Finding(
            FindingKind.GAP_CLOSED,
            f"{count} closed; the widest, {widest:.4f} mm, is at {at(place)}.",
            *place,
            False,
            (),
            widest,
        )
    ]


def junction_findings(branches: Sequence[Junction]) -> list[Finding]:
    """Return a finding for each point where an odd number of ends meet; where an even number does, outlines only
    touch.
    """
    found = []
    for branch in branches:
        if branch.odd:
            ends, ids = len(branch.entity_ids), tuple(dict.fromkeys(branch.entity_ids))
            text = f"{ends} ends meet at {at(branch.place)}; one of them belongs to no outline: delete or complete it."
            found.append(Finding(FindingKind.SELF_INTERSECTION, text, *branch.place, True, ids, float(ends)))
    return limited(found, "points where one end too many meets others")


def rounded_up(gap: float) -> str:
    """Return the next of 1, 2, 5 times a power of ten above the gap, as text."""
    scale = 10.0 ** math.floor(math.log10(max(gap, tolerances.WELD)))
    return f"{next((m * scale for m in (1, 2, 5) if m * scale >= gap - tolerances.WELD), 10 * scale):g}"


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
        whose = "its" if what == "it" else "their"
        return f"draw {what} on a layer of {whose} own, which {option('skip-layer')} leaves out"
    quoted = layer if layer.isalnum() else f'"{layer}"'
    return f"leave the layer out: {option('skip-layer', quoted)}"
