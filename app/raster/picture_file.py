"""A picture's file: how many pixels, how large they say they are, and their grey values."""

from __future__ import annotations

import os
import struct
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from threading import Lock
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core.errors import InputError

MM_PER_INCH = 25.4
"""Resolutions are told in pixels to the inch."""

Gray = NDArray[np.uint8]
"""(rows, cols), row 0 = top, 0 = black."""

_LEAST_DPI, _MOST_DPI = 1.0, 1e5
"""Pixels an inch; a file that names no more than the one, or no less than the other, says nothing that is meant."""

_LONGEST = 10.0
"""Times as long as wide; a file that says pixels are longer says nothing that is meant."""

_SHORT_BMP = 12
"""Bytes of a BMP's header of the oldest kind, which says nothing of the size of pixels."""

_LONG_BMP, _BY_MASKS = 56, 3
"""Bytes of a BMP's header from which on it says which bits of a pixel tell how clear it is; and the sort of pixels that
are told apart by such masks.
"""
_BMP_COLOURS, _ALPHA_MASK = slice(28, 34), slice(66, 70)
"""Where a BMP's header tells bits and sort of its pixels, and the mask of what tells how clear they are."""

_PNG, _JPEG, _BMP = b"\x89PNG\r\n\x1a\n", b"\xff\xd8", b"BM"
_TURN, _ACROSS, _DOWN, _UNIT = 0x112, 282, 283, 296
"""Tags of EXIF: how a picture is turned, how many pixels it has across and down a unit, and which unit."""
_STDERR = Lock()


@dataclass(frozen=True, slots=True)
class PictureDensity:
    """What a file says of the size of its pixels.

    Attributes:
        across, down: pixels in a unit along rows and along columns. unit: mm; 0 = only how long a pixel is for its
            width.
    """

    across: float
    down: float
    unit: float

    @property
    def meant(self) -> bool:
        """Can be true of a picture."""
        if not (self.across > 0 and self.down > 0 and 1 / _LONGEST <= self.across / self.down <= _LONGEST):
            return False
        inches = self.unit / MM_PER_INCH
        return not inches or all(_LEAST_DPI < each / inches < _MOST_DPI for each in (self.across, self.down))

    @property
    def pitch(self) -> float | None:
        """Size of a pixel where it is smallest, mm; None = not said."""
        return self.unit / max(self.across, self.down) if self.unit else None

    def square_shape(self, shape: tuple[int, ...]) -> tuple[int, int]:
        """Return rows and columns of a picture of this shape once its pixels are square, as small as its own where they
        are smallest.
        """
        finest = max(self.across, self.down)
        return max(round(shape[0] * finest / self.down), 1), max(round(shape[1] * finest / self.across), 1)


def picture_size(name: str, data: bytes) -> tuple[int, int]:
    """Return (columns, rows) as a picture's header says, without decoding it.

    Raises:
        InputError: it is no PNG, JPEG or BMP, or its header is cut off.
    """
    try:
        if data[:8] == _PNG:
            return _whole(struct.unpack(">II", data[16:24]))
        if data[:2] == _BMP:
            short = data[14:18] == struct.pack("<I", _SHORT_BMP)
            cols, rows = struct.unpack("<HH" if short else "<ii", data[18:22] if short else data[18:26])
            return _whole((cols, abs(rows)))
        if data[:2] == _JPEG:
            return _jpeg_size(data)
    except (struct.error, IndexError, ValueError) as error:
        raise InputError(f"{name}: the picture's header is damaged; save it again.") from error
    raise InputError(f"{name}: this is no PNG, JPEG or BMP picture; save it as one of these.")


def _whole(size: tuple[int, ...]) -> tuple[int, int]:
    cols, rows = size
    if cols < 1 or rows < 1:
        raise ValueError("no pixels")
    return cols, rows


def _segments(data: bytes) -> list[tuple[int, int]]:
    """Return (marker, place of its length) of a JPEG's segments, up to the first frame header."""
    found, at = [], 2
    while True:
        while data[at] == 0xFF:
            at += 1
        marker = data[at]
        found.append((marker, at + 1))
        if 0xC0 <= marker <= 0xCF and marker not in (0xC4, 0xC8, 0xCC):
            return found
        at += 1 + struct.unpack(">H", data[at + 1 : at + 3])[0]


