"""A stage of the display memory as a picture: its codes in colours, and beneath them what each means and how large a
pixel is.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ..formats.plot.pixels import Pixels, bgr
from ..raster.code_words import WRONG, word
from ..raster.frame import PixelCode, Plane
from ..raster.steps import StepState
from ..raster.trace import PixelChain, dashed

SHOWN_PX = 800
"""Pictures are enlarged by a whole factor, as long as they stay no wider than about this."""

PALETTE: dict[PixelCode, str] = {
    PixelCode.EMPTY: "#101418",
    PixelCode.CONTOUR: "#d8dee6",
    PixelCode.TRACED: "#4cc2ff",
    PixelCode.R: "#ff5c5c",
    PixelCode.INSIDE: "#2f4a3a",
    PixelCode.PROCESSED: "#3a424c",
    PixelCode.FRAME: "#5ee08a",
    PixelCode.RING: "#2fa866",
    PixelCode.CIRCLE: "#c792ff",
    PixelCode.LONG_LINE: "#4cc2ff",
    PixelCode.VERTEX: "#ffd24c",
    PixelCode.SHORT_LINE: "#8fd8ff",
    PixelCode.ARC: "#ff9e4c",
    PixelCode.SPLINE: "#ff6fb5",
}
"""Colour of each code, "#rrggbb", on the dark screen of a terminal."""

WRONG_COLOUR = "#ff00ff"
"""Colour of pixels in which the published fill errs."""

_SINGLE = {202: PixelCode.TRACED, **dict.fromkeys(range(404, 408), PixelCode.VERTEX)}
"""Codes that single pixels hold at a step: rings round them let them be seen."""
_RING = 7
"""Points from such a pixel's middle to its ring."""
_ROW, _SWATCH, _PAD, _COLUMN = 24, 14, 10, 200
"""Points: a row of the key, its square of colour, what is left free, a column of the key."""
_INK = "#d8dee6"
_LEAST_WIDTH = 340
"""Points: the key's words and the scale's have room in so many; a narrower picture has paper beside it."""
_BAR_SHARE = 0.25
"""Of the picture's width: the scale's bar is as long at most."""


def png(stage: StepState, dashes: Sequence[PixelChain] = ()) -> bytes:
    """Return the stage as a PNG picture, pixels as squares.

    Args:
        dashes: the contour tool's paths, which step 140 shows dashed.
    """
    return _encoded(_painted(stage, dashes))


def keyed_png(stage: StepState, pitch: float, dashes: Sequence[PixelChain] = ()) -> bytes:
    """Return the same with rings round what single pixels hold, and beneath it the codes' meanings and the scale.

    Args:
        pitch: size of a pixel, mm.
    """
    image = _painted(stage, dashes)
    _ring(image, stage)
    beside = max(_LEAST_WIDTH - image.shape[1], 0)
    image = np.concatenate([image, np.full((len(image), beside, 3), bgr(PALETTE[PixelCode.EMPTY]), np.uint8)], axis=1)
    return _encoded(np.vstack([image, _key(image.shape[1], stage, pitch)]))


def _encoded(image: Pixels) -> bytes:
    import cv2

    return bytes(cv2.imencode(".png", image)[1].tobytes())


def _factor(plane: Plane) -> int:
    """Return how many points of the picture a pixel has along each side."""
    return max(1, SHOWN_PX // int(max(plane.shape)))


def _painted(stage: StepState, dashes: Sequence[PixelChain]) -> Pixels:
    colours = np.array([bgr(PALETTE[code]) for code in PixelCode], np.uint8)
    image = colours[dashed(stage.plane, dashes) if stage.number == 140 else stage.plane]
    if stage.wrong is not None:
        image[stage.wrong] = bgr(WRONG_COLOUR)
    factor = _factor(stage.plane)
    return np.asarray(np.repeat(np.repeat(image, factor, axis=0), factor, axis=1), np.uint8)


def _ring(image: Pixels, stage: StepState) -> None:
    import cv2

    code = _SINGLE.get(stage.number)
    if code is None:
        return
    factor = _factor(stage.plane)
    for row, col in np.argwhere(stage.plane == code).tolist():
        middle = (col * factor + factor // 2, row * factor + factor // 2)
        cv2.circle(image, middle, _RING, bgr(PALETTE[code]), 1, cv2.LINE_AA)


def _key(width: int, stage: StepState, pitch: float) -> Pixels:
    """Return the strip beneath a picture: a square and words for each code that is there, and a bar of whole mm."""
    import cv2

    codes = [int(code) for code in np.unique(stage.plane).tolist()]
    codes += [WRONG] if stage.wrong is not None and stage.wrong.any() else []
    columns = max((width - _PAD) // _COLUMN, 1)
    rows = -(-len(codes) // columns)
    strip = np.full(((rows + 1) * _ROW + _PAD, width, 3), bgr(PALETTE[PixelCode.EMPTY]), np.uint8)
    strip[0] = bgr(PALETTE[PixelCode.PROCESSED])
    for k, code in enumerate(codes):
        x, y = _PAD + k % columns * _COLUMN, _PAD + k // columns * _ROW
        colour = WRONG_COLOUR if code == WRONG else PALETTE[PixelCode(code)]
        cv2.rectangle(strip, (x, y), (x + _SWATCH, y + _SWATCH), bgr(colour), cv2.FILLED)
        cv2.rectangle(strip, (x, y), (x + _SWATCH, y + _SWATCH), bgr(_INK), 1)
        _write(strip, word(code, stage.number), (x + _SWATCH + _PAD, y))
    _scale(strip, _PAD + rows * _ROW, pitch / _factor(stage.plane), pitch)
    return strip


def _scale(strip: Pixels, y: int, point: float, pitch: float) -> None:
    """Draw a bar of 1, 2 or 5 times a power of ten mm; `point` is the size of one of the picture's points, mm."""
    import cv2

    most = _BAR_SHARE * strip.shape[1] * point
    power = 10.0 ** math.floor(math.log10(most))
    long = max(each * power for each in (1, 2, 5) if each * power <= most)
    end = _PAD + round(long / point)
    middle = y + _SWATCH // 2
    cv2.line(strip, (_PAD, middle), (end, middle), bgr(_INK), 1)
    for x in (_PAD, end):
        cv2.line(strip, (x, y + 2), (x, y + _SWATCH - 2), bgr(_INK), 1)
    _write(strip, f"{long:g} mm; a pixel is {pitch:.4g} mm", (end + _PAD, y))


def _write(strip: Pixels, words: str, at: tuple[int, int]) -> None:
    import cv2

    place = (at[0], at[1] + _SWATCH - 2)
    cv2.putText(strip, words, place, cv2.FONT_HERSHEY_SIMPLEX, 0.45, bgr(_INK), 1, cv2.LINE_AA)
