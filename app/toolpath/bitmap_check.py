"""The fill of A' on the display memory (step 130), and what it says about the exact offset.

Two ways that share no code come to the same area: the exact offset, and for every pixel its distance from the drawing
together with the parity scan of the drawing. Away from contour pixels they must agree in every single pixel.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..core.wording import in_plane
from ..geometry.distance import DistanceField
from ..geometry.offset.offset import OffsetLevel
from ..model.finding import Finding, FindingKind
from ..raster.fill import Observer, fill
from ..raster.frame import BitmapFrame, PixelCode, area_mm2


@dataclass(frozen=True)
class BitmapCheck:
    """The bitmap's view of A'.

    Attributes:
        bitmap_area, exact_area: mm2; within the bitmap's own bounds they agree.
        wrong: pixels, away from contours, in which the two ways differ; must be 0.
        place: x, y of the first of these, mm.
        pitch: size of a pixel, mm.
    """

    bitmap_area: float
    exact_area: float
    wrong: int
    place: tuple[float, float]
    pitch: float

    def findings(self) -> list[Finding]:
        """Return a finding where the two ways differ."""
        if self.wrong == 0:
            return []
        x, y = self.place
        text = (
            f"The contour path differs from the bitmap fill in {self.wrong} pixels, first at {in_plane(x, y)}. "
            "Do not machine this; please report the drawing."
        )
        return [Finding(FindingKind.TOLERANCE, text, x, y, amount=float(self.wrong))]


def check_on_bitmap(field: DistanceField, level: OffsetLevel, observer: Observer | None = None) -> BitmapCheck:
    """Fill A' on a 400 x 400 bitmap and compare every pixel with the drawing's distance field.

    Args:
        field: distances from the drawing's contours.
        level: A', the rings at the contour tool's distance.
        observer: is shown the numbered steps of the fill of A'.
    """
    extent = (field.boxes[:, 0].min(), field.boxes[:, 1].min(), field.boxes[:, 2].max(), field.boxes[:, 3].max())
    frame = BitmapFrame.around(tuple(float(v) for v in extent))  # type: ignore[arg-type]  # four numbers
    part = fill(frame, field.rows)
    rows = np.concatenate([np.zeros((0, 8)), *(ring.rows for ring in level.rings)])
    shrunk = fill(frame, rows, observer)
    x, y = frame.centres()
    centres = np.stack(np.meshgrid(x, y), -1).reshape(-1, 2)
    far = (field.nearest(centres, level.distance + frame.pitch)[0] > level.distance).reshape(shrunk.plane.shape)
    differs = ((part.plane == PixelCode.INSIDE) & far) != (shrunk.plane == PixelCode.INSIDE)
    wrong = np.argwhere(differs & ~part.near_contour() & ~shrunk.near_contour())
    place = (float(x[wrong[0][1]]), float(y[wrong[0][0]])) if len(wrong) else (0.0, 0.0)
    return BitmapCheck(
        area_mm2(shrunk).estimate, sum(ring.area for ring in level.rings), len(wrong), place, frame.pitch
    )
