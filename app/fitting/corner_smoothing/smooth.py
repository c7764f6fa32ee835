"""Smooth a closed path of points, traced from pixels or finer, into circles, lines and arcs (steps 401-407).

The text's test for circles (its formula II) holds only for circles through the origin, and its five-step averages move
with the phase of the pixels. So: the longest line or arc within tolerance from each end to the next, lines first; then
every end is moved to where both sides fit best; corners are where neighbours cross, and arcs that nearly touch a line
are made to touch it.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...core.errors import ParameterError
from ...geometry.primitives import R, Rows, turns
from .rest import NO_BEND, without_bends
from .smoothed_path import PieceKind, SmoothedPath

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
_Segments = tuple[Ints, Ints, NDArray[np.uint8]]
"""Ends (n + 1,), kinds (n,), and how each begins (n,)."""

_LIMIT = 2.0
"""Times the tolerance; points may be so far from the path once its lines and arcs are joined, near corners rounds as
far.
"""

_ROUNDS = 6
"""How often segments that no joint suits are cut into finer ones."""

_LAST_ROUNDS = 4
"""How often those that still suit none are left as they are, from point to point."""


@dataclass(frozen=True, slots=True)
class CornerSmoothingOptions:
    """How to smooth. Lengths in the units of the points.

    Attributes:
        tolerance: points may be so far from the line or arc that is fitted to them, > 0; from the path, which joins
            these, up to twice as far, near corners, which pixels fill, four times: `SmoothedPath.deviation` tells.
        long_line: from this length on a line is a long one: ten times the tool's diameter in the text.
        pitch: of pixels whose centres the points are: lines and arcs are then moved to the right, out of the traced
            area, by as much as pixels inside a line lie off it on average; 0 = the points are the path itself.
    """

    tolerance: float
    long_line: float = 0.0
    pitch: float = 0.0

    def __post_init__(self) -> None:
        if not self.tolerance > 0:
            raise ParameterError(f"The smoothing tolerance is {self.tolerance:g} mm; it must be greater than 0.")


def smooth(points: Floats, options: CornerSmoothingOptions) -> SmoothedPath:
    """Return a closed path of points as circles, lines and arcs.

    Args:
        points: (m, 2), m > 0; the last is joined to the first, which is not repeated.

    References:
        JPH07107645B2, steps 401-407.
    """
    from . import joint_kernels, smooth_kernels

    places = np.ascontiguousarray(points).view(np.complex128)[:, 0]  # both coordinates compared at once
    fresh = places != np.roll(places, 1)
    if not fresh.all() and fresh.any():
        return _among(smooth(np.ascontiguousarray(points[fresh]), options), np.flatnonzero(fresh), len(points))
    count = len(points)
    if count < 4:
        return as_it_is(points)
    rounds = _rounds(points)
    ends, kinds = _segments(rounds, count, options.tolerance)
    if len(kinds) == 1 and kinds[0] == smooth_kernels.ARC:
        return _without_bias(_one_circle(points, _carriers(rounds, ends, kinds)), points, options)
    joined = np.zeros(len(kinds), np.uint8)
    for again in range(_ROUNDS + _LAST_ROUNDS):
        result, bad = _joined(rounds, (ends, kinds, joined), options)
        if not bad.any():
            return _without_bias(without_bends(result, rounds, _LIMIT * options.tolerance), points, options)
        joined[bad | np.roll(bad, 1)] = joint_kernels.PINNED
        if again % 2 or again >= _ROUNDS:
            finer = options.tolerance / 2 ** (again // 2 + 1) if again < _ROUNDS else 0.0
            ends, kinds, joined = _split(rounds, (ends, kinds, joined), bad, finer)
    return as_it_is(points)


def _among(path: SmoothedPath, numbers: Ints, count: int) -> SmoothedPath:
    """Return a path through some of a closed path's points as one through all of them.

    Args:
        numbers: which of the `count` points they are; the others repeat the one before.
    """
    whole, rest = np.divmod(path.ends, len(numbers))
    return replace(path, ends=numbers[rest] + whole * count)


def _rounds(points: Floats) -> Floats:
    """Return a closed path's points three times over."""
    return np.concatenate([points, points, points])


def _segments(rounds: Floats, count: int, tolerance: float) -> tuple[Ints, Ints]:
    """Return the ends (n + 1,) and kinds (n,) of the lines and arcs that a closed path of `count` points falls into."""
    from . import smooth_kernels

    ends, kinds = np.empty(2 * count + 2, np.int64), np.empty(2 * count + 1, np.int64)
    found = smooth_kernels.segment_closed(rounds, count, tolerance, ends, kinds)
    if found > 2:
        found = smooth_kernels.absorb(
            rounds, ends, kinds, _carriers(rounds, ends[: found + 1], kinds[:found]), tolerance
        )
    return ends[: found + 1].copy(), kinds[:found].copy()


