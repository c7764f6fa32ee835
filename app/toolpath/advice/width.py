"""How wide a region is: its narrowest passage, its largest disc, and the largest cutter that leaves nothing but sharp
corners.

All from discs that touch the walls (`Walls`, `Discs`). A passage is a pair of points of two walls between which the
disc over their distance is free; its ends are found in closed form. A cutter leaves nothing but sharp corners if it can
touch all of every wall but what lies near inner corners: there the disc that touches the wall shrinks to nothing
towards the corner, and what counts is how large it grows away from it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core.progress import NO_PROGRESS, Progress
from ...geometry.distance import DistanceField
from ...geometry.primitives import CX, CY, TURN, X0, X1, Y0, Y1, Indices, Primitives, R, Rows, lengths, points_at

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
"""The same where it has."""

_LOOKED_AT = 8
"""Walls and tips a region that are measured more closely, those first that matter most."""

_STEPS = 17
"""Places on a piece of wall, of which the best and its neighbours are looked at again."""

_REPEATS = 6
"""How often the neighbourhood of what was found is looked at anew, each time a smaller one."""


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


# The walls of a drawing as a cutter meets them, and the largest discs that touch them.
#
# A wall is a run of lines and arcs that meet without a corner. At any of its points the largest disc in the free area
# that touches it there is the largest cutter that can stand there; its centre lies on the medial axis. It is found by
# letting a disc shrink until no wall reaches into it, each wall measured exactly, so that nothing depends on how
# finely the drawing is sampled: samples only tell where to look. What is found is then made precise along the wall.
#
# References:     Ma, Bae, Choi, 3D medial axis point approximation using nearest neighbors and the normal field
# (2012): the shrinking     disc.


Floats = NDArray[np.float64]

KINK = math.radians(5.0)
"""Bends below this are no corners: a cutter of radius r leaves less than r / 1000 in them."""

_KINK_DEPTH = 4e-3
"""Radii by which a disc may reach over such a bend."""

_SAMPLES = 8000
"""Places along all walls at least, one to a line or arc and three to a wall."""

_MOST = 400
"""Places along one line or arc at most."""

_FAN = math.radians(15.0)
"""Between two discs that touch one corner that stands out."""

_SAME = 1e-5
"""mm; walls that begin so near one another touch."""

_ROUNDS = 60
"""Steps in which a disc shrinks; ten are usual."""


@dataclass(frozen=True)
class Walls:
    """Lines and arcs in runs without corners; the free area is on their left.

    Discs touch walls along tracks: the k walls come first, then the tips, corners that stand out, which a disc rolls
    round.

    Attributes:
        rows, region: as of `Primitives`.
        field: distances from them.
        before: (n,) row before each one.
        turn: (n,) by how much the contour turns where each row begins, radians, > 0 to the left.
        sharp: (n,) whether each row begins in an inner corner, or where other walls touch.
        wall: (n,) number of the wall of each row.
        along: (n,) rows in the order of their walls, and along these.
        start: (n,) how far along its wall each row begins, mm.
        size: (k,) length of each wall, mm.
        tips: (t,) rows that begin at a tip.
        corners: (k, 2) whether it begins and ends in an inner corner.
        kinked: (k,) whether it has bends too small to be corners.
        limit: (n,) radius that no disc in the row's region exceeds, mm.
    """

    rows: Rows
    region: Indices
    field: DistanceField
    before: Indices
    turn: Floats
    sharp: NDArray[np.bool_]
    wall: Indices
    along: Indices
    start: Floats
    size: Floats
    tips: Indices
    corners: NDArray[np.bool_]
    kinked: NDArray[np.bool_]
    limit: Floats

    @staticmethod
    def of(primitives: Primitives) -> Walls:
        """Return the walls of closed contours; there is at least one row."""
        rows, before = primitives.rows, primitives.previous
        turn = (_headings(rows, 0) - _headings(rows, 2)[before] + math.pi) % math.tau - math.pi
        sharp = (turn > KINK) | _touched(rows)
        corner = sharp | (turn < -KINK)
        along, first = _in_walls(before, corner)
        wall = np.empty(len(rows), np.int64)
        wall[along] = np.cumsum(first) - 1
        size = np.bincount(wall, lengths(rows)).astype(np.float64)
        start = np.empty(len(rows))
        gone = np.cumsum(lengths(rows)[along]) - lengths(rows)[along]
        start[along] = gone - gone[first][np.cumsum(first) - 1]
        begin = along[first]
        corners = np.zeros((len(size), 2), np.bool_)
        corners[:, 0] = sharp[begin]
        corners[wall[before[begin]], 1] = sharp[begin]
        kinked = np.bincount(wall, ~corner & (np.abs(turn) > 1e-4)) > 0
        return Walls(
            rows,
            primitives.region,
            DistanceField.of(rows),
            before,
            turn,
            sharp,
            wall,
            along,
            start,
            size,
            np.flatnonzero(turn < -KINK),
            corners,
            kinked,
            _limits(primitives),
        )

    @property
    def spans(self) -> Floats:
        """(k + t,) how long each track is: a wall's length, mm, and 1 for a tip."""
        return np.concatenate([self.size, np.ones(len(self.tips))])

    def normals(self, row: Indices, part: Floats) -> Floats:
        """Return unit vectors (m, 2) into the free area at fractions of rows (m,); over small bends they turn
        evenly.
        """
        rows = self.rows[row]
        along = rows[:, 2:4] - rows[:, :2]
        left = np.column_stack([-along[:, 1], along[:, 0]])
        normal = np.where(
            (rows[:, TURN] == 0)[:, None], left, (rows[:, [CX, CY]] - points_at(rows, part)) * rows[:, [TURN]]
        )
        bend = np.where(np.abs(self.turn) > KINK, 0.0, self.turn / 2)
        at_end = np.empty(len(bend))
        at_end[self.before] = bend
        return _unit(np.arctan2(normal[:, 1], normal[:, 0]) - bend[row] * (1 - part) + at_end[row] * part)


