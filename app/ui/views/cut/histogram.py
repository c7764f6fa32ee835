"""How much of the area is how far from the part. No Qt."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from .cell_colours import FINE_PLACES, OUT_OF_REACH, STEPS, CutColourBy, values_of
from .cut_picture import CutPicture, Floats

if TYPE_CHECKING:
    from ....verify.judgement import Judgement

WIDTH = 6
"""Steps of the colours' scale in a bar."""


@dataclass(frozen=True, eq=False)
class Histogram:
    """n bars along the scale of the deviation's colours.

    Attributes:
        borders: (n + 1,) along the scale, 0 = worst gouge, 1 = most metal left.
        areas: (n,) mm².
        beyond: mm² of metal left that no tool reaches; it is in no bar.
        gouge, right, left: mm² too deep, within tolerance, and left within reach.
        tolerance: mm.
    """

    borders: Floats
    areas: Floats
    beyond: float
    gouge: float
    right: float
    left: float
    tolerance: float


def histogram_of(picture: CutPicture, judgement: Judgement) -> Histogram:
    """Return the histogram of a judged cut: outside the tolerance as the cells tell, within it what the part says
    something about.
    """
    cell = picture.pitch**2
    counts = np.bincount(values_of(picture, CutColourBy.DEVIATION, picture.span).ravel(), minlength=256)
    low, high = (round(at * (STEPS - 1)) for at in FINE_PLACES)
    below, above = (np.append(np.arange(start, stop, WIDTH), stop) for start, stop in ((0, low), (high + 1, STEPS)))
    right = sum(
        band.area_mm2
        for band in judgement.bands
        if -judgement.tolerance <= band.low and band.high <= judgement.tolerance
    )
    bars = [np.add.reduceat(counts[edges[0] : edges[-1]], edges[:-1] - edges[0]) * cell for edges in (below, above)]
    borders = np.concatenate([below, above]) / STEPS
    return Histogram(
        borders,
        np.concatenate([bars[0], [right], bars[1]]),
        float(counts[OUT_OF_REACH]) * cell,
        float(bars[0].sum()),
        right,
        float(bars[1].sum()),
        judgement.tolerance,
    )
