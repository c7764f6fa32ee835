"""From a chain of pixels to a path that a machine follows: smoothed, moved out as far as the walls allow, proven
clear.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...fitting.corner_smoothing.smooth import CornerSmoothingOptions, as_it_is, astray, moved, smooth, without
from ...fitting.corner_smoothing.smoothed_path import SmoothedPath
from ...geometry.distance import DistanceField
from ...geometry.primitives import R, Rows, lengths, points_at
from ...raster.frame import BitmapFrame
from ...raster.trace import PixelChain
from ...raster.walls import Mask

Floats = NDArray[np.float64]

TOLERANCE_PX = 1.0
"""Pixels that smoothing may move a path off its pixels: half a pixel for the path's, and as much for the walls'
pixels.
"""

_STEP_PX = 0.25
"""Pixels between the places at which a path's clearance is measured."""

_MOST_PLACES = 100_000
"""Of one row; an arc that a move has turned inside out can be kilometres long, and places farther apart tell less."""

_REACH_PX = 4.0
"""Pixels that a path may be moved out by at most."""

_EXACT = 1e-7
"""Of a pixel: what a path may fall short of its distance, by rounding."""

_AIM_PX = 0.01
"""Pixels beyond its level that a path is aimed at."""

_TRIES = 10
"""How often a path is moved before it stays where it was last clear."""


def chain_points(frame: BitmapFrame, chain: PixelChain) -> Floats:
    """Return the centres (n, 2), mm, of a chain's pixels, each step's pixel once."""
    pixels = chain.pixels()[: max(len(chain.directions), 1)]
    return np.ascontiguousarray(frame.to_mm(pixels[:, ::-1].astype(np.float64) + 0.5))


def clearance(rows: Rows, field: DistanceField, step: float, limit: float) -> Floats:
    """Return for each row (n,) a distance that it keeps from a field's lines along its whole length.

    Between two measured places, a chord c apart, a point that is at least D from both keeps sqrt(D^2 - c^2 / 4) from a
    point on its chord, and an arc's sagitta less from the arc.

    Args:
        step: between places, mm, > 0; more on rows of more than _MOST_PLACES.
        limit: distances above it do not matter, mm.
    """
    size = lengths(rows)
    counts = np.clip(np.ceil(size / step), 1, _MOST_PLACES).astype(np.int64)
    owner = np.repeat(np.arange(len(rows)), counts + 1)
    place = np.arange(len(owner)) - np.repeat(np.cumsum(counts + 1) - counts - 1, counts + 1)
    distance, _ = field.nearest(points_at(rows[owner], place / counts[owner]), limit)
    least = np.full(len(rows), np.inf)
    np.minimum.at(least, owner, distance)
    chord = size / counts
    sagitta = np.where(rows[:, R] > 0, chord**2 / (8 * np.maximum(rows[:, R], 1e-12)), 0.0)
    return np.sqrt(np.maximum(least**2 - chord**2 / 4, 0.0)) - sagitta


@dataclass(frozen=True)
class WallLimits:
    """What a path has to keep from the walls' squares.

    Attributes:
        level: the distance that it is meant to have, mm.
        least: the distance below which it must not come, mm, <= level.
        field: distances from the squares.
        frame, free: which pixels are none of these squares.
    """

    level: float
    least: float
    field: DistanceField
    frame: BitmapFrame
    free: Mask

    @property
    def pitch(self) -> float:
        """Size of a pixel, mm."""
        return self.frame.pitch

    def spare(self, rows: Rows) -> Floats:
        """Return how much farther than meant each row (n,) is from the squares, mm; no more than _REACH_PX tells."""
        return clearance(rows, self.field, _STEP_PX * self.pitch, self.level + _REACH_PX * self.pitch) - self.level

    def holds(self, rows: Rows, spare: Floats) -> bool:
        """Tell whether closed rows, with what they have to spare, keep the least distance on the right side of the
        squares.

        Rows that keep any distance from the squares cannot get from one side to the other, so their ends tell.
        """
        cols, lines = np.floor(self.frame.to_px(rows[:, :2])).astype(np.int64).T
        if not (0 <= cols.min() <= cols.max() < self.frame.cols and 0 <= lines.min() <= lines.max() < self.frame.rows):
            return False
        return bool(self.free[lines, cols].all() and spare.min() >= self.least - self.level - _EXACT * self.pitch)


