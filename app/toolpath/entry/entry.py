"""Ways down into metal: a helix beside the path's beginning, a ramp along the path, or straight down."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core import tolerances
from ...geometry.distance import DistanceField
from ...geometry.kernels import point_distance
from ...geometry.primitives import CX, TURN, Rows, lengths, path_length, points_at
from ...model.curves import Point
from ...model.entry import Entry, EntryKind
from ...model.finding import Finding, FindingKind
from ...model.moves import Purpose, Tab
from ...model.operation import Direction
from ...model.tool import Tool
from ...toolpath import cleared_kernels as kernels
from ..build import Stroke
from ..linking.bridge import fraction_at
from ..rest_material import ClearedGround, Disc

Floats = NDArray[np.float64]

_ABOVE = 0.2
"""mm above the stock's top at which helix and ramp begin."""

_HELIX = (0.9, 0.7, 0.5)
"""Radii of a helix that are tried, in cutter's radii: wide enough for a cutter that does not cut at its centre, and no
post stands.
"""

_SHORTEST = 1.0
"""Cutter's radii that a ramp reaches at least from where it begins; over less a cutter's centre stays over one
place.
"""

_MOST_ROWS = 20_000
"""Rows of one way down; a path so short that it takes more has no ramp."""

_CRUMB = 0.01
"""mm; a row is not split so near to its end."""

_EXACT = 1e-7
"""mm by which a measured distance from walls may be short."""

_PLACES = 8
"""Along a ramp, where it is asked how high the metal is."""


@dataclass(frozen=True, eq=False)
class EntryContext:
    """What an entry must know of where it is.

    Attributes:
        walls: distances from all that the cutter must keep off, clamps and all.
        keep: its centre's distance from them, mm.
        beside: whether it may leave the path.
        cleared: ground cut so far.
        tabs: that stand.
        worn: whether the control offsets the path by the wear of its tool, and so nothing else that runs along it:
            then nothing does.
    """

    tool: Tool
    entry: Entry
    walls: DistanceField
    keep: float
    beside: bool
    direction: Direction
    cleared: ClearedGround
    tabs: Sequence[Tab] = ()
    worn: bool = False

    def allowed(self, place: Point) -> float:
        """Return how near to walls an entry at the beginning of a path may come: no nearer than the path does there,
        mm.
        """
        here = self.walls.gap(*place)
        return max(min(self.keep, here), self.keep - tolerances.LEVEL) - _EXACT


class ClearedWell(NamedTuple):
    """The disc that a helix clears, and the height down to which, mm."""

    disc: Disc
    floor: float


@dataclass(frozen=True, eq=False)
class Descent:
    """A way down.

    Attributes:
        kind: HELIX, RAMP or PLUNGE.
        top: height from which it goes, above the path's beginning, mm.
        path: that it goes along; no rows where it goes straight down.
        heights: (n,) at which each row of it ends, mm.
        stroke: the path to be cut after it; it begins where the descent ends.
        well: that it clears itself; None where it clears none.
    """

    kind: EntryKind
    top: float
    path: Stroke
    heights: Floats
    stroke: Stroke
    well: ClearedWell | None = None


def descent(stroke: Stroke, z: float, kind: EntryKind, ground: EntryContext) -> Descent:
    """Return the way down to the beginning of a stroke that is cut at z: of the kind that is wanted, or the next best
    that fits.
    """
    found = _helix(stroke, z, ground) if kind in (EntryKind.HELIX, EntryKind.PREDRILLED) else None
    if found is None and kind is not EntryKind.PLUNGE and not ground.worn:
        found = _ramp(stroke, z, ground)
    if found is None:
        top = _above(ground.cleared.floor(ground.tool, stroke.start))
        found = Descent(EntryKind.PLUNGE, top, stroke.part(0, 0), np.zeros(0), stroke)
    return found


def _above(material: float) -> float:
    """Return from which height an entry goes into metal that is so high: ground that was cut is where it is said to
    be.
    """
    return _ABOVE if material >= 0 else material


def heading(rows: Rows) -> Floats:
    """Return the direction (2,) in which a path sets out; NaN where its first row has no length."""
    row = rows[0]
    ahead = row[2:4] - row[:2] if row[TURN] == 0 else row[TURN] * np.array([row[CX + 1] - row[1], row[0] - row[CX]])
    length = float(np.hypot(*ahead))
    return ahead / length if length > 0 else np.full(2, np.nan)


