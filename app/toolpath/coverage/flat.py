"""Moves and regions as shapely shapes, for measuring what was made; nothing here makes a path."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import Geometry as Shape

from ...geometry.buffer import buffered
from ...geometry.outlines import Outlines, polygons
from ...geometry.primitives import TURN, R, Rows, points_of, sweeps
from ...model.moves import MoveKind, Moves
from ...model.part import Region

_AT_A_TIME = 1024
"""Regions that are made polygons of together: chords and rings of all at once would be several times the polygons."""


def move_rows(moves: Moves, chosen: NDArray[np.integer] | None = None) -> Rows:
    """Return moves as rows (n, 8) of `app.geometry.primitives`, seen from above; a full circle is one row.

    Args:
        moves: all of them.
        chosen: (n,) indices of those that are wanted; None = all.
    """
    at = np.arange(len(moves)) if chosen is None else chosen
    start, end = moves.end[np.maximum(at - 1, 0), :2], moves.end[at, :2]
    centre, kind = np.nan_to_num(moves.centre[at]), moves.kind[at]
    radius = (np.hypot(*(start - centre).T) + np.hypot(*(end - centre).T)) / 2
    turn = np.where(kind == MoveKind.ARC_CCW, 1.0, -1.0)
    arc = kind >= MoveKind.ARC_CW
    return np.column_stack([start, end, centre, np.where(arc, radius, 0.0), np.where(arc, turn, 0.0)])


def flattened(rows: Rows, chord: float) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Return (row index (m,), points (m, 2)): each row as chords that stay within `chord` mm of it, both ends
    included.
    """
    radius = np.maximum(rows[:, R], chord)
    step = 2 * np.arccos(1 - chord / radius)
    turn = np.where(rows[:, TURN] != 0, np.abs(sweeps(rows)), 0.0)
    counts = np.maximum(1, np.ceil(turn / step)).astype(np.int64)
    owner = np.repeat(np.arange(len(rows)), counts + 1)
    place = np.arange(len(owner)) - np.repeat(np.cumsum(counts + 1) - counts - 1, counts + 1)
    points = points_of(rows, owner, place / counts[owner])
    last = place == counts[owner]
    points[last] = rows[owner[last], 2:4]
    return owner, points


def lines(rows: Rows, chord: float) -> NDArray[np.object_]:
    """Return each row as a shapely line of chords that stay within `chord` mm of it; a row without a length as a point.

    Trees of shapes find nothing near a line without a length.
    """
    owner, points = flattened(rows, chord)
    found = np.asarray(shapely.linestrings(points, indices=owner), dtype=object)
    still = np.all(rows[:, :2] == rows[:, 2:4], axis=1) & (rows[:, TURN] == 0)
    found[still] = shapely.points(rows[still, :2])
    return found


def region_shapes(regions: Sequence[Region], chord: float) -> NDArray[np.object_]:
    """Return regions as polygons (n,) whose chords stay within `chord` mm of their contours.

    They stay apart, since regions that touch have a wall of no thickness between them.
    """
    some = [_some_shapes(regions[k : k + _AT_A_TIME], chord) for k in range(0, len(regions), _AT_A_TIME)]
    return np.concatenate(some) if some else np.zeros(0, dtype=object)


def _some_shapes(regions: Sequence[Region], chord: float) -> NDArray[np.object_]:
    """Return `region_shapes` of a few regions."""
    outlines = Outlines.of([contour for region in regions for contour in region.contours])
    group = np.repeat(np.arange(len(regions)), [1 + len(region.islands) for region in regions])
    parts = shapely.get_parts(shapely.get_parts(polygons(outlines, group, chord)[1]))
    return np.asarray(
        parts[(shapely.get_type_id(parts) == shapely.GeometryType.POLYGON) & ~shapely.is_empty(parts)], dtype=object
    )


def quarter_chords(radius: float, chord: float) -> int:
    """Return how many chords a quarter circle needs to stay within `chord` mm (shapely's quad_segs)."""
    if radius <= chord:
        return 1
    return max(1, int(np.ceil(np.pi / 4 / np.arccos(1 - chord / radius))))


def grown(shapes: Shape | NDArray[np.object_], distance: float, chord: float) -> Shape:
    """Return for each shape all points within `distance` mm of it; a negative distance gives the points that deep
    inside.
    """
    return buffered(shapes, distance, quarter_chords(abs(distance), chord))
