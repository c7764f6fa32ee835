"""What is proven of the engaged angle, of operations that have a limit of it: on the written text, as read back."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from ....core.progress import Progress
from ....core.wording import in_plane
from ....model.finding import Finding, FindingKind
from ....model.job import Job
from ....verify.engaged_angle import CutterPath, EngagementProof, prove_engagement
from ..written import WrittenMotions

METHOD = (
    "bounds on every motion as read back: no more of the rim than reaches beyond the ground that was cleared before, "
    "and nothing but these motions has cleared any; entries (ways down, and the first turn at their foot) are apart"
)

_TOLD = 20
"""Motions above the limit that are told one by one."""


@dataclass(frozen=True)
class LimitProof:
    """What is proven of an operation.

    Attributes:
        limit: of the engaged angle, radians.
        proof: places in program coordinates, motions of its own.
        origin: of these in part coordinates, mm.
        lines: of the NC text, of each of its motions.
    """

    KEY: ClassVar[str] = "engaged"

    limit: float
    proof: EngagementProof
    origin: tuple[float, float, float]
    lines: np.ndarray

    def values(self) -> dict[str, Any]:
        """Return it as a report lists it."""
        greatest = self.proof.greatest
        found = greatest.motion >= 0
        return {
            "limit_deg": round(math.degrees(self.limit), 6),
            "greatest_deg": math.degrees(greatest.angle),
            "x": greatest.x + self.origin[0] if found else None,
            "y": greatest.y + self.origin[1] if found else None,
            "line": int(self.lines[greatest.motion]) if found else None,
            "motions_above": len(self.proof.above),
            "entries": self.proof.entries,
            "entry_mm": self.proof.entry_mm,
            "method": METHOD,
        }

    def findings(self) -> list[Finding]:
        """Return what counts: motions that are not proven to keep the limit."""
        found = []
        for each in self.proof.above[:_TOLD]:
            x, y, line = each.x + self.origin[0], each.y + self.origin[1], int(self.lines[each.motion])
            text = (
                f"The engaged angle is proven to be at most {math.degrees(each.angle):.2f} degrees at "
                f"{in_plane(x, y)}, NC line {line}, and may be {math.degrees(self.limit):g} degrees at most "
                f"({len(self.proof.above)} motions in all)."
            )
            found.append(Finding(FindingKind.ENGAGEMENT, text, x, y, amount=math.degrees(each.angle), line=line))
        return found


def engagement_proofs(job: Job, motions: WrittenMotions, progress: Progress) -> dict[int, LimitProof]:
    """Return what is proven, by index of the operation, of those that have a limit and make moves.

    Raises:
        Cancelled: by progress.
    """
    limited = {k: each.proven_angle for k, each in enumerate(job.operations) if each.proven_angle is not None}
    proofs = {}
    for n, (index, limit) in enumerate(limited.items()):
        own = motions.done_for(index)
        if not len(own):
            continue
        radius = job.tool(job.operations[index].cut.tool).radius
        path = CutterPath(own.start, own.end, own.centre[:, :2], own.kind, radius, -motions.origin[2])
        proof = prove_engagement(path, limit, progress.part(n / len(limited), (n + 1) / len(limited)))
        proofs[index] = LimitProof(limit, proof, motions.origin, own.line)
    return proofs
