"""Fewer points for a cutter's path: raised by up to the tolerance, between chords that are proven anew."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core.progress import NO_PROGRESS, Progress

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_UPRIGHT = 1e-9
"""mm; points that are no farther apart along the line stand over one another."""
_TIMES = 4
"""So often are the ends of a chord raised that is not proven, each time by twice as much; then the points that it left
out come back.
"""


@dataclass(frozen=True, slots=True)
class PathSimplification:
    """How points are left out of a path.

    Attributes:
        along: direction of its line, of length 1.
        room: how much higher than the path another one may be, square to it, mm.
        grid: heights are rounded up to it, mm, or 0.
        owner: (m,) of each facet.
        proven: returns which chords (m, 6) of the tip's way go nowhere deeper into surfaces than allowed.
    """

    along: tuple[float, float]
    room: float
    grid: float
    owner: Ints
    proven: Callable[[Floats, Progress], NDArray[np.bool_]]


def simplified(rows: Sequence[Floats], way: PathSimplification, progress: Progress = NO_PROGRESS) -> list[Floats]:
    """Return paths (n, COLUMNS of `point_kernels`) with as few points as `way` asks for.

    Ends of runs, boundary points, corners of jumps and what they join, and places where the surface changes stay as
    they are. Nothing of the new paths is lower than the old ones, so whatever is proven of these holds; only as places
    are rounded a chord may pass beside the points that it leaves out. So all are proven once more, raised a little
    where they are not, and given up where that does not help.
    """
    from . import thin_kernels as t
    from .point_kernels import Z

    sizes = [len(each) for each in rows]
    if not sum(sizes):
        return list(rows)
    all_rows = np.concatenate(rows)
    path = _path(all_rows, np.cumsum([0, *sizes[:-1]]), way)
    t.give_room(path, max(way.room - way.grid, 0.0))
    kept, heights = np.empty(len(path) + 1, np.int64), np.empty(len(path) + 1)
    count = t.thin(path, way.grid, kept, heights)
    at = np.full(len(path), np.nan)
    at[kept[:count]] = heights[:count]
    _prove(all_rows, path, at, way, progress)
    made = all_rows.copy()
    made[:, Z] = at
    return [part[~np.isnan(part[:, Z])] for part in np.split(made, np.cumsum(sizes)[:-1])]


def _path(rows: Floats, begins: Ints, way: PathSimplification) -> Floats:
    """Return rows as `thin_kernels` read them.

    Args:
        begins: rows at which another stretch of a plane begins.
    """
    from . import point_kernels as k
    from . import thin_kernels as t

    new, first = rows[:, k.NEW], np.zeros(len(rows), np.bool_)
    first[begins[begins < len(rows)]] = True
    first |= new == k.BEGINS
    corner = new == k.CORNER
    owner = way.owner[rows[:, k.FACET].astype(np.int64)]
    fixed = first | (new == k.BOUNDARY) | corner | (np.diff(owner, prepend=owner[:1]) != 0)
    fixed[1:] |= corner[:-1]
    fixed[:-1] |= corner[1:] | first[1:]
    fixed[-1] = True
    place = rows[:, k.X] * way.along[0] + rows[:, k.Y] * way.along[1]
    upright = ~first[1:] & (np.diff(place) < _UPRIGHT)  # rounded to one place
    fixed[1:] |= upright
    fixed[:-1] |= upright
    path = np.zeros((len(rows), t.COLUMNS))
    path[:, t.T], path[:, t.Z], path[:, t.FIXED], path[:, t.BEGINS] = place, rows[:, k.Z], fixed, first
    return path


def _prove(rows: Floats, path: Floats, at: Floats, way: PathSimplification, progress: Progress) -> None:
    """Raise the points that are kept, and bring back others, so that all chords between them are proven.

    Args:
        at: (n,) height of each point that is kept, NaN of the others; changed.
    """
    from . import point_kernels as k
    from . import thin_kernels as t

    kept = np.flatnonzero(~np.isnan(at))
    longer = np.diff(kept) > 1  # what leaves no point out lies over a chord that is proven
    first, last = kept[:-1][longer], kept[1:][longer]
    for turn in range(_TIMES + 1):
        ends = [np.column_stack([rows[n, k.X], rows[n, k.Y], at[n]]) for n in (first, last)]
        good = way.proven(np.concatenate(ends, axis=1), progress)
        first, last = first[~good], last[~good]
        if not len(first) or turn == _TIMES or way.grid == 0:
            break
        for n in (first, last):
            most = path[n, t.Z] + path[n, t.ROOM]
            steep = path[n, t.ROOM] / way.room
            raised = np.ceil((at[n] + 2.0**turn * way.grid * steep) / way.grid - 1e-6) * way.grid
            at[n] = np.maximum(at[n], np.minimum(raised, most))
    for begin, stop in zip(first.tolist(), last.tolist(), strict=True):
        at[begin + 1 : stop] = path[begin + 1 : stop, t.Z]
