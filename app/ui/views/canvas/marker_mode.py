"""What clicks on the canvas do when they mark places."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from ....model.curves import Point


def place_near(places: Sequence[Point], at: Point, reach: float) -> Point | None:
    """Return the nearest of some places that is at most so far from a point, mm; None where there is none."""
    near = min(places, key=lambda place: math.dist(place, at), default=None)
    return near if near is not None and math.dist(near, at) <= reach else None


@dataclass(frozen=True)
class MarkerMode:
    """Places that are put by clicks, one each; a click on one takes it away, and a drag may move it.

    Attributes:
        prompt: what is expected.
        places: those that are there, mm.
        click: takes a place, mm, and how near counts as on it, mm.
        move: takes where a drag began and ended, mm, and how near counts as on a place, mm; None = nothing is moved.
        typed: takes a typed text; returns False when it is nothing for it.
    """

    prompt: str
    places: Callable[[], Sequence[Point]]
    click: Callable[[Point, float], None]
    typed: Callable[[str], bool] = lambda text: False
    move: Callable[[Point, Point, float], None] | None = None
