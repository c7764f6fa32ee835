"""On which side of a run its metal stands, so that it can be cut in the direction that is asked for.

What a run alone clears tells most: it is there whenever the run is cut. Where that says nothing, all that is left
beside it does. Where as much stands on either side the run is a slot, and goes either way.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ...geometry.near_points import all_within
from ...geometry.primitives import Rows, points_at
from ...model.operation import Direction
from ...toolpath.leads.contour_path import headings_at, left_of
from ...toolpath.linking.rest_runs import RingChunks, RingRun
from ...toolpath.rest_material import CutGround

_ASIDE = (0.3, 0.6, 0.9)
"""Of the radius: so far beside a run it is looked for metal."""

_MORE = 0.3
"""A side has the metal that has more of it than the other by this share of both."""

Floats = NDArray[np.float64]


def directed_runs(
    chunks: RingChunks, runs: Sequence[RingRun], ground: CutGround, radius: float, direction: Direction
) -> list[RingRun]:
    """Return the runs with the sense in which each is cut in a direction; those that are slots have none.

    Args:
        ground: that is cut before.
        radius: of the cutter, mm.
    """
    paths = [_chunks_of(chunks, run) for run in runs]
    owner = np.repeat(np.arange(len(runs)), [len(path) for path in paths])
    rows = np.concatenate([np.zeros((0, 8)), *paths])
    metal = _metal(rows, ground, radius)
    alone = metal & ~_reached_by_others(rows, owner, radius)
    size = np.hypot(*(rows[:, 2:4] - rows[:, :2]).T)[:, None]
    sense = np.zeros(len(runs), np.int64)
    for stands in (alone, metal):
        left, right = (np.bincount(owner, (stands[:, side] * size).sum(axis=1), len(runs)) for side in (0, 1))
        sided = (sense == 0) & (np.abs(right - left) > _MORE * (right + left))
        sense[sided] = np.sign(right - left)[sided].astype(np.int64)
    climb = 1 if direction is Direction.CLIMB else -1
    return [replace(run, sense=climb * int(each)) for run, each in zip(runs, sense, strict=True)]


def _chunks_of(chunks: RingChunks, run: RingRun) -> Rows:
    ring = int(np.searchsorted(chunks.first, run.chunk, "right")) - 1
    low, high = int(chunks.first[ring]), int(chunks.first[ring + 1])
    return chunks.rows[low + (run.chunk - low + np.arange(run.count)) % (high - low)]


def _beside(rows: Rows, radius: float) -> Floats:
    """Return places (n, 2, k, 2) beside the middle of each row, to its left and to its right."""
    middle = np.full(len(rows), 0.5)
    points, aside = points_at(rows, middle), left_of(headings_at(rows, middle))
    steps = radius * np.array([_ASIDE, [-each for each in _ASIDE]])
    places: Floats = points[:, None, None, :] + steps[None, :, :, None] * aside[:, None, None, :]
    return places


def _metal(rows: Rows, ground: CutGround, radius: float) -> NDArray[np.bool_]:
    """Return (n, 2, k) whether metal is left at places beside rows."""
    places = _beside(rows, radius)
    left: NDArray[np.bool_] = (ground.depth(places.reshape(-1, 2), radius) > 0).reshape(places.shape[:3])
    return left


def _reached_by_others(rows: Rows, owner: NDArray[np.int64], radius: float) -> NDArray[np.bool_]:
    """Return (n, 2, k) whether places beside rows come within the radius of the middles of rows of another run."""
    places = _beside(rows, radius)
    if not len(rows):
        return np.zeros(places.shape[:3], np.bool_)
    own = np.repeat(owner, len(_ASIDE) * 2)
    place, middle = all_within(points_at(rows, np.full(len(rows), 0.5)), places.reshape(-1, 2), radius)
    reached = np.bincount(place, owner[middle] != own[place], len(own)) > 0
    return reached.reshape(places.shape[:3])
