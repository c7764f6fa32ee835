"""Ways into areas that are open at the stock's edge: down beside the stock, and in from there."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ..core.errors import ParameterError
from ..core.progress import Progress
from ..geometry.primitives import lengths
from ..model.moves import Purpose
from ..model.operation import Operation
from ..toolpath.build import Stroke
from ..toolpath.entry.entry import EntryContext, keeps_off_walls
from ..toolpath.machining_areas import BoxSides, MachiningArea
from ..toolpath.operation_context import OperationContext, PreparedStrokes, emit

_BESIDE = 1e-6
"""mm; so far beside the stock a tool is at least that goes down there."""

_TRIED = 64
"""Places beside the stock, the nearest first, from which a straight way in is looked for."""


def open_stock(context: OperationContext, operation: Operation, area: MachiningArea) -> BoxSides | None:
    """Return the sides of the stock that an area goes on past; None where it is not asked to.

    Raises:
        ParameterError: it is, and no wall lies on the stock's edge.
    """
    if not operation.opens_edges:
        return None
    if not area.air:
        margin = context.job.stock.margin
        why = (
            f"the stock reaches {margin:g} mm beyond the drawing; set its margin to 0"
            if margin
            else ("draw the area up to the stock's edge")
        )
        raise ParameterError(
            f"open_edges of the {operation.WORD} with T{operation.cut.tool} has no effect, as none of its walls lies "
            f"on the stock's edge: {why}, or take it out."
        )
    return context.areas.stock


def know_as_clear(
    context: OperationContext, operation: Operation, stock: BoxSides, places: Sequence[NDArray[np.float64]]
) -> None:
    """Let entries know that there is no metal under a tool at places (2,), of those that are wholly beside the
    stock.
    """
    tool = context.job.tool(operation.cut.tool)
    for place in places:
        if stock.away(place[None])[0] >= tool.radius + _BESIDE:
            row = np.array([[*place, *place, 0.0, 0.0, 0.0, 0.0]])
            context.cleared.add(tool, row, np.array([-operation.cut.floor]))


def emit_prepared(context: OperationContext, index: int, prepared: PreparedStrokes, progress: Progress) -> None:
    """Append strokes that were prepared; those that begin beside the stock begin where nothing is in the way.

    Raises:
        ParameterError: the operation is deeper than the stock.
        Cancelled: by progress.
    """
    if prepared.open_stock is not None:
        starts = [np.array(stroke.start) for stroke in prepared.strokes]
        know_as_clear(context, context.job.operations[index], prepared.open_stock, starts)
    emit(context, index, prepared.area, prepared.strokes, progress)


def from_outside(
    context: OperationContext, operation: Operation, area: MachiningArea, strokes: Sequence[Stroke], keep: float
) -> tuple[Stroke, ...]:
    """Return strokes that begin beside the stock where they come there at all.

    A stroke begins on its innermost ring. The tool comes there straight from the nearest place of the stroke's own that
    is beside the stock, or, where walls are in the way, along the stroke itself, the other way round.

    Args:
        keep: of the tool's centre from walls, mm.
    """
    stock = open_stock(context, operation, area)
    assert stock is not None
    tool, cut = context.job.tool(operation.cut.tool), operation.cut
    ground = EntryContext(
        tool, cut.entry, area.distances, keep, beside=True, direction=cut.direction, cleared=context.cleared
    )
    made = tuple(_begun_outside(each, stock, ground) for each in strokes)
    know_as_clear(context, operation, stock, [np.array(each.start) for each in made])
    return made


def _begun_outside(stroke: Stroke, stock: BoxSides, ground: EntryContext) -> Stroke:
    """Return a stroke that begins beside the stock; itself where it does not come there."""
    beside = np.flatnonzero(stock.away(stroke.rows[:, :2]) >= ground.tool.radius + _BESIDE)
    if not len(beside):
        return stroke
    start, places = stroke.start, stroke.rows[beside, :2]
    for k in np.argsort(np.hypot(*(places - start).T), kind="stable")[:_TRIED].tolist():
        x, y = places[k].tolist()
        if keeps_off_walls((x, y), start, ground):
            row = np.array([[x, y, *start, 0.0, 0.0, 0.0, 0.0]])
            purpose = np.array([Purpose.POCKET], np.uint8)
            return replace(stroke, rows=row, purpose=purpose, least_z=None).and_then(stroke)
    along = np.concatenate([[0.0], np.cumsum(lengths(stroke.rows))])
    first = int(beside[np.argmin(along[beside])])
    return stroke.part(0, first).backwards().and_then(stroke)
