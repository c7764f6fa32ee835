"""Connected places of cells, each with its worst cell."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..simulation.field.workpiece import Grid

MOST = 100
"""Places that are listed, the worst ones."""


ASKED = 5000
"""Cells of a place that are looked at one by one where it has more: the worst ones, and about as many spread over the
others.
"""


@dataclass(frozen=True, eq=False)
class CellPlace:
    """Cells that hang together, by edges or corners.

    Attributes:
        cells: row * cols + col of them, of very many the worst and some of the others.
        cell: the worst one, row and column. worst: its value.
        area_mm2: of all. disc_mm: diameter of the largest disc that fits, mm, to about a cell.
    """

    cells: NDArray[np.int64]
    cell: tuple[int, int]
    worst: float
    area_mm2: float
    disc_mm: float


class FoundPlaces(NamedTuple):
    """Places, that with the largest value first, not more than MOST, and how many there are."""

    places: tuple[CellPlace, ...]
    number: int


def places_of(mask: NDArray[np.bool_], value: NDArray[np.float32], grid: Grid) -> FoundPlaces:
    """Return the connected places of a mask.

    Args:
        mask: (rows, cols). value: (rows, cols), of which the largest is the worst.
    """
    if not mask.any():
        return FoundPlaces((), 0)
    import cv2  # there mostly is none

    count, labels, stats, _ = cv2.connectedComponentsWithStats(mask.astype(np.uint8), connectivity=8)
    cells = np.flatnonzero(labels)
    label, worth = labels.ravel()[cells], value.ravel()[cells]
    order = np.lexsort((worth, label))
    # where each label begins, and where the last one ends
    ends = np.searchsorted(label[order], np.arange(1, count + 1))
    framed = np.pad(mask, 1).astype(np.uint8)  # what lies beyond the grid is no place
    inner = cv2.distanceTransform(framed, cv2.DIST_L2, cv2.DIST_MASK_PRECISE)[1:-1, 1:-1].ravel()
    worst = worth[order[ends[1:] - 1]]
    found = []
    for k in np.argsort(-worst, kind="stable")[:MOST].tolist():
        mine = cells[order[ends[k] : ends[k + 1]]][::-1]  # the worst first
        area = float(stats[k + 1, cv2.CC_STAT_AREA]) * grid.pitch**2
        disc = (2 * float(inner[mine].max()) - 1) * grid.pitch
        requested = np.concatenate([mine[:ASKED], mine[ASKED :: 1 + len(mine) // ASKED]])
        found.append(CellPlace(requested, divmod(int(mine[0]), grid.cols), float(worst[k]), area, disc))
    return FoundPlaces(tuple(found), count - 1)
