"""What is proven of threads, milled or tapped: lead, pitch diameter, depth, and what other operations leave of them."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

import numpy as np

from ..core.wording import in_plane
from ..model.curves import Point
from ..model.finding import Finding, FindingKind
from ..model.motion import Floats
from ..model.thread_sizes import ThreadSize
from .registry import ProofInput

REPORTED = 0.01
"""mm by which a thread's lead or its pitch diameter may be off before it counts: a fifth of the usual tolerance of
M3.
"""


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
        others: what other operations take of it.
    """

    KEY: ClassVar[str] = "cut_thread"

    thread: ThreadSize
    holes: int
    lead_off_mm: float
    pitch_diameter_off_mm: float = 0.0
    bare_mm: float = 0.0
    x: float | None = None
    y: float | None = None
    others: ThreadLoss | None = None

    def values(self) -> dict[str, Any]:
        """Return it as a report lists it."""
        return {
            "thread": self.thread.value,
            "holes": self.holes,
            "lead_off_mm": self.lead_off_mm,
            "pitch_diameter_off_mm": self.pitch_diameter_off_mm,
            "bare_mm": self.bare_mm,
            "cut_away_mm": self.others.deepest if self.others else 0.0,
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
        if self.others is not None:
            yield self.others.finding(self.thread)


_AROUND = 24
"""Places at least round an axis, at the pitch diameter, that are asked for how deep others cut."""


class ThreadLoss(NamedTuple):
    """What other operations cut of threads, at their pitch diameter, where they take most.

    Attributes:
        threads: of which they take more than a turn.
        x, y: of the worst one.
        depth: to which the thread is cut, mm. whole, deepest: down to where others cut all round, and anywhere, mm.
    """

    threads: int
    x: float
    y: float
    depth: float
    whole: float
    deepest: float

    def finding(self, thread: ThreadSize) -> Finding:
        """Return it in words; it counts where not a turn stands all round: one that is open on a side holds little."""
        stands = max(self.depth - self.whole, 0.0)
        what = f"Of the {self.depth:g} mm of {thread.value} at {in_plane(self.x, self.y)}"
        others = "" if self.threads == 1 else f", the worst of {self.threads} threads,"
        if self.deepest - self.whole > thread.pitch:
            how = f"other operations take {self.deepest:.3f} mm on a part of the way round"
        else:
            how = f"{stands:.3f} mm stand: other operations cut down to Z {-self.whole:.3f} there, beyond its teeth"
        return Finding(
            FindingKind.ENGAGEMENT,
            f"{what}{others} {how}; the depth counts from Z 0.",
            self.x,
            self.y,
            counts=self.depth - self.deepest < thread.pitch,
            amount=self.deepest,
        )


def thread_loss(evidence: ProofInput, axes: Sequence[Point], thread: ThreadSize) -> ThreadLoss | None:
    """Return what other operations, before or after it, take of threads round some axes; None where that is no more
    than a turn, as a countersink does. Other passes of threads take nothing.
    """
    operation = evidence.operation
    depth = operation.cut.floor + operation.beyond
    ring = _ring(thread, evidence.plain.spacing(thread.pitch))
    heights = evidence.plain.lowest((np.array(axes)[:, None] + ring).reshape(-1, 2))
    deep = np.clip(-heights, 0.0, depth).reshape(len(axes), len(ring))
    whole, lost = deep.min(axis=1), deep.max(axis=1)
    if not (lost > thread.pitch).any():
        return None
    worst = max(range(len(axes)), key=lambda k: (float(lost[k]), float(whole[k])))
    x, y = axes[worst]
    return ThreadLoss(int((lost > thread.pitch).sum()), x, y, depth, float(whole[worst]), float(lost[worst]))


def _ring(thread: ThreadSize, spacing: float) -> Floats:
    """Return places (n, 2) round an axis at the pitch diameter, no farther apart than a spacing, mm."""
    count = max(_AROUND, math.ceil(math.pi * thread.pitch_diameter / spacing))
    angles = np.linspace(0.0, math.tau, count, endpoint=False)
    found: Floats = np.column_stack([np.cos(angles), np.sin(angles)]) * thread.pitch_diameter / 2
    return found
