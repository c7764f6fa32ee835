"""Lines and arcs as rows of numbers, for kernels, and back.

A row is (x0, y0, x1, y1, cx, cy, r, turn): start, end, centre, radius, and turn = 0 for a line, +1 for an arc that
runs counter-clockwise, -1 for one that runs clockwise. Arcs of rows sweep less than pi, so that "is this direction
within the arc" is two cross products. Lengths in mm.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import chain, pairwise
from operator import attrgetter

import numpy as np
from numpy.typing import NDArray

from ..core.errors import GeometryError
from ..model.curves import Arc, Circle, Line, Point, Primitive
from ..model.part import Contour, Region
from . import kernels

Rows = NDArray[np.float64]

Indices = NDArray[np.int64]

_MAX_SWEEP = 0.75 * math.pi
"""Radians; an arc that sweeps more becomes several rows: kernels rely on arcs below half a turn."""

_MANY = 256
"""Rows from which compiled code is worth being loaded."""

_FEW = 8
"""Rows that are measured quicker one by one."""

X0, Y0, X1, Y1, CX, CY, R, TURN = range(8)
"""Columns of a row: start, end, centre and radius, mm; turn is 1 counter-clockwise, -1 clockwise, 0 for a line."""


@dataclass(frozen=True)
class Primitives:
    """Closed contours as rows; the area to machine lies to the left of travel.

    Attributes:
        rows: (n, 8) float64, see the module.
        previous: (n,) int64 row that ends where this one starts.
        region: (n,) int64 region number that the row bounds.
    """

    rows: Rows
    previous: Indices
    region: Indices


_ENDS = attrgetter("start", "end")


def curve_rows(curve: Primitive) -> list[tuple[float, ...]]:
    """Return the rows of one line, arc or circle; arcs are split so that each sweeps less than pi.

    Raises:
        GeometryError: an arc begins where it ends; as a row it would be a full turn.
    """
    if isinstance(curve, Line):
        return [(*curve.start, *curve.end, 0.0, 0.0, 0.0, 0.0)]
    if isinstance(curve, Circle):
        return _arc_rows(curve.start, curve.start, curve.centre, math.tau if curve.ccw else -math.tau)
    if curve.start == curve.end:
        raise _no_arc(curve.start)
    return _arc_rows(curve.start, curve.end, curve.centre, curve.sweep)


def rows_of(primitives: Sequence[Primitive]) -> tuple[Rows, Indices]:
    """Return the rows (n, 8) of many lines, arcs and circles, as `curve_rows` has them, and which one each is from.

    Raises:
        GeometryError: an arc begins where it ends.
    """
    kinds = set(map(type, primitives))
    if Circle in kinds:
        return _one_by_one(primitives, np.array([k for k, each in enumerate(primitives) if type(each) is Circle]))
    ends = chain.from_iterable(chain.from_iterable(map(_ENDS, primitives)))
    rows = np.zeros((len(primitives), 8))
    rows[:, :4] = np.fromiter(ends, np.float64, 4 * len(rows)).reshape(-1, 4)
    if Arc not in kinds:
        return rows, np.arange(len(rows))
    bent = [(k, each.centre, each.ccw) for k, each in enumerate(primitives) if type(each) is Arc]
    at, centres, left = zip(*bent, strict=True)
    arcs, turn = np.array(at), np.where(np.array(left), 1.0, -1.0)
    a, b, centre = rows[arcs, :2], rows[arcs, 2:4], np.array(centres)
    if (same := np.flatnonzero((a == b).all(axis=1))).size:
        raise _no_arc((float(a[same[0], 0]), float(a[same[0], 1])))
    u, v = a - centre, b - centre
    sweep = (turn * np.arctan2(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0], (u * v).sum(axis=1))) % math.tau
    wide = arcs[sweep > _MAX_SWEEP - 1e-9]
    if len(wide):
        return _one_by_one(primitives, wide)
    # the centre on the bisector of the ends, see `_arc_row`
    d, middle = b - a, (a + b) / 2
    along = ((centre - middle) * d).sum(axis=1) / (d * d).sum(axis=1)
    rows[arcs, CX:R] = centre - along[:, None] * d
    rows[arcs, R] = np.hypot(*(a - rows[arcs, CX:R]).T)
    rows[arcs, TURN] = turn
    return rows, np.arange(len(rows))


def _one_by_one(primitives: Sequence[Primitive], split: Indices) -> tuple[Rows, Indices]:
    """Return what `rows_of` does where some, by number, take several rows."""
    parts, owners, done = [], [], 0
    for k in (*split.tolist(), len(primitives)):
        if k > done:
            rows, owner = rows_of(primitives[done:k])
            parts.append(rows)
            owners.append(owner + done)
        if k < len(primitives):
            parts.append(np.array(curve_rows(primitives[k])))
            owners.append(np.full(len(parts[-1]), k))
        done = k + 1
    return np.concatenate(parts), np.concatenate(owners)


def _no_arc(at: tuple[float, float]) -> GeometryError:
    return GeometryError(f"An arc at ({at[0]:.3f}, {at[1]:.3f}) begins where it ends; delete it, or draw a circle.")


def _arc_rows(
    start: tuple[float, float], end: tuple[float, float], centre: tuple[float, float], sweep: float
) -> list[tuple[float, ...]]:
    count = max(1, math.ceil(abs(sweep) / _MAX_SWEEP))
    first = math.atan2(start[1] - centre[1], start[0] - centre[0])
    r0, r1 = math.dist(start, centre), math.dist(end, centre)
    points = [start]
    for k in range(1, count):
        radius, angle = r0 + (r1 - r0) * k / count, first + sweep * k / count
        points.append((centre[0] + radius * math.cos(angle), centre[1] + radius * math.sin(angle)))
    points.append(end)
    turn = 1.0 if sweep > 0 else -1.0
    return [_arc_row(a, b, centre, turn) for a, b in pairwise(points)]


def _arc_row(
    a: tuple[float, float], b: tuple[float, float], centre: tuple[float, float], turn: float
) -> tuple[float, ...]:
    """Return an arc's row with its centre moved onto the bisector of its ends, so that both radii are the same
    number.
    """
    dx, dy = b[0] - a[0], b[1] - a[1]
    mx, my = (a[0] + b[0]) / 2, (a[1] + b[1]) / 2
    along = ((centre[0] - mx) * dx + (centre[1] - my) * dy) / (dx * dx + dy * dy)
    cx, cy = centre[0] - along * dx, centre[1] - along * dy
    return (*a, *b, cx, cy, math.hypot(a[0] - cx, a[1] - cy), turn)


def contour_rows(contour: Contour) -> Rows:
    """Return the rows (n, 8) of a contour, in its direction; they are the caller's own."""
    return rows_of_each([contour])[0].copy()