def _jpeg_size(data: bytes) -> tuple[int, int]:
    _, at = _segments(data)[-1]
    rows, cols = struct.unpack(">HH", data[at + 3 : at + 7])
    return _whole((cols, rows))


def density_of(data: bytes) -> PictureDensity | None:
    """Return how large its pixels are as a picture's file says, once it is turned upright; None = it says nothing that
    is meant.
    """
    exif = _exif(data)
    said = [each for each in (*_own_densities(data), _exif_density(exif)) if each is not None and each.meant]
    reported = next((each for each in said if each.unit), said[0] if said else None)
    if reported is not None and exif.get(_TURN, 1) > 4:
        return PictureDensity(reported.down, reported.across, reported.unit)
    return reported


def _own_densities(data: bytes) -> list[PictureDensity]:
    """Return what the format's own header says."""
    if data[:2] == _BMP:
        says = len(data) >= 46 and data[14:18] != struct.pack("<I", _SHORT_BMP)
        return [_density(struct.unpack("<ii", data[38:46]), 1000.0)] if says else []
    if data[:2] == _JPEG:
        return [
            _density(struct.unpack(">HH", body[8:12]), {1: MM_PER_INCH, 2: 10.0}.get(body[7], 0.0))
            for marker, body in _bodies(data)
            if marker == 0xE0 and body[:5] == b"JFIF\0" and len(body) >= 12
        ]
    return [
        _density(struct.unpack(">II", body[:8]), 1000.0 if body[8] == 1 else 0.0)
        for kind, body in _chunks(data)
        if kind == b"pHYs" and len(body) >= 9
    ]


def _density(pixels: tuple[int, ...], unit: float) -> PictureDensity:
    """Return the density of a header, in which a 0 is left out: pixels are square then."""
    across, down = pixels
    return PictureDensity(float(across or down), float(down or across), unit)


def _chunks(data: bytes) -> Iterator[tuple[bytes, bytes]]:
    """Yield kind and content of a PNG's chunks, but for the pixels'."""
    at = 8
    while at + 8 <= len(data):
        length, kind = struct.unpack(">I4s", data[at : at + 8])
        if kind != b"IDAT":
            yield kind, data[at + 8 : at + 8 + length]
        at += 12 + length


def _bodies(data: bytes) -> Iterator[tuple[int, bytes]]:
    """Yield marker and content of a JPEG's segments."""
    for marker, at in _segments(data):
        yield marker, data[at + 2 : at + struct.unpack(">H", data[at : at + 2])[0]]


def _exif(data: bytes) -> dict[int, float]:
    """Return the few entries of a file's EXIF that tell of size and turn, by tag."""
    if data[:2] == _JPEG:
        bodies = [body[6:] for marker, body in _bodies(data) if marker == 0xE1 and body[:6] == b"Exif\0\0"]
    else:
        bodies = [body for kind, body in _chunks(data) if kind == b"eXIf"] if data[:8] == _PNG else []
    try:
        return _entries(bodies[0]) if bodies else {}
    except (struct.error, ZeroDivisionError):
        return {}


def _entries(tiff: bytes) -> dict[int, float]:
    order = "<" if tiff[:2] == b"II" else ">"
    (start,) = struct.unpack(order + "I", tiff[4:8])
    (count,) = struct.unpack(order + "H", tiff[start : start + 2])
    found: dict[int, float] = {}
    for at in range(start + 2, start + 2 + 12 * count, 12):
        tag, _, _, place = struct.unpack(order + "HHII", tiff[at : at + 12])
        if tag in (_TURN, _UNIT):
            (found[tag],) = struct.unpack(order + "H", tiff[at + 8 : at + 10])
        elif tag in (_ACROSS, _DOWN):
            above, below = struct.unpack(order + "II", tiff[place : place + 8])
            found[tag] = above / below
    return found


def _exif_density(exif: dict[int, float]) -> PictureDensity | None:
    if _ACROSS not in exif or _DOWN not in exif:
        return None
    return PictureDensity(exif[_ACROSS], exif[_DOWN], {2: MM_PER_INCH, 3: 10.0}.get(int(exif.get(_UNIT, 2)), 0.0))


