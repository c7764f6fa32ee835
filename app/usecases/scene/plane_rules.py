"""Rules of cutting planes that are not parallel: a fan through one place, planes square on a guide.

Each plane becomes passes of its own with that one plane, so everything behind knows parallel planes alone.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ...core.errors import ParameterError
from ...model.motion import Floats
from ...model.scene import Passes, Strategy

ALONE = 9e4
"""mm; a pitch so large that no second plane meets what is machined."""
_MOST = 2000
"""Planes of a fan or along a guide."""


def expanded(passes: Passes) -> tuple[Passes, ...]:
    """Return passes as they are, or one for each of their planes where these are not parallel, in order.

    Args:
        passes: with any rule. Zigzags go every other plane the other way.

    Raises:
        ParameterError: there are too many planes.
    """
    if passes.parallel:
        return (passes,)
    places = list(_fan(passes) if passes.fan_deg is not None else _along(passes))
    if len(places) > _MOST:
        raise ParameterError(f"{len(places):,} planes of passes; {_MOST:,} are the most, so use a larger step.")
    return tuple(_alone(passes, number, *place) for number, place in enumerate(places))


def _alone(passes: Passes, number: int, x: float, y: float, angle_deg: float) -> Passes:
    back = passes.strategy is Strategy.ZIGZAG and number % 2 == 1
    return replace(
        passes,
        name=f"{passes.name} {number + 1}".strip(),
        through=(x, y),
        angle_deg=(angle_deg + (180.0 if back else 0.0) + 180.0) % 360.0 - 180.0,
        pitch=ALONE,
        fan_deg=None,
        guide=(),
    )


def _fan(passes: Passes) -> Iterator[tuple[float, float, float]]:
    """Yield the place and the angle of each plane of a fan; half a turn from the first it is the first again."""
    assert passes.fan_deg is not None
    first, last, step = passes.fan_deg
    for k in range(math.floor((last - first) / step + 1e-9) + 1):
        if k * step < 180.0 - 1e-9 or k == 0:
            yield (*passes.through, first + k * step)


def _along(passes: Passes) -> Iterator[tuple[float, float, float]]:
    """Yield the place and the angle of each plane along a guide, square on it."""
    assert passes.pitch is not None
    guide = np.array(passes.guide, np.float64)
    sizes = np.linalg.norm(np.diff(guide, axis=0), axis=1)
    along = np.concatenate([[0.0], np.cumsum(sizes)])
    for distance in np.arange(0.0, along[-1] * (1 + 1e-12), passes.pitch).tolist():
        x, y = (float(np.interp(distance, along, guide[:, axis])) for axis in (0, 1))
        way = _way(guide, along, distance, passes.pitch)
        yield x, y, math.degrees(math.atan2(way[1], way[0])) + 90.0


def _way(guide: Floats, along: Floats, distance: float, pitch: float) -> Floats:
    """Return the guide's direction at a place: from half a pitch before to half a pitch behind, so that planes turn
    with it rather than at its corners.
    """
    ends = [
        np.array([np.interp(distance + side, along, guide[:, axis]) for axis in (0, 1)])
        for side in (-pitch / 2, pitch / 2)
    ]
    way: Floats = ends[1] - ends[0]
    return way
