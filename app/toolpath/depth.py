"""Depth passes: strokes at one height after the other, with plunges and safe rapids between them."""

from __future__ import annotations

import math
from collections.abc import Sequence

from app.model.moves import Purpose
from app.model.operation import Cut
from app.toolpath.build import Label, MovesBuilder, Stroke


def pass_heights(depth: float, stepdown: float) -> tuple[float, ...]:
    """Return the heights of equal depth passes, mm, from the top down, the last one at -depth.

    Args:
        depth: mm, > 0.
        stepdown: largest depth of one pass, mm, > 0.
    """
    count = max(1, math.ceil(depth / stepdown - 1e-9))
    return tuple(-depth * k / count for k in range(1, count + 1))


def cut_in_passes(strokes: Sequence[Stroke], cut: Cut, heights: tuple[float, float], label: Label, builder: MovesBuilder) -> None:
    """Append every stroke at every depth.

    Strokes that end where they begin go down all their passes without a lift; the others are cut at one
    depth all together before the next. The tool goes to clearance height before it travels.

    Args:
        heights: clearance height and the height from which plunges go at plunge rate, mm.
    """
    passes = pass_heights(cut.depth, cut.stepdown)
    for group in _groups(strokes, len(passes)):
        for z in passes if len(group) > 1 or not group[0].closed else ():
            for stroke in group:
                _approach(stroke, heights, label, builder)
                _plunge_and_cut(stroke, z, label, builder)
                _retract(stroke, heights[0], label, builder)
        if len(group) == 1 and group[0].closed:
            _approach(group[0], heights, label, builder)
            for z in passes:
                _plunge_and_cut(group[0], z, label, builder)
            _retract(group[0], heights[0], label, builder)


def _groups(strokes: Sequence[Stroke], passes: int) -> list[list[Stroke]]:
    """Return closed strokes each alone, and all open ones together."""
    if passes == 1:
        return [[stroke] for stroke in strokes]
    together = [stroke for stroke in strokes if not stroke.closed]
    alone = [[stroke] for stroke in strokes if stroke.closed]
    return ([together] if together else []) + alone


def _approach(stroke: Stroke, heights: tuple[float, float], label: Label, builder: MovesBuilder) -> None:
    safe_z, retract_z = heights
    builder.straight((*stroke.start, safe_z), Purpose.RAPID, label)
    if retract_z < safe_z:
        builder.straight((*stroke.start, retract_z), Purpose.RAPID, label)


def _plunge_and_cut(stroke: Stroke, z: float, label: Label, builder: MovesBuilder) -> None:
    builder.straight((*stroke.start, z), Purpose.PLUNGE, label, stroke.region)
    builder.cut(stroke, z, label)


def _retract(stroke: Stroke, safe_z: float, label: Label, builder: MovesBuilder) -> None:
    end = stroke.rows[-1]
    builder.straight((float(end[2]), float(end[3]), safe_z), Purpose.RAPID, label)
