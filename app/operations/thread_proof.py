"""What is proven of threads, milled or tapped: lead, pitch diameter, depth, and what other operations leave of them."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.wording import in_plane
from ..geometry.primitives import boxes, distances
from ..model.curves import Point
from ..model.finding import Finding, FindingKind
from ..model.job import Job
from ..model.motion import Floats
from ..model.moves import Moves
from ..model.thread_sizes import ThreadSize
from ..model.tool import Tool
from ..toolpath.coverage.areas import move_rows
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
"""Places round an axis, at the pitch diameter, that are asked for how deep others cut."""


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
        """Return it in words; it counts where not a turn stands all round."""
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
            counts=stands < thread.pitch,
            amount=self.deepest,
        )


def thread_loss(evidence: ProofInput, axes: Sequence[Point], thread: ThreadSize) -> ThreadLoss | None:
    """Return what other operations, before or after it, take of threads round some axes; None where that is no more
    than a turn, as a countersink does. Other passes of threads take nothing.
    """
    operation = evidence.operation
    depth = operation.cut.floor + operation.beyond
    cuts = _OtherCuts.of(evidence.program.moves, evidence.job, evidence.index)
    angles = np.linspace(0.0, math.tau, _AROUND, endpoint=False)
    ring = np.column_stack([np.cos(angles), np.sin(angles)]) * thread.pitch_diameter / 2
    deep = np.array([np.minimum(cuts.depths(ring + axis), depth) for axis in axes])
    lost = deep.max(axis=1)
    if not (lost > thread.pitch).any():
        return None
    worst = max(range(len(axes)), key=lambda k: (float(deep[k].min()), float(lost[k])))
    x, y = axes[worst]
    return ThreadLoss(int((lost > thread.pitch).sum()), x, y, depth, float(deep[worst].min()), float(lost[worst]))


class _OtherCuts(NamedTuple):
    """Moves that cut: rows (n, 8) and boxes (n, 4) of the cutter's centre, heights of their tips (n,), and the flat
    radius, the rounding, the rise of the cone and the radius of each cutter, (n, 4).
    """

    rows: Floats
    around: Floats
    tips: Floats
    shapes: Floats

    @staticmethod
    def of(moves: Moves, job: Job, index: int) -> _OtherCuts:
        """Return the moves below Z 0 of all operations but one, and but those that cut threads, too."""
        threads = [tool.number for tool in job.tools if tool.kind.threads]
        low = np.minimum(moves.start[:, 2], moves.end[:, 2])
        chosen = np.flatnonzero((low < 0) & (moves.operation != index) & ~np.isin(moves.tool, threads))
        rows = move_rows(moves, chosen)
        upright = (rows[:, :2] == rows[:, 2:4]).all(axis=1) & (rows[:, 7] == 0)
        high = np.maximum(moves.start[chosen, 2], moves.end[chosen, 2])
        shapes = {tool.number: _shape(tool) for tool in job.tools}
        own = np.array([shapes[number] for number in moves.tool[chosen].tolist()]).reshape(-1, 4)
        return _OtherCuts(rows, boxes(rows), np.where(upright, low[chosen], high), own)

    def depths(self, points: Floats) -> Floats:
        """Return how deep is cut at points (m, 2) near one another, mm: of a slope what its upper end cuts."""
        low, high = points.min(axis=0), points.max(axis=0)
        wide = self.shapes[:, 3:]
        near: NDArray[np.bool_] = (self.around[:, :2] - wide <= high).all(axis=1)
        near &= (self.around[:, 2:] + wide >= low).all(axis=1)
        rows, tips, shapes = self.rows[near], self.tips[near], self.shapes[near]
        found = np.zeros(len(points))
        for k, point in enumerate(points):
            beyond = distances(rows, np.broadcast_to(point, (len(rows), 2))) - shapes[:, 0]
            rise = np.where(beyond <= 0, 0.0, shapes[:, 1] + beyond * shapes[:, 2])
            cut = np.where(beyond + shapes[:, 0] < shapes[:, 3], -(tips + rise), 0.0)
            found[k] = cut.max(initial=0.0)
        return found


def _shape(tool: Tool) -> tuple[float, float, float, float]:
    profile = tool.profile
    return profile.flat, profile.fillet, profile.cone, tool.radius
