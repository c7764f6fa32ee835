"""The curves that motions run along: sweeps, lengths, directions and extent, in closed form but for splines."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from .motion import Floats, MotionKind, Motions, Nurbs, Plane

SPLINE_PIECES = 256
"""Chords that stand for a spline where its length is asked for."""

FIRST_CHORDS, FEWEST_CHORDS = 64, 8
"""Of a spline whose chords are to keep to it, and of each of its pieces."""

AXES = np.array([plane.axes for plane in Plane])


@dataclass(frozen=True, eq=False)
class ArcPaths:
    """The arcs among some motions, m of them, each in the axes of its own plane.

    The point at a fraction t of an arc is at angle + t sweep round the centre, at the radius start_radius +
    t (end_radius - start_radius), and t rise along the normal.

    Attributes:
        rows: (m,) index of each among the motions.
        axes: (m, 3) columns of the plane's first axis, second axis and normal.
        centre: (m, 2) mm.
        angle: (m,) of the start as seen from the centre, radians.
        sweep: (m,) radians, counter-clockwise positive as seen from the positive end of the normal; whole turns count.
        start_radius, end_radius: (m,) mm.
        height: (m,) of the start along the normal, mm. rise: (m,) to the end's.
    """

    rows: NDArray[np.intp]
    axes: NDArray[np.intp]
    centre: Floats
    angle: Floats
    sweep: Floats
    start_radius: Floats
    end_radius: Floats
    height: Floats
    rise: Floats

    def __len__(self) -> int:
        return len(self.rows)

    def points(self, fractions: Floats) -> Floats:
        """Return (m, k, 3) points of every arc at k fractions in [0, 1]."""
        angle = self.angle[:, None] + self.sweep[:, None] * fractions
        radius = self.start_radius[:, None] + (self.end_radius - self.start_radius)[:, None] * fractions
        own = np.stack(
            [
                self.centre[:, :1] + radius * np.cos(angle),
                self.centre[:, 1:] + radius * np.sin(angle),
                self.height[:, None] + self.rise[:, None] * fractions,
            ],
            axis=2,
        )
        points = np.empty_like(own)
        np.put_along_axis(points, np.broadcast_to(self.axes[:, None], own.shape), own, axis=2)
        return points

    def lengths(self) -> Floats:
        """Return (m,) lengths, mm; a spiral counts with its mean radius, which is right to (change of radius)^2 / (24
        length).
        """
        mean = (self.start_radius + self.end_radius) / 2
        return np.hypot(np.hypot(mean * self.sweep, self.end_radius - self.start_radius), self.rise)


def arc_paths(motions: Motions, first: int = 0, stop: int | None = None) -> ArcPaths:
    """Return the arcs among motions `first` to `stop`, `stop` excluded; None: to the last."""
    kind: NDArray[np.uint8] = motions.kind[first:stop]
    rows = np.flatnonzero((kind == MotionKind.ARC_CW) | (kind == MotionKind.ARC_CCW)) + first
    axes = AXES[motions.plane[rows]]
    start, end, centre = (points[rows[:, None], axes] for points in (motions.start, motions.end, motions.centre))
    out, back = start[:, :2] - centre[:, :2], end[:, :2] - centre[:, :2]
    angle = np.arctan2(out[:, 1], out[:, 0])
    sense = np.where(motions.kind[rows] == MotionKind.ARC_CCW, 1.0, -1.0)
    turn = (np.arctan2(back[:, 1], back[:, 0]) - angle) * sense % (2 * np.pi)
    whole = (start[:, 0] == end[:, 0]) & (start[:, 1] == end[:, 1])
    turn = np.where(whole, 2 * np.pi, turn) + 2 * np.pi * (np.maximum(motions.turns[rows], 1) - 1)
    return ArcPaths(
        rows=rows,
        axes=axes,
        centre=centre[:, :2],
        angle=angle,
        sweep=turn * sense,
        start_radius=_sizes(out),
        end_radius=_sizes(back),
        height=start[:, 2],
        rise=end[:, 2] - start[:, 2],
    )


def motion_rows(motions: Motions) -> Floats:
    """Return motions as rows (n, 8) of `app.geometry.primitives`, seen from above: arcs that do not lie flat, and
    splines, as their chords.
    """
    kind = motions.kind
    arc = ((kind == MotionKind.ARC_CW) | (kind == MotionKind.ARC_CCW)) & (motions.plane == Plane.XY)
    centre = np.where(arc[:, None], np.nan_to_num(motions.centre[:, :2]), 0.0)
    start, end = motions.start[:, :2], motions.end[:, :2]
    radius = np.where(arc, (np.hypot(*(start - centre).T) + np.hypot(*(end - centre).T)) / 2, 0.0)
    turn = np.where(arc, np.where(kind == MotionKind.ARC_CCW, 1.0, -1.0), 0.0)
    return np.column_stack([start, end, centre, radius, turn])


def spline_points(spline: Nurbs, count: int = SPLINE_PIECES + 1) -> Floats:
    """Return (count, 3) points of a spline, evenly spread over its parameter, its ends among them."""
    return _points_at(spline, np.linspace(*_span(spline), count))


def fine_spline_points(spline: Nurbs, chord: float, most: int) -> Floats:
    """Return (k, 3) points of a spline, ends among them, so close together that their chords keep to it.

    A chord is halved until the point at the middle of its parameters is near its own middle. The first ones are parts
    of the pieces between knots, which bend but simply.

    Args:
        spline: any.
        chord: how far a chord may be from the spline, mm, > 0.
        most: chords from which no more are halved, where they do not keep to it.
    """
    low, high = _span(spline)
    knots = np.unique(np.clip(spline.knots, low, high))
    parts = max(FIRST_CHORDS // (len(knots) - 1), FEWEST_CHORDS)
    at = np.append((knots[:-1, None] + np.diff(knots)[:, None] * (np.arange(parts) / parts)).ravel(), knots[-1])
    while True:
        points, middle = _points_at(spline, at), (at[1:] + at[:-1]) / 2
        far = _sizes(_points_at(spline, middle) - (points[1:] + points[:-1]) / 2) > chord
        if not np.any(far) or len(at) > most:
            return points
        at = np.sort(np.concatenate([at, middle[far]]))


def _span(spline: Nurbs) -> tuple[float, float]:
    """Return the parameters of a spline's ends."""
    return float(spline.knots[spline.degree]), float(spline.knots[-spline.degree - 1])


