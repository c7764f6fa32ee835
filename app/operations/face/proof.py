"""What is proven of facing: on the written text, as read back, the area of the stock's top that no pass at Z 0
clears.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
import shapely

from ...model.finding import Finding, FindingKind
from ...model.motion import MotionKind
from ...model.stock_box import stock_box
from ..registry import ProofInput

_LEVEL = 1e-3
"""mm above Z 0 at which a pass still clears it."""

_CHORD = 1e-3
"""mm; strips end in chords that lie this much within them, at most."""

_LEAST = 1e-4
"""mm2; less is left by digits alone."""


@dataclass(frozen=True)
class FaceProof:
    """What is proven of a face operation.

    Attributes:
        left_mm2: of the stock's top that no pass clears. x, y: in the middle of the largest such place.
    """

    KEY: ClassVar[str] = "faced"

    left_mm2: float
    x: float
    y: float

    def values(self) -> dict[str, Any]:
        """Return it as a report lists it."""
        return {"left_mm2": self.left_mm2, "x": self.x, "y": self.y}

    def findings(self) -> Iterator[Finding]:
        """Yield what counts."""
        if self.left_mm2 > _LEAST:
            text = f"{self.left_mm2:.4f} mm2 of the stock's top are not faced; use a smaller stepover."
            yield Finding(FindingKind.LEFT_REACHABLE, text, self.x, self.y, amount=self.left_mm2)


def face_proof(evidence: ProofInput) -> FaceProof:
    """Return what is proven of a face operation."""
    job, motions = evidence.job, evidence.motions
    box = stock_box(job, evidence.program.regions, evidence.program.lines)
    top = shapely.box(box.x0, box.y0, box.x1, box.y1)
    low = (motions.kind == MotionKind.LINE) & (np.maximum(motions.start[:, 2], motions.end[:, 2]) <= _LEVEL)
    ways = shapely.linestrings(np.stack([motions.start[low, :2], motions.end[low, :2]], axis=1))
    radius = job.tool(evidence.operation.cut.tool).profile.flat
    cleared = shapely.union_all(shapely.buffer(ways, radius - _CHORD, quad_segs=64))
    left = shapely.difference(top, cleared)
    place = shapely.point_on_surface(max(shapely.get_parts(left), key=shapely.area) if left.area else top)
    return FaceProof(float(left.area), float(place.x), float(place.y))
