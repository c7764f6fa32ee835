"""Draw contours into the display memory; every pixel notes how often they cross its row's centre line."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..geometry.primitives import CX, CY, TURN, X0, X1, Y0, Y1, R, Rows, contour_rows
from ..model.part import Contour
from .codes import Plane
from .frame import BitmapFrame


def draw(frame: BitmapFrame, contours: Sequence[Contour] | Rows) -> tuple[Plane, Plane]:
    """Return the contour pixels of closed contours as codes, and what lies left of the picture.

    Every pixel in which a contour crosses its row's centre line is a contour pixel; an edge counts for y0 <= yc < y1,
    a horizontal one never. An odd count makes code 2, an even one R. Where a contour runs on between two crossings,
    its pixels are drawn as R, so that the drawn line is 8-connected.

    Args:
        contours: closed, or the rows (n, 8) of closed contours; parts outside the frame are cut off, those left of it
            still count.

    Returns:
        (rows, cols) uint8 codes 0, 2, R; (rows,) uint8: 1 where an odd number of crossings lies left of the frame.
    """
    from . import kernels

    plane, left = np.zeros((frame.rows, frame.cols), np.uint8), np.zeros(frame.rows, np.uint8)
    kernels.draw(image_rows(frame, rows_of(contours)), plane, left)
    return plane, left


def rows_of(contours: Sequence[Contour] | Rows) -> Rows:
    """Return the rows (n, 8) of contours, mm, or the rows themselves."""
    if isinstance(contours, np.ndarray):
        return contours
    return np.concatenate([np.zeros((0, 8)), *(contour_rows(contour) for contour in contours)])


def image_rows(frame: BitmapFrame, rows: Rows) -> Rows:
    """Return lines and arcs (n, 8) in image coordinates; their sense of turning is mirrored with the y axis."""
    image = np.empty_like(rows)
    for x, y in ((X0, Y0), (X1, Y1), (CX, CY)):
        image[:, [x, y]] = frame.to_px(rows[:, [x, y]])
    image[:, R] = rows[:, R] / frame.pitch
    image[:, TURN] = -rows[:, TURN]
    return image
