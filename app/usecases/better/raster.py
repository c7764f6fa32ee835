"""The passes of a program that goes to and fro over a surface, told from the way between them."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ...core.errors import InputError
from ...gcode.interpreter.program import NcProgram
from ...model.motion import Floats, MotionKind

_ALONG = math.cos(math.radians(20.0))
"""A move is of a pass where its way over the plane is within that of the passes' direction."""
_FEWEST_POINTS, _FEWEST_ROWS = 4, 4
"""Points of a pass, and passes: fewer tell of no surface."""
_STRAIGHT = 0.02
"""mm; by so much a pass may leave its own line, seen from above."""
_SHARE = 0.8
"""Of all that is fed sideways: so much of it has to be passes, or the program is another kind."""
_FILLED = 0.5
"""Of the pitch: places are no farther apart along a pass."""
_STEEP = 0.02
"""A move that goes so little sideways for its length is a plunge or a lift, of no direction."""


@dataclass(frozen=True)
class PassFrame:
    """The direction of passes: u along them, v across, both in the plane.

    Attributes:
        angle: of u to X, radians, in (-pi / 2, pi / 2].
    """

    angle: float

    def inwards(self, points: Floats) -> Floats:
        """Return points (n, 3) as u, v, z."""
        return self._turned(points, -self.angle)

    def outwards(self, points: Floats) -> Floats:
        """Return points (n, 3) in u, v, z as X, Y, Z."""
        return self._turned(points, self.angle)

    @staticmethod
    def _turned(points: Floats, angle: float) -> Floats:
        c, s = math.cos(angle), math.sin(angle)
        x, y = points[:, 0], points[:, 1]
        return np.column_stack([x * c - y * s, x * s + y * c, *points[:, 2:].T])


@dataclass(frozen=True, eq=False)
class RasterProgram:
    """A program's passes.

    Attributes:
        frame: their direction.
        rows: (n, 3) places of the tip of each, u rising, in u, v, z, mm; neighbours follow one another.
        pitch: from row to row, mm, the usual one.
        zigzag: whether they go there and back.
        feed: mm/min, the usual one. share: of all that is fed sideways that is passes, by length.
    """

    frame: PassFrame
    rows: tuple[Floats, ...]
    pitch: float
    zigzag: bool
    feed: float
    share: float

    @property
    def points(self) -> Floats:
        """All places (n, 3) in u, v, z, mm."""
        return np.concatenate(self.rows)


def raster_of(name: str, program: NcProgram) -> RasterProgram:
    """Return the passes of a program.

    Args:
        name: of the file, for messages. program: as it was read, its motions anchored.

    Raises:
        InputError: it does not go over a surface in straight passes beside one another.
    """
    motions = program.motions
    fed = np.flatnonzero(motions.kind != MotionKind.RAPID)
    ways = motions.end[fed] - motions.start[fed]
    sizes = np.linalg.norm(ways, axis=1)
    over = np.hypot(ways[:, 0], ways[:, 1])
    flat = (motions.kind[fed] == MotionKind.LINE) & (over > _STEEP * sizes) & (sizes > 0)
    if not flat.any():
        raise _other(name, "it has no straight feed moves over the plane")
    double = 2 * np.arctan2(ways[flat, 1], ways[flat, 0])
    angle = math.atan2(float(over[flat] @ np.sin(double)), float(over[flat] @ np.cos(double))) / 2
    frame = PassFrame(angle)
    turned = frame.inwards(ways)
    side = np.where(flat & (np.abs(turned[:, 0]) >= _ALONG * over), np.sign(turned[:, 0]), 0).astype(np.int64)
    runs = _runs(fed, side)
    rows, senses, length = [], [], 0.0
    for first, stop in runs:
        some = fed[first:stop]
        row = frame.inwards(np.vstack([motions.start[some[:1]], motions.end[some]]))
        length += float(sizes[first:stop].sum())
        _ensure_straight(name, row, int(motions.line[some[0]]))
        senses.append(int(side[first]))
        rows.append(row if side[first] > 0 else row[::-1])
    share = length / max(float(sizes[over > _STEEP * sizes].sum()), 1e-9)
    if len(rows) < _FEWEST_ROWS or share < _SHARE:
        raise _other(
            name, f"{len(rows)} passes along {math.degrees(angle):.4g} degrees are {share:.0%} of its feed moves"
        )
    order = sorted(range(len(rows)), key=lambda k: (round(float(rows[k][:, 1].mean()), 3), float(rows[k][0, 0])))
    ordered = _beside([np.ascontiguousarray(rows[k]) for k in order])
    feeds = motions.feed[fed[flat]]
    feed = float(np.median(feeds[np.isfinite(feeds) & (feeds > 0)])) if np.isfinite(feeds).any() else 600.0
    zigzag = any(one != other for one, other in pairwise(senses))
    return RasterProgram(frame, ordered, _pitch(name, ordered), zigzag, feed, share)


