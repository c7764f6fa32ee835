"""The height that is left at single points, in float64: for places finer than the cells."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import shapely
from numpy.typing import NDArray

from ...model.motion import Floats, MotionKind
from ...model.motion_path import reach
from ..cutter import Cutter
from .course import Course
from .pieces import Splitter

ROUNDS = 60
"""Times that the interval in which a cutter is lowest is cut to two thirds."""

PORTION = 400_000
"""Pairs of a point and a piece that are looked at together."""


def lowest(points: Floats, course: Course, cutters: Mapping[int, Cutter]) -> tuple[Floats, NDArray[np.int64]]:
    """Return the lowest height (m,) that cutting motions reach at points, infinite where none comes, and the motion's row, -1 = none.

    Args:
        points: (m, 2) mm.
        course: rapids and what is left out do not cut.
        cutters: by T number.
    """
    best, row = np.full(len(points), np.inf), np.full(len(points), -1, np.int64)
    motions = course.motions
    cuts = (motions.kind != MotionKind.RAPID) & np.isin(course.tool, list(cutters))
    cuts[list(course.left_out)] = False
    rows = np.flatnonzero(cuts)
    if not len(rows) or not len(points):
        return best, row
    low, high = reach(motions)
    wide = np.array([cutters[number].radius for number in course.tool[rows].tolist()])[:, None]
    near = shapely.box(*(low[rows, :2] - wide).T, *(high[rows, :2] + wide).T)
    used = rows[np.unique(shapely.STRtree(shapely.points(points)).query(near)[0])]
    splitter = Splitter(motions, arcs_stay=False)
    for number in np.unique(course.tool[used]).tolist():
        own = used[course.tool[used] == number]
        parts = [splitter.pieces(int(k), int(k) + 1) for k in own]
        start, end = (np.concatenate([getattr(part, name) for part in parts]) for name in ("start", "end"))
        owner = np.concatenate([part.motion for part in parts])
        _lower(points, (start, end, owner), cutters[number], (best, row))
    return best, row


def _lower(points: Floats, pieces: tuple[Floats, Floats, NDArray[np.int32]], cutter: Cutter,
           found: tuple[Floats, NDArray[np.int64]]) -> None:  # fmt: skip
    """Lower the heights at points to those of straight pieces."""
    start, end, owner = pieces
    best, row = found
    tree = shapely.STRtree(shapely.points(points))
    least, most = np.minimum(start, end)[:, :2] - cutter.radius, np.maximum(start, end)[:, :2] + cutter.radius
    step = max(1, PORTION // 64)
    for first in range(0, len(start), step):
        part = slice(first, first + step)
        piece, point = tree.query(shapely.box(*least[part].T, *most[part].T))
        for at in range(0, len(piece), PORTION):
            k, p = piece[at : at + PORTION] + first, point[at : at + PORTION]
            heights = over_straight(points[p], start[k], end[k], cutter)
            order = np.argsort(-heights, kind="stable")  # the lowest last, so that it stays
            better = heights[order] < best[p[order]]
            best[p[order][better]], row[p[order][better]] = heights[order][better], owner[k[order][better]]


def over_straight(points: Floats, start: Floats, end: Floats, cutter: Cutter) -> Floats:
    """Return the lowest height (n,) of a cutter over a point on a straight way each; infinite where it does not come over it.

    The height over the way is convex where the cutter is over the point, so an interval round its least one is narrowed.
    """
    way, off = end[:, :2] - start[:, :2], points - start[:, :2]
    square = np.einsum("ij,ij->i", way, way)
    moves = square > 1e-18
    safe = np.where(moves, square, 1.0)
    foot = np.einsum("ij,ij->i", off, way) / safe
    aside2 = np.einsum("ij,ij->i", off, off) - np.where(moves, foot**2 * square, 0.0)
    half2 = np.where(moves, (cutter.radius**2 - aside2) / safe, 0.0)
    half = np.sqrt(np.maximum(half2, 0.0))
    low, high = (np.where(moves, np.clip(foot + sign * half, 0.0, 1.0), 0.0) for sign in (-1, 1))
    high = np.where(moves, high, 1.0)
    rise = end[:, 2] - start[:, 2]

    def height(t: Floats) -> Floats:
        return start[:, 2] + cutter.lift + t * rise + cutter.heights(np.minimum(np.hypot(*(off - t[:, None] * way).T), cutter.radius))

    for _ in range(ROUNDS):
        third = (high - low) / 3
        left, right = low + third, high - third
        falls = height(left) > height(right)
        low, high = np.where(falls, left, low), np.where(falls, high, right)
    middle = (low + high) / 2
    comes = (aside2 <= cutter.radius**2) & (np.hypot(*(off - middle[:, None] * way).T) <= cutter.radius * (1 + 1e-12))
    return np.where(comes, height(middle), np.inf)
