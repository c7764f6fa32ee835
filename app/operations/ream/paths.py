"""Reaming: down at feed to the depth, and out at feed, so that the way out marks no wall."""

from __future__ import annotations

from ...core.progress import Progress
from ...core.wording import in_plane
from ...model.finding import Finding, FindingKind
from ...model.hole_operations import ReamOperation
from ...model.moves import Purpose
from ...model.operation import ALIKE
from ...toolpath.drill_holes import CircleHole, tip_depth
from ...toolpath.operation_context import OperationContext
from ..holes import HolesBefore, HoleVerb, holes_in_order, out_of_hole, over_hole, width_findings

MOST_LEFT = 0.5
"""mm of diameter; what a reamer takes off at most: it cuts with its chamfer alone."""

VERB = HoleVerb("ream", "reams", "reamed", "reamer", f"narrower than the reamer by more than {ALIKE:g} mm")


def ream(context: OperationContext, index: int, progress: Progress) -> None:
    """Ream every circle as wide as the reamer.

    Raises:
        ParameterError: it is deeper than the stock.
        Cancelled: by progress.
    """
    job, builder = context.job, context.builder
    operation = job.operations[index]
    assert isinstance(operation, ReamOperation)
    bottom = -tip_depth(job, operation)
    solid: list[CircleHole] = []
    reamed: list[CircleHole] = []
    made = HolesBefore(job, context.areas.drawn, index)
    for hole, label in holes_in_order(context, index, VERB, progress):
        reamed.append(hole)
        before = made.at(hole, -bottom)
        if before is None or not 0 <= job.tool(operation.cut.tool).diameter - before <= MOST_LEFT:
            solid.append(hole)
        over_hole(context, (hole.x, hole.y), label)
        builder.straight((hole.x, hole.y, bottom), Purpose.DRILL, label)
        builder.straight((hole.x, hole.y, job.retract_z), Purpose.DRILL, label)
        out_of_hole(context, label)
    context.findings.extend(width_findings(reamed, job.tool(operation.cut.tool)))
    if solid:
        first = solid[0]
        text = (
            f"No operation before it drills {'the hole' if len(solid) == 1 else f'{len(solid)} of the holes'} at "
            f"{in_plane(first.x, first.y)} to a little less than T{operation.cut.tool} and as deep; a reamer takes "
            f"off {MOST_LEFT:g} mm of the diameter at the most: drill first."
        )
        context.findings.append(Finding(FindingKind.ENGAGEMENT, text, first.x, first.y, amount=float(len(solid))))