def rows_of_each(contours: Sequence[Contour]) -> list[Rows]:
    """Return the rows (n, 8) of each of some contours, in its direction: the ones that the contour keeps, which nobody
    may change. Those that none has asked for yet are made at once.
    """
    new = [contour for contour in contours if "rows" not in contour.kept]
    if new:
        rows, owner = rows_of([each for contour in new for each in contour.primitives])
        upto = np.searchsorted(owner, np.cumsum([len(contour.primitives) for contour in new]))
        for contour, own in zip(new, np.split(rows, upto[:-1]), strict=True):
            contour.kept["rows"] = own
    return [contour.kept["rows"] for contour in contours]


def pack(regions: Sequence[Region]) -> Primitives:
    """Return the rows of all contours of some regions: boundaries counter-clockwise, islands clockwise, none
    crossing.
    """
    contours = [(contour, region.number) for region in regions for contour in region.contours]
    rows = rows_of_each([contour for contour, _ in contours])
    counts = np.array([len(each) for each in rows], np.int64)
    stop, some = np.cumsum(counts), counts > 0
    previous = np.arange(-1, int(counts.sum()) - 1)
    previous[(stop - counts)[some]] = stop[some] - 1
    numbers = np.repeat(np.array([number for _, number in contours], np.int64), counts)
    return Primitives(np.concatenate([np.zeros((0, 8)), *rows]), previous, numbers)


def reversed_rows(rows: Rows) -> Rows:
    """Return the same path travelled the other way."""
    back = rows[::-1].copy()
    back[:, [X0, Y0, X1, Y1]] = back[:, [X1, Y1, X0, Y0]]
    back[:, TURN] *= -1
    return back


def within_half_turn(rows: Rows) -> Rows:
    """Return the same path with arcs of up to a full turn cut into arcs below pi, as distances need them."""
    parts = np.maximum(np.ceil(np.abs(sweeps(rows)) / _MAX_SWEEP), 1).astype(np.int64)
    index = np.repeat(np.arange(len(rows)), parts)
    number = np.arange(len(index)) - np.repeat(np.cumsum(parts) - parts, parts)
    cut = rows[index].copy()
    cut[:, :2] = points_at(rows[index], number / parts[index])
    ends = points_at(rows[index], (number + 1) / parts[index])
    cut[:, 2:4] = np.where((number + 1 == parts[index])[:, None], rows[index, 2:4], ends)
    return np.ascontiguousarray(cut)


