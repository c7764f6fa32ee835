"""Collect moves row by row and freeze them into columns."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..geometry.primitives import CX, TURN, X0, X1, Y0, Y1, R, Rows, lengths, point_on, reversed_rows
from ..model.moves import MoveKind, Moves, Purpose
from .merge_kernels import beginnings

_KIND_BY_TURN = np.array([MoveKind.ARC_CW, MoveKind.LINE, MoveKind.ARC_CCW], np.uint8)


@dataclass(frozen=True)
class StrokeLabel:
    """What every move of a stroke has in common.

    Attributes:
        operation: index into the job's operations.
        tool: T number.
        feed, plunge_rate: mm/min.
    """

    operation: int
    tool: int
    feed: float
    plunge_rate: float

    @cached_property
    def fast(self) -> StrokeLabel:
        """The same, but it plunges at feed rate: over ground that is cut."""
        return replace(self, plunge_rate=self.feed)


@dataclass(frozen=True)
class Stroke:
    """A path in the plane that is cut without lifting the tool.

    Attributes:
        rows: (n, 8) lines and arcs, each beginning where the one before ends.
        purpose: (n,) uint8 Purpose of each row.
        region: number of its region.
        least_z: (n,) height below which each row must not go, mm, -inf where any depth will do; None = nowhere.
            Where it changes from one row to the next the tool goes straight up or down.
        at_floor: True: it is cut at the last depth only.
        follows: True: it is cut right after the stroke before it in the list, at each depth.
        rank: strokes of a lower rank are cut, at all depths, before those of a higher one.
    """

    rows: Rows
    purpose: NDArray[np.uint8]
    region: int
    least_z: NDArray[np.float64] | None = None
    at_floor: bool = False
    follows: bool = False
    rank: int = 0

    @cached_property
    def start(self) -> tuple[float, float]:
        """Where it begins, mm."""
        return float(self.rows[0, X0]), float(self.rows[0, Y0])

    @cached_property
    def end(self) -> tuple[float, float]:
        """Where it ends, mm."""
        return float(self.rows[-1, X1]), float(self.rows[-1, Y1])

    @property
    def closed(self) -> bool:
        """True when it ends where it begins."""
        return bool(np.all(self.rows[-1, 2:4] == self.rows[0, :2]))

    def heights(self, z: float) -> NDArray[np.float64]:
        """Return (n,) at which height each row is cut by a pass at z, mm."""
        return np.full(len(self.rows), z) if self.least_z is None else np.maximum(self.least_z, z)

    def begins_at(self, z: float) -> float:
        """Return at which height its first row is cut by a pass at z, mm."""
        return z if self.least_z is None else max(float(self.least_z[0]), z)

    def part(self, first: int, stop: int) -> Stroke:
        """Return its rows from `first` up to `stop`, which is left out."""
        least_z = None if self.least_z is None else self.least_z[first:stop]
        return replace(self, rows=self.rows[first:stop], purpose=self.purpose[first:stop], least_z=least_z)

    def backwards(self) -> Stroke:
        """Return it from its end to its beginning."""
        least_z = None if self.least_z is None else self.least_z[::-1]
        return replace(self, rows=reversed_rows(self.rows), purpose=self.purpose[::-1], least_z=least_z)

    def split(self, row: int, fraction: float) -> tuple[Stroke, Stroke]:
        """Return what of it comes before and after a fraction in [0, 1] of a row; either may have no rows."""
        if fraction <= 0:
            return self.part(0, row), self.part(row, len(self.rows))
        if fraction >= 1:
            return self.part(0, row + 1), self.part(row + 1, len(self.rows))
        first, second = split_row(self.rows[row], fraction)
        before, after = self.part(0, row + 1), self.part(row, len(self.rows))
        return (
            replace(before, rows=np.concatenate([before.rows[:-1], first[None]])),
            replace(after, rows=np.concatenate([second[None], after.rows[1:]])),
        )

    def and_then(self, other: Stroke) -> Stroke:
        """Return one stroke of this one and another that begins where it ends."""
        least_z = None
        if self.least_z is not None or other.least_z is not None:
            least_z = np.concatenate(
                [np.full(len(each.rows), -np.inf) if each.least_z is None else each.least_z for each in (self, other)]
            )
        return replace(
            self,
            rows=np.concatenate([self.rows, other.rows]),
            purpose=np.concatenate([self.purpose, other.purpose]),
            least_z=least_z,
        )


class _Appended(NamedTuple):
    """One straight move to a place, or a whole path: as it was given, for arrays of all are made at once.

    Attributes:
        rows: (n, 8) of a path; None of a straight move.
        ends: (n,) the height at which each row ends, or the place (x, y, z) where a straight move does, mm.
        purpose, feed: of all its moves, or (n,) of each.
    """

    rows: Rows | None
    ends: NDArray[np.float64] | tuple[float, float, float]
    purpose: Purpose | NDArray[np.uint8]
    label: StrokeLabel
    region: int
    feed: float | NDArray[np.float64]


class MovesBuilder:
    """Appends moves; knows where the tool is."""

    def __init__(self) -> None:
        self._columns: list[_Appended] = []

    @property
    def at(self) -> tuple[float, float, float]:
        """Where the tool is, mm; NaN before the first move."""
        if not self._columns:
            return math.nan, math.nan, math.nan
        rows, ends = self._columns[-1][:2]
        x, y, z = ends if rows is None else (*rows[-1, X1:CX].tolist(), float(ends[-1]))
        return x, y, z

    def straight(self, end: tuple[float, float, float], purpose: Purpose, label: StrokeLabel, region: int = 0) -> None:
        """Append a rapid, or a plunge at plunge rate."""
        feed = 0.0 if purpose is Purpose.RAPID else label.plunge_rate
        self._columns.append(_Appended(None, end, purpose, label, region, feed))

    def cut(self, stroke: Stroke, z: float, label: StrokeLabel) -> None:
        """Append a whole stroke at height z, mm, at feed rate, over its least heights; the tool is at its beginning."""
        heights = stroke.heights(z)
        if stroke.least_z is None or not np.any(np.diff(heights)):
            self._path(stroke, heights, label, label.feed)
            return
        first = 0
        for k in (*(np.flatnonzero(np.diff(heights)) + 1).tolist(), len(heights)):
            if first:
                x, y = stroke.rows[first, :2].tolist()
                up = heights[first] > heights[first - 1]
                self.straight(
                    (x, y, float(heights[first])), Purpose.TAB if up else Purpose.PLUNGE, label, stroke.region
                )
            self._path(stroke.part(first, k), heights[first:k], label, label.feed)
            first = k

    def ramp(self, stroke: Stroke, heights: NDArray[np.float64], label: StrokeLabel) -> None:
        """Append a way down along a stroke, each row of it ending at its own height (n,), mm, and no row faster than
        may be.

        The cutter cuts with its end and with all of its width, so it goes at half the feed rate, and down no faster
        than a plunge.
        """
        fall = np.abs(heights - np.append(self.at[2], heights[:-1]))
        slope = fall / np.maximum(np.hypot(lengths(stroke.rows), fall), 1e-12)
        feed = np.minimum(
            max(label.feed / 2, min(label.plunge_rate, label.feed)), label.plunge_rate / np.maximum(slope, 1e-9)
        )
        self._columns.append(_Appended(stroke.rows, heights, Purpose.PLUNGE, label, stroke.region, feed))

    def along(
        self, stroke: Stroke, heights: NDArray[np.float64], label: StrokeLabel, feed: NDArray[np.float64]
    ) -> None:
        """Append a path whose rows each end at their own height, mm, and have their own feed, mm/min, (n,) each."""
        self._path(stroke, heights, label, feed)

    def _path(
        self, stroke: Stroke, heights: NDArray[np.float64], label: StrokeLabel, feed: float | NDArray[np.float64]
    ) -> None:
        self._columns.append(_Appended(stroke.rows, heights, stroke.purpose, label, stroke.region, feed))

    def moves(self) -> Moves:
        """Return everything appended so far."""
        columns = self._columns
        counts = np.array([1 if each.rows is None else len(each.rows) for each in columns], np.int64)
        straight = np.repeat(np.array([each.rows is None for each in columns], np.bool_), counts)
        rows = np.concatenate([np.zeros((0, 8)), *(each.rows for each in columns if each.rows is not None)])
        purpose = _spread([each.purpose for each in columns], counts, np.dtype(np.uint8))
        end = np.empty((len(straight), 3))
        end[straight] = np.array([each.ends for each in columns if each.rows is None]).reshape(-1, 3)
        heights = np.concatenate([np.zeros(0), *(each.ends for each in columns if each.rows is not None)])
        end[~straight] = np.column_stack([rows[:, X1:CX], heights])
        centre, kind = np.full((len(straight), 2), math.nan), np.full(len(straight), MoveKind.LINE, np.uint8)
        centre[~straight] = np.where(rows[:, [TURN]] != 0, rows[:, CX:R], math.nan)
        kind[~straight] = _KIND_BY_TURN[rows[:, TURN].astype(np.int64) + 1]
        kind[straight & (purpose == Purpose.RAPID)] = MoveKind.RAPID
        return Moves(
            end=end,
            centre=centre,
            kind=kind,
            purpose=purpose,
            operation=np.repeat(np.array([each.label.operation for each in columns], np.int16), counts),
            tool=np.repeat(np.array([each.label.tool for each in columns], np.int16), counts),
            region=np.repeat(np.array([each.region for each in columns], np.int32), counts),
            feed=_spread([each.feed for each in columns], counts, np.dtype(np.float64)),
            line=np.zeros(int(counts.sum()), np.int32),
        )


def _spread(values: Sequence[float | NDArray[Any]], counts: NDArray[np.int64], kind: np.dtype[Any]) -> NDArray[Any]:
    """Return one value a move from one for each column, or an array (count,) of its own."""
    single = np.array([not isinstance(value, np.ndarray) for value in values], np.bool_)
    found = np.empty(int(counts.sum()), kind)
    of = np.repeat(single, counts)
    found[of] = np.repeat(
        np.array([value for value in values if not isinstance(value, np.ndarray)], kind), counts[single]
    )
    found[~of] = np.concatenate([np.zeros(0, kind), *(value for value in values if isinstance(value, np.ndarray))])
    return found


def merged(stroke: Stroke) -> Stroke:
    """Return a stroke whose neighbouring arcs of one circle, purpose and least height are one, but never a full turn or
    more.
    """
    turns = stroke.rows[:, TURN]
    if not ((turns[1:] != 0) & (turns[1:] == turns[:-1])).any():
        return stroke
    least_z = stroke.least_z
    heights = np.zeros(0) if least_z is None else least_z
    kept = beginnings(
        *(np.ascontiguousarray(each) for each in (stroke.rows, stroke.purpose.astype(np.uint8, copy=False), heights))
    )
    if len(kept) == len(stroke.rows):
        return stroke
    joined = stroke.rows[kept]
    joined[:, X1 : Y1 + 1] = stroke.rows[np.append(kept[1:] - 1, len(stroke.rows) - 1), X1 : Y1 + 1]
    return replace(
        stroke, rows=joined, purpose=stroke.purpose[kept], least_z=None if least_z is None else least_z[kept]
    )


def split_row(row: Rows, fraction: float) -> tuple[Rows, Rows]:
    """Return the parts of a row (8,) before and after a fraction in (0, 1) of its length."""
    first, second = row.copy(), row.copy()
    first[2:4] = second[:2] = point_on(row.tolist(), fraction)
    return first, second


def started_at(rows: Rows, index: int, fraction: float) -> Rows:
    """Return a closed path's rows so that it begins at a fraction of one of them."""
    if fraction <= 0:
        return np.concatenate([rows[index:], rows[:index]])
    if fraction >= 1:
        return started_at(rows, (index + 1) % len(rows), 0.0)
    first, second = split_row(rows[index], fraction)
    return np.concatenate([second[None], rows[index + 1 :], rows[:index], first[None]])
