"""Where the stock and the work origin are: the box round the regions, in part coordinates."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import chain
from operator import attrgetter

import numpy as np
from numpy.typing import NDArray

from ..core.errors import ParameterError
from .curves import Arc, Circle, Point, Primitive
from .job import Job, OriginXY, OriginZ
from .moves import Program
from .part import Contour, Region

QUADRANTS = ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))
"""Directions in which a circle reaches farthest along an axis."""


_Box = tuple[float, float, float, float]
"""x0, y0, x1, y1, mm."""

_ENDS = attrgetter("start", "end")


@dataclass(frozen=True, slots=True)
class StockBox:
    """The stock, mm, part coordinates; z1 is its top: 0, or what stands above that at first."""

    x0: float
    y0: float
    z0: float
    x1: float
    y1: float
    z1: float = 0.0

    @property
    def size(self) -> tuple[float, float, float]:
        """Length along X, Y and Z, mm."""
        return (self.x1 - self.x0, self.y1 - self.y0, self.z1 - self.z0)


def extent(contours: Iterable[Contour]) -> _Box | None:
    """Return (x0, y0, x1, y1) of the contours, mm, arcs by what they really reach; None when there are none."""
    drawn = [contour for contour in contours if contour.primitives]
    if not drawn:
        return None
    _keep_boxes([contour for contour in drawn if "box" not in contour.kept])
    x0, y0, x1, y1 = zip(*[contour.kept["box"] for contour in drawn], strict=True)
    return (min(x0), min(y0), max(x1), max(y1))


def _keep_boxes(contours: Sequence[Contour]) -> None:
    """Have contours keep their boxes."""
    if not contours:
        return
    curves = [each for contour in contours for each in contour.primitives]
    counts = np.array([len(contour.primitives) for contour in contours])
    first, owner = np.cumsum(counts) - counts, np.repeat(np.arange(len(contours)), counts)
    ends = np.fromiter(chain.from_iterable(chain.from_iterable(map(_ENDS, curves))), np.float64, 4 * len(curves))
    ends = ends.reshape(-1, 2, 2)
    low, high = np.minimum.reduceat(ends.min(axis=1), first), np.maximum.reduceat(ends.max(axis=1), first)
    boxes = np.hstack([low, high]).tolist()
    for curve, of in _perhaps_beyond(curves, ends, owner):
        for x, y in _tops_beyond(curve, boxes[of]):
            x0, y0, x1, y1 = boxes[of]
            boxes[of] = [min(x0, x), min(y0, y), max(x1, x), max(y1, y)]
    for contour, box in zip(contours, boxes, strict=True):
        contour.kept["box"] = tuple(box)


def _perhaps_beyond(
    curves: Sequence[Primitive], ends: NDArray[np.float64], owner: NDArray[np.int64]
) -> Iterator[tuple[Arc | Circle, int]]:
    """Yield the circles, and the arcs that may pass a quadrant, with the number of their owner: hardly any of the short
    arcs of a fitted curve passes one.

    Args:
        ends: (n, 2, 2) where each of the curves begins and ends.
        owner: (n,) whose each one is.
    """
    bent = [(k, curve) for k, curve in enumerate(curves) if isinstance(curve, Arc | Circle)]
    numbers = [k for k, _ in bent]
    centre = np.fromiter(chain.from_iterable(curve.centre for _, curve in bent), np.float64, 2 * len(bent))
    a, b = ends[numbers].transpose(1, 0, 2) - centre.reshape(-1, 2)
    turn = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    ahead = np.where([curve.ccw for _, curve in bent], turn, -turn) > 0
    round_ones = np.array([isinstance(curve, Circle) for _, curve in bent], np.bool_)
    perhaps = round_ones | ~((a * b > 0).all(axis=1) & ahead)
    for (k, curve), may in zip(bent, perhaps.tolist(), strict=True):
        if may:
            yield curve, int(owner[k])


def stock_box(job: Job, regions: Iterable[Region], lines: Iterable[Contour] = ()) -> StockBox:
    """Return the stock of a job: the extent of its regions and of the open lines that it follows, and the margin round
    them; where that has no width, as round one straight line, the radius of the widest tool in use.

    Raises:
        ParameterError: there is neither.
    """
    box = extent((*(contour for region in regions for contour in region.contours), *lines))
    if box is None:
        raise ParameterError(
            "The part has no closed contour, so there is no stock to set the work origin on; close a contour first."
        )
    return _round(job, box)


def drawn_stock(job: Job, drawn: tuple[float, float, float, float]) -> StockBox:
    """Return the stock round a drawing before anybody has looked what of it bounds anything: copies, and the margin.

    Args:
        job: whose stock.
        drawn: x0, y0, x1, y1 of what is drawn, once, mm.
    """
    x0, y0, x1, y1 = drawn
    along, across = ([shift[axis] for shift in job.copies.shifts] for axis in (0, 1))
    return _round(job, (x0 + min(along), y0 + min(across), x1 + max(along), y1 + max(across)))


def _round(job: Job, box: tuple[float, float, float, float]) -> StockBox:
    """Return the stock of a job round a box in mm."""
    x0, y0, x1, y1 = box
    margin, widest = job.stock.margin, max((tool.radius for tool in job.needed_tools()), default=0.0)
    beside_x = margin if x1 > x0 else max(margin, widest)
    beside_y = margin if y1 > y0 else max(margin, widest)
    thickness, above = job.stock.thickness, job.stock.above
    return StockBox(x0 - beside_x, y0 - beside_y, -thickness, x1 + beside_x, y1 + beside_y, above)


def work_origin(job: Job, box: StockBox) -> tuple[float, float, float]:
    """Return the work origin in part coordinates, mm: NC coordinates = part coordinates - work origin."""
    x, y = {
        OriginXY.DRAWING: (0.0, 0.0),
        OriginXY.LOWER_LEFT: (box.x0, box.y0),
        OriginXY.CENTRE: ((box.x0 + box.x1) / 2, (box.y0 + box.y1) / 2),
    }[job.origin_xy]
    return (x, y, 0.0 if job.origin_z is OriginZ.TOP else box.z0)


def program_origin(job: Job, program: Program) -> tuple[float, float, float]:
    """Return the work origin of a job's program, mm, part coordinates: of the stock round all that it machines."""
    return work_origin(job, stock_box(job, program.regions, program.lines))


def _tops_beyond(curve: Arc | Circle, box: Sequence[float]) -> list[Point]:
    """Return where an arc or circle passes a quadrant beyond a box: there alone it may reach farther than the box."""
    (cx, cy), radius, (x0, y0, x1, y1) = curve.centre, curve.radius, box
    found = []
    for ux, uy in QUADRANTS:
        x, y = cx + radius * ux, cy + radius * uy
        if x0 <= x <= x1 and y0 <= y <= y1:
            continue
        if isinstance(curve, Circle) or _passes(curve, math.atan2(uy, ux)):
            found.append((x, y))
    return found


def _passes(arc: Arc, angle: float) -> bool:
    """Tell whether an arc passes the direction `angle` as seen from its centre."""
    turn = (angle - arc.start_angle) % math.tau if arc.ccw else (arc.start_angle - angle) % math.tau
    return turn < abs(arc.sweep)
