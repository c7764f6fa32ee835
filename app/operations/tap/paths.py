"""Tapping: down by one pitch a turn of the spindle, and out with the spindle turning back; and what is proven of it on
the written text as read back: how far the tap is fed for each turn, and how deep.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...core.errors import ParameterError
from ...core.progress import Progress
from ...model.finding import Finding, FindingKind
from ...model.hole_operations import TapOperation
from ...model.motion import MotionKind
from ...model.moves import Purpose
from ...model.tool import Tool
from ...toolpath.drill_holes import CircleHole, tip_depth
from ...toolpath.operation_context import OperationContext
from ..holes import (
    HolesBefore,
    HoleVerb,
    holes_in_order,
    no_thread_findings,
    out_of_hole,
    over_hole,
    thread_findings,
)
from ..registry import ProofInput
from ..thread_proof import ThreadProof, thread_loss

VERB = HoleVerb("tap", "taps", "tapped", "tap", "narrower than the thread's core")

_SAME = 0.15
"""mm by which a tap may be wider or narrower than its thread: taps are made with an allowance."""


def tapping_feed(operation: TapOperation, tool: Tool) -> float:
    """Return the feed of a tap, mm/min: the pitch for each turn of the spindle as the program says its speed."""
    return operation.thread.pitch * round(tool.spindle_speed)


def tap(context: OperationContext, index: int, progress: Progress) -> None:
    """Tap every circle that is as wide as the thread, or as the hole before it.

    Raises:
        ParameterError: it is deeper than the stock, or the tap is one of another thread.
        Cancelled: by progress.
    """
    job, builder = context.job, context.builder
    operation = job.operations[index]
    assert isinstance(operation, TapOperation)
    tool, thread = job.tool(operation.cut.tool), operation.thread
    if abs(tool.diameter - thread.major) > _SAME:
        raise ParameterError(
            f"T{tool.number} {tool.label} is {tool.diameter:g} mm wide, and a tap for {thread.value} is "
            f"{thread.major:g} mm; choose the thread or another tap."
        )
    bottom, feed = -tip_depth(job, operation), tapping_feed(operation, tool)
    unready: list[CircleHole] = []
    holes: list[CircleHole] = []
    made = HolesBefore(job, context.areas.drawn, index)
    for hole, label in holes_in_order(context, index, VERB, progress):
        holes.append(hole)
        if (made.at(hole, -bottom) or 0.0) < thread.nut_core - 1e-6:
            unready.append(hole)
        over_hole(context, (hole.x, hole.y), label)
        tapping = replace(label, plunge_rate=feed)
        builder.straight((hole.x, hole.y, bottom), Purpose.DRILL, tapping)
        builder.straight((hole.x, hole.y, job.retract_z), Purpose.DRILL, tapping)
        out_of_hole(context, label)
    if unready:
        first = unready[0]
        text = (
            f"No operation before it makes {'the hole' if len(unready) == 1 else f'{len(unready)} of the holes'} at "
            f"({first.x:.3f}, {first.y:.3f}) as wide as the core of {thread.value}, {thread.nut_core:.3f} mm, and "
            f"{-bottom:g} mm deep; the tap would break: drill {thread.tap_drill:g} mm first."
        )
        context.findings.append(Finding(FindingKind.ENGAGEMENT, text, first.x, first.y, amount=float(len(unready))))
    context.findings.extend(no_thread_findings(holes, made, operation, -bottom))
    context.findings.extend(thread_findings(holes, tool, operation))
    context.findings.append(_feed_finding(operation, tool, feed))


def _feed_finding(operation: TapOperation, tool: Tool, feed: float) -> Finding:
    """Return how fast the tap goes, and what the cut shows of it."""
    hand = " to the left" if operation.left_hand else ""
    text = (
        f"T{tool.number} taps {operation.thread.value}{hand} at {feed:g} mm/min: {operation.thread.pitch:g} mm a turn "
        f"at {round(tool.spindle_speed)} rpm. The cut shows no turns of a thread, only the core within the tap's teeth."
    )
    return Finding(FindingKind.ASSUMED, text, counts=False, amount=feed)


def tapped_proof(evidence: ProofInput) -> ThreadProof | None:
    """Return what is proven of an operation that taps; None where it has no holes."""
    operation, motions = evidence.operation, evidence.motions
    assert isinstance(operation, TapOperation)
    if not evidence.program.areas[evidence.index].regions:
        return None
    own = motions.kind == MotionKind.LINE
    speed = round(evidence.job.tool(operation.cut.tool).spindle_speed)
    off = np.abs(motions.feed[own] / speed - operation.thread.pitch)
    floor = operation.cut.floor + operation.beyond
    start, end = motions.start[:, 2], motions.end[:, 2]
    bottoms = end[own & (end < start)]
    bare = max(0.0, float((bottoms + floor).max(initial=-np.inf)))
    axes = sorted(set(map(tuple, motions.end[own & (end < start), :2].tolist())))
    loss = thread_loss(evidence, axes, operation.thread) if axes else None
    return ThreadProof(operation.thread, len(bottoms), float(off.max(initial=0.0)), bare_mm=bare, others=loss)
