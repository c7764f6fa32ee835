"""What is proven of threads: on the written text, as read back.

Of milled ones, each arc about a hole's axis: how far it goes along the axis for its angle, and how wide the gap is at
the pitch diameter, where tooth and gap are half a pitch wide each. The gap is what a tooth covers that goes round on
the helix as it was read, by its own shape: as wide at the mill's edge as a thread without error has it there. Of tapped
ones, how far the tap is fed for each turn of the spindle.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..model.curves import Circle
from ..model.finding import Finding, FindingKind
from ..model.hole_operations import TapOperation, ThreadOperation
from ..model.job import Job
from ..model.motion import MotionKind
from ..model.moves import Program
from ..model.thread_sizes import ThreadSize
from .written import OperationMotions, WrittenMotions

Floats = NDArray[np.float64]

REPORTED = 0.01
"""mm by which a thread's lead or its pitch diameter may be off before it counts: a fifth of the usual tolerance of
M3.
"""

_ABOUT = 5e-3
"""mm; an arc whose centre is this near to a hole's axis goes round it."""

_ANGLES = np.linspace(-1.2, 1.2, 2001)


@dataclass(frozen=True)
class ThreadProof:
    """What is proven of a thread operation.

    Attributes:
        thread: that was asked for.
        holes: how many have it.
        lead_off_mm: by which one turn is too long or too short, at most.
        pitch_diameter_off_mm: by which that is too wide (> 0) or too narrow, where it is worst.
        bare_mm: of the depth asked for, on which there is no thread, at most, but for a turn at the lower end.
        x, y: of the worst hole.
    """

    thread: ThreadSize
    holes: int
    lead_off_mm: float
    pitch_diameter_off_mm: float = 0.0
    bare_mm: float = 0.0
    x: float | None = None
    y: float | None = None

    def values(self) -> dict[str, Any]:
        """Return it as a report lists it."""
        return {
            "thread": self.thread.value,
            "holes": self.holes,
            "lead_off_mm": self.lead_off_mm,
            "pitch_diameter_off_mm": self.pitch_diameter_off_mm,
            "bare_mm": self.bare_mm,
        }

    def findings(self) -> Iterator[Finding]:
        """Yield what counts."""
        name, off = self.thread.value, self.pitch_diameter_off_mm
        if self.lead_off_mm > REPORTED:
            text = f"The lead of {name} is off by {self.lead_off_mm:.4f} mm a turn."
            yield Finding(FindingKind.TOLERANCE, text, self.x, self.y, amount=self.lead_off_mm)
        if abs(off) > REPORTED:
            text = f"The pitch diameter of {name} is {abs(off):.4f} mm too {'wide' if off > 0 else 'narrow'}."
            yield Finding(FindingKind.TOLERANCE, text, self.x, self.y, amount=abs(off))
        if self.bare_mm > REPORTED:
            text = f"{self.bare_mm:.3f} mm of the depth of {name} have no thread."
            yield Finding(FindingKind.LEFT_REACHABLE, text, self.x, self.y, amount=self.bare_mm)


def thread_proofs(program: Program, job: Job, motions: WrittenMotions) -> dict[int, ThreadProof]:
    """Return what is proven, by index of the operation, of those that cut threads and have holes."""
    if not motions.files:
        return {}
    threading = [
        k
        for k, each in enumerate(job.operations)
        if isinstance(each, ThreadOperation | TapOperation) and each.cut.enabled and program.areas[k].regions
    ]
    origin = np.array(motions.origin)
    return {k: _Turns(program, job, motions.done_for(k), origin).proof(k) for k in threading}


@dataclass(frozen=True, eq=False)
class _Turns:
    """Motions of an operation as read back; part = program + origin, mm."""

    program: Program
    job: Job
    motions: OperationMotions
    origin: Floats

    def proof(self, index: int) -> ThreadProof:
        """Return what is proven of an operation."""
        operation = self.job.operations[index]
        if isinstance(operation, TapOperation):
            return self._tapped(operation)
        assert isinstance(operation, ThreadOperation)
        return self._milled(index, operation)

    def _tapped(self, operation: TapOperation) -> ThreadProof:
        own = self.motions.kind == MotionKind.LINE
        speed = round(self.job.tool(operation.cut.tool).spindle_speed)
        off = np.abs(self.motions.feed[own] / speed - operation.thread.pitch)
        floor = operation.cut.floor + operation.beyond
        start, end = self.motions.start[:, 2] + self.origin[2], self.motions.end[:, 2] + self.origin[2]
        bottoms = end[own & (end < start)]
        bare = max(0.0, float((bottoms + floor).max(initial=-np.inf)))
        return ThreadProof(operation.thread, len(bottoms), float(off.max(initial=0.0)), bare_mm=bare)

    def _milled(self, index: int, operation: ThreadOperation) -> ThreadProof:
        thread, tool = operation.thread, self.job.tool(operation.cut.tool)
        circles = (region.boundary.primitives[0] for region in self.program.areas[index].regions)
        axes = [each.centre for each in circles if isinstance(each, Circle)]
        motions, kind = self.motions, self.motions.kind
        start, end, centre = motions.start + self.origin, motions.end + self.origin, motions.centre + self.origin
        arcs = (kind >= MotionKind.ARC_CW) & (kind <= MotionKind.ARC_CCW)
        lead = diameter = bare = 0.0
        place: tuple[float, float] = axes[0]
        for x, y in axes:
            own = np.flatnonzero(arcs & (np.hypot(centre[:, 0] - x, centre[:, 1] - y) < _ABOUT))
            if not len(own):
                return ThreadProof(thread, len(axes), 0.0, 0.0, operation.cut.depth, x, y)
            a, b = start[own] - (x, y, 0.0), end[own] - (x, y, 0.0)
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
        return ThreadProof(thread, len(axes), lead, diameter, bare, *place)


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
