"""Clips of inserted blocks (XCLIP in CAD programs): of which layers one hides something that its block draws."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from typing import Any

import numpy as np

from ...core import tolerances
from ...geometry.sample import sample
from ...model.curves import Curve

_ROUGH = 1e-3
"""By so much of its own size a clip may be too small: curves are looked at by their chords."""


def hidden_layers(insert: Any, curves: Iterable[tuple[Curve, str]]) -> tuple[str, ...]:
    """Return the layers of which a clip of an inserted block hides something, or may; none where it hides nothing.

    Args:
        insert: of the library. curves: of its block, in the block's own coordinates, each with its layer.
    """
    if not insert.has_extension_dict:
        return ()
    from ezdxf.xclip import XClip

    clip = XClip(insert)
    if not clip.is_clipping_enabled:
        return ()
    path, by_layer = clip.get_block_clipping_path(), defaultdict[str, list[Curve]](list)
    for curve, layer in curves:
        by_layer[layer].append(curve)
    area = None if path.is_inverted_clip else _area([(corner.x, corner.y) for corner in path.vertices])
    return tuple(layer for layer, drawn in by_layer.items() if area is None or not _holds(area, drawn))


def _area(corners: list[tuple[float, float]]) -> Any:
    """Return the area of a polygon, a little wider; None for too few corners, or numbers beyond all measure."""
    import shapely

    try:
        with np.errstate(all="ignore"):
            area = shapely.make_valid(shapely.Polygon(corners))
            x0, y0, x1, y1 = area.bounds
            return area.buffer(tolerances.JOIN + _ROUGH * max(x1 - x0, y1 - y0), join_style="mitre")
    except (ValueError, shapely.errors.GEOSException):
        return None


def _holds(area: Any, curves: Iterable[Curve]) -> bool:
    """Tell whether all curves lie within an area."""
    import shapely

    try:
        with np.errstate(all="ignore"):
            return all(bool(area.covers(shapely.LineString(sample(curve)))) for curve in curves)
    except (ValueError, shapely.errors.GEOSException):  # numbers beyond all measure
        return False
