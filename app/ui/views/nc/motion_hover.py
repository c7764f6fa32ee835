"""Which motion lies under the mouse, and what there is to say about it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ....model.curves import Point
from ....model.motion import MotionKind
from ...framework.figures import grouped
from ..canvas.painting.curve_path import LINE_TO
from .motion_shapes import MotionShapes, ViewSide

Floats = NDArray[np.float64]

_NAMES = {
    MotionKind.RAPID: "Rapid",
    MotionKind.LINE: "Line",
    MotionKind.ARC_CW: "Arc clockwise",
    MotionKind.ARC_CCW: "Arc counter-clockwise",
    MotionKind.SPLINE: "Spline",
}
_MOST_CURVED = 300
_CUBIC_POINTS = 33


def nearest_motion(shapes: MotionShapes, side: ViewSide, at: Point, reach: float) -> int | None:
    """Return the number of the motion that is nearest to a point as seen from a side, or None.

    Of motions that lie on one another the one nearest to the eye is taken, and of these the last.

    Args:
        at: mm, to the right and up.
        reach: largest distance, mm.
    """
    columns = list(side.value)
    place = np.asarray(at)
    near = np.all((shapes.low[:, columns] <= place + reach) & (shapes.high[:, columns] >= place - reach), axis=1)
    rows = shapes.seen(side, np.flatnonzero(near))
    if not len(rows):
        return None
    distance = _distances(shapes, rows, columns, place)
    best = float(distance.min())
    if best > reach:
        return None
    alike = rows[distance <= best + 1e-6]
    front = shapes.high[alike, side.depth] * (-1 if side is ViewSide.XZ else 1)
    return int(alike[np.flatnonzero(front >= front.max() - 1e-6)[-1]])


def _distances(shapes: MotionShapes, rows: NDArray[np.int64], columns: list[int], at: Floats) -> Floats:
    """Return the distance of a point from each of some motions, mm; arcs to 1e-5 of their radius, the last 300 of them
    only.
    """
    motions = shapes.program.motions
    distance = _from_lines(motions.start[rows][:, columns], motions.end[rows][:, columns], at)
    curved = np.flatnonzero(shapes.offset[rows + 1] - shapes.offset[rows] > 1)
    distance[curved] = np.inf
    for k in curved[-_MOST_CURVED:]:
        points = outline(shapes, int(rows[k]))[:, columns]
        distance[k] = _from_lines(points[:-1], points[1:], at).min()
    return distance


def _from_lines(a: Floats, b: Floats, at: Floats) -> Floats:
    """Return the distance of a point from each of the lines from a (k, 2) to b (k, 2)."""
    d = b - a
    square = np.einsum("ij,ij->i", d, d)
    share = np.clip(np.einsum("ij,ij->i", at - a, d) / np.where(square > 0, square, 1.0), 0.0, 1.0)
    return np.asarray(np.hypot(*(a + share[:, None] * d - at).T))


def outline(shapes: MotionShapes, row: int) -> Floats:
    """Return (k, 3) points along a motion, mm: lines by their ends, cubics by 33 points each."""
    first, last = int(shapes.offset[row]), int(shapes.offset[row + 1])
    start, points = shapes.program.motions.start[row], shapes.points[first:last]
    if shapes.kinds[first] == LINE_TO:
        return np.vstack([start, points])
    begin = np.vstack([start, points[2:-1:3]])[:, None]
    t = np.linspace(0, 1, _CUBIC_POINTS)[1:, None]
    one, two, end = (points[k::3][:, None] for k in range(3))
    cubics = (1 - t) ** 3 * begin + 3 * (1 - t) ** 2 * t * one + 3 * (1 - t) * t**2 * two + t**3 * end
    return np.vstack([start, cubics.reshape(-1, 3)])


def describe_motion(shapes: MotionShapes, row: int) -> str:
    """Return what a motion is: kind, line, tool, feed, length, Z."""
    motions = shapes.program.motions
    kind = MotionKind(int(motions.kind[row]))
    words = [_NAMES[kind], f"line {int(motions.line[row])}"]
    if shapes.tool[row]:
        words.append(f"T{int(shapes.tool[row])}")
    if kind is not MotionKind.RAPID:
        words.append("no feed told" if np.isnan(motions.feed[row]) else f"F {motions.feed[row]:g}")
    words.append(
        "to the machine's home" if row in shapes.program.homeward else f"{grouped(float(shapes.length[row]))} mm"
    )
    if kind in (MotionKind.ARC_CW, MotionKind.ARC_CCW):
        words.append(f"R {float(np.linalg.norm((motions.start - motions.centre)[row])):.3f}")
    words.append(_heights(shapes, row))
    return " · ".join(words)


def _heights(shapes: MotionShapes, row: int) -> str:
    """Return Z at the ends of a motion, "home" where only the machine knows it."""
    motions = shapes.program.motions
    ends = ((shapes.away, motions.start), (shapes.home, motions.end))
    first, last = ("home" if home[row, 2] else f"{places[row, 2] + 0.0:.3f}" for home, places in ends)
    return f"Z {last}" if first == last else f"Z {first} to {last}"