def _carriers(rounds: Floats, ends: Ints, kinds: Ints) -> Floats:
    """Return the line or circle (n, 5) that fits each segment."""
    from . import smooth_kernels

    carriers = np.empty((len(kinds), 5))
    smooth_kernels.carriers(rounds, ends, kinds, len(kinds), carriers)
    return carriers


def _split(rounds: Floats, segments: _Segments, bad: NDArray[np.bool_], tolerance: float) -> _Segments:
    """Return segments, the bad ones, of which there is one at least, in finer pieces."""
    ends, kinds, joined = segments[0], segments[1].copy(), segments[2]
    places, inner, others = [], [], []
    for k in np.flatnonzero(bad).tolist():
        finer, own = _finer(rounds, int(ends[k]), int(ends[k + 1]), tolerance)
        kinds[k] = own[0]
        places.append(np.full(len(own) - 1, k + 1))
        inner.append(finer[1:-1])
        others.append(own[1:])
    at = np.concatenate(places)
    return (
        np.insert(ends, at, np.concatenate(inner)),
        np.insert(kinds, at, np.concatenate(others)),
        np.insert(joined, at, 0),
    )


def _finer(rounds: Floats, a: int, b: int, tolerance: float) -> tuple[Ints, Ints]:
    """Return the ends (n + 1,) and kinds (n,) of the lines and arcs that points a ... b fall into; without tolerance of
    the steps.
    """
    from . import smooth_kernels

    if not tolerance:
        return np.arange(a, b + 1), np.full(b - a, smooth_kernels.LINE)
    ends, kinds = np.empty(b - a + 1, np.int64), np.empty(b - a, np.int64)
    found = smooth_kernels.segment(rounds, a, b - a, tolerance, ends, kinds)
    return ends[: found + 1], kinds[:found]


def _joined(
    rounds: Floats, segments: _Segments, options: CornerSmoothingOptions
) -> tuple[SmoothedPath, NDArray[np.bool_]]:
    """Return the path along segments, tangent where neighbours nearly touch, and which rows are too far off."""
    from . import joint_kernels

    ends, kinds, pinned = segments
    carriers, joined, worst = _carriers(rounds, ends, kinds), pinned.copy(), np.empty((len(kinds), 2))
    joint_kernels.make_tangent(rounds, ends, carriers, joined, options.tolerance)
    joint_kernels.let_arcs_touch(rounds, ends, carriers, joined, options.tolerance)
    rows = _rows(rounds, ends, carriers, joined, options.tolerance)
    joined[(joined == joint_kernels.TANGENT) & (turns(rows, np.arange(-1, len(rows) - 1)) > NO_BEND)] = (
        joint_kernels.CROSSING
    )
    joint_kernels.deviations(rounds, ends, carriers, rows, worst)
    path = SmoothedPath(
        rows, _kinds(rows, options), ends, joined, float(worst[:, 0].max()), exact=True, carriers=carriers
    )
    return path, worst[:, 1] > _LIMIT * options.tolerance


def _one_circle(points: Floats, carriers: Floats) -> SmoothedPath:
    """Step 401: the whole path is one circle."""
    off = np.hypot(*(points - carriers[0, :2]).T) - carriers[0, 2]
    return SmoothedPath(
        circle_rows(carriers[0]),
        np.array([PieceKind.CIRCLE]),
        np.array([0, len(points)]),
        np.ones(1, np.uint8),
        float(np.abs(off).max()),
        exact=True,
        carriers=carriers,
    )


def circle_rows(carrier: Floats) -> Rows:
    """Return the one row (1, 8) of a full circle that a carrier (5,) is, from angle 0 on."""
    cx, cy, r, turn = carrier[:4]
    return np.array([[cx + r, cy, cx + r, cy, cx, cy, r, turn]])


def _rows(rounds: Floats, ends: Ints, carriers: Floats, joined: NDArray[np.uint8], tolerance: float) -> Rows:
    """Return the rows along carriers that begin as told."""
    from . import joint_kernels

    joints, rows = np.empty((len(carriers), 2)), np.empty((len(carriers), 8))
    joint_kernels.join(np.ascontiguousarray(rounds[ends[:-1]]), carriers, joined, tolerance, joints)
    joint_kernels.rows_between(carriers, joints, rows)
    return rows


def _kinds(rows: Rows, options: CornerSmoothingOptions) -> Ints:
    length = np.hypot(rows[:, 2] - rows[:, 0], rows[:, 3] - rows[:, 1])
    lines = np.where(length >= options.long_line, PieceKind.LONG_LINE, PieceKind.SHORT_LINE)
    return np.where(rows[:, R] == 0, lines, PieceKind.ARC).astype(np.int64)


