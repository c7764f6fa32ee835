"""What fitting a curve to points gives: motions, and which point each of them ends at."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.model.motion import Floats, MotionKind, Motions, Nurbs, Plane

Ints = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class FittedPath:
    """A path that stands for a polyline of n points.

    Attributes:
        motions: m lines, arcs (in any plane; helices) and splines; feed NaN, line and state 0.
        last: (m,) index of the point that each motion's end answers to: strictly rising, the last one n - 1.
    """

    motions: Motions
    last: Ints


def lines_between(points: Floats) -> Motions:
    """Return straight motions from each point (n, 3) to the next."""
    return _motions(points[:-1], points[1:], np.full(len(points) - 1, MotionKind.LINE, np.uint8))


def spline_motion(curve: Nurbs) -> Motions:
    """Return one motion along a spline."""
    ends = curve.points[[0]], curve.points[[-1]]
    return _motions(*ends, np.full(1, MotionKind.SPLINE, np.uint8), {0: curve})


def _motions(start: Floats, end: Floats, kind: NDArray[np.uint8], splines: dict[int, Nurbs] | None = None) -> Motions:
    count = len(kind)
    whole = np.zeros(count, np.int32)
    return Motions(
        start=start.copy(), end=end.copy(), centre=np.full((count, 3), np.nan), kind=kind, plane=np.full(count, Plane.XY, np.uint8),
        turns=whole.copy(), feed=np.full(count, np.nan), line=whole.copy(), state=whole.copy(), splines=splines or {},
    )  # fmt: skip


def chained(parts: Sequence[FittedPath]) -> FittedPath:
    """Return paths one after the other as one; the point where one ends is the first of the next."""
    base, rows = 0, 0
    last: list[Ints] = []
    splines: dict[int, Nurbs] = {}
    for part in parts:
        last.append(part.last + base)
        splines |= {row + rows: spline for row, spline in part.motions.splines.items()}
        base, rows = int(last[-1][-1]), rows + len(part.motions)

    def joined(name: str) -> NDArray[Any]:
        return np.concatenate([getattr(part.motions, name) for part in parts])

    motions = Motions(
        joined("start"), joined("end"), joined("centre"), joined("kind"), joined("plane"), joined("turns"), joined("feed"),
        joined("line"), joined("state"), splines,
    )  # fmt: skip
    return FittedPath(motions, np.concatenate(last))
