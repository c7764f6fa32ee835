"""Moving pictures as GIF: each is only the rectangle that differs from the one before, in 256 colours of its own. No
Qt.

OpenCV finds the colours and packs the rectangles. Its own animations are not used: they hold all pictures in memory and
repeat what does not move. The format is that of "Graphics Interchange Format, version 89a", CompuServe 1990.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from ....core.errors import HitofudeError

Pixels = NDArray[np.uint8]
"""(height, width, 3), red first, upper row first."""

MOST_PER_SECOND = 50.0
"""Times are hundredths of a second, and what is shown for less than two of them is shown more slowly by most
programs.
"""

_QUALITY, _NO_DITHER = 8, 3
_TABLE, _SIZE_BITS = 0x80, 0x07
_EXTENSION, _IMAGE, _END = 0x21, 0x2C, b"\x3b"
_HEAD, _DESCRIPTION = 13, 10
_FOR_EVER = b"\x21\xff\x0bNETSCAPE2.0\x03\x01\x00\x00\x00"
_STAYS = 0x04
"""A picture stays, and the next one is painted over it."""


def gif_chunks(frames: Iterator[Pixels], per_second: float) -> Iterator[bytes]:
    """Give the bytes of a GIF that is shown for ever, piece by piece, one for each picture and one at the end.

    Args:
        frames: pictures of one size, one or more.
        per_second: pictures, in (0, `MOST_PER_SECOND`]; rounding of times does not add up.

    Raises:
        ValueError: pictures of different sizes, or none.
    """
    before: Pixels | None = None
    for number, frame in enumerate(frames):
        head = b""
        if before is None:
            head = b"GIF89a" + struct.pack("<HHBBB", frame.shape[1], frame.shape[0], 0x70, 0, 0) + _FOR_EVER
        elif before.shape != frame.shape:
            raise ValueError(
                f"picture {number + 1} is {frame.shape[1]} by {frame.shape[0]} px, the one before {before.shape[1]} "
                f"by {before.shape[0]}"
            )
        rows, columns = changed(before, frame)
        hundredths = round(100 * (number + 1) / per_second) - round(100 * number / per_second)
        yield head + _picture(frame[rows, columns], (columns.start, rows.start), hundredths)
        before = frame.copy()
    if before is None:
        raise ValueError("no pictures")
    yield _END


def changed(before: Pixels | None, frame: Pixels) -> tuple[slice, slice]:
    """Return rows and columns of the smallest rectangle that holds all pixels that differ; one pixel where none
    does.
    """
    if before is None:
        return slice(0, frame.shape[0]), slice(0, frame.shape[1])
    other = np.any(frame != before, axis=2)
    sides = [np.flatnonzero(other.any(axis=axis)) for axis in (1, 0)]
    if not len(sides[0]):
        return slice(0, 1), slice(0, 1)
    rows, columns = (slice(int(side[0]), int(side[-1]) + 1) for side in sides)
    return rows, columns


def _picture(pixels: Pixels, corner: tuple[int, int], hundredths: int) -> bytes:
    """Return the blocks of one picture.

    Args:
        pixels: its rectangle. corner: px from the left and from the top. hundredths: s / 100 that it is shown.
    """
    import cv2

    how = [cv2.IMWRITE_GIF_QUALITY, _QUALITY, cv2.IMWRITE_GIF_DITHER, _NO_DITHER]
    done, packed = cv2.imencode(".gif", np.ascontiguousarray(pixels[..., ::-1]), how)
    if not done:
        raise HitofudeError(f"OpenCV {cv2.__version__} cannot pack a picture as GIF; save single pictures instead.")
    table, data = _taken_apart(packed.tobytes())
    bits = (len(table) // 3).bit_length() - 2
    control = struct.pack("<BBBBHBB", _EXTENSION, 0xF9, 4, _STAYS, hundredths, 0, 0)
    place = struct.pack("<BHHHHB", _IMAGE, *corner, pixels.shape[1], pixels.shape[0], _TABLE | bits)
    return control + place + table + data


def _taken_apart(packed: bytes) -> tuple[bytes, bytes]:
    """Return the colours and the packed pixels of a GIF of one picture."""
    at, table = _HEAD, b""
    if packed[10] & _TABLE:
        at, table = _after_table(packed, at, packed[10])
    while packed[at] == _EXTENSION:
        at = _after_blocks(packed, at + 2)
    flags = packed[at + _DESCRIPTION - 1]
    at += _DESCRIPTION
    if flags & _TABLE:
        at, table = _after_table(packed, at, flags)
    return table, packed[at : _after_blocks(packed, at + 1)]


def _after_table(packed: bytes, at: int, flags: int) -> tuple[int, bytes]:
    end = at + (3 << ((flags & _SIZE_BITS) + 1))
    return end, packed[at:end]


def _after_blocks(packed: bytes, at: int) -> int:
    """Return where a row of blocks, each led by its length, has ended."""
    while packed[at]:
        at += 1 + packed[at]
    return at + 1
