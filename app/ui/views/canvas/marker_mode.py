"""What clicks on the canvas do when they mark places."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from ....model.curves import Point


@dataclass(frozen=True)
class MarkerMode:
    """Places that are put by clicks, one each; a click on one takes it away.

    Attributes:
        prompt: what is expected.
        places: those that are there, mm.
        click: takes a place, mm, and how near counts as on it, mm.
        typed: takes a typed text; returns False when it is nothing for it.
    """

    prompt: str
    places: Callable[[], Sequence[Point]]
    click: Callable[[Point, float], None]
    typed: Callable[[str], bool] = lambda text: False
