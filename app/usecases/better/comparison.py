"""The cut of a new program beside that of the old one, cell by cell, both ways."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...model.motion import Floats
from ...simulation.field.workpiece import Workpiece
from .area import PassArea


@dataclass(frozen=True, slots=True)
class FarthestCell:
    """The cell at which two cuts differ the most one way: by how much, mm, >= 0, and where, mm."""

    amount_mm: float
    x: float
    y: float


@dataclass(frozen=True, slots=True)
class CutComparison:
    """Two cuts on the same cells, each height exact in float32; lengths square to the surface.

    Attributes:
        left: where the new cut leaves the most over the old one. deeper: where it goes the deepest below it.
        mean_mm: root of the mean square. cells: how many were compared. spacing_mm: of them.
        beside_left_mm, beside_deeper_mm: the same beside the passes, where the ball's own side is what was cut.
    """

    left: FarthestCell
    deeper: FarthestCell
    mean_mm: float
    cells: int
    spacing_mm: float
    beside_left_mm: float
    beside_deeper_mm: float

    @property
    def farthest_mm(self) -> float:
        """The most by which both cuts differ anywhere, mm."""
        return max(self.left.amount_mm, self.deeper.amount_mm, self.beside_left_mm, self.beside_deeper_mm)


def compared(old: Workpiece, new: Workpiece, area: PassArea) -> CutComparison:
    """Return how far a new cut is from an old one on the same grid.

    A difference of heights is more than the one square to the metal by as much as the metal is steep; of both cuts the
    one that is less steep there says how much, so that what is told is never less than what is true.

    Args:
        area: of the passes: its cells are told from those beside them.
    """
    grid = old.grid
    x, y = np.meshgrid(
        grid.x0 + (np.arange(grid.cols) + 0.5) * grid.pitch, grid.y0 + (np.arange(grid.rows) + 0.5) * grid.pitch
    )
    places = np.column_stack([x.ravel(), y.ravel()])
    apart = (new.heights.astype(np.float64) - old.heights).ravel()
    over = area.inside(places)
    square = (apart / np.minimum(_mean_steepness(old), _mean_steepness(new)))[over]
    beside = (apart / _steepness(old))[~over]
    return CutComparison(
        _farthest(square, places[over]),
        _farthest(-square, places[over]),
        float(np.sqrt(np.mean(square**2))),
        int(over.sum()),
        grid.pitch,
        float(max(beside.max(initial=0.0), 0.0)),
        float(max((-beside).max(initial=0.0), 0.0)),
    )


def _mean_steepness(workpiece: Workpiece) -> Floats:
    """Return of each cell (n,) how much longer lengths along Z are than those square to what is there, by the mean
    slope between its neighbours: on a crest between two passes there is none.
    """
    down, across = np.gradient(workpiece.heights.astype(np.float64), workpiece.grid.pitch)
    steep: Floats = np.sqrt(1 + down**2 + across**2).ravel()
    return steep


def _steepness(workpiece: Workpiece) -> Floats:
    """Return of each cell (n,) how much longer lengths along Z are than those square to what is there: by its steepest
    neighbour, as a ball's side and the edge of its cut are steep.
    """
    heights = np.pad(workpiece.heights.astype(np.float64), 1, mode="edge")
    middle = heights[1:-1, 1:-1]
    x = np.maximum(np.abs(heights[1:-1, 2:] - middle), np.abs(heights[1:-1, :-2] - middle)) / workpiece.grid.pitch
    y = np.maximum(np.abs(heights[2:, 1:-1] - middle), np.abs(heights[:-2, 1:-1] - middle)) / workpiece.grid.pitch
    steep: Floats = np.sqrt(1 + x**2 + y**2).ravel()
    return steep


def _farthest(amount: Floats, places: NDArray[np.float64]) -> FarthestCell:
    at = int(np.argmax(amount))
    return FarthestCell(max(float(amount[at]), 0.0), float(places[at, 0]), float(places[at, 1]))