def _without_bias(path: SmoothedPath, points: Floats, options: CornerSmoothingOptions) -> SmoothedPath:
    """Return the path moved out of the traced area by what pixels lie inside it on average."""
    return moved(path, points, options.pitch / 2 * _slant(path), options.tolerance) if options.pitch else path


def _slant(path: SmoothedPath) -> Floats:
    """Return for each row the larger coordinate of its unit normal, for arcs the mean along them."""
    if len(path.rows) == 1:
        return np.array([2 * np.sqrt(2) / np.pi])
    lines = np.abs(path.carriers[:, 2:4]).max(axis=1)
    angles = np.linspace(0, 1, 33)
    rows = path.rows
    start = np.arctan2(rows[:, 1] - rows[:, 5], rows[:, 0] - rows[:, 4])
    sweep = (
        (rows[:, 7] * (np.arctan2(rows[:, 3] - rows[:, 5], rows[:, 2] - rows[:, 4]) - start)) % (2 * np.pi) * rows[:, 7]
    )
    along = start[:, None] + sweep[:, None] * angles
    arcs = np.maximum(np.abs(np.cos(along)), np.abs(np.sin(along))).mean(axis=1)
    slant: Floats = np.where(rows[:, 7] == 0, lines, arcs)
    return slant


def moved(path: SmoothedPath, points: Floats, right: Floats, tolerance: float) -> SmoothedPath:
    """Return a path whose lines and circles are moved to the right of travel and joined again.

    Args:
        points: that the path was made from.
        right: (n,) how far each row moves; negative to the left. Rows that touch one another go on doing so only where
            they are moved alike.
        tolerance: that the path was made with.
    """
    from . import joint_kernels

    carriers = _moved(path.carriers, right)
    if not path.exact:
        return path
    if len(carriers) == 1:
        return replace(path, rows=circle_rows(carriers[0]), carriers=carriers)
    alike = (right == np.roll(right, 1)) & ((path.joined == joint_kernels.TANGENT) | (right == 0))
    joined = np.where(alike, path.joined, joint_kernels.CROSSING).astype(np.uint8)
    rows = _rows(_rounds(points), path.ends, carriers, joined, tolerance + float(np.abs(right).max()))
    return replace(path, rows=rows, carriers=carriers)


def astray(path: SmoothedPath, points: Floats, limit: float) -> NDArray[np.bool_]:
    """Return which rows (n,) run back, have no radius left, or are farther than a limit from the points they
    replace.
    """
    if not path.exact or len(path.rows) == 1:
        return path.carriers[:, 2] * path.carriers[:, 4] < 0
    from . import joint_kernels

    worst = np.empty((len(path.rows), 2))
    joint_kernels.deviations(_rounds(points), path.ends, path.carriers, path.rows, worst)
    shrunk: NDArray[np.bool_] = (path.carriers[:, 4] == 1) & (path.carriers[:, 2] <= 0)
    return shrunk | (worst[:, 1] > limit)


def without(path: SmoothedPath, dropped: NDArray[np.bool_]) -> SmoothedPath | None:
    """Return the path without some of its rows, whose neighbours are still to be joined by `moved`; None where too few
    stay.

    Args:
        dropped: (n,) the rows to leave out; their points go to their neighbours.
    """
    from . import joint_kernels

    kept = np.flatnonzero(~dropped)
    if len(kept) < 3:
        return None
    count = int(path.ends[-1] - path.ends[0])
    before = np.roll(kept, 1)
    end_before = path.ends[before + 1] - np.where(before > kept, count, 0)
    starts = (end_before + path.ends[kept]) // 2
    starts += count if starts[0] < 0 else 0
    next_to = (before + 1) % len(dropped) == kept
    return replace(
        path,
        rows=path.rows[kept],
        kinds=path.kinds[kept],
        ends=np.append(starts, starts[0] + count),
        joined=np.where(next_to, path.joined[kept], joint_kernels.CROSSING).astype(np.uint8),
        carriers=path.carriers[kept],
    )


def _moved(carriers: Floats, right: Floats) -> Floats:
    """Return lines moved to their right and circles made larger or smaller, whichever is to the right of travel."""
    result = carriers.copy()
    line = carriers[:, 4] == 0
    result[line, 0] += right[line] * carriers[line, 3]
    result[line, 1] -= right[line] * carriers[line, 2]
    result[~line, 2] += right[~line] * carriers[~line, 3]
    return result


def as_it_is(points: Floats) -> SmoothedPath:
    """Return the path as lines from point to point."""
    rows = np.zeros((len(points), 8))
    rows[:, :2], rows[:, 2:4] = points, np.roll(points, -1, axis=0)
    count = len(points)
    kinds, joined = np.full(count, PieceKind.SPLINE), np.full(count, 2, np.uint8)
    return SmoothedPath(rows, kinds, np.arange(count + 1), joined, 0.0, exact=False, carriers=np.zeros((count, 5)))
