"""How wide a region is: its narrowest passage, its largest disc, and the largest cutter that leaves nothing but sharp
corners.

All from discs that touch the walls (`advise_walls`). A passage is a pair of points of two walls between which the disc
over their distance is free; its ends are found in closed form. A cutter leaves nothing but sharp corners if it can
touch all of every wall but what lies near inner corners: there the disc that touches the wall shrinks to nothing
towards the corner, and what counts is how large it grows away from it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...core.progress import NO_PROGRESS, Progress
from ...geometry.primitives import CX, Indices, R, Rows
from .walls import Discs, Floats, Walls, discs_along, discs_at, feet_on

SHORTEST = 0.1
"""mm; a wall shorter than this is part of a corner, and no cutter is chosen for it."""

_OPPOSITE = -0.17
"""Cosine between the places where a disc touches, from its centre, below which they may be the ends of a passage."""

_NOTHING = 1e-4
"""mm; a passage narrower than this is a place where walls touch."""

_PORTION = 2000
"""Passages that are looked at in one go."""

_PROVEN = 1e-7
"""mm by which a wall may reach into the disc of a passage: rounding."""

_FALL = 1e-6
"""Share by which discs may shrink on the way out of a corner: rounding; more where the wall has small bends."""

_FALL_KINKED = 5e-3

_LOOKED_AT = 8
"""Walls and tips a region that are measured more closely, those first that matter most."""

_STEPS = 17
"""Places on a piece of wall, of which the best and its neighbours are looked at again."""

_REPEATS = 6


@dataclass(frozen=True)
class RegionWidths:
    """What n regions are like, in the order of their numbers; places (n, 2), sizes (n,), mm.

    Attributes:
        passage, passage_at: diameter of the largest disc that passes everywhere, and the middle of the narrowest place.
        disc, disc_at: diameter and centre of the largest disc.
        clearing, clearing_at: diameter of the largest cutter that leaves nothing but sharp corners, and where its
            centre would be in the place that keeps it from being larger.
    """

    passage: Floats
    passage_at: Floats
    disc: Floats
    disc_at: Floats
    clearing: Floats
    clearing_at: Floats


def widths(walls: Walls, progress: Progress = NO_PROGRESS) -> RegionWidths:
    """Return the widths of all regions, each within 0.001 mm.

    Raises:
        Cancelled: by progress.
    """
    discs = discs_along(walls, progress.part(0.0, 0.6))
    numbers, region = np.unique(walls.region, return_inverse=True)
    progress.step(0.6, "Largest discs")
    disc, disc_at = _largest(walls, discs, region, len(numbers))
    progress.step(0.7, "Passages")
    passage, passage_at = _narrowest(walls, discs, region, disc, progress.part(0.7, 0.9))
    wide = np.isinf(passage)
    passage[wide], passage_at[wide] = disc[wide], disc_at[wide]
    progress.step(0.9, "Walls that a cutter reaches")
    clearing, clearing_at = _least_touch(walls, discs, region, len(numbers))
    for size, at in ((passage, passage_at), (disc, disc_at)):
        less = size < clearing
        clearing[less], clearing_at[less] = size[less], at[less]
    return RegionWidths(passage, passage_at, disc, disc_at, clearing, clearing_at)


def _largest(walls: Walls, discs: Discs, region: Indices, count: int) -> tuple[Floats, Floats]:
    """Return (diameter (count,), centre (count, 2)) of the largest disc of each region."""
    order = np.lexsort((-discs.radius, region[discs.row]))
    places = order[_first_of_each(region[discs.row[order]], discs.track[order])]
    found = _sharpened(walls, discs, places, np.ones(len(places), np.bool_))
    return _best(2 * found.radius, found.centre, region[discs.row[places]], count, largest=True)


def _first_of_each(region: Indices, track: Indices) -> Indices:
    """Return indices of the first place on each track, for the first few tracks of each region; places come region by
    region.
    """
    _, first = np.unique(track, return_index=True)
    first = np.sort(first)
    begin = np.searchsorted(region[first], region[first], side="left")
    kept: Indices = first[np.arange(len(first)) - begin < _LOOKED_AT]
    return kept


def _best(size: Floats, at: Floats, region: Indices, count: int, largest: bool) -> tuple[Floats, Floats]:
    """Return the largest or the least size of each region and where it is."""
    order = np.lexsort((-size if largest else size, region))
    regions, first = np.unique(region[order], return_index=True)
    sizes, places = np.full(count, 0.0 if largest else np.inf), np.full((count, 2), np.nan)
    sizes[regions], places[regions] = size[order][first], at[order][first]
    return sizes, places


def _sharpened(walls: Walls, discs: Discs, places: Indices, largest: np.ndarray) -> Discs:
    """Return the largest discs near some places (m,) along their tracks, or the least ones where `largest` (m,) is
    False.
    """
    track = discs.track[places]
    size = walls.spans[track]
    at = discs.place[places]
    reach = np.minimum(_spacing(walls, discs)[places], size)
    sign = np.where(largest, 1.0, -1.0)
    for _ in range(_REPEATS):
        low, high = np.clip(at - reach, 0.0, size), np.clip(at + reach, 0.0, size)
        tried = low[:, None] + (high - low)[:, None] * np.linspace(0.0, 1.0, _STEPS)
        tried[:, _STEPS // 2] = at  # what is known is not lost
        found = discs_at(walls, np.repeat(track, _STEPS), tried.ravel())
        best = np.argmax(found.radius.reshape(-1, _STEPS) * sign[:, None], axis=1)
        at, reach = tried[np.arange(len(at)), best], 2.2 * reach / (_STEPS - 1)
    return discs_at(walls, track, at)


def _spacing(walls: Walls, discs: Discs) -> Floats:
    """Return how far (m,) the places to both sides of each place are away at most, mm."""
    gaps = np.where(discs.track[1:] == discs.track[:-1], np.diff(discs.place), 0.0)
    around = np.maximum(np.concatenate([[0.0], gaps]), np.concatenate([gaps, [0.0]]))
    found: Floats = np.where(around > 0, around, walls.spans[discs.track])
    return found


def _least_touch(walls: Walls, discs: Discs, region: Indices, count: int) -> tuple[Floats, Floats]:
    """Return (diameter, centre) of the least disc that must fit so that every wall is touched but for its inner
    corners.
    """
    begin = np.searchsorted(discs.track, np.arange(len(walls.size) + 1))
    telling, peaks = np.full(len(walls.size), -1), np.zeros(len(walls.size), np.bool_)
    for k in np.flatnonzero(walls.size >= SHORTEST):
        own = discs.radius[begin[k] : begin[k + 1]]
        at, peaks[k] = _telling(own, walls.corners[k], _FALL_KINKED if walls.kinked[k] else _FALL)
        telling[k] = begin[k] + at
    telling = telling[telling >= 0]
    order = telling[np.lexsort((discs.radius[telling], region[discs.row[telling]]))]
    places = order[_first_of_each(region[discs.row[order]], discs.track[order])]
    found = _sharpened(walls, discs, places, peaks[discs.track[places]])
    return _best(2 * found.radius, found.centre, region[discs.row[places]], count, largest=False)


def _telling(radius: Floats, corners: np.ndarray, fall: float) -> tuple[int, bool]:
    """Return which of the discs along a wall is the one that must fit, and whether it is the largest one round about.

    Args:
        radius: (m,) of discs along the wall.
        corners: whether the wall begins and ends in an inner corner.
    """
    first, last = 0, len(radius) - 1
    if corners[0]:
        first = _rise(radius, fall)
    if corners[1]:
        last -= _rise(radius[::-1], fall)
    if first >= last:
        return int(np.argmax(radius)), True
    least = first + int(np.argmin(radius[first : last + 1]))
    return least, (least == first and bool(corners[0])) or (least == last and bool(corners[1]))


def _rise(radius: Floats, fall: float) -> int:
    """Return the index of the top that the discs grow to from the first one on."""
    falling = np.flatnonzero(radius[1:] < np.maximum.accumulate(radius)[:-1] * (1 - fall))
    risen = radius[: falling[0] + 1] if len(falling) else radius
    return int(np.argmax(risen))


def _narrowest(walls: Walls, discs: Discs, region: Indices, below: Floats, progress: Progress) -> tuple[Floats, Floats]:
    """Return (width, middle) of the narrowest passage of each region that is narrower than `below`, mm; width inf where
    there is none.
    """
    a, b = _pairs(walls, discs)
    ways = _across(walls.rows[a], walls.rows[b])
    p, q = (np.concatenate([way[end] for way in ways]) for end in (0, 1))
    width, owner = np.hypot(*(q - p).T), np.tile(region[a], len(ways))
    order = np.argsort(width, kind="stable")
    order = order[(width[order] > _NOTHING) & (width[order] < below[owner[order]] - _NOTHING)]
    found, at = np.full(len(below), np.inf), np.full((len(below), 2), np.nan)
    for first in range(0, len(order), _PORTION):  # the narrowest ones first
        progress.step(first / len(order), "Passages")
        tried = order[first : first + _PORTION]
        tried = tried[np.isinf(found[owner[tried]])]
        middle = (p[tried] + q[tried]) / 2
        free = np.abs(walls.field.nearest(middle)[0] - width[tried] / 2) <= _PROVEN + 1e-9 * width[tried]
        tried, middle = tried[free], middle[free]
        inside = walls.field.inside(middle)
        own, which = np.unique(owner[tried[inside]], return_index=True)
        found[own], at[own] = width[tried[inside]][which], middle[inside][which]
    return found, at


def _pairs(walls: Walls, discs: Discs) -> tuple[Indices, Indices]:
    """Return pairs of rows (m,), (m,) that discs touch on nearly opposite sides."""
    touching = np.flatnonzero(discs.other >= 0)
    here, there = (discs.point - discs.centre)[touching], (discs.far - discs.centre)[touching]
    opposite = touching[(here * there).sum(axis=1) < _OPPOSITE * discs.radius[touching] ** 2]
    pairs = np.sort(np.column_stack([discs.row[opposite], discs.other[opposite]]), axis=1)
    beside = np.concatenate(
        [
            pairs,
            np.column_stack([walls.before[pairs[:, 0]], pairs[:, 1]]),
            np.column_stack([pairs[:, 0], walls.before[pairs[:, 1]]]),
        ]
    )
    unique = np.unique(np.sort(beside, axis=1), axis=0)
    return np.ascontiguousarray(unique[:, 0]), np.ascontiguousarray(unique[:, 1])


def _across(a: Rows, b: Rows) -> list[tuple[Floats, Floats]]:
    """Return all ways (p (m, 2), q (m, 2)) between rows a (m, 8) and b that can be shortest round about.

    Where a passage is narrowest one of its walls at least ends, is straight or bends away from it, and the way goes
    through its centre.
    """
    ways = [(a[:, k : k + 2], feet_on(b, a[:, k : k + 2])) for k in (0, 2)] + [
        (feet_on(a, b[:, k : k + 2]), b[:, k : k + 2]) for k in (0, 2)
    ]
    for one, two, turned in ((a, b, False), (b, a, True)):
        there = feet_on(two, one[:, CX:R])
        here = feet_on(one, there)
        ways.append((there, here) if turned else (here, there))
    return ways
