"""What is proven of tapped threads, on the written text as read back: how far the tap is fed for each turn of the
spindle, and how deep.
"""

from __future__ import annotations

import numpy as np

from ...model.hole_operations import TapOperation
from ...model.motion import MotionKind
from ..registry import ProofInput
from ..thread_proof import ThreadProof, thread_loss


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
