"""What is proven to be left of V-carved areas: on the written text, as read back."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from ....core.progress import Progress
from ....model.finding import Finding, FindingKind
from ....model.job import Job
from ....model.motion import MotionKind
from ....model.moves import Program
from ....verify.carved_roof import ConePath, RoofProof, prove_roof, straightened
from ....verify.verdict import followed_walls
from ..written import WrittenMotions

METHOD = (
    "motions as read back, held against the largest discs behind places of the drawn curves; what is left at a disc's "
    "centre bounds what is left from there to the curve"
)

SIDEWAYS = 0.005
"""mm beside a wall; what is left and less than that is not told."""

_CHORD = 5e-4
"""mm between an arc and the chords that stand for it where what is left is measured."""


@dataclass(frozen=True)
class CarvingProof:
    """What is proven of an operation.

    Attributes:
        proof: in part coordinates.
        rate: mm of radius per mm of height.
        tool: its words. ball: whether it is a ball, which no corner is narrow enough for.
    """

    KEY: ClassVar[str] = "carved"

    proof: RoofProof
    rate: float
    tool: str
    ball: bool = False

    def values(self) -> dict[str, Any]:
        """Return it as a report lists it."""
        proof = self.proof
        return {
            "left_mm": proof.left_mm,
            "x": proof.x,
            "y": proof.y,
            "places": proof.places,
            "places_left": proof.above,
            "between_places_mm": proof.gap_mm / self.rate,
            "too_blunt_mm": proof.blunt_mm,
            "method": METHOD,
        }

    def findings(self) -> list[Finding]:
        """Return what counts: what is left and could be carved; and what the flat tip is too wide for."""
        proof, found = self.proof, []
        if proof.above:
            text = (
                f"{self.tool} leaves metal above the carved walls behind {proof.above} of {proof.places} places of the "
                f"drawn curves, {proof.left_mm:.4f} mm high at most, at ({proof.x:.3f}, {proof.y:.3f})."
            )
            found.append(Finding(FindingKind.LEFT_REACHABLE, text, proof.x, proof.y, amount=proof.left_mm))
        if proof.blunt_mm > 0:
            text = (
                f"{self.tool} is too round for {proof.blunt_mm:.3f} mm of the drawn curves, at inner corners and in "
                "narrow places, whose edges stay sharp; a V cutter or a smaller ball reaches them."
                if self.ball
                else f"The tip of {self.tool} is too wide for {proof.blunt_mm:.3f} mm of the drawn curves, at corners "
                "and in narrow places; a sharper cutter reaches them."
            )
            found.append(Finding(FindingKind.LEFT_UNREACHABLE, text, counts=False, amount=proof.blunt_mm))
        return found


def carving_proofs(program: Program, job: Job, motions: WrittenMotions, progress: Progress) -> dict[int, CarvingProof]:
    """Return what is proven, by index of the operation, of those that carve and have an area.

    Raises:
        Cancelled: by progress.
    """
    carving = [k for k, each in enumerate(job.operations) if each.CARVES and each.cut.enabled]
    if not motions.files:
        return {}
    proofs = {}
    for n, index in enumerate(carving):
        cut, regions = job.operations[index].cut, program.areas[index].regions
        if not regions:
            continue
        own = motions.done_for(index, cutting=True).moved(motions.origin)
        a, b, c = own.start, own.end, own.centre[:, :2]
        tool = job.tool(cut.tool)
        begins, ends = straightened(_rows(a, b, c, own.kind), np.stack([a[:, 2], b[:, 2]], 1), _CHORD)
        cone = job.operations[index].carved_by(tool)
        begins[:, 2] += cone.lifted
        ends[:, 2] += cone.lifted
        path = ConePath(begins, ends, cone.tip, cone.rate, cone.greatest, cone.flat)
        share = progress.part(n / len(carving), (n + 1) / len(carving))
        proof = prove_roof(path, followed_walls(program.areas[index]), SIDEWAYS / cone.rate, share)
        proofs[index] = CarvingProof(proof, cone.rate, f"T{tool.number} {tool.label}", cone.lifted > 0)
    return proofs


def _rows(start: np.ndarray, end: np.ndarray, centre: np.ndarray, kind: np.ndarray) -> np.ndarray:
    """Return motions as lines and arcs in the plane, (n, 8)."""
    rows = np.zeros((len(kind), 8))
    rows[:, :2], rows[:, 2:4] = start[:, :2], end[:, :2]
    turn = np.where(kind == MotionKind.ARC_CCW, 1.0, np.where(kind == MotionKind.ARC_CW, -1.0, 0.0))
    arcs = turn != 0
    rows[arcs, 4:6], rows[arcs, 7] = centre[arcs], turn[arcs]
    rows[arcs, 6] = np.hypot(*(start[arcs, :2] - centre[arcs]).T)
    return rows
