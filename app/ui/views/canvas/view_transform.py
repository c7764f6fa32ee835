"""Where the drawing lies on the screen: mm to pixels and back. Screen y runs down, part y up; only this file flips
it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from PySide6.QtCore import QPointF, QRectF
from PySide6.QtGui import QTransform

from ....geometry.sample import Box
from ....model.curves import Point

SMALLEST_SCALE = 1e-3
LARGEST_SCALE = 2e4


@dataclass(frozen=True, slots=True)
class ViewTransform:
    """A uniform scale and a shift.

    Attributes:
        scale: screen px per mm, > 0.
        ox, oy: screen position of the drawing's zero, px.
    """

    scale: float = 5.0
    ox: float = 0.0
    oy: float = 0.0

    def to_screen(self, point: Point) -> QPointF:
        """Return the screen position of a point in mm."""
        return QPointF(self.ox + self.scale * point[0], self.oy - self.scale * point[1])

    def to_world(self, position: QPointF) -> Point:
        """Return the point in mm under a screen position."""
        return ((position.x() - self.ox) / self.scale, (self.oy - position.y()) / self.scale)

    def world_box(self, area: QRectF) -> Box:
        """Return x0, y0, x1, y1 in mm of a screen rectangle."""
        (x0, y1), (x1, y0) = self.to_world(area.topLeft()), self.to_world(area.bottomRight())
        return (x0, y0, x1, y1)

    def transform(self) -> QTransform:
        """Return the map from mm to screen px for a painter."""
        return QTransform(self.scale, 0.0, 0.0, -self.scale, self.ox, self.oy)

    def zoomed(self, factor: float, at: QPointF) -> ViewTransform:
        """Return the view enlarged by a factor; the point under `at` stays where it is."""
        scale = min(max(self.scale * factor, SMALLEST_SCALE), LARGEST_SCALE)
        real = scale / self.scale
        return ViewTransform(scale, at.x() + (self.ox - at.x()) * real, at.y() + (self.oy - at.y()) * real)

    def panned(self, dx: float, dy: float) -> ViewTransform:
        """Return the view shifted on the screen, px."""
        return replace(self, ox=self.ox + dx, oy=self.oy + dy)

    def centred(self, point: Point, area: QRectF) -> ViewTransform:
        """Return the view with a point in mm in the middle of a screen rectangle."""
        middle = area.center()
        return replace(self, ox=middle.x() - self.scale * point[0], oy=middle.y() + self.scale * point[1])

    def towards(self, other: ViewTransform, share: float, area: QRectF) -> ViewTransform:
        """Return the view on the way to another one; share 0 is this one, 1 the other. Scale goes in equal ratios."""
        if share >= 1:
            return other
        scale = self.scale * (other.scale / self.scale) ** share
        grown = (
            share
            if abs(other.scale - self.scale) < 1e-9 * self.scale
            else (scale - self.scale) / (other.scale - self.scale)
        )
        a, b = self.to_world(area.center()), other.to_world(area.center())
        along = grown * other.scale / scale if scale > 0 else share
        centre = (a[0] + (b[0] - a[0]) * along, a[1] + (b[1] - a[1]) * along)
        return replace(self, scale=scale).centred(centre, area)


def fitted(box: Box, area: QRectF, margin: float = 40.0) -> ViewTransform:
    """Return the view that shows a box in mm as large as it goes in a screen rectangle.

    Args:
        margin: free space kept on every side, px.
    """
    width, height = max(box[2] - box[0], 1e-6), max(box[3] - box[1], 1e-6)
    free_width, free_height = max(area.width() - 2 * margin, 20.0), max(area.height() - 2 * margin, 20.0)
    scale = min(max(min(free_width / width, free_height / height), SMALLEST_SCALE), LARGEST_SCALE / 10)
    return ViewTransform(scale).centred(((box[0] + box[2]) / 2, (box[1] + box[3]) / 2), area)


def nice_step(smallest: float) -> float:
    """Return the least 1, 2 or 5 times a power of ten that is not below `smallest` > 0."""
    power = 10.0 ** math.floor(math.log10(smallest))
    return next(step * power for step in (1.0, 2.0, 5.0, 10.0) if step * power >= smallest * (1 - 1e-9))
