"""Fill closed contours in the display memory (steps 130 and 201-208), always right."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise

import numpy as np

from ..core.pool import pool
from ..geometry.primitives import CX, CY, TURN, X0, X1, Y0, Y1, R, Rows, contour_rows
from ..model.part import Contour
from .frame import BitmapFrame, Codes, PixelCode, Plane
from .trace import trace

Observer = Callable[[int, Plane], None]
"""Gets the number of a step of the text and the picture (rows, cols) that the display memory shows after it."""

_BAND = 1 << 20
"""Pixels that are worth a thread's start."""


def fill(frame: BitmapFrame, contours: Sequence[Contour] | Rows, observer: Observer | None = None) -> Codes:
    """Fill what closed contours enclose, by even-odd counting along the rows.

    A pixel that is no contour pixel, and whose centre lies on no contour, is filled exactly when its centre is inside
    by even-odd counting, for contours that cross, touch, overlap or merge within a pixel too: parity comes from the
    crossings that each pixel noted while it was drawn, not from how the drawn pixels look. Contour pixels are filled.

    Args:
        contours: closed, or the rows (n, 8) of closed contours; order, direction and nesting do not matter.
        observer: is shown the memory after steps 201 (contour pixels 1), 202 (start pixels 2), 203 (traced pixels 2),
            206 (R where the count is even), 208 (inside I) and 130 (all of them 1). Costs nothing when there is none.

    References:
        JPH07107645B2, process 130. The text marks R by the look of the chain code (its formula I), which fails where
        strands merge, where tracing skips pixels and at acute vertices that do not turn back; see `draw` for the rule
        used.
    """
    plane, left = draw(frame, contours)
    if observer is not None:
        _show_tracing(plane, observer)
        observer(206, plane.copy())
    codes = Codes(frame, _scan(plane, left))
    if observer is not None:
        observer(208, codes.plane.copy())
        observer(130, codes.filled.astype(np.uint8))
    return codes


def _show_tracing(plane: Plane, observer: Observer) -> None:
    chains, traced = trace(plane)
    contour = np.asarray(plane != PixelCode.EMPTY, np.uint8)
    observer(201, contour)
    starts = contour.copy()
    for chain in chains:
        starts[chain.start] = PixelCode.TRACED
    observer(202, starts)
    observer(203, traced)


def _scan(plane: Plane, left: Plane) -> Plane:
    """Return the plane with its inside marked; rows are padded to whole words of eight pixels while they are
    scanned.
    """
    from . import kernels

    rows, cols = plane.shape
    wide = plane if cols % 8 == 0 else np.pad(plane, ((0, 0), (0, -cols % 8)))
    cuts = np.linspace(0, rows, 1 + plane.size // _BAND).astype(int) if plane.size >= 2 * _BAND else [0, rows]
    bands = [(wide[a:b], wide[a:b].view(np.uint64), left[a:b]) for a, b in pairwise(cuts)]
    if len(bands) == 1:
        kernels.scan(*bands[0])
    else:
        list(pool().map(lambda band: kernels.scan(*band), bands))
    return np.ascontiguousarray(wide[:, :cols])


# Draw contours into the display memory; every pixel notes how often they cross its row's centre line.


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
