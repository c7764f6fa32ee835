"""Lines of a scene as they are painted: by what they stand for, whose they are, and which tool goes there."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


class LineRole(Enum):
    """What a line stands for."""

    SURFACE = "surface"
    PATH = "path"
    LINK = "link"
    RAPID = "rapid"
    PLUNGE = "plunge"
    TIP = "tip"


@dataclass(frozen=True, eq=False, slots=True)
class SceneLines:
    """Lines that are painted alike.

    Attributes:
        role: what they stand for. points: (n, 3) mm. joined: (n,) whether a line goes on from each to the next.
        surface: number of the surface that they are on, -1 = of none. tool: its T number, 0 = of none.
    """

    role: LineRole
    points: Floats
    joined: NDArray[np.bool_]
    surface: int = -1
    tool: int = 0


def scene_lines(role: LineRole, points: Floats, surface: int = -1, tool: int = 0) -> SceneLines:
    """Return one line through points (n, 3) mm, as a strand."""
    joined = np.ones(len(points), np.bool_)
    joined[-1:] = False
    return SceneLines(role, np.ascontiguousarray(points, np.float64), joined, surface, tool)


@dataclass(frozen=True, eq=False)
class BoundaryPoint:
    """Where the topmost surface changes: its name, number of its plane over all passes, place (3,) mm, and kind."""

    name: str
    plane: int
    place: Floats
    kind: str
