"""What an NC text holds, motion block by motion block: which G word moves, how far, for which move of the program."""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Reached = tuple[float | None, float | None, float | None]
"""X, Y and Z; None where it is not known where the control is."""


@dataclass(frozen=True)
class Motions:
    """The m motion blocks of a text, in their order.

    A block's length begins where the block before ended. An axis that no block has moved yet counts nothing: the first
    block and the approach behind it are as long as if the tool began at clearance above the first point.

    Attributes:
        kind: (m,) uint8 MoveKind.
        length: (m,) mm; helices along the helix.
        move: (m,) int32 index of the program's move that the block was written for; the lift at a tool's end belongs to
            its last move.
    """

    kind: NDArray[np.uint8]
    length: NDArray[np.float64]
    move: NDArray[np.int32]

    @staticmethod
    def none() -> Motions:
        """Return those of an empty text."""
        return Motions(np.zeros(0, np.uint8), np.zeros(0), np.zeros(0, np.int32))


def straight_length(start: Reached, end: Reached) -> float:
    """Return the length of a straight move, in the unit of its points; axes that are not known at both ends count nothing."""
    return math.hypot(*(b - a for a, b in zip(start, end, strict=True) if a is not None and b is not None))


def arc_length(start: Reached, end: Reached, centre: complex, clockwise: bool) -> float:
    """Return the length of an arc or a helix.

    Args:
        start, end: where it begins and ends; alike in X and Y = a full turn.
        centre: from the start to the centre.
        clockwise: its sense.
    """
    first = -centre
    last = complex((end[0] or 0.0) - (start[0] or 0.0), (end[1] or 0.0) - (start[1] or 0.0)) - centre
    turn = (cmath.phase(last) - cmath.phase(first)) * (-1 if clockwise else 1) % math.tau
    return math.hypot((turn or math.tau) * abs(first), (end[2] or 0.0) - (start[2] or 0.0))