def _points_at(spline: Nurbs, parameters: Floats) -> Floats:
    from scipy.interpolate import BSpline

    weighted = np.column_stack([spline.points * spline.weights[:, None], spline.weights])
    points = BSpline(spline.knots, weighted, spline.degree)(parameters)
    return np.asarray(points[:, :3] / points[:, 3:])


def lengths(motions: Motions, arcs: ArcPaths | None = None) -> Floats:
    """Return (n,) length of each motion, mm; splines by chords.

    Args:
        motions: n motions.
        arcs: those among them, where the caller has them already.
    """
    long = _sizes(motions.end - motions.start)
    arcs = arc_paths(motions) if arcs is None else arcs
    long[arcs.rows] = arcs.lengths()
    for row, spline in motions.splines.items():
        long[row] = np.sum(np.linalg.norm(np.diff(spline_points(spline), axis=0), axis=1))
    return long


def directions(motions: Motions, arcs: ArcPaths) -> tuple[Floats, Floats]:
    """Return the unit vectors (n, 3) in which each motion sets out and arrives; 0 where it has no length.

    Args:
        motions: n motions.
        arcs: those among them.
    """
    out = motions.end - motions.start
    into = out.copy()
    out[arcs.rows], into[arcs.rows] = (_tangents(arcs, fraction) for fraction in (0.0, 1.0))
    for row, spline in motions.splines.items():
        points = spline_points(spline)
        out[row], into[row] = points[1] - points[0], points[-1] - points[-2]
    return _units(out), _units(into)


def _tangents(arcs: ArcPaths, fraction: float) -> Floats:
    """Return (m, 3) how arcs move at a fraction, mm a sweep."""
    angle = arcs.angle + arcs.sweep * fraction
    radius = arcs.start_radius + (arcs.end_radius - arcs.start_radius) * fraction
    grow, turn = arcs.end_radius - arcs.start_radius, radius * arcs.sweep
    cos, sin = np.cos(angle), np.sin(angle)
    return along_xyz(np.column_stack([grow * cos - turn * sin, grow * sin + turn * cos, arcs.rise]), arcs.axes)


def along_xyz(own: Floats, axes: NDArray[np.intp]) -> Floats:
    """Return what is told along each arc's own axes along X, Y and Z.

    Args:
        own: (m, 3) along the plane's first and second axis and its normal.
        axes: (m, 3) columns that these are.
    """
    if np.all(axes[:, 2] == Plane.XY.axes[2]):  # as nearly always: nothing to put elsewhere
        return own
    moved = np.empty_like(own)
    np.put_along_axis(moved, axes, own, axis=1)
    return moved


def _units(vectors: Floats) -> Floats:
    size = _sizes(vectors)
    return vectors / np.where(size > 0, size, 1.0)[:, None]


def _sizes(vectors: Floats) -> Floats:
    return np.asarray(np.sqrt(np.einsum("ij,ij->i", vectors, vectors)))


def reach(motions: Motions) -> tuple[Floats, Floats]:
    """Return the lowest and the highest coordinates (n, 3) of each motion, mm: arcs exactly, splines by their control
    points.
    """
    low, high = np.minimum(motions.start, motions.end), np.maximum(motions.start, motions.end)
    arcs = arc_paths(motions)
    radius = np.maximum(arcs.start_radius, arcs.end_radius)
    first, span = np.minimum(arcs.angle, arcs.angle + arcs.sweep), np.abs(arcs.sweep)
    for axis, quarter, sign in ((0, 0.0, 1), (1, 0.5, 1), (0, 1.0, -1), (1, 1.5, -1)):
        passed = (np.pi * quarter - first) % (2 * np.pi) <= span
        rows, column = arcs.rows[passed], arcs.axes[passed, axis]
        edge = arcs.centre[passed, axis] + sign * radius[passed]
        side = high if sign > 0 else low
        side[rows, column] = np.maximum(side[rows, column], edge) if sign > 0 else np.minimum(side[rows, column], edge)
    for row, spline in motions.splines.items():
        low[row], high[row] = spline.points.min(axis=0), spline.points.max(axis=0)
    return low, high


def anchored(motions: Motions) -> Motions:
    """Return motions that follow one another and begin where the program first sends each axis.

    Nobody knows where the machine stands before, so the way there has no length along that axis; nor has the jump of
    the controlled point to another tool's tip. Motions that are not straight keep their start.
    """
    start, end = motions.start.copy(), motions.end.copy()
    straight = np.flatnonzero((motions.kind[1:] == MotionKind.RAPID) | (motions.kind[1:] == MotionKind.LINE)) + 1
    start[straight] = end[straight - 1]
    for axis, row in enumerate(motions.known_from):
        if 0 <= row < len(motions) and motions.kind[row] in (MotionKind.RAPID, MotionKind.LINE):
            start[: row + 1, axis] = end[: row + 1, axis] = motions.end[row, axis]
    return replace(motions, start=start, end=end)
