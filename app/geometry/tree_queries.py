"""Questions to a tree of shapes, asked in portions."""

from __future__ import annotations

import numpy as np
import shapely
from numpy.typing import NDArray

_PORTION = 500
"""Shapes a question; the library holds all other threads while it answers, the window's among them."""


def near(
    tree: shapely.STRtree, shapes: NDArray[np.object_], distance: float | NDArray[np.float64] | None = None
) -> NDArray[np.int64]:
    """Return pairs (2, m): index of a shape, index in the tree, whose boxes meet, or that come within a distance.

    Args:
        distance: mm, for all shapes or for each; None compares boxes only.
    """
    found = [np.zeros((2, 0), np.int64)]
    for first in range(0, len(shapes), _PORTION):
        part = slice(first, first + _PORTION)
        if distance is None:
            pairs = tree.query(shapes[part])
        else:
            pairs = tree.query(shapes[part], predicate="dwithin", distance=np.broadcast_to(distance, len(shapes))[part])
        found.append(pairs + np.array([[first], [0]]))
    return np.concatenate(found, axis=1)