@dataclass(frozen=True)
class Discs:
    """The largest discs that touch walls at some points.

    Attributes:
        row: (m,) row that each touches.
        track: (m,) wall or tip that it touches.
        place: (m,) how far along its track it does, mm; round a tip from 0 to 1.
        point: (m, 2) where.
        radius: (m,) mm.
        centre: (m, 2).
        other: (m,) row that it touches elsewhere, or -1.
        far: (m, 2) where, or the point itself.
    """

    row: Indices
    track: Indices
    place: Floats
    point: Floats
    radius: Floats
    centre: Floats
    other: Indices
    far: Floats


def discs_along(walls: Walls, progress: Progress = NO_PROGRESS) -> Discs:
    """Return discs all along the walls, and round all tips; in the order of tracks, and along each.

    Raises:
        Cancelled: by progress.
    """
    size = lengths(walls.rows)
    least = np.where(np.bincount(walls.wall) < 3, 3, 1)[walls.wall[walls.along]]
    counts = np.clip(np.ceil(size[walls.along] / (size.sum() / _SAMPLES)), least, _MOST).astype(np.int64)
    row, part = np.repeat(walls.along, counts), (_numbered(counts) + 0.5) / np.repeat(counts, counts)
    fan = np.ceil(-walls.turn[walls.tips] / _FAN).astype(np.int64) + 1
    tip, share = np.repeat(np.arange(len(walls.tips)), fan), _numbered(fan) / np.repeat(fan - 1, fan)
    track = np.concatenate([walls.wall[row], len(walls.size) + tip])
    return discs_at(walls, track, np.concatenate([walls.start[row] + part * size[row], share]), progress)


def _numbered(counts: Indices) -> Indices:
    """Return 0 … c - 1 for each count c, one after the other."""
    numbers: Indices = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)
    return numbers


def discs_at(walls: Walls, track: Indices, place: Floats, progress: Progress = NO_PROGRESS) -> Discs:
    """Return the discs that touch some tracks (m,) at some places along them (m,).

    Raises:
        Cancelled: by progress.
    """
    count = len(walls.size)
    wall = np.minimum(track, count - 1)
    number = walls.wall[walls.along]
    first = np.searchsorted(number, np.arange(count + 1))
    total = np.concatenate([[0.0], np.cumsum(walls.size)])
    index = np.searchsorted(total[number] + walls.start[walls.along], total[wall] + place, side="right") - 1
    row = walls.along[np.clip(index, first[wall], first[wall + 1] - 1)]
    part = np.clip((place - walls.start[row]) / lengths(walls.rows)[row], 0.0, 1.0)
    point, normal = points_at(walls.rows[row], part), walls.normals(row, part)
    round_tip = track >= count
    tip = walls.tips[track[round_tip] - count]
    row[round_tip], point[round_tip] = tip, walls.rows[tip, :2]
    normal[round_tip] = _unit(_headings(walls.rows[tip], 0) - walls.turn[tip] * (1 - place[round_tip]) + math.pi / 2)
    radius, other, far = _shrunk(walls, row, (point, normal), progress)
    return Discs(row, track, place, point, radius, point + radius[:, None] * normal, other, far)


