"""A part on the display memory: which pixels a cutter may be in, whatever it was drawn or scanned as."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core.errors import ParameterError
from ...geometry.distance import DistanceField
from ...geometry.primitives import boxes, contour_rows, pack
from ...model.part import Region
from ...raster.fill import draw
from ...raster.frame import PATH_BYTES, BitmapFrame, Plane
from ...raster.peel import frame_pixels
from ...raster.walls import Mask, free_pixels, wall_rows
from .options import BitmapSize


@dataclass(frozen=True)
class BitmapPart:
    """A part as pixels.

    Attributes:
        frame: where they lie.
        regions: what they show, as the verdict sees it: the drawing, or the edges of a picture's pixels.
        drawn: contour pixels as codes (step 110).
        free: (rows, cols) pixels whose whole square a cutter may clear.
        label: (rows, cols) number of the region that a free pixel lies in, else 0.
        squares: distances from the squares of all other pixels.
    """

    frame: BitmapFrame
    regions: tuple[Region, ...]
    drawn: Plane
    free: Mask
    label: NDArray[np.int32]
    squares: DistanceField


def part_of_regions(regions: Sequence[Region], size: BitmapSize) -> BitmapPart:
    """Draw regions on a bitmap that holds them all (step 110).

    Args:
        regions: at least one.

    Raises:
        ParameterError: the bitmap would be too large, or nothing of the drawing is as wide as a pixel.
    """
    rows = pack(regions).rows
    around = boxes(rows)
    low, high = around[:, :2].min(axis=0), around[:, 2:].max(axis=0)
    frame = size.frame((float(low[0]), float(low[1]), float(high[0]), float(high[1])))
    frame.ask_memory(PATH_BYTES)
    free = free_pixels(frame, rows)
    if not free.any():
        raise ParameterError(
            f"Nothing of the drawing is as wide as a pixel of {frame.pitch:.3g} mm; "
            "use a larger bitmap or a smaller pitch."
        )
    return BitmapPart(
        frame, tuple(regions), draw(frame, rows)[0], free, _labels(frame, free, regions), _squares(frame, free)
    )


def part_of_mask(frame: BitmapFrame, free: Mask, regions: Sequence[Region], ink: Mask | None = None) -> BitmapPart:
    """Return the part that a picture shows.

    Args:
        free: pixels that a cutter may clear, some at least.
        regions: the same along the pixels' edges.
        ink: what is shown as its contours; None = the free pixels' own border.
    """
    drawn = (frame_pixels(free) if ink is None else ink).astype(np.uint8)
    return BitmapPart(frame, tuple(regions), drawn, free, _labels(frame, free, regions), _squares(frame, free))


def _squares(frame: BitmapFrame, free: Mask) -> DistanceField:
    return DistanceField.of(wall_rows(frame, free))


def _labels(frame: BitmapFrame, free: Mask, regions: Sequence[Region]) -> NDArray[np.int32]:
    """Return the region that each free pixel lies in, found once for each connected area."""
    import cv2

    count, areas = cv2.connectedComponents(free.astype(np.uint8), connectivity=4)
    _, first = np.unique(areas.ravel(), return_index=True)
    rows, cols = np.unravel_index(first, areas.shape)
    centres = frame.to_mm(np.stack([cols + 0.5, rows + 0.5], axis=1))
    number = np.zeros(count, np.int32)
    for region in regions:
        inside = DistanceField.of(np.concatenate([contour_rows(contour) for contour in region.contours])).inside(
            centres
        )
        number[inside & (number == 0)] = region.number
    number[0] = 0
    labels: NDArray[np.int32] = number[areas]
    return labels
