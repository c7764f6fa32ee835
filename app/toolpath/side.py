"""Which way along the walls a cutter goes: rings, cut open where they run beside clamps, in the order that frees parts
last.
"""

from __future__ import annotations

import numpy as np

from ..geometry.nesting import ranks
from ..geometry.offset.offset import Level, Ring
from ..geometry.primitives import reversed_rows
from ..model.operation import Direction
from .leads.contour_path import Path
from .sheets import Sheet


def wall_paths(level: Level, sheet: Sheet, direction: Direction) -> tuple[Path, ...]:
    """Return the paths along all walls that a level's rings follow, but not along clamps or the frame.

    A ring has the area to machine on its left, inside and outside alike, and so the metal that stays on its right: its
    own direction is climb milling.

    Args:
        level: rings at tool radius + stock to leave.
    """
    paths: list[Path] = []
    for ring, rank in zip(level.rings, ranks([ring.rows for ring in level.rings]), strict=True):
        paths.extend(_along_walls(ring, sheet, rank))
    if direction is Direction.CLIMB:
        return tuple(paths)
    return tuple(Path(reversed_rows(path.rows), path.closed, path.region, path.rank, path.area) for path in paths)


def _along_walls(ring: Ring, sheet: Sheet, rank: int) -> list[Path]:
    bare = sheet.follows_bare(ring.rows)
    if not bare.any():
        return [Path(ring.rows, True, ring.region, rank, ring.area)]
    if bare.all():
        return []
    # begin beside something bare, so that no run is cut in two by the ring's own beginning
    first = int(np.argmax(bare))
    rows, bare = np.roll(ring.rows, -first, axis=0), np.roll(bare, -first)
    edges = np.flatnonzero(np.diff(np.concatenate([[True], bare, [True]]).astype(np.int8)))
    return [Path(rows[a:b], False, ring.region, rank, ring.area) for a, b in edges.reshape(-1, 2).tolist()]
