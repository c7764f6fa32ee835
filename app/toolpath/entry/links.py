"""Ways from the end of a cut to the beginning of the next one with the tool down."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from ...core import tolerances
from ...geometry.kernels import point_distance
from ...geometry.primitives import path_length
from ...model.curves import Point
from ...model.moves import Purpose
from .. import cleared_kernels as kernels
from ..build import Stroke
from ..linking.bridge import fraction_at
from .entry import EntryContext

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
    ends = float(walls.nearest(np.array([a, b]))[0].min())
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
