"""The relief of a cut for the light: normals, and how much light reaches corners. No Qt."""

from __future__ import annotations

import os
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ....core.pool import pool

Bytes = NDArray[np.uint8]

GAIN, LIMIT = 2.5, 0.15
"""Slopes well under LIMIT are lit as if they were GAIN times as steep."""

WALL = 2.0
"""From this slope on cells count as a wall: there the steps of the grid, not the metal, would tell the slope's
direction.
"""

_WIDE = 11
"""Cells that are taken together to tell which way a wall faces; how steep it is, its own cells tell."""

_COARSE = 4
_SPANS = (3, 7, 15)
"""Widths, in squares of 4 x 4 cells, of the neighbourhoods that a corner is compared with."""

_DARKEST = 0.45

_BANDS, _FEW = max(2, os.cpu_count() or 2), 100_000
"""Parts that a relief is worked out in at a time, where there are not only few cells."""

_NEAR = _WIDE // 2 + 1
"""A normal is told by cells at most this far away."""

REACH = (max(_SPANS) // 2 + 3) * _COARSE
"""A height changes the relief of cells at most this far away."""


def relief(heights: NDArray[np.float32], pitch: float) -> Bytes:
    """Return (rows, columns, 4) bytes: x and y of each cell's normal, the light that reaches it, 255.

    Args:
        heights: (rows, columns) mm.
        pitch: mm.
    """
    heights = np.ascontiguousarray(heights)
    return _relief(heights, corner_light(heights, pitch), pitch)


def relief_part(heights: NDArray[np.float32], pitch: float, rows: slice, columns: slice) -> Bytes:
    """Return what `relief` has for a rectangle of cells, to the bit, in the time that the rectangle takes.

    Only the light of corners is worked out for all cells, as their squares of four by four lie across the whole.

    Args:
        heights: all of them, (rows, columns) mm. pitch: mm.
        rows, columns: the rectangle, within the heights.
    """
    light = corner_light(heights, pitch)
    wide = tuple(slice(max(part.start - _NEAR, 0), part.stop + _NEAR) for part in (rows, columns))
    inner = tuple(
        slice(part.start - outer.start, part.stop - outer.start)
        for part, outer in zip((rows, columns), wide, strict=True)
    )
    return np.ascontiguousarray(
        _relief(np.ascontiguousarray(heights[wide]), np.ascontiguousarray(light[wide]), pitch)[inner]
    )


def _relief(heights: NDArray[np.float32], light: Bytes, pitch: float) -> Bytes:
    import cv2

    out = np.empty(heights.shape, "<u4")
    smooth = np.asarray(cv2.GaussianBlur(heights, (_WIDE, _WIDE), 0.0, borderType=cv2.BORDER_REPLICATE))
    spread = np.asarray(cv2.morphologyEx(heights, cv2.MORPH_GRADIENT, np.ones((3, 3), np.uint8)))
    steep = np.where(spread > np.float32(2 * WALL * pitch), spread / np.float32(2 * pitch), np.float32(0.0))
    rows, bands = heights.shape[0], 1 if heights.size < _FEW else _BANDS
    ends = np.linspace(0, rows, bands + 1).astype(int).tolist()
    done = [pool().submit(_band, (heights, smooth, steep, light), pitch, out, span) for span in pairwise(ends)]
    for each in done:
        each.result()
    return out.view(np.uint8).reshape(*heights.shape, 4)


def _band(fields: tuple[NDArray[Any], ...], pitch: float, out: NDArray[np.uint32], span: tuple[int, int]) -> None:
    """Write the relief of some rows; slopes want one more on either side."""
    from .relief_kernels import relief_map

    first, last = max(span[0] - 1, 0), min(span[1] + 1, len(out))
    made = np.empty((last - first, out.shape[1]), out.dtype)
    relief_map(*(each[first:last] for each in fields), np.float32(pitch), np.float32(GAIN), np.float32(LIMIT), made)
    out[span[0] : span[1]] = made[span[0] - first : span[1] - first]


def corner_light(heights: NDArray[np.float32], pitch: float) -> Bytes:
    """Return (rows, columns) how much light reaches each cell, 255 = all: less, the more the metal round it stands
    higher.

    A plane, however it slopes, gets all of it.
    """
    import cv2

    rows, columns = heights.shape
    size = (-(-columns // _COARSE), -(-rows // _COARSE))
    small = np.asarray(cv2.resize(heights, size, interpolation=cv2.INTER_AREA))
    margin = min(max(_SPANS) // 2, min(small.shape) - 1)
    wide = np.pad(small, margin, mode="reflect", reflect_type="odd")  # a slope goes on beyond the stock
    shade = np.zeros_like(small)
    for span in _SPANS:
        around = np.asarray(cv2.blur(wide, (span, span)))[
            margin : margin + small.shape[0], margin : margin + small.shape[1]
        ]
        shade += np.clip((around - small) / np.float32(span * _COARSE * pitch), 0.0, 0.5)
    light = np.round(255.0 * (1.0 - _DARKEST * np.minimum(shade * 1.5, 1.0))).astype(np.uint8)
    return np.ascontiguousarray(cv2.resize(light, (columns, rows), interpolation=cv2.INTER_LINEAR))
