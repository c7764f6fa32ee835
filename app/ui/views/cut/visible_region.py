"""Which part of the stock is worth a finer look (step S101): the rectangle round all that is seen of it. No Qt."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .camera import Camera, Floats, Size
from .cell_picking import SectionPlane, pick_finest
from .cut_picture import CutPicture

VisibleRegion = tuple[float, float, float, float]
"""x0, y0, x1, y1, mm."""

LEAST_PITCH = 1e-3
"""mm; finer cells than these would show the rounding of the heights."""

RAYS = (21, 15)
"""Lines of sight across and down that look for what is seen."""

GAIN = 0.7
"""A finer look is worth its time where its cells are smaller than this share of those that are shown."""

_MARGIN = 0.06
_SPARE = 1.6
_SLIMMEST, _LEAST_HALF = 0.05, 1e-3
"""A part is not slimmer than this share of its length; and mm."""


@dataclass(frozen=True, eq=False)
class RegionQuery:
    """What is looked at, and how.

    Attributes:
        picture: all of the cut. detail: a part of it in finer cells, or None.
        camera: from where. size: of the view, px. section: what is taken away.
    """

    picture: CutPicture
    detail: CutPicture | None
    camera: Camera
    size: Size
    section: SectionPlane | None


def region_to_refine(sight: RegionQuery, cells: int) -> VisibleRegion | None:
    """Return the part of the stock that should be cut with finer cells; None where the cells of the whole will do.

    Args:
        sight: what is looked at.
        cells: along the longer side of a part, as of the whole.
    """
    seen = seen_part(sight)
    if seen is None:
        return None
    low, high = sight.picture.low[:2], sight.picture.high[:2]
    middle, half = (seen[0] + seen[1]) / 2, (seen[1] - seen[0]) * (0.5 + _MARGIN)
    half = np.maximum(half, max(float(half.max()), _LEAST_HALF) * _SLIMMEST)
    half *= max(1.0, 0.5 * LEAST_PITCH * cells / float(half.max()))
    first, last = np.maximum(middle - half, low), np.minimum(middle + half, high)
    if np.any(last <= first) or float(np.max(last - first)) > GAIN * sight.picture.pitch * cells:
        return None
    return float(first[0]), float(first[1]), float(last[0]), float(last[1])


def serves(window: VisibleRegion, detail: CutPicture | None) -> bool:
    """Return whether the finer look that there is shows a part of the stock well enough."""
    if detail is None:
        return False
    low, high, slack = detail.low[:2], detail.high[:2], 2 * detail.pitch
    inside = bool(np.all(np.array(window[:2]) >= low - slack) and np.all(np.array(window[2:]) <= high + slack))
    return inside and max(window[2] - window[0], window[3] - window[1]) * _SPARE >= float(np.max(high - low))


def seen_part(sight: RegionQuery) -> tuple[Floats, Floats] | None:
    """Return the corners of the rectangle, XY, round all metal that lines of sight through the view meet; None = they
    meet none.
    """
    width, height = sight.size
    places = [(x, y) for x in np.linspace(0.5, width - 0.5, RAYS[0]) for y in np.linspace(0.5, height - 0.5, RAYS[1])]
    hits = (pick_finest(sight.picture, sight.detail, sight.camera.ray(at, sight.size), sight.section) for at in places)
    met = np.array([hit.place[:2] for hit in hits if hit is not None])
    if not len(met):
        return None
    return met.min(axis=0), met.max(axis=0)