def _helix(stroke: Stroke, z: float, ground: EntryContext) -> Descent | None:
    """Return turns of a circle that touches the path where it begins, all of it clear of walls."""
    ahead = heading(stroke.rows)
    if not ground.beside or np.isnan(ahead[0]):
        return None
    allowed = ground.allowed(stroke.start)
    left = np.array([-ahead[1], ahead[0]])
    sides = (1.0, -1.0) if ground.direction is Direction.CLIMB else (-1.0, 1.0)
    for share in _HELIX:
        for side in sides:
            radius = share * ground.tool.radius
            centre = np.array(stroke.start) + side * radius * left
            if ground.walls.gap(*centre.tolist()) >= allowed + radius and not _over_tab(centre, radius, ground):
                return _turns(stroke, z, _HelixCircle(radius, side, centre), ground)
    return None


def _over_tab(centre: Floats, radius: float, ground: EntryContext) -> bool:
    reach = radius + 2 * ground.tool.radius
    return any(math.dist(centre, (tab.x, tab.y)) < reach + tab.width / 2 for tab in ground.tabs)


class _HelixCircle(NamedTuple):
    """The circle of a helix: radius, mm, side of the path that it lies on (1 = left, -1 = right), centre (2,)."""

    radius: float
    side: float
    centre: Floats


def _turns(stroke: Stroke, z: float, circle: _HelixCircle, ground: EntryContext) -> Descent:
    radius, side, centre = circle
    x, y = centre.tolist()
    disc = Disc(x, y, radius + ground.tool.radius)
    material = (
        ground.cleared.wells[disc]
        if disc in ground.cleared.wells
        else ground.cleared.floor(ground.tool, (x, y), radius)
    )
    top = _above(material)
    count = max(1, math.ceil((top - z) / (math.tau * radius * math.tan(ground.entry.angle)) - 1e-9))
    across = 2 * centre - np.array(stroke.start)
    there = [*stroke.start, *across, *centre, radius, side]
    back = [*across, *stroke.start, *centre, radius, side]
    rows = np.array([there, back] * count)
    heights = top + (z - top) * np.arange(1, 2 * count + 1) / (2 * count)
    heights[-1] = z
    path = replace(stroke, rows=rows, purpose=np.zeros(len(rows), np.uint8), least_z=None)
    return Descent(EntryKind.HELIX, top, path, heights, stroke, ClearedWell(disc, min(0.0, z + (top - z) / count)))


def _ramp(stroke: Stroke, z: float, ground: EntryContext) -> Descent | None:
    """Return a way along the path: on round a closed one, there and back along the first rows of another."""
    head = _free_head(stroke, z)
    size = lengths(head.rows)
    if not len(size) or size.sum() <= _CRUMB:
        return None
    most = (_ABOVE - z) / math.tan(ground.entry.angle)
    material = max(
        ground.cleared.floor(ground.tool, place) for place in _places(head.rows, min(most, float(size.sum())))
    )
    top = _above(material)
    long = (top - z) / math.tan(ground.entry.angle)
    if stroke.closed and stroke.least_z is None:
        return _round(stroke, z, top, max(long, min(2 * ground.tool.radius, float(size.sum()))))
    if _reach(head.rows) < _SHORTEST * ground.tool.radius:
        return None
    leg, _ = _at(head, min(float(size.sum()), max(long / 2, _SHORTEST * ground.tool.radius)))
    span = path_length(leg.rows)
    count = math.ceil(long / (2 * span) - 1e-9)
    if 2 * count * len(leg.rows) > _MOST_ROWS:
        return None
    both = leg.and_then(leg.backwards())
    path = replace(both, rows=np.tile(both.rows, (count, 1)), purpose=np.tile(both.purpose, count), least_z=None)
    return Descent(EntryKind.RAMP, top, path, _falling(path.rows, top, z), stroke)


