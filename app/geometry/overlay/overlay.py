"""Contours that cross become contours that only touch, with the same area by the even-odd rule.

The boundary of an even-odd area is the sum, modulo two, of all edges: whether an edge stays follows from how often it
is there, and no look at its sides can lose it. Sides say which of the edges that meet at a node go on from one another,
which edge that two areas share stays as a wall, and what outlines hold. At the end an independent witness measures the
same area.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core import tolerances
from ...model.finding import Finding, FindingKind
from ...model.part import Contour
from ..chaining.findings import at
from ..even_odd import EvenOddMeasure, even_odd
from ..primitives import Rows, contour_rows, reversed_rows, signed_area
from .nodes import RowPieces, edges_of, pieces_of, settled
from .planar_graph import PlanarGraph
from .sides import CountSteps, counted

Indices = NDArray[np.int64]
Flags = NDArray[np.bool_]

_SPECK = tolerances.LEVEL**2
"""mm2; less is no area, whatever it is of."""

_NAMED = 3
"""So many contours are named in a sentence."""


@dataclass(frozen=True)
class OverlayResult:
    """What an overlay gives.

    Attributes:
        contours: closed; they touch at most.
        findings: where their area is not that of what they were made of.
    """

    contours: tuple[Contour, ...]
    findings: tuple[Finding, ...] = ()


def without_crossings(contours: Sequence[Contour]) -> OverlayResult:
    """Return contours whose even-odd area is the same, of which none crosses itself or another.

    Args:
        contours: closed.

    Returns:
        Closed contours; those that meet neither themselves nor others are as they were. They name all entities of those
        they were made of. Slivers thinner than WELD are left out.
    """
    pieces = pieces_of(*_together([contour_rows(contour) for contour in contours]))
    meet = _meeting(pieces, len(contours))
    made = [_MadeOf(k, contours[k]) for k in np.flatnonzero(~meet).tolist()]
    pieces = settled(_part(pieces, meet[pieces.contour]))
    if not len(pieces.rows):  # what meets is smaller than what is merged
        return OverlayResult(_in_order(made))
    net = PlanarGraph.of(pieces)
    odd = np.bincount(net.edges.of, minlength=len(net.edges.rows)) % 2 == 1
    none = np.zeros(len(net.members), np.int64)
    counts = counted(net.faces, CountSteps(odd, np.zeros(len(odd), np.int64)), none > 0, none)
    findings: list[Finding] = []
    for numbers, loops in zip(net.members, net.loops(odd, counts), strict=True):
        members = [contours[k] for k in numbers]
        parts = net.contours(loops, members)
        made += [_MadeOf(numbers[0], part) for part in parts]
        findings += differing(even_odd(members), even_odd(parts).area, members)
    return OverlayResult(_in_order(made), tuple(findings))


def without_outlines(contours: Sequence[Contour], outlines: Sequence[Contour]) -> OverlayResult:
    """Return contours of the area that contours bound by the even-odd rule, without what any of some outlines holds.

    Args:
        contours: closed; they may touch, but cross neither themselves nor one another.
        outlines: closed; none crosses itself, but they may lie over one another and over the contours.

    Returns:
        Closed contours that touch at most. Those that meet no outline are as they were.
    """
    if not contours or not outlines:
        return OverlayResult(tuple(contours))
    every, count = [*contours, *outlines], len(contours)
    rows = [contour_rows(contour) for contour in every]
    rows[count:] = [each if signed_area(each) > 0 else reversed_rows(each) for each in rows[count:]]
    pieces = settled(pieces_of(*_together(rows)))
    if not len(pieces.rows):  # all is smaller than what is merged
        return OverlayResult(tuple(contours))
    net = PlanarGraph.of(pieces)
    steps = _steps(net, count)
    around, holder = net.held_by(rows)
    odd = np.bincount(around, holder < count, len(net.members)) % 2 == 1
    held = np.bincount(around, holder >= count, len(net.members)).astype(np.int64)
    loops = net.loops(steps.odd, counted(net.faces, steps, odd, held))
    made: list[_MadeOf] = []
    for number, members in enumerate(net.members):
        mine = [every[k] for k in members if k < count]
        if len(mine) == len(members) and held[number] == 0:
            made += map(_MadeOf, members, mine)
        else:
            named = mine or [replace(every[members[0]], layer=contours[0].layer)]
            made += [_MadeOf(members[0], part) for part in net.contours(loops[number], named)]
    parts = _in_order(made)
    return OverlayResult(parts, tuple(differing(even_odd(contours, outlines), even_odd(parts).area, contours)))


def differing(drawn: EvenOddMeasure, made: float, contours: Sequence[Contour], spare: float = 0.0) -> list[Finding]:
    """Return the finding that an area is not what was drawn, if it is not: then something is wrong that nobody has
    noticed.

    Args:
        drawn: the witness of what was drawn.
        made: area of what was made of it, mm2.
        contours: from which it was made.
        spare: by which it may differ for reasons that are known, mm2, besides what merging moves.
    """
    missing = drawn.area - made
    if abs(missing) <= max(drawn.length * tolerances.WELD, _SPECK) + spare:
        return []
    x, y = contours[0].primitives[0].start
    places = ", ".join(at(contour.primitives[0].start) for contour in contours[:_NAMED])
    more = f" and {len(contours) - _NAMED} more" if len(contours) > _NAMED else ""
    who = f"contour that begins at {places}" if len(contours) == 1 else f"contours that begin at {places}{more}"
    text = (
        f"The area of the {who} came out {abs(missing):.4f} mm2 too {'small' if missing > 0 else 'large'}; do not use "
        "this program, move one of the curves by 1 um and compute again."
    )
    ids = tuple(dict.fromkeys(number for contour in contours for number in contour.entity_ids))
    return [Finding(FindingKind.AREA, text, x, y, entity_ids=ids, amount=abs(missing))]


class _MadeOf(NamedTuple):
    """A contour, and the number of the one that it was made of."""

    number: int
    contour: Contour


def _in_order(made: Sequence[_MadeOf]) -> tuple[Contour, ...]:
    """Return contours in the order of what they were made of."""
    return tuple(contour for _, contour in sorted(made, key=lambda each: each.number))


def _steps(net: PlanarGraph, count: int) -> CountSteps:
    """Return how counts of contours, which are numbered below `count`, and of outlines differ across each edge."""
    drawn = net.pieces.contour < count
    odd = np.bincount(net.edges.of, drawn, len(net.edges.rows)) % 2 == 1
    ahead = np.where(drawn, 0, np.where(net.edges.forward, 1, -1))
    return CountSteps(odd, np.bincount(net.edges.of, ahead, len(net.edges.rows)).astype(np.int64))


class _NumberedRows(NamedTuple):
    """Rows (n, 8), and the number of the contour of each."""

    rows: Rows
    contour: Indices


def _together(rows: Sequence[Rows]) -> _NumberedRows:
    """Return the rows of all contours, one after the other."""
    number = np.repeat(np.arange(len(rows)), [len(each) for each in rows])
    return _NumberedRows(np.concatenate([np.zeros((0, 8)), *rows]), number)


def _part(pieces: RowPieces, chosen: Flags) -> RowPieces:
    """Return some of the pieces."""
    start, end = pieces.start[chosen], pieces.end[chosen]
    return RowPieces(pieces.rows[chosen], pieces.contour[chosen], start, end, pieces.nodes, pieces.moved[chosen])


def _meeting(pieces: RowPieces, count: int) -> Flags:
    """Return which contours (count,) come to a node where they, or others, have been; ways forth and back do not
    count.
    """
    meet = np.zeros(count, np.bool_)
    if not len(pieces.rows):
        return meet
    edges = edges_of(pieces)
    index = np.arange(len(pieces.rows))
    first = np.unique(pieces.contour, return_index=True)[1]
    after = index + 1
    after[np.append(first[1:], len(index)) - 1] = first
    back = (edges.of[after] == edges.of) & (edges.forward[after] != edges.forward) & (after != index)
    before = np.empty_like(after)
    before[after] = index
    gone = back & ~back[before]
    kept = ~(gone | gone[before])
    node = pieces.start[kept]
    busy = np.bincount(node, minlength=len(pieces.nodes)) > 1
    meet[pieces.contour[kept][busy[node]]] = True
    return meet
