"""What the window calls each kind of tool, its icon, and what it is for."""

from __future__ import annotations

import math

from ...model.tool import ToolKind

KINDS: dict[ToolKind, str] = {
    ToolKind.FLAT: "Flat end mill",
    ToolKind.BULL: "Bull-nose mill",
    ToolKind.BALL: "Ball end mill",
    ToolKind.TAPER: "Tapered ball mill",
    ToolKind.V: "V cutter",
    ToolKind.DRILL: "Drill",
}
"""In the order in which they are listed."""

USUAL_ANGLES: dict[ToolKind, float] = {
    ToolKind.V: math.radians(90),
    ToolKind.DRILL: math.radians(118),
    ToolKind.TAPER: math.radians(10),
}
"""Full angles of the point or cone, radians, that a tool gets which becomes one of these kinds."""


def icon_of(kind: ToolKind) -> str:
    """Return the name of a kind's icon."""
    return f"cutter-{kind.value}"


def use_of(kind: ToolKind) -> str:
    """Return what operations take a kind of tool for; "" of flat ones, which mill everything."""
    if kind is ToolKind.FLAT:
        return ""
    return (
        "For drill operations."
        if kind is ToolKind.DRILL
        else "For paths on the line; along walls it is led as a flat one."
    )
