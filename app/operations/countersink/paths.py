"""Countersinking: a cone goes straight down until it is as wide at the surface as it is to be there."""

from __future__ import annotations

from ...core.errors import ParameterError
from ...core.progress import Progress
from ...model.finding import Finding, FindingKind
from ...model.hole_operations import CountersinkOperation
from ...model.moves import Purpose
from ...toolpath.operation_context import OperationContext
from ..holes import HoleVerb, holes_in_order, out_of_hole, over_hole

VERB = HoleVerb(
    "countersink", "countersinks", "countersunk", "cutter", "not one that the cone fits, at its tip or where it ends,"
)


def countersink(context: OperationContext, index: int, progress: Progress) -> None:
    """Sink a cone into every circle that the cutter is wide enough for.

    Raises:
        ParameterError: a cone goes deeper than the stock and its waste.
        Cancelled: by progress.
    """
    job, builder = context.job, context.builder
    operation = job.operations[index]
    assert isinstance(operation, CountersinkOperation)
    tool = job.cutter(operation)
    depths = []
    for hole, label in holes_in_order(context, index, VERB, progress):
        depth = operation.tip_depth(hole.diameter, tool)
        if depth > job.stock.thickness + job.stock.under + 1e-9:
            raise ParameterError(
                f"T{tool.number} {tool.label} is {operation.made(hole.diameter, tool):g} mm wide {depth:.3f} mm "
                f"above its tip, but the stock is {job.stock.thickness:g} mm thick; take a blunter cone, or a smaller "
                "diameter."
            )
        over_hole(context, (hole.x, hole.y), label)
        builder.straight((hole.x, hole.y, -depth), Purpose.DRILL, label)
        out_of_hole(context, label)
        depths.append(depth)
    if depths:
        deep = f"{min(depths):.3f}" + (f" to {max(depths):.3f}" if max(depths) - min(depths) > 5e-4 else "")
        text = f"T{tool.number} goes {deep} mm deep with its tip, so that the cone is as wide at the top as asked."
        context.findings.append(Finding(FindingKind.ASSUMED, text, counts=False, amount=max(depths)))
