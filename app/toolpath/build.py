"""Collect moves row by row and freeze them into columns."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.geometry.primitives import CX, CY, TURN, X0, X1, Y0, Y1, R, Rows, sweeps
from app.model.moves import MoveKind, Moves, Purpose

_SAME_CENTRE = 1e-6  # mm
_NO_CENTRE = (math.nan, math.nan)


@dataclass(frozen=True)
class Label:
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


@dataclass(frozen=True)
class Stroke:
    """A path in the plane that is cut without lifting the tool.

    Attributes:
        rows: (n, 8) lines and arcs, each beginning where the one before ends.
        purpose: (n,) uint8 Purpose of each row.
        region: number of its region.
    """

    rows: Rows
    purpose: NDArray[np.uint8]
    region: int

    @property
    def start(self) -> tuple[float, float]:
        """Where it begins, mm."""
        return float(self.rows[0, X0]), float(self.rows[0, Y0])

    @property
    def closed(self) -> bool:
        """True when it ends where it begins."""
        return bool(np.all(self.rows[-1, 2:4] == self.rows[0, :2]))


class MovesBuilder:
    """Appends moves; knows where the tool is."""

    def __init__(self) -> None:
        self._columns: list[tuple[Rows, Rows, NDArray[np.uint8], Purpose | NDArray[np.uint8], Label, int, float]] = []

    def straight(self, end: tuple[float, float, float], purpose: Purpose, label: Label, region: int = 0) -> None:
        """Append a rapid, or a plunge at plunge rate."""
        rapid = purpose is Purpose.RAPID
        kind = np.array([MoveKind.RAPID if rapid else MoveKind.LINE], np.uint8)
        feed = 0.0 if rapid else label.plunge_rate
        self._columns.append((np.array([end]), np.array([_NO_CENTRE]), kind, purpose, label, region, feed))

    def cut(self, stroke: Stroke, z: float, label: Label) -> None:
        """Append a whole stroke at height z, mm, at feed rate."""
        rows, purpose = merge_arcs(stroke.rows, stroke.purpose)
        end = np.column_stack([rows[:, X1], rows[:, Y1], np.full(len(rows), z)])
        arcs = rows[:, TURN] != 0
        centre = np.where(arcs[:, None], rows[:, [CX, CY]], math.nan)
        kind = np.where(arcs, np.where(rows[:, TURN] > 0, MoveKind.ARC_CCW, MoveKind.ARC_CW), MoveKind.LINE).astype(np.uint8)
        self._columns.append((end, centre, kind, purpose, label, stroke.region, label.feed))

    def moves(self) -> Moves:
        """Return everything appended so far."""
        counts = [len(c[2]) for c in self._columns]
        purposes = [np.broadcast_to(np.asarray(c[3], np.uint8), n) for c, n in zip(self._columns, counts, strict=True)]
        return Moves(
            end=np.concatenate([np.zeros((0, 3)), *(c[0] for c in self._columns)]),
            centre=np.concatenate([np.zeros((0, 2)), *(c[1] for c in self._columns)]),
            kind=np.concatenate([np.zeros(0, np.uint8), *(c[2] for c in self._columns)]),
            purpose=np.concatenate([np.zeros(0, np.uint8), *purposes]),
            operation=np.repeat(np.array([c[4].operation for c in self._columns], np.int16), counts),
            tool=np.repeat(np.array([c[4].tool for c in self._columns], np.int16), counts),
            region=np.repeat(np.array([c[5] for c in self._columns], np.int16), counts),
            feed=np.repeat(np.array([c[6] for c in self._columns]), counts),
            line=np.zeros(sum(counts), np.int32),
        )


def merge_arcs(rows: Rows, purpose: NDArray[np.uint8]) -> tuple[Rows, NDArray[np.uint8]]:
    """Join neighbouring arcs of one circle, as long as they stay less than a full turn."""
    same = ((rows[1:, TURN] != 0) & (rows[1:, TURN] == rows[:-1, TURN]) & (purpose[1:] == purpose[:-1])
            & (np.hypot(rows[1:, CX] - rows[:-1, CX], rows[1:, CY] - rows[:-1, CY]) < _SAME_CENTRE)
            & (np.abs(rows[1:, R] - rows[:-1, R]) < _SAME_CENTRE))
    if not same.any():
        return rows, purpose
    turn = np.abs(sweeps(rows))
    merged, kept, total = [rows[0].copy()], [0], turn[0]
    for i in range(1, len(rows)):
        if same[i - 1] and total + turn[i] < math.tau - 1e-3:
            merged[-1][[X1, Y1]] = rows[i, [X1, Y1]]
            total += turn[i]
            continue
        merged.append(rows[i].copy())
        kept.append(i)
        total = turn[i]
    return np.array(merged), purpose[kept]


def split_row(row: Rows, fraction: float) -> tuple[Rows, Rows]:
    """Return the parts of a row (8,) before and after a fraction in (0, 1) of its length."""
    first, second = row.copy(), row.copy()
    if row[TURN] == 0:
        point = row[:2] + fraction * (row[2:4] - row[:2])
    else:
        angle = math.atan2(row[Y0] - row[CY], row[X0] - row[CX]) + fraction * float(sweeps(row[None])[0])
        point = row[[CX, CY]] + row[R] * np.array([math.cos(angle), math.sin(angle)])
    first[2:4] = second[:2] = point
    return first, second


def started_at(rows: Rows, index: int, fraction: float) -> Rows:
    """Return a closed path's rows so that it begins at a fraction of one of them."""
    if fraction <= 0:
        return np.concatenate([rows[index:], rows[:index]])
    if fraction >= 1:
        return started_at(rows, (index + 1) % len(rows), 0.0)
    first, second = split_row(rows[index], fraction)
    return np.concatenate([second[None], rows[index + 1:], rows[:index], first[None]])
