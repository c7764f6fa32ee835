"""The last way along the walls, over scallops alone, proven beforehand; where that fails, more discs come first."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ...core.progress import Progress
from ...geometry.offset.offset import Ring
from ...geometry.primitives import CX, CY, TURN, X0, X1, Y0, Y1, R, Rows, lengths, points_at, sweeps
from ...toolpath.engagement.rim_kernels import bound_along
from .cleared_discs import ClearedDisc, ClearedDiscs, Point, WallClearance
from .limit import EngagementLimit

Floats = NDArray[np.float64]

_SMOOTH = 1e-6
"""Radians; a path that turns by less is smooth."""

_MENDED = 400
"""Discs that are added for one ring at most."""

_COARSE = 0.1
"""Radii of the cutter that are looked at as one piece at first."""

_FINEST = 2e-4
"""mm; so short pieces are not halved."""

_SHARES = (1.0, 0.7, 0.4, 0.2, 0.1, 0.05)
"""Of the way from a place on the wall to a middle: where one more disc is tried, the middle first."""


def sharp_corners(rings: Sequence[Ring], least: float) -> tuple[Floats, Floats]:
    """Return the corners (n, 2) at which rings turn left by more than an angle, and by how much they do."""
    found = [(ring.rows[:, :2], _turns(ring.rows)) for ring in rings]
    places = np.concatenate([np.zeros((0, 2)), *(each for each, _ in found)])
    turn = np.concatenate([np.zeros(0), *(each for _, each in found)])
    return places[turn > least], turn[turn > least]


def _turns(rows: Rows) -> Floats:
    """Return by how much (n,) a closed path turns left where each row begins, radians."""
    back = np.roll(rows, 1, axis=0)
    ahead, came = _direction(rows, X0), _direction(back, X1)
    return np.asarray(np.arctan2(came[:, 0] * ahead[:, 1] - came[:, 1] * ahead[:, 0], (came * ahead).sum(axis=1)))


def _direction(rows: Rows, at: int) -> Floats:
    arm = rows[:, at : at + 2] - rows[:, [CX, CY]]
    across = np.column_stack([-arm[:, 1], arm[:, 0]]) * rows[:, [TURN]]
    ahead = np.where(rows[:, [TURN]] == 0, rows[:, 2:4] - rows[:, :2], across)
    return np.asarray(ahead / np.maximum(np.hypot(*ahead.T), 1e-300)[:, None])


def rounded(ring: Ring, by: float) -> Rows:
    """Return the rows of a ring moved outwards by a length, mm, with an arc of that radius round each corner."""
    rows, turn = ring.rows, _turns(ring.rows)
    out = rows.copy()
    for at in (X0, X1):
        ahead = _direction(rows, at)
        out[:, at] += by * ahead[:, 1]
        out[:, at + 1] -= by * ahead[:, 0]
    out[:, R] += np.where(rows[:, TURN] != 0, by * rows[:, TURN], 0.0)
    made: list[Floats] = []
    for k in range(len(rows)):
        before = out[k - 1]
        if turn[k] > _SMOOTH:
            corner = rows[k, :2]
            made.append(np.array([before[X1], before[Y1], out[k, X0], out[k, Y0], *corner, by, 1.0]))
        else:
            out[k, :2] = before[2:4]
        made.append(out[k])
    path = np.array(made)
    path[:-1, 2:4] = path[1:, :2]
    path[-1, 2:4] = path[0, :2]
    return path[lengths(path) > 1e-7]


@dataclass
class RingProof:
    """Looks at rings.

    Attributes:
        unproven: places at which the limit could not be kept.
    """

    limit: EngagementLimit
    room: WallClearance
    discs: ClearedDiscs
    unproven: list[Point] = field(default_factory=list)

    def holds(self, path: Rows, progress: Progress) -> bool:
        """Tell whether a ring keeps the limit, after more discs were cleared where it would not.

        Raises:
            Cancelled: by progress.
        """
        size, turn = lengths(path), sweeps(path)
        mended = 0
        for k, row in enumerate(path):
            progress.step(k / len(path), "Prove the way along the walls")
            while True:
                bound, at = bound_along(
                    self._near(row, size[k]),
                    row,
                    self.limit.radius,
                    (float(turn[k]), float(size[k])),
                    (self.limit.planned, _COARSE * self.limit.radius, _FINEST, self.limit.planned),
                )
                if bound <= self.limit.planned:
                    break
                x, y = points_at(row[None], np.array([at]))[0].tolist()
                mended += 1
                if mended > _MENDED or not self._mend((x, y)):
                    self.unproven.append((x, y))
                    return False
        return True

    def _near(self, row: Floats, size: float) -> Floats:
        """Return what is clear near a row, as shapes of `rim_kernels`, a little smaller than it is."""
        table = self.discs.table
        middle = points_at(row[None], np.array([0.5]))[0]
        away = np.hypot(table[:, 0] - middle[0], table[:, 1] - middle[1])
        near = away < table[:, 2] + self.limit.radius + size / 2
        return shapes_of(table[near] - [0.0, 0.0, self.limit.slack])

    def _mend(self, place: Point) -> bool:
        """Clear one more disc that touches the wall where the cutter at a place does, or the way to it."""
        centre, _ = self.room.to_axis(place)
        for share in _SHARES:
            x, y = (place[j] + share * (centre[j] - place[j]) for j in (0, 1))
            reach = self.room.at((x, y))
            turn = reach - self.limit.radius
            if turn < self.limit.least_turn:
                continue
            spare = self.discs.depth_in((x, y)) - self.limit.clear_needed(turn)
            sticks_out = self.discs.depth_in((x, y)) < reach - 1e-4
            if not sticks_out.all():
                continue
            k = int(np.argmax(spare))
            if spare[k] >= 0:
                self.discs.add(ClearedDisc(x, y, reach, k))
                return True
        return False


def shapes_of(discs: Floats) -> Floats:
    """Return discs (n, 3) as shapes (n, 9) of `rim_kernels`."""
    shapes = np.zeros((len(discs), 9))
    shapes[:, :3] = discs
    shapes[:, [5, 8]] = math.inf
    return shapes
