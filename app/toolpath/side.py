"""Which way along the walls a cutter goes: rings, cut open where they run beside clamps, in the order that frees parts
last.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import shapely

from ..geometry.offset.offset import OffsetLevel, Ring
from ..geometry.outlines import Outlines, polygons
from ..geometry.primitives import reversed_rows
from ..model.operation import Direction
from .leads.contour_path import ContourPath
from .machining_areas import MachiningArea

_CHORD = 0.01
"""mm; only which ring lies in which depends on it."""


def wall_paths(level: OffsetLevel, area: MachiningArea, direction: Direction) -> tuple[ContourPath, ...]:
    """Return the paths along all walls that a level's rings follow, but not along clamps or the frame.

    A ring has the area to machine on its left, inside and outside alike, and so the metal that stays on its right: its
    own direction is climb milling.

    Args:
        level: rings at tool radius + stock to leave.
    """
    paths: list[ContourPath] = []
    for ring, rank in zip(level.rings, ranks([ring.rows for ring in level.rings]), strict=True):
        paths.extend(_along_walls(ring, area, rank))
    if direction is Direction.CLIMB:
        return tuple(paths)
    return tuple(
        ContourPath(reversed_rows(path.rows), path.closed, path.region, path.rank, path.area) for path in paths
    )


def _along_walls(ring: Ring, area: MachiningArea, rank: int) -> list[ContourPath]:
    bare = area.follows_bare(ring.rows)
    if not bare.any():
        return [ContourPath(ring.rows, True, ring.region, rank, ring.area)]
    if bare.all():
        return []
    # begin beside something bare, so that no run is cut in two by the ring's own beginning
    first = int(np.argmax(bare))
    rows, bare = np.roll(ring.rows, -first, axis=0), np.roll(bare, -first)
    edges = np.flatnonzero(np.diff(np.concatenate([[True], bare, [True]]).astype(np.int8)))
    return [ContourPath(rows[a:b], False, ring.region, rank, ring.area) for a, b in edges.reshape(-1, 2).tolist()]


def ranks(loops: Sequence[np.ndarray]) -> list[int]:
    """Return how many of some closed loops of rows lie round each of them."""
    if len(loops) < 2:
        return [0] * len(loops)
    outlines = Outlines.joined(loops)
    shapes = np.asarray(shapely.points(outlines.rows[outlines.first[:-1], :2]), dtype=object)
    places = shapes.copy()
    number, wide = polygons(outlines, np.arange(len(outlines)), _CHORD)
    shapes[number] = wide
    held = shapely.STRtree(shapes).query(places, predicate="within")
    size = shapely.area(shapes)
    inside = held[:, (held[0] != held[1]) & (size[held[0]] < size[held[1]])]
    return [int(count) for count in np.bincount(inside[0], minlength=len(loops))]