def pixel_path(points: Floats, keep: WallLimits, options: CornerSmoothingOptions) -> SmoothedPath:
    """Return the path along a chain's points, as near to its level as pixels allow (steps 401-407).

    Where no smoothed path keeps the least distance, not even a less smooth one, it stays a line from pixel to pixel,
    which does.

    Args:
        points: (n, 2) centres of pixels that keep clear of the walls, mm.
        keep: what to keep from the walls.
        options: tolerance and long lines, mm.
    """
    if len(points) == 1:
        return _spot(as_it_is(points), keep.pitch)
    for tolerance in (options.tolerance, options.tolerance / 2, options.tolerance / 4):
        path = smooth(points, replace(options, tolerance=tolerance))
        out = _moved_out(path, points, keep, options.tolerance) if path.exact else None
        if out is not None:
            return out
    return as_it_is(points)


def _moved_out(path: SmoothedPath, points: Floats, keep: WallLimits, tolerance: float) -> SmoothedPath | None:
    """Return the path moved to its level, rows that touch all alike; None where nothing keeps the least distance.

    Rows that come too near go back and then stay, so that neighbours in a corner do not take turns. Rows that vanish on
    the way, as small arcs round an island do, are left out.
    """
    right, stays, best = np.zeros(len(path.rows)), np.zeros(len(path.rows), np.bool_), None
    tried, aim = path, _AIM_PX * keep.pitch
    for turn in range(_TRIES):
        each = keep.spare(tried.rows)
        if keep.holds(tried.rows, each):
            best = tried
        spare = _per_group(each, path.tangent)
        if turn >= _TRIES // 2 and spare.min() < 0:
            spare = np.full(len(spare), 1.5 * spare.min())  # corners that no side alone can mend: all go back together
        change = np.where(spare < 0, (1 + turn / 4) * spare - 2 * aim, np.where(stays, 0.0, spare - aim))
        if np.abs(change).max() < 2 * aim:
            break
        stays |= spare < 0
        right = np.minimum(right + change, _REACH_PX * keep.pitch)
        tried = moved(path, points, right, tolerance)
        while (lost := astray(tried, points, 2 * tolerance + _REACH_PX * keep.pitch)).any():
            fewer = without(path, lost)
            if fewer is None:
                return best
            path, right, stays = fewer, right[~lost], stays[~lost]
            tried = moved(path, points, right, tolerance)
    return best


def _per_group(values: Floats, tangent: NDArray[np.bool_]) -> Floats:
    """Return for each row the least value of all rows that it is joined to without a corner."""
    corners = max(int(np.sum(~tangent)), 1)
    groups = np.cumsum(~tangent) % corners
    least = np.full(corners, np.inf)
    np.minimum.at(least, groups, values)
    shared: Floats = least[groups]
    return shared


def _spot(path: SmoothedPath, pitch: float) -> SmoothedPath:
    """Return a path of one pixel as a line a quarter of a pixel long, there and back, so that there is something to
    cut.
    """
    x, y = path.rows[0, :2]
    rows = np.zeros((2, 8))
    rows[0, :4], rows[1, :4] = (x, y, x + pitch / 4, y), (x + pitch / 4, y, x, y)
    return SmoothedPath(
        rows,
        np.repeat(path.kinds, 2),
        np.array([0, 0, 1]),
        np.zeros(2, np.uint8),
        0.0,
        exact=False,
        carriers=np.zeros((2, 5)),
    )
