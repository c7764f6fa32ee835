"""Areas that a tool's centre may be in, on pixels alone, and the paths round them as levels of one distance field."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from app.bitmap.border import Index
from app.bitmap.peel import Floats, distance_px, frame_pixels
from app.bitmap.walls import Mask

SAFE_PX = 1.21
"""A path through pixel centres comes nearer to the walls' squares than its pixels' distances say by less than this:
half a pixel's diagonal for the square, half a pixel for the way between two centres."""


def offset_area(free: Mask, radius: float, spare: float) -> Mask:
    """Step 120: return the pixels in which a tool's centre may be, A' of A.

    Args:
        free: pixels whose squares lie wholly inside the part's walls.
        radius: of the tool, and the stock it leaves, px, >= 0; 0 = every free pixel.
        spare: how far smoothing may move the path off these pixels, px.
    """
    if radius == 0:
        return free
    area: Mask = distance_px(free) - SAFE_PX - spare >= radius
    return area


def frame_distance(area: Mask) -> Floats:
    """Return the distance of every pixel of A' from the nearest pixel of its frame, px: the one field that all rings are levels of.

    The frame's pixels are the contour tool's path itself. -1 outside of the area.
    """
    distance = distance_px(area, frame_pixels(area))
    distance[~area] = -1
    return distance


@dataclass(frozen=True, slots=True)
class RingSteps:
    """Where pocket paths lie, in pixels from the frame of A'.

    Attributes:
        first: the outermost one, >= 0.
        step: from path to path, >= 1.
        early: by how much all others lie nearer to the frame than steps say: what the outermost one keeps to be safe, they
            need not; 0 <= early <= step - 1.
    """

    first: float
    step: float
    early: float = 0.0


def ring_index(distance: Floats, steps: RingSteps) -> Index:
    """Return which pocket path each pixel lies inside of (steps 141-148): path k is the border of {index >= k}, k = 1, 2, …

    No path is made from the one before it, so nothing adds up.

    Args:
        distance: from the frame, px; -1 outside.
    """
    exact = np.sqrt(np.rint(np.maximum(distance, 0).astype(np.float64) ** 2))  # squares of distances are whole numbers
    outermost = (distance >= 0) & ((exact > steps.first) | (steps.first == 0))
    further = np.maximum((exact - steps.first + steps.early) // steps.step, 0)
    return np.where(outermost, np.minimum(1 + further, 65535), 0).astype(np.uint16)
