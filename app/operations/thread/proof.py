"""What is proven of milled threads: on the written text, as read back.

Of each arc about a hole's axis: how far it goes along the axis for its angle, and how wide the gap is at the pitch
diameter, where tooth and gap are half a pitch wide each. The gap is what a tooth covers that goes round on the helix as
it was read, by its own shape: as wide at the mill's edge as a thread without error has it there.
"""

from __future__ import annotations

import math

import numpy as np

from ...model.curves import Circle
from ...model.hole_operations import ThreadOperation
from ...model.motion import Floats, MotionKind
from ...model.thread_sizes import ThreadSize
from ..registry import ProofInput
from ..thread_proof import ThreadProof, thread_loss

_ABOUT = 5e-3
"""mm; an arc whose centre is this near to a hole's axis goes round it."""

_ANGLES = np.linspace(-1.2, 1.2, 2001)
"""Radians to both sides of where a tooth cuts deepest, at which it is held against the thread's flank."""


def milled_proof(evidence: ProofInput) -> ThreadProof | None:
    """Return what is proven of an operation that mills threads; None where it has no holes."""
    operation = evidence.operation
    assert isinstance(operation, ThreadOperation)
    thread, tool = operation.thread, evidence.job.tool(operation.cut.tool)
    circles = (region.boundary.primitives[0] for region in evidence.program.areas[evidence.index].regions)
    axes = [each.centre for each in circles if isinstance(each, Circle)]
    if not axes:
        return None
    motions, kind = evidence.motions, evidence.motions.kind
    arcs = (kind >= MotionKind.ARC_CW) & (kind <= MotionKind.ARC_CCW)
    lead = diameter = bare = 0.0
    place: tuple[float, float] = axes[0]
    for x, y in axes:
        own = np.flatnonzero(arcs & (np.hypot(motions.centre[:, 0] - x, motions.centre[:, 1] - y) < _ABOUT))
        if not len(own):
            return ThreadProof(thread, len(axes), 0.0, 0.0, operation.cut.depth, x, y)
        a, b = motions.start[own] - (x, y, 0.0), motions.end[own] - (x, y, 0.0)
        angle = np.arctan2(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0], a[:, 0] * b[:, 0] + a[:, 1] * b[:, 1])
        sweep = np.where(kind[own] == MotionKind.ARC_CCW, angle % math.tau, -(-angle % math.tau))
        rise = -thread.pitch if operation.left_hand else thread.pitch  # of a turn counter-clockwise
        lead = max(lead, float(np.abs((b[:, 2] - a[:, 2]) * math.tau / sweep - rise).max()))
        for way in np.unique(np.round(np.hypot(a[:, 0], a[:, 1]), 6)):
            off = _pitch_diameter_off(thread, tool.radius, float(way), operation.external)
            if abs(off) > abs(diameter):
                diameter, place = off, (x, y)
        teeth = max(1, math.floor(tool.flute_length / thread.pitch + 1e-9))
        bare = max(bare, _bare(np.sort([a[:, 2], b[:, 2]], axis=0), operation.cut.depth, thread.pitch, teeth))
    return ThreadProof(thread, len(axes), lead, diameter, bare, *place, thread_loss(evidence, axes, thread))


def _pitch_diameter_off(thread: ThreadSize, radius: float, way: float, external: bool) -> float:
    """Return by how much the pitch diameter is too wide, mm, of what a tooth covers that goes round on a helix.

    Args:
        thread: that was asked for. radius: of the mill, mm. way: radius of its centre's helix, mm.
        external: on a boss, where what is cut too much makes it narrower.
    """
    slope, place = math.tan(math.radians(thread.form.value / 2)), thread.pitch_diameter / 2
    deep = place - thread.bolt_core / 2 if external else thread.major / 2 - place
    far = np.hypot(way * np.cos(_ANGLES) - place, way * np.sin(_ANGLES))
    half = (radius - far - deep) * slope + thread.pitch * _ANGLES / math.tau  # beyond a quarter of the pitch
    off = 2 * float(half.max()) / slope
    return -off if external else off


def _bare(heights: Floats, depth: float, pitch: float, teeth: int) -> float:
    """Return the longest stretch of a depth, but for a turn at its lower end, that no tooth comes by, mm.

    Args:
        heights: (2, n) from where to where each arc goes, mm.
    """
    low, high = heights[0], heights[1] + (teeth - 1) * pitch
    order = np.argsort(low)
    top, longest = -depth + pitch, 0.0
    for a, b in zip(low[order].tolist(), high[order].tolist(), strict=True):
        longest = max(longest, min(a, 0.0) - top)
        top = max(top, b)
    return max(longest, -top)
