"""What each numbered step looks like on a display of one bit: solid, half, sparse, dotted, dashed."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ....raster.frame import POINTS, PixelCode, Plane
from ....raster.steps import StepState
from ....raster.trace import PixelChain
from .glyphs import Bits

DASH, GAP = 6, 4
"""Points of a dash of the contour tool's path, and between two."""

DOT = 2
"""Points of a dot of a path that is not smoothed yet, and between two."""

_REWRITTEN = (110, 120, 130, 140)
"""Steps after which the text has the whole screen rewritten."""

_BLOCKS = (PixelCode.R, PixelCode.VERTEX)
_ROW, _COL = np.indices((POINTS, POINTS))
_HALF: Bits = (_ROW + _COL) % 2 == 0
_SPARSE: Bits = (_ROW % 4 == 0) & ((_COL + _ROW // 2) % 4 == 0)
"""How what is left of an area, and what is processed, is lit; lines are solid."""


@dataclass(frozen=True, eq=False)
class ScreenStill:
    """The display after a step.

    Attributes:
        number: of the step. name: what it is called, with region and turn. packed: its points, eight a byte.
        hold_ms: how long it is shown.
    """

    number: int
    name: str
    packed: NDArray[np.uint8]
    hold_ms: int

    @property
    def picture(self) -> Bits:
        """(400, 400) points."""
        return np.unpackbits(self.packed).reshape(POINTS, POINTS).astype(np.bool_)


def stills_of(
    stages: Iterable[StepState], contours: Sequence[PixelChain], smoothed: Sequence[PixelChain] = ()
) -> Iterator[ScreenStill]:
    """Yield what the display shows after each stage.

    Args:
        stages: of a bitmap of 400 x 400 points.
        contours: the contour tool's paths, drawn dashed in steps 120 and 140.
        smoothed: paths that are smoothed in steps 401-407, dotted until they are.
    """
    for stage in stages:
        yield still_of(stage, contours, smoothed)


def still_of(stage: StepState, contours: Sequence[PixelChain] = (), smoothed: Sequence[PixelChain] = ()) -> ScreenStill:
    """Return what the display shows after a stage; chains as in `stills_of`."""
    plane, number = stage.plane, stage.number
    picture: Bits = plane != PixelCode.EMPTY
    if number in (120, 140):
        picture = _of_codes(plane, (PixelCode.FRAME, PixelCode.RING)) | _dashed(contours, DASH, GAP)
    elif number == 208:
        picture &= (plane != PixelCode.INSIDE) | _HALF
    elif number > 400:
        picture &= (plane != PixelCode.CONTOUR) | _dashed(smoothed, DOT, DOT)
    elif number > 300 or 141 <= number <= 148:
        picture &= ((plane != PixelCode.CONTOUR) | _HALF) & ((plane != PixelCode.PROCESSED) | _SPARSE)
    if number != 208:
        picture |= _blocks(_of_codes(plane, _BLOCKS))
    return ScreenStill(number, _name(stage), np.packbits(picture), _hold_ms(number))


def _of_codes(plane: Plane, codes: Sequence[PixelCode]) -> Bits:
    lit: Bits = np.isin(plane, codes)
    return lit


def _dashed(chains: Sequence[PixelChain], dash: int, gap: int) -> Bits:
    """Return chains with `dash` points lit, then `gap` dark, all along, so that no direction fares better."""
    picture = np.zeros((POINTS, POINTS), np.bool_)
    for chain in chains:
        pixels = chain.pixels()
        picture[tuple(pixels[np.arange(len(pixels)) % (dash + gap) < dash].T)] = True
    return picture


def _blocks(marks: Bits) -> Bits:
    """Return marks as squares of 3 x 3 points, so that they stand out from a line of single points."""
    around = np.pad(marks, 1)
    blocks = marks.copy()
    for row in range(3):
        for col in range(3):
            blocks |= around[row : row + POINTS, col : col + POINTS]
    return blocks


def _name(stage: StepState) -> str:
    region = f"  AREA {stage.region}" if stage.region else ""
    turn = f"  TURN {stage.turn}" if stage.turn > 1 else ""
    return f"{stage.name}{region}{turn}"


def _hold_ms(number: int) -> int:
    if number in _REWRITTEN:
        return 1200
    return 400 if 200 < number < 210 or number > 400 else 80
