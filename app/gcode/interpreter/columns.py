"""The columns of a program's motions while they grow: the reader's core adds rows one by one, its lane many at once."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...model.motion import MotionKind, Motions, Nurbs, Plane

_FIRST = 1024
_GROWTH = 1.5
_NOWHERE = (float("nan"),) * 3

Place = tuple[float, float, float]


@dataclass(slots=True)
class Motion:
    """One motion; what each field is, `Motions` says."""

    kind: MotionKind | int
    start: Place
    end: Place
    feed: float
    line: int
    state: int
    plane: Plane | int = Plane.XY
    centre: Place = _NOWHERE
    turns: int = 0


class MotionColumns:
    """The columns of `Motions`, longer than they need be: rows from `count` on mean nothing yet.

    Attributes:
        count: how many motions there are. Who writes rows straight into the arrays raises it.
        start, end, centre, kind, plane, turns, feed, line, state: see `Motions`.
    """

    __slots__ = ("centre", "count", "end", "feed", "kind", "line", "plane", "start", "state", "turns")

    def __init__(self) -> None:
        self._clear()

    def _clear(self) -> None:
        self.count = 0
        self.start, self.end, self.centre = np.zeros((3, 0, 3))
        self.feed = np.zeros(0)
        self.kind, self.plane = np.zeros((2, 0), np.uint8)
        self.turns, self.line, self.state = np.zeros((3, 0), np.int32)

    def __len__(self) -> int:
        return self.count

    def arrays(self) -> tuple[NDArray[np.float64] | NDArray[np.uint8] | NDArray[np.int32], ...]:
        """Return the arrays in the order in which kernels take them."""
        return self.start, self.end, self.centre, self.kind, self.plane, self.turns, self.feed, self.line, self.state

    def reserve(self, more: int) -> None:
        """Make room for some more motions.

        Args:
            more: how many, >= 0.
        """
        if self.count + more > len(self.kind):
            self._resize(max(self.count + more, int(_GROWTH * len(self.kind)), _FIRST))

    def add(self, motion: Motion) -> None:
        """Add a motion at the end."""
        self.reserve(1)
        row = self.count
        self.start[row], self.end[row], self.centre[row] = motion.start, motion.end, motion.centre
        self.kind[row], self.plane[row], self.turns[row] = motion.kind, motion.plane, motion.turns
        self.feed[row], self.line[row], self.state[row] = motion.feed, motion.line, motion.state
        self.count = row + 1

    def motions(self, splines: dict[int, Nurbs] | None = None, known_from: tuple[int, int, int] = (0, 0, 0)) -> Motions:
        """Return all motions, and be empty again: the arrays are handed over, so that nothing is held twice.

        Args:
            splines: the curves of the SPLINE rows.
            known_from: see `Motions`.
        """
        self._resize(self.count)
        cut = Motions(
            self.start,
            self.end,
            self.centre,
            self.kind,
            self.plane,
            self.turns,
            self.feed,
            self.line,
            self.state,
            splines or {},
            known_from,
        )
        self._clear()
        return cut

    def _resize(self, rows: int) -> None:
        """Give every array its rows; what is there stays."""
        for name in ("start", "end", "centre", "kind", "plane", "turns", "feed", "line", "state"):
            old = getattr(self, name)
            new = np.empty((rows, *old.shape[1:]), old.dtype)
            new[: self.count] = old[: self.count]
            setattr(self, name, new)
