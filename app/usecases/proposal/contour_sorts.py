"""The contours of a drawing sorted by what they mostly are: outlines, holes, pockets with their islands, lines.

How deep a closed contour is nested decides: what lies in no other one is the outline of a part; what lies in an odd
number of others is cut away, and what lies in an even number stands in it as an island. A circle that is cut away and
holds nothing is a hole; so is a slot or a bore with a keyway or a flat: whatever is round over half a turn.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import Enum
from typing import NamedTuple

import numpy as np

from ...core.wording import in_plane
from ...geometry.as_circle import as_circle
from ...geometry.outlines import holders
from ...geometry.primitives import CX, CY, TURN, R, contour_rows, lengths, signed_area, sweeps
from ...model.curve_selectors import CirclesOf, ContourKind, CurveNumber, OnLayer, Selector
from ...model.curves import Line
from ...model.finding import Finding, FindingKind
from ...model.part import Contour, Part
from ...toolpath.drawn_contours import SAME_DIAMETER, DrawnContours, selected

_GAP = 0.05
"""Of a line's length; an open line whose ends are nearer to one another is taken for an outline with a gap in it."""

_SAME_CENTRE = 1e-4  # mm

_HALF_TURN = math.pi - 0.01
"""Radians; arcs on one circle that turn by so much in all are half a circle, as at the end of a slot."""


class ContourSort(Enum):
    """What a closed contour mostly is."""

    OUTLINE = "outline"
    HOLE = "hole"
    BORE = "bore"
    POCKET = "pocket"
    ISLAND = "island"


class HolesOfSize(NamedTuple):
    """Circles of one diameter, mm."""

    size: float
    circles: tuple[Contour, ...]


@dataclass(frozen=True)
class SortedContours:
    """The contours of a drawing, once a contour however often the part is copied.

    Attributes:
        outlines: that lie in no other one.
        holes: circles that hold nothing, by their diameters, rising.
        bores: slots, and other holes that are round over half a turn.
        pockets: other contours that lie in an odd number of others; islands: those that stand in them.
        lines: open lines, and all curves of a layer that has more of these than closed contours and no outline.
        strokes: of letters.
        gaps: findings about outlines that are not closed, which no operation is proposed for.
    """

    outlines: tuple[Contour, ...] = ()
    holes: tuple[HolesOfSize, ...] = ()
    bores: tuple[Contour, ...] = ()
    pockets: tuple[Contour, ...] = ()
    islands: tuple[Contour, ...] = ()
    lines: tuple[Contour, ...] = ()
    strokes: tuple[Contour, ...] = ()
    gaps: tuple[Finding, ...] = ()


def sorted_contours(part: Part, drawn: DrawnContours) -> SortedContours:
    """Return the contours of a drawing by what they mostly are.

    Args:
        part: the drawing. drawn: what a job without copies machines of it.
    """
    letters = {entity.id for entity in part.entities if entity.lettering}
    strokes = [each for each in drawn.open if letters.issuperset(each.entity_ids)]
    engraved = _engraved(drawn)
    closed = [each for each in drawn.closed if each.layer not in engraved]
    lines = [each for each in drawn.open if not letters.issuperset(each.entity_ids)]
    broken = [
        each
        for each in lines
        if each.layer not in engraved and _gap(each) <= _GAP * float(lengths(contour_rows(each)).sum())
    ]
    # an outline with a gap holds what is drawn in it all the same, or its holes would be taken for parts
    around = holders([*closed, *(_closed(each) for each in broken)])
    holding = {k for held in around for k in held}
    sorts = [_sort(each, len(around[k]), k in holding) for k, each in enumerate(closed)]

    def of(sort: ContourSort) -> tuple[Contour, ...]:
        return tuple(each for each, own in zip(closed, sorts, strict=True) if own is sort)

    return SortedContours(
        outlines=of(ContourSort.OUTLINE),
        holes=by_diameter(of(ContourSort.HOLE)),
        bores=of(ContourSort.BORE),
        pockets=of(ContourSort.POCKET),
        islands=of(ContourSort.ISLAND),
        lines=(
            *(each for each in lines if not any(each is other for other in broken)),
            *(each for each in drawn.closed if each.layer in engraved),
        ),
        strokes=tuple(strokes),
        gaps=tuple(_about_gap(each) for each in broken),
    )


def _engraved(drawn: DrawnContours) -> frozenset[str]:
    """Return the layers of which all is engraved: words that are drawn as curves, whose O bounds no area."""
    open_, closed = (Counter(each.layer for each in some) for some in (drawn.open, drawn.closed))
    parts = {each.layer for each in drawn.closed if id(each) not in drawn.inner}
    return frozenset(name for name, count in open_.items() if count >= closed[name] > 0 and name not in parts)