def _round(stroke: Stroke, z: float, top: float, long: float) -> Descent | None:
    """Return a way down round a closed path, which then begins where the way ends."""
    whole = path_length(stroke.rows)
    turns = math.floor(long / whole)
    if (turns + 1) * len(stroke.rows) > _MOST_ROWS:
        return None
    first, rest = _at(stroke, long - turns * whole)
    path = replace(
        stroke,
        rows=np.concatenate([np.tile(stroke.rows, (turns, 1)), first.rows]),
        purpose=np.zeros(turns * len(stroke.rows) + len(first.rows), np.uint8),
    )
    return Descent(EntryKind.RAMP, top, path, _falling(path.rows, top, z), rest.and_then(first))


def _free_head(stroke: Stroke, z: float) -> Stroke:
    """Return its first rows, as far as nothing must stand higher than z."""
    if stroke.least_z is None:
        return stroke
    high = stroke.least_z > z
    return stroke.part(0, int(np.argmax(high)) if high.any() else len(high))


def _at(stroke: Stroke, long: float) -> tuple[Stroke, Stroke]:
    """Return a stroke's beginning of a length, or a little more where that spares a crumb of a row, and the rest of
    it.
    """
    size = lengths(stroke.rows)
    ends = np.cumsum(size)
    row = min(int(np.searchsorted(ends, long - 1e-9)), len(ends) - 1)
    into = max(long - (ends[row] - size[row]), _CRUMB)
    return stroke.split(row, 1.0 if size[row] - into < _CRUMB else into / size[row])


def _reach(rows: Rows) -> float:
    """Return how far a path gets from where it begins, by its ends and middles, mm."""
    places = np.concatenate([rows[:, 2:4], points_at(rows, np.full(len(rows), 0.5))])
    return float(np.hypot(*(places - rows[0, :2]).T).max())


def _places(rows: Rows, long: float) -> list[Point]:
    """Return a few places along the beginning of a path."""
    size = lengths(rows)
    ends = np.cumsum(size)
    gone = np.linspace(0.0, long, _PLACES)
    row = np.minimum(np.searchsorted(ends, gone), len(ends) - 1)
    part = (gone - (ends - size)[row]) / np.maximum(size[row], 1e-12)
    return [(float(x), float(y)) for x, y in points_at(rows[row], np.clip(part, 0.0, 1.0))]


def _falling(rows: Rows, top: float, z: float) -> Floats:
    """Return (n,) heights at the ends of rows that fall evenly from top to z."""
    gone = np.cumsum(lengths(rows))
    heights: Floats = top + (z - top) * gone / gone[-1]
    heights[-1] = z
    return heights


# What there is to say of the ways that an operation takes into the metal.


@dataclass
class EntryFallbacks:
    """Entries that are not as asked, by kind: how many, and where the first one is."""

    others: dict[EntryKind, tuple[int, Point]] = field(default_factory=dict)

    def note(self, requested: EntryKind, taken: EntryKind, place: Point) -> None:
        """Count an entry."""
        if taken is not requested:
            count, first = self.others.get(taken, (0, place))
            self.others[taken] = count + 1, first

    def findings(self, tool: Tool, requested: EntryKind) -> tuple[Finding, ...]:
        """Return one remark, if any entry is not as asked."""
        if not self.others:
            return ()
        kinds = [kind for kind in _WORDS if kind in self.others]
        said = [_said(kind, *self.others[kind], _reason(requested, kind)) for kind in kinds]
        x, y = self.others[kinds[0]][1]
        text = f"T{tool.number} {tool.label}: {'; '.join(said)}."
        return (
            Finding(FindingKind.ENTRY, text, x, y, counts=False, amount=float(sum(n for n, _ in self.others.values()))),
        )


_WORDS = {EntryKind.PLUNGE: "straight down", EntryKind.RAMP: "a ramp along the path", EntryKind.HELIX: "a helix"}
"""Worst first."""


def _said(kind: EntryKind, count: int, place: Point, reason: str) -> str:
    entries = "1 entry is" if count == 1 else f"{count} entries are"
    first = "" if count == 1 else "the first "
    return f"{entries} {_WORDS[kind]} as {reason}, {first}at ({place[0]:.3f}, {place[1]:.3f})"


def _reason(requested: EntryKind, taken: EntryKind) -> str:
    if requested is EntryKind.PREDRILLED:
        return "no drilled hole is near"
    if taken is EntryKind.PLUNGE:
        return "no ramp fits" if requested is EntryKind.RAMP else "neither helix nor ramp fits"
    return "no helix fits"


