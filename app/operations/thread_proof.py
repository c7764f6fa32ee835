"""What is proven of threads, milled or tapped: lead, pitch diameter, depth."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, ClassVar

from ..model.finding import Finding, FindingKind
from ..model.thread_sizes import ThreadSize

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
    """

    KEY: ClassVar[str] = "cut_thread"

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
