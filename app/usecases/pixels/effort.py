"""How long jobs on pixels will take, reckoned from counts before they are begun.

Seconds a piece are measured, on bitmaps of 512 to 4,096 pixels a side with paths of 19,000 to 280,000.
"""

from __future__ import annotations

from collections.abc import Sequence

from ...core.effort import Reckoning
from ...core.wording import counted
from .part import BitmapPart

_PIXEL_S = 5e-8
"""A pixel of a bitmap that an operation shrinks and traces."""
_CHAIN_S = 2e-5
"""A pixel along a path that is smoothed, and proven to keep clear: straight walls take a third of it, waves twice."""
_ON_PIXELS_S = 0.07
"""A contour whose paths on pixels are linked, written, read back, and measured as to what they leave."""


def bitmap_effort(part: BitmapPart, chains_mm: Sequence[float]) -> Reckoning:
    """Return what a job on pixels takes.

    Args:
        part: the pixels. chains_mm: how long the paths of each operation are, about, in one pass.
    """
    pitch, contours = part.frame.pitch, sum(len(region.contours) for region in part.regions)
    along = sum(chains_mm) / pitch
    seconds = part.free.size * len(chains_mm) * _PIXEL_S + along * _CHAIN_S + contours * _ON_PIXELS_S
    many, outlines = contours * _ON_PIXELS_S > seconds / 2, counted(contours, "contour", thousands=",")
    return Reckoning(
        seconds,
        f"{along:,.0f} pixels of paths in {outlines} on {part.frame.cols:,} x {part.frame.rows:,} pixels",
        "leave out layers" if many else "use a smaller bitmap, a larger pitch, or a larger tool",
    )