def sweeps(rows: Rows) -> NDArray[np.float64]:
    """Return the signed sweep of each row, radians; 0 for lines; a row that ends where it starts is a full turn."""
    if len(rows) >= _MANY:
        found = np.empty(len(rows))
        kernels.row_sweeps(np.ascontiguousarray(rows, np.float64), found)
        return found
    a = np.arctan2(rows[:, Y0] - rows[:, CY], rows[:, X0] - rows[:, CX])
    b = np.arctan2(rows[:, Y1] - rows[:, CY], rows[:, X1] - rows[:, CX])
    turn = np.where(rows[:, TURN] >= 0, (b - a) % math.tau, (a - b) % math.tau)
    same = (rows[:, X0] == rows[:, X1]) & (rows[:, Y0] == rows[:, Y1])
    return np.where(same, math.tau, turn) * rows[:, TURN]


def sweep_of(row: Sequence[float]) -> float:
    """Return the signed sweep of one row of eight numbers, radians, as `sweeps` does: a few rows are quicker so."""
    x0, y0, x1, y1, cx, cy, _, turn = row
    if turn == 0:
        return 0.0
    if x0 == x1 and y0 == y1:
        return math.tau * turn
    return (math.atan2(y1 - cy, x1 - cx) - math.atan2(y0 - cy, x0 - cx)) * turn % math.tau * turn


def turns(rows: Rows, previous: Indices) -> NDArray[np.float64]:
    """Return by how much (n,) closed paths turn where each row begins, radians, in [0, pi].

    Args:
        previous: (n,) number of the row that ends where each begins.
    """

    def ahead(at: int) -> NDArray[np.float64]:
        arm_x, arm_y = rows[:, at] - rows[:, CX], rows[:, at + 1] - rows[:, CY]
        line, turn = rows[:, TURN] == 0, rows[:, TURN]
        return np.arctan2(
            np.where(line, rows[:, Y1] - rows[:, Y0], turn * arm_x),
            np.where(line, rows[:, X1] - rows[:, X0], -turn * arm_y),
        )

    return np.abs((ahead(X0) - ahead(X1)[previous] + math.pi) % math.tau - math.pi)


def lengths(rows: Rows) -> NDArray[np.float64]:
    """Return the length of each row, mm."""
    chord = np.hypot(rows[:, X1] - rows[:, X0], rows[:, Y1] - rows[:, Y0])
    return np.where(rows[:, TURN] == 0, chord, np.abs(sweeps(rows)) * rows[:, R])


def path_length(rows: Rows) -> float:
    """Return the length of a path, mm."""
    if len(rows) > _FEW:
        return float(lengths(rows).sum())
    each = (
        math.hypot(row[X1] - row[X0], row[Y1] - row[Y0]) if row[TURN] == 0 else abs(sweep_of(row)) * row[R]
        for row in rows.tolist()
    )
    return float(sum(each))


def signed_area(rows: Rows) -> float:
    """Return the area that closed rows enclose, mm2, positive when counter-clockwise (Green's theorem, exact for
    arcs).
    """
    origin = rows[0, :2] if len(rows) else np.zeros(2)
    x0, y0 = rows[:, X0] - origin[0], rows[:, Y0] - origin[1]
    x1, y1 = rows[:, X1] - origin[0], rows[:, Y1] - origin[1]
    polygon = float(np.sum(x0 * y1 - x1 * y0)) / 2
    turn = sweeps(rows)
    return polygon + float(np.sum(rows[:, R] ** 2 * (turn - np.sin(turn)))) / 2


def boxes(rows: Rows) -> NDArray[np.float64]:
    """Return (n, 4) boxes x0, y0, x1, y1 that hold each row exactly, mm."""
    around = np.empty((len(rows), 4))
    kernels.row_boxes(np.ascontiguousarray(rows, np.float64), around)
    return around


def sample(rows: Rows, tolerance: float) -> NDArray[np.float64]:
    """Return points (m, 2) along rows whose chords stay within `tolerance` mm; each row's end is left to the next
    one.
    """
    return samples(rows, tolerance)[1]


def samples(rows: Rows, tolerance: float | NDArray[np.float64]) -> tuple[Indices, NDArray[np.float64]]:
    """Return (row (m,), points (m, 2)) along rows whose chords stay within a tolerance, mm, of all or of each row (n,);
    see `sample`.
    """
    turn = np.abs(sweeps(rows))
    step = 2 * np.arccos(np.clip(1 - tolerance / np.maximum(rows[:, R], tolerance), 0, 1))
    counts = np.where(rows[:, TURN] == 0, 1, np.maximum(1, np.ceil(turn / step))).astype(np.int64)
    index = np.repeat(np.arange(len(rows)), counts)
    part = (np.arange(len(index)) - np.repeat(np.cumsum(counts) - counts, counts)) / counts[index]
    return index, points_of(rows, index, part)


