"""What smoothing makes of a path (steps 401-407): circles, lines and arcs, and which points each of them replaces."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from ...geometry.primitives import Rows

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


class PieceKind(IntEnum):
    """What a piece of a smoothed path is; the value is the step that finds it."""

    CIRCLE = 401
    LONG_LINE = 403
    SHORT_LINE = 405
    ARC = 406
    SPLINE = 407


@dataclass(frozen=True)
class SmoothedPath:
    """A closed path as n circles, lines and arcs.

    Attributes:
        rows: (n, 8) rows of `app.geometry.primitives`, each beginning where the one before ends; arcs up to a full
            turn.
        kinds: (n,) PieceKind.
        ends: (n + 1,) indices of the points between which each row runs, rising; those beyond the last go on from the
            first.
        joined: (n,) how each row begins: see `joint_kernels`.
        deviation: greatest distance of a point from its row.
        exact: False where nothing but lines from point to point came near enough.
        carriers: (n, 5) the lines and circles that the rows lie on, see `joint_kernels`.
    """

    rows: Rows
    kinds: Ints
    ends: Ints
    joined: NDArray[np.uint8]
    deviation: float
    exact: bool
    carriers: Floats

    @property
    def tangent(self) -> NDArray[np.bool_]:
        """(n,) whether each row begins in the direction in which the one before ends."""
        from . import joint_kernels

        touching: NDArray[np.bool_] = self.joined == joint_kernels.TANGENT
        return touching
