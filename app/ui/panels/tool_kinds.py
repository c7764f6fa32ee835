"""How the window lists the registered kinds of tools: in which order, with which icon, and what each is for."""

from __future__ import annotations

from contextlib import suppress

from ...core.resources import resource
from ...model.tool_kind import ToolKind, ToolShape, tool_kinds

_SAMPLE = ToolShape(radius=3.0, corner_radius=1.0, tip_radius=1.0, half_angle=0.5)
"""A cutter with every number that a kind may have, mm and radians: its profile tells whether the end is rounded."""


def listed_kinds() -> tuple[ToolKind, ...]:
    """Return all kinds in the order of lists: end mills from sharp to round, cones, what cuts threads, drills."""
    return tuple(sorted(tool_kinds(), key=_rank))


def _rank(kind: ToolKind) -> tuple[bool, ...]:
    rounded = kind.profile(_SAMPLE).fillet > 0
    return kind.drills, kind.threads, kind.conical, not kind.square, not kind.level, not rounded


def icon_of(kind: ToolKind) -> str:
    """Return the name of a kind's icon; one that has none of its own is shown by that of the kind most like it."""
    with suppress(FileNotFoundError):
        return resource("icons", f"cutter-{kind.value}.svg").stem
    if kind.drills:
        like = ToolKind.DRILL
    elif kind.conical:
        like = ToolKind.TAPER if kind.profile(_SAMPLE).fillet > 0 else ToolKind.V
    elif kind.level:
        like = ToolKind.FLAT if kind.square else ToolKind.BULL
    else:
        like = ToolKind.BALL
    return f"cutter-{like.value}"


def use_of(kind: ToolKind) -> str:
    """Return what operations take a kind of tool for; "" of those that mill everything."""
    if kind.drills or kind.work:
        return f"For {kind.work or 'drill'} operations."
    return "" if kind.square else "For paths on the line; along walls it is led as a flat one."