# Ways from the end of a cut to the beginning of the next one with the tool down.


_RAPID = 5000.0
"""mm/min; as fast as a common machine travels."""

_STOPS = 1.0
"""s that a lift costs beside its length: the tool starts and stops along two axes, and comes down slowly."""

_SLACK = 5e-7
"""mm by which a proven way may come nearer to a wall than asked."""

_STEPS = 4000
"""With which a way is proven to keep off walls."""

_TAIL = 200
"""Last rows of a stroke among which it may pass its beginning again."""

Place = tuple[float, float, float]


@dataclass(frozen=True, eq=False)
class PassLink:
    """A path over ground that is cut, and the height of the pass at which it goes, mm; no rows = straight up or
    nothing.
    """

    path: Stroke
    height: float


def way_straight(
    stroke: Stroke, here: Place, air: tuple[float, float], ground: EntryContext, feed: float
) -> PassLink | None:
    """Return the straight way to where a stroke begins, if it is clear, and quicker than through the air.

    All of it lies on ground that is cut as deep, and nowhere is it nearer to a wall than its ends or than a path may
    be.

    Args:
        here: where the tool is, mm.
        air: heights of travel and of retract, mm.
        feed: mm/min.
    """
    x, y, height = here
    long = math.dist((x, y), stroke.start)
    if not ground.beside or long / feed * 60 > _lift_seconds(here, stroke.start, air, feed) or height >= 0:
        return None
    floor = ground.cleared.floor(ground.tool, stroke.start)
    level = max(height, floor)
    if level >= 0 or not ground.cleared.is_clear(ground.tool, (x, y), stroke.start, level):
        return None
    if not keeps_off_walls((x, y), stroke.start, ground):
        return None
    row = np.array([[x, y, *stroke.start, 0.0, 0.0, 0.0, 0.0]])
    return PassLink(Stroke(row, np.array([Purpose.LINK], np.uint8), stroke.region), level)


def keeps_off_walls(a: Point, b: Point, ground: EntryContext) -> bool:
    """Tell whether a straight way is nowhere nearer to a wall than its ends or than a path may be."""
    walls = ground.walls
    ends = min(walls.gap(*a), walls.gap(*b))
    keep = max(min(ground.keep, ends), ground.keep - tolerances.LEVEL)
    return bool(
        kernels.keeps_off(walls.rows, walls.order, walls.nodes, np.array([*a, *b], np.float64), keep, _SLACK, _STEPS)
    )


def way_back(stroke: Stroke, z: float, air: tuple[float, float], feed: float) -> PassLink | None:
    """Return the way from the end of a stroke that was just cut at z to its beginning along itself, if quicker than
    through the air.

    Where it passes its beginning again, behind its lead-in, that is the end of it and the lead-in alone.
    """
    lead = int(np.argmin(np.append(stroke.purpose == Purpose.LEAD, False)))
    found = _tail(stroke, lead)
    back = stroke.backwards() if found is None else found.backwards().and_then(stroke.part(0, lead).backwards())
    seconds = path_length(back.rows) / feed * 60
    if not len(back.rows) or seconds > _lift_seconds(
        (*stroke.end, float(stroke.heights(z)[-1])), stroke.start, air, feed
    ):
        return None
    return PassLink(replace(back, purpose=np.full(len(back.rows), Purpose.LINK, np.uint8)), z)


def _tail(stroke: Stroke, lead: int) -> Stroke | None:
    """Return what of a stroke comes after it passes the place again where its lead-in ends."""
    rows = np.ascontiguousarray(stroke.rows)
    if lead >= len(rows):
        return None
    x, y = rows[lead, :2].tolist()
    for row in range(len(rows) - 1, max(lead, len(rows) - _TAIL), -1):
        if point_distance(rows, row, x, y) < tolerances.WELD:
            return stroke.split(row, fraction_at(rows[row], rows[lead, :2]))[1]
    return None


def _lift_seconds(here: Place, there: tuple[float, float], air: tuple[float, float], feed: float) -> float:
    """Return how long it takes to a place through the air, and down again as deep as here."""
    x, y, height = here
    travel, retract = air
    quick = (travel - height) + math.dist((x, y), there) + (travel - retract)
    return 60 * (quick / _RAPID + max(0.0, retract - height) / feed) + _STOPS
