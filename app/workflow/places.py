"""Connected places of cells, each with its worst cell."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from app.dexel.workpiece import Grid

MOST = 100
"""Places that are listed, the worst ones."""


@dataclass(frozen=True, slots=True)
class CellPlace:
    """Cells that hang together, by edges or corners.

    Attributes:
        cell: row and column of the worst one. worst: its value. middle: row and column of the one farthest from the rim.
        area_mm2: of all. disc_mm: diameter of the largest disc that fits, mm, to about a cell.
    """

    cell: tuple[int, int]
    worst: float
    middle: tuple[int, int]
    area_mm2: float
    disc_mm: float


def places_of(mask: NDArray[np.bool_], value: NDArray[np.float32], grid: Grid) -> tuple[CellPlace, ...]:
    """Return the connected places of a mask, that with the largest value first, not more than MOST.

    Args:
        mask: (rows, cols). value: (rows, cols), of which the largest is the worst.
    """
    count, labels, stats, _ = cv2.connectedComponentsWithStats(mask.astype(np.uint8), connectivity=8)
    if count <= 1:
        return ()
    cells = np.flatnonzero(labels)
    label, worth = labels.ravel()[cells], value.ravel()[cells]
    order = np.lexsort((worth, label))
    last = np.flatnonzero(np.concatenate([label[order][1:] != label[order][:-1], [True]]))
    worst = order[last]  # of label 1, 2, …
    inner = cv2.distanceTransform(mask.astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_PRECISE).ravel()[cells]
    deepest = np.lexsort((inner, label))[last]
    found = []
    for k in np.argsort(-worth[worst], kind="stable")[:MOST].tolist():
        one, middle = (divmod(int(cells[which[k]]), grid.cols) for which in (worst, deepest))
        area = float(stats[k + 1, cv2.CC_STAT_AREA]) * grid.pitch**2
        found.append(CellPlace(one, float(worth[worst[k]]), middle, area, (2 * float(inner[deepest[k]]) - 1) * grid.pitch))
    return tuple(found)