def decoded(name: str, data: bytes) -> Gray:
    """Return a picture's grey values, upright; what can be seen through lies on white paper.

    Raises:
        InputError: it is damaged.
    """
    import cv2

    _ensure_whole(name, data)
    see_through = _is_see_through(data)
    flags = cv2.IMREAD_UNCHANGED if see_through else cv2.IMREAD_GRAYSCALE
    with _silence():
        try:
            image = cv2.imdecode(np.frombuffer(data, np.uint8), flags)
        except cv2.error:
            image = None
    if image is None:
        raise InputError(f"{name}: the picture is damaged and cannot be decoded; save it again.")
    if not see_through:
        return _on_paper(np.asarray(image))
    if data[:2] == _BMP and not image[..., 3].any():  # its writer has left alone what tells how clear pixels are
        return _on_paper(image[..., :3])
    upright = _turned(np.asarray(image), int(_exif(data).get(_TURN, 1)))  # as the decoder does with all others
    return _on_paper(_without_clear_grey(upright, data))


def _turned(image: NDArray[Any], turn: int) -> NDArray[Any]:
    """Return a picture upright that is turned as EXIF says, 1 ... 8."""
    if 5 <= turn <= 8:
        image = np.swapaxes(image, 0, 1)
    if turn in (3, 4, 7, 8):
        image = image[::-1]
    return np.ascontiguousarray(image[:, ::-1] if turn in (2, 3, 6, 7) else image)


def _without_clear_grey(image: NDArray[Any], data: bytes) -> NDArray[Any]:
    """Return a picture with white for the grey that its file calls clear; the decoder knows of clear colours alone."""
    clear = next((body for kind, body in _chunks(data) if kind == b"tRNS"), b"") if data[:8] == _PNG else b""
    if image.ndim != 2 or data[25] != 0 or len(clear) < 2:
        return image
    depth, most = data[24], np.iinfo(image.dtype).max
    grey = struct.unpack(">H", clear[:2])[0] & ((1 << depth) - 1)
    return np.where(image == grey * most // ((1 << depth) - 1), most, image).astype(image.dtype)


def _ensure_whole(name: str, data: bytes) -> None:
    """Refuse a PNG that is cut short, or of whose chunks one says that it is longer than the file: a decoder takes that
    much memory.
    """
    at = 8 if data[:8] == _PNG else len(data)
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at : at + 8]) if at + 8 <= len(data) else (0, b"")
        if kind == b"" or at + 12 + length > len(data):
            what = kind.decode("ascii", "replace") or "unknown"
            raise InputError(
                f"{name}: the picture is damaged and cannot be decoded: its part {what!r} at byte {at} reaches beyond "
                "the end of the file; save it again."
            )
        if kind == b"IEND":
            return
        at += 12 + length


def _is_see_through(data: bytes) -> bool:
    if data[:2] == _BMP:
        masked = data[_BMP_COLOURS] == struct.pack("<HI", 32, _BY_MASKS)
        return masked and int.from_bytes(data[14:18], "little") >= _LONG_BMP and any(data[_ALPHA_MASK])
    return data[:8] == _PNG and (data[25] in (4, 6) or any(kind == b"tRNS" for kind, _ in _chunks(data)))


def _on_paper(image: NDArray[Any]) -> Gray:
    """Return grey values of a picture of one, three or four channels of 8 or 16 bits."""
    import cv2

    if image.dtype == np.uint16:
        image = (image >> 8).astype(np.uint8)
    if image.ndim == 2:
        return np.asarray(image, np.uint8)
    if image.shape[2] == 3:
        return np.asarray(cv2.cvtColor(image, cv2.COLOR_BGR2GRAY), np.uint8)
    dark = 255 - cv2.cvtColor(image, cv2.COLOR_BGRA2GRAY)
    return np.asarray(255 - cv2.multiply(dark, np.ascontiguousarray(image[..., 3]), scale=1 / 255), np.uint8)


@contextmanager
def _silence() -> Iterator[None]:
    """Keep what decoders write to the process's own error output, which no setting of theirs stops, from the user.

    One at a time: two that change places would leave it closed.
    """
    with _STDERR:
        try:
            kept = os.dup(2)
        except OSError:
            yield
            return
        nowhere = os.open(os.devnull, os.O_WRONLY)
        try:
            os.dup2(nowhere, 2)
            yield
        finally:
            os.dup2(kept, 2)
            os.close(nowhere)
            os.close(kept)
