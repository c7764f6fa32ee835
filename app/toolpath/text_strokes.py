"""Strokes of letters: lines for a tool to follow, which bound nothing, wherever they meet, cross or close."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from ..geometry.chaining.chain import ChainingResult, chain
from ..model.curves import Arc, Circle, Primitive
from ..model.finding import Finding, FindingKind
from ..model.part import Contour, Entity
from .witness import chaining_findings


def strokes_of(entities: Sequence[Entity], join_tolerance: float) -> tuple[tuple[Contour, ...], list[Finding]]:
    """Return the strokes of letters as open lines, also those that end where they begin, and what is to say about them.

    Args:
        entities: strokes of letters. join_tolerance: within which ends are joined, mm.
    """
    if not entities:
        return (), []
    chaining = chain(entities, join_tolerance)
    lines = tuple(map(_opened, chaining.contours))
    doubts = chaining_findings(entities, ChainingResult(lines, chaining.findings), join_tolerance)
    return lines, [*(_told(lines, layer) for layer in dict.fromkeys(line.layer for line in lines)), *doubts]


def _opened(contour: Contour) -> Contour:
    return replace(
        contour, primitives=tuple(part for each in contour.primitives for part in _halves(each)), closed=False
    )


def _halves(primitive: Primitive) -> tuple[Primitive, ...]:
    """Return both halves of a circle, and anything else as it is."""
    if not isinstance(primitive, Circle):
        return (primitive,)
    (x, y), radius, ccw = primitive.centre, primitive.radius, primitive.ccw
    right, left = (x + radius, y), (x - radius, y)
    return Arc(right, left, (x, y), ccw), Arc(left, right, (x, y), ccw)


def _told(lines: Sequence[Contour], layer: str) -> Finding:
    """Return the remark that letters of a layer are but strokes; it goes where an operation follows them all."""
    mine = [line for line in lines if line.layer == layer]
    x, y = mine[0].primitives[0].start
    count = "1 stroke of a letter, which bounds" if len(mine) == 1 else f"{len(mine)} strokes of letters, which bound"
    text = f"Layer {layer} has {count} nothing and that no operation follows; --side on engraves along them."
    ids = tuple(dict.fromkeys(number for line in mine for number in line.entity_ids))
    return Finding(FindingKind.OPEN_CONTOUR, text, x, y, False, ids, float(len(mine)))
