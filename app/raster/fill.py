"""Fill closed contours in the display memory (steps 130 and 201-208), always right."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise

import numpy as np

from ..core.pool import pool
from ..geometry.primitives import Rows
from ..model.part import Contour
from .codes import Codes, PixelCode, Plane
from .draw import draw
from .frame import BitmapFrame
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