def points_at(rows: Rows, fraction: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the point (n, 2) at a fraction in [0, 1] of each row's length."""
    if len(rows) >= _MANY:
        return points_of(rows, np.arange(len(rows)), fraction)
    line = rows[:, :2] + (rows[:, 2:4] - rows[:, :2]) * fraction[:, None]
    angle = np.arctan2(rows[:, Y0] - rows[:, CY], rows[:, X0] - rows[:, CX]) + sweeps(rows) * fraction
    arc = rows[:, CX:R] + rows[:, [R]] * np.stack([np.cos(angle), np.sin(angle)], 1)
    arc = np.where((fraction == 0)[:, None], rows[:, :2], arc)
    return np.where((rows[:, TURN] == 0)[:, None], line, arc)


def points_of(rows: Rows, which: Indices, fraction: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the point (m, 2) at a fraction in [0, 1] of the length of the row that each of m numbers names."""
    if len(which) < _MANY:
        return points_at(rows[which], fraction)
    found = np.empty((len(which), 2))
    kernels.places_on(
        np.ascontiguousarray(rows, np.float64),
        np.ascontiguousarray(which, np.int64),
        np.ascontiguousarray(fraction, np.float64),
        found,
    )
    return found


def point_on(row: Sequence[float], fraction: float) -> Point:
    """Return the point at a fraction in [0, 1] of one row of eight numbers, as `points_at` does."""
    x0, y0, x1, y1, cx, cy, r, turn = row
    if turn == 0:
        return x0 + (x1 - x0) * fraction, y0 + (y1 - y0) * fraction
    if fraction == 0:
        return x0, y0
    angle = math.atan2(y0 - cy, x0 - cx) + sweep_of(row) * fraction
    return cx + r * math.cos(angle), cy + r * math.sin(angle)


def fraction_on(row: Sequence[float], point: Point) -> float:
    """Return the fraction in [0, 1] of the length of one row of eight numbers that is nearest to a point."""
    x0, y0, x1, y1, cx, cy, _, turn = row
    if turn == 0:
        dx, dy = x1 - x0, y1 - y0
        square = dx * dx + dy * dy
        along = (point[0] - x0) * dx + (point[1] - y0) * dy
        return min(max(along / (square if square > 0 else 1.0), 0.0), 1.0)
    start = math.atan2(y0 - cy, x0 - cx)
    sweep = (math.atan2(y1 - cy, x1 - cx) - start) * turn % math.tau
    gone = (math.atan2(point[1] - cy, point[0] - cx) - start) * turn % math.tau
    if gone <= sweep:
        return gone / (sweep if sweep > 0 else 1.0)
    return 1.0 if gone - sweep < math.tau - gone else 0.0


def distances(rows: Rows, points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return how far each point (n, 2) is from the row (n, 8) of its own, ends included, mm."""
    along, arm, back = rows[:, 2:4] - rows[:, :2], points - rows[:, :2], points - rows[:, 2:4]
    share = np.clip((arm * along).sum(axis=1) / np.maximum((along**2).sum(axis=1), 1e-300), 0.0, 1.0)
    straight = np.hypot(*(arm - along * share[:, None]).T)
    out, first, last = points - rows[:, CX:R], rows[:, :2] - rows[:, CX:R], rows[:, 2:4] - rows[:, CX:R]
    before = (first[:, 0] * out[:, 1] - first[:, 1] * out[:, 0]) * rows[:, TURN] < 0
    beyond = (out[:, 0] * last[:, 1] - out[:, 1] * last[:, 0]) * rows[:, TURN] < 0
    ends = np.minimum(np.hypot(*arm.T), np.hypot(*back.T))
    curved = np.where(before | beyond, ends, np.abs(np.hypot(*out.T) - rows[:, R]))
    far: NDArray[np.float64] = np.where(rows[:, TURN] == 0, straight, curved)
    return far


def row_curve(row: Rows) -> Line | Arc:
    """Return one row as a line or an arc of the model.

    Raises:
        GeometryError: it is an arc that begins where it ends, which the model does not know.
    """
    start, end = (float(row[X0]), float(row[Y0])), (float(row[X1]), float(row[Y1]))
    if row[TURN] == 0:
        return Line(start, end)
    if start == end:
        raise _no_arc(start)
    return Arc(start, end, (float(row[CX]), float(row[CY])), bool(row[TURN] > 0))
