"""Slots: along the middle where they are as wide as the tool, else in rings or in arcs within what the line grows to.

The shape that is wanted is the line grown by half of the width, with round ends; `MachiningAreas` makes its walls. So a
wide slot is a pocket of that area, and what proves a pocket proves it.
"""

from __future__ import annotations

from collections.abc import Iterator

import shapely

from ...core.errors import ParameterError
from ...core.progress import Progress
from ...core.wording import in_plane
from ...geometry.offset.offset import OffsetLevel
from ...geometry.primitives import contour_rows, sample
from ...model.entry import Lead, LeadKind
from ...model.finding import Finding, FindingKind
from ...model.job import Job
from ...model.operation import Direction
from ...model.slot_operation import SlotOperation
from ...model.tool import Tool
from ...toolpath.coverage.areas import region_shapes
from ...toolpath.drawn_contours import selected
from ...toolpath.leads.lead import LeadContext, runs
from ...toolpath.linking.link import LinkOptions
from ...toolpath.machining_areas import MachiningArea, MachiningAreas
from ...toolpath.narrow_regions import too_small
from ...toolpath.operation_context import OperationContext, emit, passes_of
from ..adaptive.paths import adaptive, room_needed
from ..contour.paths import StrokeExtras, strokes_of
from ..engrave.open_line import line_paths
from ..pocket.paths import PocketTarget, clear_in_rings

_SAME = 1e-9
"""mm; a slot is as wide as the tool within this."""

_CHORD = 1e-3
"""mm; what clamps hold of slots is measured as chords this near to them."""


def slot(context: OperationContext, index: int, progress: Progress) -> None:
    """Cut slots along the lines of an operation.

    Raises:
        ParameterError: the slot is narrower than the tool, the tool leaves no level floor as wide as it is, or the
            stock is too thin.
        Cancelled: by progress.
    """
    operation = context.job.operations[index]
    assert isinstance(operation, SlotOperation)
    tool = context.job.tool(operation.cut.tool)
    check_tool(operation, tool)
    area = context.areas.of(operation)
    if area is None:
        return
    if area.lines:
        _along_lines(context, index, area, progress)
    elif operation.trochoidal:
        adaptive(context, index, progress)
        context.findings.extend(_under_clamps(context.areas, operation, tool))
    else:
        target = PocketTarget(tool.radius, tool.radius, LinkOptions(operation.cut.direction))
        first = clear_in_rings(context, index, area, target, progress)
        context.findings.extend(slot_findings(context.areas, operation, area, first))


def check_tool(operation: SlotOperation, tool: Tool) -> None:
    """Refuse a tool that cannot make a slot.

    Raises:
        ParameterError: it is wider than the slot, not flat, or has no room for arcs.
    """
    width, name = operation.line_width(tool) or 0.0, f"T{tool.number} {tool.label}"
    if not tool.kind.square:
        raise ParameterError(
            f"{name} makes no slot with straight walls and a level floor; take a flat mill, or follow the lines with "
            "a contour on the line."
        )
    if width < tool.diameter - _SAME:
        raise ParameterError(
            f"The slot is {width:g} mm wide, and {name} is {tool.diameter:g} mm; make it wider, or take a thinner mill."
        )
    if operation.trochoidal and width <= tool.diameter + _SAME:
        raise ParameterError(
            f"The slot is as wide as {name}, {tool.diameter:g} mm, so all of its rim is in metal; a trochoidal way "
            "needs a thinner mill or a larger slot_width."
        )


def outermost_distance(job: Job, operation: SlotOperation) -> float:
    """Return how far from the walls the tool's centre has to have room, mm."""
    return room_needed(job, operation) if operation.trochoidal else job.tool(operation.cut.tool).radius


def slot_findings(
    areas: MachiningAreas, operation: SlotOperation, area: MachiningArea, level: OffsetLevel
) -> list[Finding]:
    """Return where clamps are in the way of wide slots, or leave no room between them.

    Args:
        level: the outermost rings of its tool's centre.
    """
    tool = areas.job.tool(operation.cut.tool)
    need = 2 * level.distance
    return [*too_small(area.regions, level, tool, need), *_under_clamps(areas, operation, tool)]


def _under_clamps(areas: MachiningAreas, operation: SlotOperation, tool: Tool) -> Iterator[Finding]:
    """Yield how much of the slots lies under clamps."""
    if not areas.drawn.clamps:
        return
    found = selected(areas.drawn, operation.cut.curves)
    lines = [
        shapely.LineString([*sample(rows, _CHORD), rows[-1, 2:4]])
        for rows in map(contour_rows, (*found.closed, *found.open))
    ]
    slots = shapely.buffer(shapely.union_all(lines), (operation.line_width(tool) or 0.0) / 2, quad_segs=64)
    held = shapely.intersection(slots, shapely.union_all(region_shapes(areas.drawn.clamps, _CHORD)))
    if held.area > _CHORD:
        x, y = shapely.get_coordinates(shapely.point_on_surface(held))[0].tolist()
        text = (
            f"{held.area:.1f} mm2 of the slots lies under clamps, at {in_plane(x, y)} for one, and stays; move the "
            "clamp and cut the rest."
        )
        yield Finding(FindingKind.LEFT_OUT, text, x, y, amount=float(held.area))


def _along_lines(context: OperationContext, index: int, area: MachiningArea, progress: Progress) -> None:
    """Cut slots that are as wide as the tool: its centre on the lines."""
    cut, tool = context.job.operations[index].cut, context.job.tool(context.job.operations[index].cut.tool)
    paths, findings = line_paths(area, tool, cut.direction, progress.part(0.0, 0.7))
    context.findings.extend(findings)
    away = 1.0 if cut.direction is Direction.CLIMB else -1.0
    around = LeadContext(area.distances, tool, tool.radius, away, Lead(LeadKind.NONE))
    strokes = strokes_of(runs(paths, [[] for _ in paths], around), [()] * len(paths), StrokeExtras())
    context.strokes += len(strokes) * passes_of(context, index)
    emit(context, index, area, strokes, progress.part(0.7, 1.0))
