"""Pocket paths: rings of one distance field from the outermost frame inwards, linked to one stroke (steps 141-148)."""

from __future__ import annotations

import math

from app import tolerances
from app.errors import ParameterError
from app.geometry.distance import DistanceField
from app.geometry.offset import Level
from app.model.operation import PocketOperation
from app.model.tool import Tool


def stepover_of(operation: PocketOperation, tool: Tool) -> float:
    """Return the distance between rings, mm: as asked, or the largest that covers everything by itself.

    A stepover s <= R leaves no point farther than R from some ring. Overlap of the 1986 text = 2 R - s.

    Raises:
        ParameterError: the stepover is larger than the tool.
    """
    if operation.stepover is None:
        return tool.radius
    if operation.stepover > tool.diameter:
        raise ParameterError(f"Stepover is {operation.stepover:g} mm, more than the diameter of T{tool.number} ({tool.diameter:g} mm); "
                             f"use at most {tool.radius:g} mm to clear everything.")
    return operation.stepover


def pocket_distances(outermost: float, stepover: float, field: DistanceField) -> tuple[float, ...]:
    """Return the distances of all rings from the drawing, mm: outermost + k stepover, as far as any point can be.

    Args:
        outermost: contour tool radius + stock to leave + pocket tool radius, mm.
        stepover: mm, > 0.
    """
    x0, y0, x1, y1 = field.boxes[:, 0].min(), field.boxes[:, 1].min(), field.boxes[:, 2].max(), field.boxes[:, 3].max()
    deepest = min(x1 - x0, y1 - y0) / 2
    count = max(0, math.floor((deepest - outermost + tolerances.FIT) / stepover) + 1)
    return tuple(outermost + k * stepover for k in range(count))


def without_empty(levels: tuple[Level, ...]) -> tuple[Level, ...]:
    """Return the levels up to the last one that has rings."""
    last = max((k for k, level in enumerate(levels) if level.rings), default=-1)
    return levels[:last + 1]