def _sort(contour: Contour, depth: int, holds: bool) -> ContourSort:
    if depth == 0:
        return ContourSort.OUTLINE
    if depth % 2 == 0:
        return ContourSort.ISLAND
    if not holds and as_circle(contour) is not None:
        return ContourSort.HOLE
    return ContourSort.BORE if not holds and _is_round(contour) else ContourSort.POCKET


def _is_round(contour: Contour) -> bool:
    """Tell whether a closed contour bulges over half a turn of one circle: the end of a slot, a bore with a keyway."""
    rows = contour_rows(contour)
    turn = sweeps(rows) * math.copysign(1.0, signed_area(rows))
    same = (
        (rows[:, TURN] != 0)
        & (np.roll(rows[:, TURN], 1) == rows[:, TURN])
        & (np.hypot(*(rows[:, [CX, CY]] - np.roll(rows, 1, axis=0)[:, [CX, CY]]).T) < _SAME_CENTRE)
        & (np.abs(rows[:, R] - np.roll(rows[:, R], 1)) < _SAME_CENTRE)
    )
    if same.all():
        return bool(turn.sum() > 0)
    first = int(np.argmin(same))  # begin where an arc does not go on
    run = np.cumsum(~np.roll(same, -first)) - 1
    total = np.bincount(run, np.where(np.roll(rows[:, TURN], -first) != 0, np.roll(turn, -first), 0.0))
    return bool(total.max() >= _HALF_TURN)


def by_diameter(circles: Sequence[Contour]) -> tuple[HolesOfSize, ...]:
    """Return circles in groups of one diameter, rising."""
    sizes = [(2 * circle.radius, each) for each in circles if (circle := as_circle(each)) is not None]
    groups: list[tuple[float, list[Contour]]] = []
    for size, each in sorted(sizes, key=lambda pair: pair[0]):
        if groups and size - groups[-1][0] <= SAME_DIAMETER:
            groups[-1][1].append(each)
        else:
            groups.append((size, [each]))
    return tuple(HolesOfSize(round(size, 4), tuple(some)) for size, some in groups)


def _gap(line: Contour) -> float:
    """Return how far the ends of an open line are from one another, mm; infinite where no outline could end so."""
    (x0, y0), (x1, y1) = line.primitives[0].start, line.primitives[-1].end
    return math.hypot(x1 - x0, y1 - y0)


def _closed(line: Contour) -> Contour:
    (x0, y0), (x1, y1) = line.primitives[-1].end, line.primitives[0].start
    closing = () if (x0, y0) == (x1, y1) else (Line((x0, y0), (x1, y1)),)
    return replace(line, primitives=(*line.primitives, *closing), closed=True)


def _about_gap(line: Contour) -> Finding:
    x, y = line.primitives[-1].end
    text = (
        f"An outline has a gap of {_gap(line):.3f} mm at {in_plane(x, y)}, so no operation is proposed for it; close "
        "it, or raise the join tolerance."
    )
    return Finding(FindingKind.OPEN_CONTOUR, text, x, y, counts=True, entity_ids=line.entity_ids, amount=_gap(line))


def selectors_for(
    requested: Sequence[Contour], drawn: DrawnContours, made: Sequence[Contour] = (), as_circles: bool = False
) -> tuple[Selector, ...]:
    """Return the plainest selectors that select some contours and no others: by where they lie, by their diameter, by
    their layers, else by number.

    Args:
        requested: contours, closed and open.
        drawn: what they are of.
        made: circles that drills make, which are no walls to others, so that it does not matter whether these are
            selected too.
        as_circles: they are wanted as circles, wherever they lie.
    """
    mine, free = {id(each) for each in requested}, {id(each) for each in made}
    sizes = [2 * circle.radius for each in requested if each.closed and (circle := as_circle(each)) is not None]
    ways: list[tuple[Selector, ...]] = [] if as_circles else [(kind,) for kind in ContourKind]
    if sizes and max(sizes) - min(sizes) <= SAME_DIAMETER:
        ways.append((CirclesOf(round(sizes[0], 4), round(sizes[0], 4)),))
    ways.append(tuple(OnLayer(name) for name in dict.fromkeys(each.layer for each in requested)))
    for way in ways:
        found = selected(drawn, way)
        chosen = {id(each) for each in (*found.closed, *found.open)}
        if mine <= chosen <= mine | free:
            return way
    return tuple(CurveNumber(min(each.entity_ids)) for each in requested)
