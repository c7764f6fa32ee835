"""The even-odd area of curves as they are drawn: the witness of everything that is made of them.

A horizontal line meets curves in a sorted row of places; between the first and the second, the third and the fourth …
lies the area. Integrated over all heights in closed form, that is exact, and indifferent to how curves touch, coincide
or nearly do: where two change places without being noticed, nothing changes. It shares no step with what cuts, joins or
nests contours.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import chain, compress
from operator import attrgetter

import numpy as np
from numpy.typing import NDArray

from ..model.curves import Arc, Circle, Line, Primitive
from ..model.part import Contour
from . import even_odd_kernels

Floats = NDArray[np.float64]

Flags = NDArray[np.bool_]


@dataclass(frozen=True)
class EvenOddMeasure:
    """What the witness says of some curves.

    Attributes:
        area: mm2 where an odd number of contours and no outline goes round.
        length: of all curves, mm.
        loose: height over which some curve has no other one to go with, mm; nothing for closed contours.
    """

    area: float
    length: float
    loose: float = 0.0


_NO_CHORDS = np.zeros((0, 4))
"""Lines (n, 4) from place to place, mm: none."""


def even_odd(
    contours: Sequence[Contour], outlines: Sequence[Contour] = (), chords: Floats = _NO_CHORDS
) -> EvenOddMeasure:
    """Return the area where an odd number of closed contours and no outline goes round, exactly.

    Args:
        contours: they may cross, touch and lie on one another in any way.
        outlines: what each holds by itself is left out; they may overlap.
        chords: (n, 4) x0, y0, x1, y1 of lines, mm, that count with the contours.
    """
    lists = [[p for contour in contours for p in contour.primitives], *([*outline.primitives] for outline in outlines)]
    curves = [p for each in lists for p in each]
    if not curves and not len(chords):
        return EvenOddMeasure(0.0, 0.0)
    owner = np.concatenate(
        [np.repeat(np.arange(-1, len(outlines)), [len(each) for each in lists]), np.full(len(chords), -1)]
    )
    centre = _middle(curves, chords)
    risen, index, length = _rising(curves, chords, centre)
    low = np.argsort(risen[:, 0], kind="stable")
    risen, owner = np.ascontiguousarray(risen[low]), np.ascontiguousarray(owner[index[low]])
    meeting = even_odd_kernels.meeting_heights(risen, _sides(risen))
    heights = np.unique(np.concatenate([risen[:, 0], risen[:, 1], meeting]))
    area, loose = even_odd_kernels.swept_area(risen, owner, len(outlines), heights)
    return EvenOddMeasure(area, length, loose)


def _middle(curves: Sequence[Primitive], chords: Floats) -> Floats:
    """Return a point amid the curves: what is far from zero loses digits."""
    drawn = np.fromiter(chain.from_iterable(map(attrgetter("start"), curves)), np.float64, 2 * len(curves))
    starts = np.concatenate([drawn.reshape(-1, 2), chords[:, :2]])
    middle: Floats = (starts.min(axis=0) + starts.max(axis=0)) / 2
    return middle


def _rising(curves: Sequence[Primitive], chords: Floats, centre: Floats) -> tuple[Floats, NDArray[np.int64], float]:
    """Return (curves that rise all along (m, 7), see the kernels, from which curve (m,) each is, length of all, mm)."""
    straight = np.array([isinstance(curve, Line) for curve in curves], np.bool_)
    lines, arcs = np.flatnonzero(straight), np.flatnonzero(~straight)
    points = chain.from_iterable(map(attrgetter("start", "end"), compress(curves, straight)))
    drawn = np.fromiter(chain.from_iterable(points), np.float64, 4 * len(lines)).reshape(-1, 4)
    ends, lines = (
        np.concatenate([drawn, chords]) - np.tile(centre, 2),
        np.append(lines, len(curves) + np.arange(len(chords))),
    )
    length = float(np.hypot(ends[:, 2] - ends[:, 0], ends[:, 3] - ends[:, 1]).sum())
    risen = np.hstack([ends[:, [1, 3, 0, 2]], np.zeros((len(ends), 3))])
    bent, index, more = _rising_arcs([curve for curve in curves if not isinstance(curve, Line)], centre)
    risen, index = np.concatenate([risen, bent]), np.concatenate([lines, arcs[index]])
    down = risen[:, 0] > risen[:, 1]
    risen[down, :4] = risen[down][:, [1, 0, 3, 2]]
    rising = risen[:, 0] < risen[:, 1]
    return risen[rising], index[rising], length + more


def _rising_arcs(arcs: Sequence[Arc | Circle], centre: Floats) -> tuple[Floats, NDArray[np.int64], float]:
    """Return the same for arcs and circles, which are cut at their highest and lowest places."""
    if not arcs:
        return np.zeros((0, 7)), np.zeros(0, np.int64), 0.0
    points = chain.from_iterable(map(attrgetter("start", "end", "centre"), arcs))
    table = np.fromiter(chain.from_iterable(points), np.float64, 6 * len(arcs))
    start, end, middle = np.hsplit(table.reshape(-1, 6), 3)
    sweep, radius, first = _turning(start - middle, end - middle, arcs)
    start, end, middle = start - centre, end - centre, middle - centre
    turn = np.sign(sweep)
    hits = np.stack([(side * np.pi / 2 - first) * turn % (2 * np.pi) for side in (1.0, -1.0)], 1)
    tops = np.stack([middle[:, 1] + radius, middle[:, 1] - radius], 1)
    swapped = hits[:, 0] > hits[:, 1]
    hits[swapped], tops[swapped] = hits[swapped, ::-1], tops[swapped, ::-1]
    whole = np.abs(sweep)
    begun, over = hits <= 0, hits >= whole[:, None]  # an arc that begins at its top is cut at its bottom alone
    angles = np.column_stack([np.zeros(len(arcs)), np.minimum(hits, whole[:, None]), whole])
    y = np.column_stack([start[:, 1], _where(begun, start[:, 1], over, end[:, 1], tops), end[:, 1]])
    x = np.column_stack([start[:, 0], _where(begun, start[:, 0], over, end[:, 0], middle[:, [0]]), end[:, 0]])
    found = []
    for k in range(3):
        right = np.cos(first + turn * (angles[:, k] + angles[:, k + 1]) / 2) >= 0
        found.append(
            np.column_stack([y[:, k], y[:, k + 1], x[:, k], x[:, k + 1], middle, np.where(right, radius, -radius)])
        )
    return np.concatenate(found), np.tile(np.arange(len(arcs)), 3), float((whole * radius).sum())


def _where(begun: Flags, first: Floats, over: Flags, last: Floats, between: Floats) -> Floats:
    """Return (n, 2) the first value (n,) where a cut lies before an arc, the last one where it lies behind it."""
    inner: Floats = np.where(over, last[:, None], between)
    return np.where(begun, first[:, None], inner)


def _turning(out: Floats, back: Floats, arcs: Sequence[Arc | Circle]) -> tuple[Floats, Floats, Floats]:
    """Return (signed sweep, radius, angle of the start), each (n,), of arcs that begin and end at these vectors from
    their centres.
    """
    ccw = np.fromiter(map(attrgetter("ccw"), arcs), np.bool_, len(arcs))
    whole = np.array([isinstance(arc, Circle) for arc in arcs], np.bool_)
    first, last = np.arctan2(out[:, 1], out[:, 0]), np.arctan2(back[:, 1], back[:, 0])
    turn = (last - first) % (2 * np.pi)
    sweep = np.where(ccw, np.where(whole, 2 * np.pi, turn), np.where(whole, 0.0, turn) - 2 * np.pi)
    return sweep, (np.hypot(*out.T) + np.hypot(*back.T)) / 2, first


def _sides(risen: Floats) -> Floats:
    """Return least and greatest x (n, 2) of curves that rise all along."""
    low, high = np.minimum(risen[:, 2], risen[:, 3]), np.maximum(risen[:, 2], risen[:, 3])
    bulging = (risen[:, 6] != 0) & (risen[:, 0] < risen[:, 5]) & (risen[:, 1] > risen[:, 5])
    out = risen[:, 4] + risen[:, 6]
    low, high = np.where(bulging, np.minimum(low, out), low), np.where(bulging, np.maximum(high, out), high)
    return np.column_stack([low, high])
