"""What fitting a curve to points gives: motions, and which point each of them ends at."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import Enum
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..model.motion import Floats, MotionKind, Motions, Nurbs, Plane

Ints = NDArray[np.int64]


class RefusalReason(Enum):
    """Why something else stands where a spline was asked for; the value is how people are told."""

    BLOCKS = "a spline would take as many blocks or more"
    SHORT = "too few points for a spline"
    LEVEL = "the control knows splines at one height only"
    HOOKED = "a spline would set out where the moves do not lead"
    BENT = "splines would bend more where they meet than the moves do"
    UNPROVEN = "no spline was found that keeps to the tolerance"
    CONTROL = "the control knows no splines"


@dataclass(frozen=True, slots=True)
class SplineRefusal:
    """A run of points in which something else stands for a spline.

    Attributes:
        reason: why.
        blocks: that splines would take; 0 = not known, since none was written out.
        instead: that what stands there takes.
    """

    reason: RefusalReason
    blocks: int = 0
    instead: int = 0


@dataclass(frozen=True, eq=False)
class FittedPath:
    """A path that stands for a polyline of n points.

    Attributes:
        motions: m lines, arcs (in any plane; helices) and splines; feed NaN, line and state 0.
        last: (m,) index of the point nearest to each motion's end along the polyline: never falling, the last one n -
            1.
        refusals: where splines were asked for and something else stands.
    """

    motions: Motions
    last: Ints
    refusals: tuple[SplineRefusal, ...] = ()


def lines_between(points: Floats) -> Motions:
    """Return straight motions from each point (n, 3) to the next."""
    return _motions(points[:-1], points[1:], np.full(len(points) - 1, MotionKind.LINE, np.uint8))


def arcs_between(places: Floats, half: Floats, plane: NDArray[np.uint8]) -> Motions:
    """Return lines and arcs from each place to the next.

    Args:
        places: (m + 1, 3) mm.
        half: (m,) half of each sweep, radians, positive to the left as seen from the plane's normal; 0 a line.
        plane: (m,) of the arcs.
    """
    count = len(half)
    arc = half != 0
    plane = np.where(arc, plane, Plane.XY).astype(np.uint8)
    axes, row = np.array([each.axes for each in Plane])[plane], np.arange(count)[:, None]
    a, b = places[:-1][row, axes], places[1:][row, axes]
    chord = b - a
    # from the chord's middle to the centre, in chords to the left
    up = np.where(arc, 0.5 / np.tan(np.where(arc, half, 1.0)), 0.0)
    own = a.copy()
    own[:, 0] = (a[:, 0] + b[:, 0]) / 2 - up * chord[:, 1]
    own[:, 1] = (a[:, 1] + b[:, 1]) / 2 + up * chord[:, 0]
    motions = _motions(
        places[:-1],
        places[1:],
        np.where(arc, np.where(half > 0, MotionKind.ARC_CCW, MotionKind.ARC_CW), MotionKind.LINE),
    )
    centre = np.empty((count, 3))
    centre[row, axes] = own
    centre[~arc] = np.nan
    return replace(motions, centre=centre, plane=plane, turns=arc.astype(np.int32))


def spline_motion(curve: Nurbs) -> Motions:
    """Return one motion along a spline."""
    ends = curve.points[[0]], curve.points[[-1]]
    return _motions(*ends, np.full(1, MotionKind.SPLINE, np.uint8), {0: curve})


def _motions(start: Floats, end: Floats, kind: NDArray[Any], splines: dict[int, Nurbs] | None = None) -> Motions:
    count = len(kind)
    whole = np.zeros(count, np.int32)
    return Motions(
        start=start.copy(),
        end=end.copy(),
        centre=np.full((count, 3), np.nan),
        kind=kind.astype(np.uint8),
        plane=np.full(count, Plane.XY, np.uint8),
        turns=whole.copy(),
        feed=np.full(count, np.nan),
        line=whole.copy(),
        state=whole.copy(),
        splines=splines or {},
    )


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
        start=joined("start"),
        end=joined("end"),
        centre=joined("centre"),
        kind=joined("kind"),
        plane=joined("plane"),
        turns=joined("turns"),
        feed=joined("feed"),
        line=joined("line"),
        state=joined("state"),
        splines=splines,
    )
    return FittedPath(motions, np.concatenate(last), tuple(each for part in parts for each in part.refusals))
