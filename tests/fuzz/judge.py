"""An independent judge of a cut floor: points, the even-odd rule over the drawn curves themselves, and the motions of
the NC text.

It shares nothing with what makes and judges paths but the curves and the reader of NC: no chains, no overlay, no
regions, no polygons.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy.interpolate import BSpline

from app.gcode.interpreter.program import NcProgram
from app.model.curves import Arc, Circle, Curve, Ellipse, Line, Spline
from app.model.motion import MotionKind

Floats = NDArray[np.float64]

COUNT, CHORDS = 3000, 400
"""Points that are asked about; chords of a turn, and of a span of a spline."""
DOUBT = 0.05
"""mm; nearer to a curve, or to the edge of a cut, a point decides nothing."""


def sampled(curve: Curve) -> Floats:
    """Return points (n, 2) along a curve."""
    if isinstance(curve, Line):
        return np.array([curve.start, curve.end])
    if isinstance(curve, Circle):
        angle = np.linspace(0, 2 * np.pi, CHORDS + 1)
        return np.array(curve.centre) + curve.radius * np.column_stack([np.cos(angle), np.sin(angle)])
    if isinstance(curve, Arc):
        return _along_arc(curve)
    if isinstance(curve, Ellipse):
        return np.array([curve.at(t) for t in np.linspace(curve.start_parameter, curve.end_parameter, CHORDS + 1)])
    return _along_spline(curve)


def _along_arc(arc: Arc) -> Floats:
    centre, start, end = (complex(*p) for p in (arc.centre, arc.start, arc.end))
    first, last = np.angle(start - centre), np.angle(end - centre)
    sweep = (last - first) % (2 * np.pi) if arc.ccw else -((first - last) % (2 * np.pi))
    share = np.linspace(0, 1, CHORDS + 1)
    radius = abs(start - centre) + share * (abs(end - centre) - abs(start - centre))
    at = centre + radius * np.exp(1j * (first + share * sweep))
    return np.column_stack([at.real, at.imag])


def _along_spline(curve: Spline) -> Floats:
    points, knots = np.array(curve.control_points), np.array(curve.knots)
    weights = np.array(curve.weights or [1.0] * len(points))
    at = np.unique(np.concatenate([np.linspace(a, b, 40) for a, b in pairwise(knots) if b > a]))
    made = BSpline(knots, np.column_stack([points * weights[:, None], weights]), curve.degree)(at)
    return made[:, :2] / made[:, 2:]


def is_odd(points: Floats, segments: Floats) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Return whether points (n, 2) lie within an odd number of curves, and whether rays in four directions agree on it.

    Args:
        segments: (m, 2, 2) chords of all curves.
    """
    votes = []
    for angle in (0.123, 1.9, 3.3, 5.01):
        turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        p, s = points @ turn, segments @ turn
        (ax, ay), (bx, by) = s[:, 0].T, s[:, 1].T
        crossings = np.zeros(len(p), np.int64)
        for first in range(0, len(p), 200):
            x, y = p[first : first + 200, :1], p[first : first + 200, 1:]
            spans = (ay <= y) != (by <= y)
            with np.errstate(divide="ignore", invalid="ignore"):
                crossings[first : first + 200] = (spans & (ax + (y - ay) / (by - ay) * (bx - ax) > x)).sum(axis=1)
        votes.append(crossings % 2 == 1)
    return votes[0], np.logical_and.reduce([vote == votes[0] for vote in votes])


def _swept(program: NcProgram, radii: dict[int, float], depth: float, points: Floats) -> Floats:
    """Return for each point how far it is from what any tool sweeps at the floor, mm; below 0 = it is cut."""
    motions, away = program.motions, np.full(len(points), np.inf)
    low = np.maximum(motions.start[:, 2], motions.end[:, 2]) <= -depth + 1e-6
    for row in np.flatnonzero(low & (motions.kind != MotionKind.RAPID)).tolist():
        start, end, centre = motions.start[row, :2], motions.end[row, :2], motions.centre[row, :2]
        kind = MotionKind(motions.kind[row])
        if kind is MotionKind.LINE:
            way = np.array([start, end])
        else:
            whole = bool((start == end).all())
            ccw = kind is MotionKind.ARC_CCW
            way = (
                sampled(Circle(tuple(centre), float(np.hypot(*(start - centre)))))
                if whole
                else sampled(Arc(tuple(start), tuple(end), tuple(centre), ccw))
            )
        radius = radii[program.states[motions.state[row]].tool]
        near = np.all((points >= way.min(axis=0) - 2 * radius) & (points <= way.max(axis=0) + 2 * radius), axis=1)
        line = shapely.linestrings(way) if np.any(way[0] != way[-1]) or len(way) > 2 else shapely.points(way[0])
        away[near] = np.minimum(away[near], shapely.distance(line, shapely.points(points[near])) - radius)
    return away


def wrong_floor(curves: Sequence[Curve], program: NcProgram, radii: dict[int, float], depth: float) -> str:
    """Return what is wrong with a floor that is said to be whole: where metal is cut outside, or left although a tool
    fits; "" = nothing.

    Args:
        curves: that bound it by the even-odd rule, mm. radii: of the tools by T number. depth: of the floor below Z 0.
    """
    chains = [sampled(curve) for curve in curves]
    segments = np.concatenate([np.stack([chain[:-1], chain[1:]], axis=1) for chain in chains])
    low, high = segments.min(axis=(0, 1)), segments.max(axis=(0, 1))
    chance = np.random.default_rng(1)
    spread = chance.uniform(low - 1, high + 1, (COUNT // 2, 2))
    beside = segments[chance.integers(0, len(segments), COUNT // 2)].mean(axis=1) + chance.normal(
        0, max(radii.values()), (COUNT // 2, 2)
    )
    points = np.concatenate([spread, beside])
    odd, sure = is_odd(points, segments)
    tree = shapely.STRtree(shapely.linestrings(segments))
    _, wall = tree.query_nearest(shapely.points(points), return_distance=True, all_matches=False)
    away = _swept(program, radii, depth, points)
    gouged = sure & ~odd & (wall > DOUBT) & (away < -DOUBT)
    left = sure & odd & (wall > min(radii.values()) + DOUBT) & (away > DOUBT)
    for what, where in (("cut outside of the drawing", gouged), ("left although the tool fits", left)):
        if where.any():
            place = points[np.flatnonzero(where)[0]]
            return f"{int(where.sum())} of {len(points)} points are {what}, one at ({place[0]:.3f}, {place[1]:.3f})"
    return ""
