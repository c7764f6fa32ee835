"""What each code of the display memory means at a step of the text of 1986, in words."""

from __future__ import annotations

from collections.abc import Mapping

from .frame import PixelCode

WRONG = len(PixelCode)
"""The code under which pixels are shown in which the published fill errs; no display memory holds it."""

_WORDS: Mapping[int, str] = {
    PixelCode.EMPTY: "empty",
    PixelCode.CONTOUR: "contour",
    PixelCode.TRACED: "traced",
    PixelCode.R: "must not count",
    PixelCode.INSIDE: "inside",
    PixelCode.PROCESSED: "processed",
    PixelCode.FRAME: "outermost path",
    PixelCode.RING: "path further in",
    PixelCode.CIRCLE: "circle",
    PixelCode.LONG_LINE: "long line",
    PixelCode.VERTEX: "vertex",
    PixelCode.SHORT_LINE: "short line",
    PixelCode.ARC: "arc",
    PixelCode.SPLINE: "free curve",
    WRONG: "wrong as published",
}

_AREA, _LATER = "area still to clear", "path, not fitted yet"
_AT_STEP: Mapping[int, Mapping[int, str]] = {
    202: {PixelCode.TRACED: "start pixel S"},
    205: {PixelCode.VERTEX: "found: must not count"},
    206: {PixelCode.TRACED: "counts", PixelCode.CONTOUR: "never traced"},
    207: {PixelCode.TRACED: "counts", PixelCode.CONTOUR: "never traced"},
    208: {PixelCode.TRACED: "counts", PixelCode.CONTOUR: "never traced"},
    130: {PixelCode.CONTOUR: "area A'"},
    306: {PixelCode.FRAME: "frame of the area", PixelCode.CONTOUR: _AREA},
    140: {PixelCode.CONTOUR: "contour tool's path"},
    **{number: {PixelCode.CONTOUR: _AREA} for number in (*range(301, 306), 307, *range(141, 149))},
    **{number: {PixelCode.CONTOUR: _LATER} for number in range(401, 408)},
}


def word(code: int, step: int) -> str:
    """Return what a code means in a step of the text."""
    return _AT_STEP.get(step, {}).get(code) or _WORDS[code]
