"""The height of cells under a move, by brute force: dense places along the path, then ever finer round the best ones.

Slow, float64, and sharing nothing with the engine: the path is a function, the cutter is its profile.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

import numpy as np

from app.model.motion import Floats
from app.simulation.cutter import Cutter

Path = Callable[[Floats], Floats]
"""Fractions in [0, 1], of any shape, to places (…, 3), mm."""

SAMPLES, FINER, ROUNDS = 401, 12, 13


def line(start: Iterable[float], end: Iterable[float]) -> Path:
    first, last = np.array(list(start), float), np.array(list(end), float)
    return lambda t: first + np.asarray(t)[..., None] * (last - first)


def swept(cutter: Cutter, path: Path, cells: Floats) -> Floats:
    """Return the lowest height (n,) that the cutter reaches over cells (n, 2) on its way; infinite where it does not
    come.

    The best and the second best dense sample that is a local minimum are both followed: arcs may have two.
    """
    t = np.linspace(0.0, 1.0, SAMPLES)
    values = over(cutter, path(t)[None], cells[:, None])
    lower = np.pad(values, ((0, 0), (1, 1)), constant_values=np.inf)
    valley = np.where((values <= lower[:, :-2]) & (values <= lower[:, 2:]), values, np.inf)
    near = nearest_times(path, cells, t)
    starts = np.concatenate([t[np.argsort(valley, axis=1)[:, :3]], near], axis=1)
    return np.min([followed(cutter, path, cells, starts[:, k]) for k in range(starts.shape[1])], axis=0)


def nearest_times(path: Path, cells: Floats, t: Floats) -> Floats:
    """Where the axis passes nearest, refined: a cell at the rim may be met between two samples only."""
    reach = np.linalg.norm(path(t)[None, :, :2] - cells[:, None], axis=2)
    best = t[np.argmin(reach, axis=1)]
    width = 1.0 / (SAMPLES - 1)
    for _ in range(ROUNDS):
        tries = np.clip(best[:, None] + np.linspace(-width, width, 2 * FINER + 1), 0.0, 1.0)
        reach = np.linalg.norm(path(tries)[..., :2] - cells[:, None], axis=2)
        best = tries[np.arange(len(cells)), np.argmin(reach, axis=1)]
        width /= FINER / 2
    return best[:, None]


def followed(cutter: Cutter, path: Path, cells: Floats, best: Floats) -> Floats:
    """The height at a local minimum near each `best`, by nets each 6 times finer than the one before."""
    width, value = 1.5 / (SAMPLES - 1), np.full(len(cells), np.inf)
    for _ in range(ROUNDS):
        tries = np.clip(best[:, None] + np.linspace(-width, width, 2 * FINER + 1), 0.0, 1.0)
        values = over(cutter, path(tries), cells[:, None])
        least = np.argmin(values, axis=1)
        value = np.minimum(value, values[np.arange(len(cells)), least])
        best = tries[np.arange(len(cells)), least]
        width /= FINER / 2
    return value


def over(cutter: Cutter, tips: Floats, cells: Floats) -> Floats:
    """Height of the cutter's profile over cells when its tip stands at `tips`."""
    return np.asarray(
        tips[..., 2] + cutter.heights(np.hypot(tips[..., 0] - cells[..., 0], tips[..., 1] - cells[..., 1]))
    )


def field(moves: Iterable[tuple[Cutter, Path]], cells: Floats, top: float, floor: float = -np.inf) -> Floats:
    """Heights (n,) of cells (n, 2) after moves into stock of height `top`."""
    heights = np.full(len(cells), top)
    for cutter, path in moves:
        places = path(np.linspace(0.0, 1.0, 65))[:, :2]
        reach = cutter.radius + np.abs(np.diff(places, axis=0)).max()
        near = np.all((cells >= places.min(axis=0) - reach) & (cells <= places.max(axis=0) + reach), axis=1)
        if near.any():
            heights[near] = np.minimum(heights[near], swept(cutter, path, cells[near]))
    return np.maximum(heights, floor)


def slopes(moves: Sequence[tuple[Cutter, Path]], cells: Floats, heights: Floats, top: float, floor: float) -> Floats:
    """How steep (n,) the field of heights is: the greatest of four differences over 1 um."""
    step = 1e-3
    beside = [
        field(moves, cells + shift, top, floor) for shift in ((step, 0.0), (-step, 0.0), (0.0, step), (0.0, -step))
    ]
    return np.asarray(np.max(np.abs(np.array(beside) - heights), axis=0) / step)
