"""Sentences about what chaining removed, joined, or left open."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from ...core import tolerances
from ...model.curves import Circle, Line, Point, Primitive
from ...model.finding import Finding, FindingKind
from ...model.job import LARGEST_JOIN
from ...model.part import Contour
from ..primitives import boxes, contour_rows
from .overlap import Overlap
from .pieces import ChainPiece, length_of
from .trace import Junction

LIMIT = 20
"""So many places of one kind are named one by one; the rest is counted."""


def at(point: Point) -> str:
    """Return a place as text, mm."""
    return f"({point[0]:.3f}, {point[1]:.3f})".replace("-0.000", "0.000")


def size_of(contour: Contour) -> str:
    """Return how wide and high a contour is, as text, mm."""
    (x0, y0), (x1, y1) = _corners(contour)
    return f"{_tidy(x1 - x0)} x {_tidy(y1 - y0)} mm"


def named(contour: Contour) -> str:
    """Return what a contour is called: by its layer, its size and its lower left corner, for these are what a CAD
    program shows.
    """
    return f"The contour on layer {contour.layer}, {size_of(contour)} from {at(_corners(contour)[0])},"


def _corners(contour: Contour) -> tuple[Point, Point]:
    around = boxes(contour_rows(contour))
    (x0, y0), (x1, y1) = around[:, :2].min(axis=0).tolist(), around[:, 2:].max(axis=0).tolist()
    return (x0, y0), (x1, y1)


def _tidy(length: float) -> str:
    return f"{length:.3f}".rstrip("0").rstrip(".")


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
    place = {entity: k for k, contour in enumerate(contours) for entity in contour.entity_ids}
    found = []
    for each in shared:
        a, b, overlap = each.first, each.second, each.overlap
        middle = ((overlap.start[0] + overlap.end[0]) / 2, (overlap.start[1] + overlap.end[1]) / 2)
        one, other = place.get(a.entity), place.get(b.entity)
        counts = False
        if overlap.removed:
            what = f"; {_noun(b.primitives[0])} {b.entity} adds nothing and is left out."
        elif overlap.trimmed:
            what = "; one was cut to where the other ends."
        elif one is None or other is None:
            continue
        elif one != other and contours[one].closed and contours[other].closed:
            what = f"; {_lower(named(contours[one]))} and {_lower(named(contours[other]))} share this stretch."
        elif overlap.length <= join_tolerance + tolerances.WELD:
            what = "; their ends were joined."
        else:
            length = rounded_up(overlap.length)
            joined = f", or join with a tolerance of {length} mm if that is small enough for the part"
            what = f"; trim one{joined * (float(length) <= LARGEST_JOIN)}."
            counts = True
        text = f"{_names(a, b)} overlap by {overlap.length:.3f} mm from {at(overlap.start)} to {at(overlap.end)}{what}"
        found.append(Finding(FindingKind.OVERLAP, text, *middle, counts, (a.entity, b.entity), overlap.length))
    return limited(found, "overlapping curves")


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
