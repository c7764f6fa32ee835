"""The relief of a cut for the light: normals, and how much light reaches corners. No Qt."""

from __future__ import annotations

import os
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ....core.pool import pool

Bytes = NDArray[np.uint8]

BANDS = 8
"""Bytes that a cell's relief has: four of its top, four of the wall beside it."""

GAIN, LIMIT = 2.5, 0.15
"""Slopes well under LIMIT are lit as if they were GAIN times as steep."""

WALL = 4.0
"""Cells that differ by more than so many of their widths from the ones next to them may stand beside a wall."""

_SUDDEN = 1.4
"""They do where the cells two away differ by less than so many times as much: a slope goes on, a wall does not."""

_BELL, _BELL_REACH = 2.0, 5
"""Width of the bell that cells round a wall are weighed with, and how far it reaches, cells."""

_COARSE = 4
_SPANS = (3, 7, 15)
"""Widths, in squares of 4 x 4 cells, of the neighbourhoods that a corner is compared with."""

_DARKEST = 0.5

_BANDS, _FEW = max(2, os.cpu_count() or 2), 100_000
"""Parts that a relief is worked out in at a time, where there are not only few cells."""

_NEAR = _BELL_REACH + 1
"""A normal is told by cells at most this far away."""

REACH = (max(_SPANS) // 2 + 3) * _COARSE
"""A height changes the relief of cells at most this far away."""


def relief(heights: NDArray[np.float32], pitch: float) -> Bytes:
    """Return (rows, columns, 8) bytes: x and y of each cell's normal, the light that reaches it, 255; and beside walls
    how far it is from one and which way that faces, 0 (`relief_kernels.relief_map`).

    Args:
        heights: (rows, columns) mm.
        pitch: mm.
    """
    heights = np.ascontiguousarray(heights)
    return _relief(heights, means_around(heights), pitch, (0, 0))


def relief_part(heights: NDArray[np.float32], pitch: float, rows: slice, columns: slice) -> Bytes:
    """Return what `relief` has for a rectangle of cells, to the bit, in the time that the rectangle takes.

    Only what the light of corners asks is worked out for all cells, as its squares of four by four lie across the
    whole.

    Args:
        heights: all of them, (rows, columns) mm. pitch: mm.
        rows, columns: the rectangle, within the heights.
    """
    wide = tuple(slice(max(part.start - _NEAR, 0), part.stop + _NEAR) for part in (rows, columns))
    inner = tuple(
        slice(part.start - outer.start, part.stop - outer.start)
        for part, outer in zip((rows, columns), wide, strict=True)
    )
    first = wide[0].start, wide[1].start
    part = _relief(np.ascontiguousarray(heights[wide]), means_around(heights), pitch, first)
    return np.ascontiguousarray(part[inner])


def _relief(heights: NDArray[np.float32], around: NDArray[np.float32], pitch: float, first: tuple[int, int]) -> Bytes:
    """Return the relief of cells; `first` are the row and the column of the whole, of which `around` tells, that they
    begin with.
    """
    import cv2

    out = np.empty(heights.shape, "<u8")
    lowest, highest, wide_low, wide_high = (
        np.asarray(extreme(heights, np.ones((size, size), np.uint8), borderType=cv2.BORDER_REPLICATE))
        for size in (3, 5)
        for extreme in (cv2.erode, cv2.dilate)
    )
    rise = highest - lowest
    wall = (rise > np.float32(WALL * pitch)) & (wide_high - wide_low < np.float32(_SUDDEN) * rise)
    fields = tuple(each.astype(np.float32) for each in (heights, lowest, np.where(wall, highest, lowest)))
    rows, bands = heights.shape[0], 1 if heights.size < _FEW else _BANDS
    ends = np.linspace(0, rows, bands + 1).astype(int).tolist()
    light = _LightSource(around, pitch, first)
    done = [pool().submit(_band, fields, light, out, span) for span in pairwise(ends)]
    for each in done:
        each.result()
    return out.view(np.uint8).reshape(*heights.shape, BANDS)


@dataclass(frozen=True, eq=False)
class _LightSource:
    """What tells the light of cells: means of `means_around`, pitch, mm, and the row and column of the whole that they
    begin with.
    """

    around: NDArray[np.float32]
    pitch: float
    first: tuple[int, int]


def _band(
    fields: tuple[NDArray[np.float32], ...], light: _LightSource, out: NDArray[np.uint64], span: tuple[int, int]
) -> None:
    """Write the relief of some rows; it wants some more on either side."""
    from .relief_kernels import relief_map

    first, last = max(span[0] - _NEAR, 0), min(span[1] + _NEAR, len(out))
    made = np.empty((last - first, out.shape[1]), out.dtype)
    gains = np.array([1.0 / (wide * _COARSE * light.pitch) for wide in _SPANS], np.float32)
    frame = np.array([light.first[0] + first, light.first[1], _COARSE], float)
    shape = np.array([light.pitch, GAIN, LIMIT, _BELL, _DARKEST], np.float32)
    relief_map(*(each[first:last] for each in fields), light.around, gains, frame, _bell(), shape, made)
    out[span[0] : span[1]] = made[span[0] - first : span[1] - first]


def _bell() -> NDArray[np.float32]:
    along = np.exp(-0.5 * (np.arange(-_BELL_REACH, _BELL_REACH + 1) / _BELL) ** 2)
    weights = np.outer(along, along)
    return np.ascontiguousarray(weights / weights.sum(), np.float32)


def means_around(heights: NDArray[np.float32]) -> NDArray[np.float32]:
    """Return (3, rows / 4, columns / 4), two or more each, the mean height of the neighbourhoods of each square of four
    by four cells, mm.
    """
    import cv2

    rows, columns = heights.shape
    size = (max(-(-columns // _COARSE), 2), max(-(-rows // _COARSE), 2))
    small = np.asarray(cv2.resize(heights, size, interpolation=cv2.INTER_AREA))
    margin = min(max(_SPANS) // 2, min(small.shape) - 1)
    wide = np.pad(small, margin, mode="reflect", reflect_type="odd")  # a slope goes on beyond the stock
    inner = tuple(slice(margin, margin + count) for count in small.shape)
    return np.ascontiguousarray([np.asarray(cv2.blur(wide, (span, span)))[inner] for span in _SPANS], np.float32)
