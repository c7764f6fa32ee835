"""What a control does with an NC program: its motions as columns, one row each, in the order of doing."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


class MotionKind(IntEnum):
    """How the control moves; the first four are the G words, and alike in `MoveKind`."""

    RAPID = 0
    LINE = 1
    ARC_CW = 2
    ARC_CCW = 3
    SPLINE = 4


class Plane(IntEnum):
    """Plane of arcs and cycles; clockwise is as seen from the positive end of its normal."""

    XY = 0
    ZX = 1
    YZ = 2

    @property
    def axes(self) -> tuple[int, int, int]:
        """Columns of the plane's first and second axis and of its normal; right-handed."""
        return ((0, 1, 2), (2, 0, 1), (1, 2, 0))[self]


@dataclass(frozen=True, eq=False)
class Nurbs:
    """A rational B-spline in space, clamped at both ends.

    Attributes:
        points: (k, 3) control points, mm; the first and the last are the curve's ends.
        weights: (k,) > 0.
        knots: (k + degree + 1,) not decreasing.
        degree: >= 1, < k.
    """

    points: Floats
    weights: Floats
    knots: Floats
    degree: int


@dataclass(frozen=True, eq=False)
class Motions:
    """A sequence of n motions of the controlled point.

    Coordinates are mm from the zero of the work offsets' table: what the program says plus the work offset, G52 and G92
    that are in force (all 0 unless the program or the reader's caller sets them), so that parts of one program cut
    under different offsets lie where they belong. Tool length counts as compensated: the point is the tool's tip.

    Attributes:
        start, end: (n, 3) mm. A motion starts where the one before ended, but for a jump of the controlled point
            (another tool length).
        centre: (n, 3) centre of arcs, mm, at the height of the start; NaN for others.
        kind: (n,) uint8 MotionKind.
        plane: (n,) uint8 Plane in force.
        turns: (n,) int32 of arcs: 1 = up to a full turn, 2 = up to two; 0 for others. An arc whose ends are alike in
            its plane is whole turns.
        feed: (n,) mm/min along the path; 0 for rapids; NaN where the program has not said it.
        line: (n,) int32 1-based line of the text.
        state: (n,) int32 index into the states of the program that they belong to.
        splines: the curve of each SPLINE motion, by row.
        known_from: for X, Y, Z the first row whose end the program itself has set; n if it never does; -1 where the
            first motion starts at a place that is taken for known: the program moves the axis in G91 before it has set
            it. Before it the axis stands where the reader was told that it starts.
    """

    start: Floats
    end: Floats
    centre: Floats
    kind: NDArray[np.uint8]
    plane: NDArray[np.uint8]
    turns: NDArray[np.int32]
    feed: Floats
    line: NDArray[np.int32]
    state: NDArray[np.int32]
    splines: dict[int, Nurbs] = field(default_factory=dict)
    known_from: tuple[int, int, int] = (0, 0, 0)

    def __len__(self) -> int:
        return len(self.kind)

    def __post_init__(self) -> None:
        for name in ("start", "end", "centre", "kind", "plane", "turns", "feed", "line", "state"):
            column = getattr(self, name)
            if len(column) != len(self.kind):
                raise ValueError("columns of different length")
            column.setflags(write=False)

    @staticmethod
    def none() -> Motions:
        """Return no motion."""
        places = np.zeros((0, 3))
        small, whole = np.zeros(0, np.uint8), np.zeros(0, np.int32)
        return Motions(
            start=places,
            end=places,
            centre=places,
            kind=small,
            plane=small,
            turns=whole,
            feed=np.zeros(0),
            line=whole,
            state=whole,
        )
