"""Where a program's passes are, seen from above: what both cuts are compared over, and which way the passes run."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import shapely
from numpy.typing import NDArray

from ...model.motion import Floats


@dataclass(frozen=True, eq=False)
class PassArea:
    """A strip as wide as the pitch along each pass.

    Attributes:
        lines: (n, 3) places of the tip of each pass, program coordinates, mm. pitch: from pass to pass, mm.
    """

    lines: Sequence[Floats]
    pitch: float

    @cached_property
    def outline(self) -> shapely.Geometry:
        """All strips."""
        strips = [
            shapely.LineString(line[:, :2]).buffer(self.pitch / 2, cap_style="flat", join_style="mitre")
            for line in self.lines
        ]
        return shapely.union_all(strips, grid_size=1e-6)

    def inside(self, places: Floats) -> NDArray[np.bool_]:
        """Tell which places (n, 2), program coordinates, lie over the passes."""
        area = self.outline
        shapely.prepare(area)
        within: NDArray[np.bool_] = shapely.contains_xy(area, places[:, 0], places[:, 1])
        return within

    def angles(self, places: Floats) -> Floats:
        """Return how the pass that is nearest to places (n, 2) runs there, (n,) radians from X, its sense no matter."""
        from scipy.spatial import KDTree

        middles = np.concatenate([(line[1:, :2] + line[:-1, :2]) / 2 for line in self.lines])
        ways = np.concatenate([np.diff(line[:, :2], axis=0) for line in self.lines])
        found: Floats = np.arctan2(ways[:, 1], ways[:, 0])[KDTree(middles).query(places)[1]]
        return found
