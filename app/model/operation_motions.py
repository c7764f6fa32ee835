"""Motions of one operation, as they were read back from the text: what its proof is made on."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from .motion import Floats


@dataclass(frozen=True, eq=False)
class OperationMotions:
    """Motions of one operation, n of them.

    Attributes:
        start, end, centre: (n, 3) mm; centres of arcs. Program coordinates, where they were not moved.
        kind: (n,) MotionKind.
        feed: (n,) mm/min.
        line: (n,) of the NC text of its file.
    """

    start: Floats
    end: Floats
    centre: Floats
    kind: NDArray[np.uint8]
    feed: Floats
    line: NDArray[np.int32]

    def __len__(self) -> int:
        return len(self.kind)

    def moved(self, by: tuple[float, float, float]) -> OperationMotions:
        """Return them so many mm along X, Y, Z."""
        return replace(self, start=self.start + by, end=self.end + by, centre=self.centre + by)
