"""Where a tool aims and what lies there, by what it asks for: a point, a curve, or curves to be selected."""

from __future__ import annotations

from ....model.curves import Point
from ....model.part import Entity
from .drawing_tool import DrawingTool, InputKind, Pick
from .painting.part_layer import PartLayer
from .snap import SnapKind
from .snap_state import SnapState
from .snapped_point import REACH_PX, SnappedPoint, rounded


def aimed(
    at: Point, tool: DrawingTool, aiming: SnapState, picture: PartLayer, steps: tuple[float, float]
) -> tuple[SnappedPoint | None, Pick | None]:
    """Return the point that a click gives, None where it selects, and the curve that it picks.

    Args:
        at: where the mouse is, mm.
        steps: of the fine raster, mm; px per mm.
    """
    if tool.wants is InputKind.SELECTION:
        return None, None
    found = aiming.aim(at, tool, *steps) if tool.exact else SnappedPoint(rounded(at, steps[1]))
    if tool.wants not in (InputKind.CURVE, InputKind.EITHER) or (tool.wants is InputKind.EITHER and _on_point(found)):
        return found, None
    things = picture.candidates(at, REACH_PX / steps[1])
    entity = next((thing for thing in things if isinstance(thing, Entity)), None)
    return found, Pick(entity.id, found.point, entity.curve) if entity is not None else None


def _on_point(found: SnappedPoint) -> bool:
    return found.snap is not None and found.snap.kind not in (SnapKind.GRID, SnapKind.NEAREST)