def _shrunk(
    walls: Walls, row: Indices, touch: tuple[Floats, Floats], progress: Progress
) -> tuple[Floats, Indices, Floats]:
    """Return (radius (m,), other row (m,) or -1, where (m, 2)) of discs that touch rows at points (m, 2), centres in
    directions (m, 2).
    """
    point, normal = touch
    radius, other, far = walls.limit[row].copy(), np.full(len(row), -1), point.copy()
    active = np.arange(len(row))
    for step in range(_ROUNDS):
        progress.step(step / _ROUNDS, "Discs along the walls")
        if not len(active):
            break
        centre = point[active] + radius[active, None] * normal[active]
        distance, nearest = walls.field.nearest(centre)
        feet = feet_on(walls.rows[nearest], centre)
        way = feet - point[active]
        gap, depth = (way**2).sum(axis=1), (way * normal[active]).sum(axis=1)
        mine = (
            (walls.wall[nearest] == walls.wall[row[active]])
            & walls.kinked[walls.wall[nearest]]
            & (gap < (radius[active] / 2) ** 2)
        )
        room = np.maximum(np.where(mine, _KINK_DEPTH * radius[active], 0.0), 1e-9)
        with np.errstate(divide="ignore", invalid="ignore"):
            smaller = gap / (2 * depth)
        go_on = (distance < radius[active] - room) & (depth > 0) & (gap > 1e-18) & (smaller < radius[active])
        active, nearest, feet, smaller = active[go_on], nearest[go_on], feet[go_on], smaller[go_on]
        radius[active], other[active], far[active] = smaller, nearest, feet
    return radius, other, far


def feet_on(rows: Rows, points: Floats) -> Floats:
    """Return the point (n, 2) of each row (n, 8) nearest to each point (n, 2)."""
    along = rows[:, 2:4] - rows[:, :2]
    share = np.clip(((points - rows[:, :2]) * along).sum(axis=1) / np.maximum((along**2).sum(axis=1), 1e-300), 0.0, 1.0)
    on_line = rows[:, :2] + share[:, None] * along
    arm, turn = points - rows[:, [CX, CY]], rows[:, TURN]
    a, b = rows[:, [X0, Y0]] - rows[:, [CX, CY]], rows[:, [X1, Y1]] - rows[:, [CX, CY]]
    within = (turn * (a[:, 0] * arm[:, 1] - a[:, 1] * arm[:, 0]) >= 0) & (
        turn * (arm[:, 0] * b[:, 1] - arm[:, 1] * b[:, 0]) >= 0
    )
    size = np.hypot(*arm.T)
    on_arc = rows[:, [CX, CY]] + arm * (rows[:, R] / np.maximum(size, 1e-300))[:, None]
    nearer_a = ((points - rows[:, :2]) ** 2).sum(axis=1) <= ((points - rows[:, 2:4]) ** 2).sum(axis=1)
    at_end = np.where(nearer_a[:, None], rows[:, :2], rows[:, 2:4])
    found: Floats = np.where((turn == 0)[:, None], on_line, np.where((within & (size > 0))[:, None], on_arc, at_end))
    return found


def _headings(rows: Rows, at: int) -> Floats:
    """Return the direction (n,) in which each row leaves its begin (at = 0) or comes to its end (at = 2), radians."""
    arm, turn = rows[:, at : at + 2] - rows[:, [CX, CY]], rows[:, TURN]
    along = rows[:, 2:4] - rows[:, :2]
    angle: Floats = np.arctan2(
        np.where(turn == 0, along[:, 1], turn * arm[:, 0]), np.where(turn == 0, along[:, 0], -turn * arm[:, 1])
    )
    return angle


def _unit(angle: Floats) -> Floats:
    return np.column_stack([np.cos(angle), np.sin(angle)])


def _touched(rows: Rows) -> NDArray[np.bool_]:
    """Tell (n,) where another row begins at the same place as each one: contours touch there."""
    from scipy.spatial import cKDTree

    found = np.zeros(len(rows), np.bool_)
    found[cKDTree(rows[:, :2]).query_pairs(_SAME, output_type="ndarray")] = True
    return found


def _in_walls(before: Indices, corner: NDArray[np.bool_]) -> tuple[Indices, NDArray[np.bool_]]:
    """Return rows (n,) in the order of walls, each contour from a corner on if it has one; and which of them (n,) begin
    a wall.
    """
    count = len(before)
    contours = np.split(np.arange(count), np.flatnonzero(before != np.arange(count) - 1)[1:])
    turned = [np.roll(rows, -int(np.argmax(corner[rows]))) for rows in contours]
    along = np.concatenate(turned)
    first = corner[along].copy()
    first[np.cumsum([0, *map(len, turned)])[:-1]] = True
    return along, first


def _limits(primitives: Primitives) -> Floats:
    """Return for each row half the narrower side of the box round its region, and a little more."""
    _, number = np.unique(primitives.region, return_inverse=True)
    boxes = DistanceField.of(primitives.rows).boxes
    low, high = np.full((number.max() + 1, 2), np.inf), np.full((number.max() + 1, 2), -np.inf)
    np.minimum.at(low, number, boxes[:, :2])
    np.maximum.at(high, number, boxes[:, 2:])
    limits: Floats = 1.001 * (high - low).min(axis=1)[number] / 2
    return limits