def filled(raster: RasterProgram) -> RasterProgram:
    """Return passes with places between points that are far apart: a chord over a facet says as much of it as points
    within it do.
    """
    rows = []
    for row in raster.rows:
        parts = np.linalg.norm(np.diff(row, axis=0), axis=1) / (_FILLED * raster.pitch)
        counts = np.maximum(np.ceil(parts), 1).astype(np.int64)
        chord = np.repeat(np.arange(len(counts)), counts)
        share = (np.arange(len(chord)) - np.repeat(np.cumsum(counts) - counts, counts)) / counts[chord]
        between = row[chord] + share[:, None] * (row[chord + 1] - row[chord])
        rows.append(np.concatenate([between, row[-1:]]))
    return replace(raster, rows=tuple(rows))


def _runs(fed: NDArray[np.int64], side: NDArray[np.int64]) -> list[tuple[int, int]]:
    """Return first and stop among the fed motions of each pass."""
    changes = np.flatnonzero((np.diff(side) != 0) | (np.diff(fed) != 1)) + 1
    edges = [0, *changes.tolist(), len(side)]
    return [(a, b) for a, b in pairwise(edges) if side[a] != 0 and b - a >= _FEWEST_POINTS - 1]


def _beside(rows: list[Floats]) -> tuple[Floats, ...]:
    """Return rows in such an order that those that follow one another lie beside one another: where passes have gaps,
    one side of a gap after the other.
    """
    chains: list[list[Floats]] = []
    for row in rows:
        shared = [min(chain[-1][-1, 0], row[-1, 0]) - max(chain[-1][0, 0], row[0, 0]) for chain in chains]
        ahead = [
            length if chain[-1][0, 1] < row[0, 1] - _STRAIGHT else -1.0
            for chain, length in zip(chains, shared, strict=True)
        ]
        best = int(np.argmax(ahead)) if ahead else -1
        if best >= 0 and ahead[best] > 0:
            chains[best].append(row)
        else:
            chains.append([row])
    return tuple(row for chain in chains for row in chain)


def _ensure_straight(name: str, row: Floats, line: int) -> None:
    swings = float(np.ptp(row[:, 1]))
    if swings > _STRAIGHT:
        raise _other(name, f"the pass of line {line} leaves its straight line by {swings:.3g} mm, seen from above")


def _pitch(name: str, rows: tuple[Floats, ...]) -> float:
    places = np.unique([round(float(row[:, 1].mean()), 3) for row in rows])
    if len(places) < _FEWEST_ROWS:
        raise _other(name, f"its passes lie on {len(places)} lines, and {_FEWEST_ROWS} are the least")
    return float(np.median(np.diff(places)))


def _other(name: str, why: str) -> InputError:
    return InputError(
        f"{name}: {why}; a program that can be made better goes over a surface in straight passes beside one another. "
        "Use smooth, which takes any program."
    )
