"""Clips of inserted blocks (XCLIP in CAD programs): whether one hides something of what its block draws."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from ...core import tolerances
from ...geometry.sample import sample
from ...model.curves import Curve

_ROUGH = 1e-3
"""By so much of its own size a clip may be too small: curves are looked at by their chords."""


def hides(insert: Any, curves: Iterable[Curve]) -> bool:
    """Tell whether a clip hides something of an inserted block, or may.

    Args:
        insert: of the library. curves: of its block, in the block's own coordinates.
    """
    if not insert.has_extension_dict:
        return False
    from ezdxf.xclip import XClip

    clip = XClip(insert)
    if not clip.is_clipping_enabled:
        return False
    path = clip.get_block_clipping_path()
    return path.is_inverted_clip or not _holds([(corner.x, corner.y) for corner in path.vertices], curves)


def _holds(corners: list[tuple[float, float]], curves: Iterable[Curve]) -> bool:
    """Tell whether all curves lie within a polygon."""
    import shapely

    try:
        with np.errstate(all="ignore"):
            area = shapely.make_valid(shapely.Polygon(corners))
            x0, y0, x1, y1 = area.bounds
            wider = area.buffer(tolerances.JOIN + _ROUGH * max(x1 - x0, y1 - y0), join_style="mitre")
            return all(bool(wider.covers(shapely.LineString(sample(curve)))) for curve in curves)
    except (ValueError, shapely.errors.GEOSException):  # too few corners, or numbers beyond all measure
        return False
