"""Walls that lie on the stock's edges, and how an area goes on past them, where there is no metal.

Past each such wall the area is a strip along the stock's edge: as far out as asked for, and as far on to both sides, so
that a tool goes round the ends of the walls that meet the edge at whatever angle they do.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray

from ..core import tolerances
from ..geometry.even_odd import even_odd
from ..geometry.overlay.overlay import differing, without_crossings
from ..geometry.primitives import TURN, Rows, pack
from ..geometry.region import polygon_contour
from ..model.finding import Finding
from ..model.part import Contour, Region


class BoxSides(NamedTuple):
    """The sides of a box, mm."""

    x0: float
    y0: float
    x1: float
    y1: float

    def grown(self, by: float) -> BoxSides:
        """Return the sides of a box that is so much larger all round, mm."""
        return BoxSides(self.x0 - by, self.y0 - by, self.x1 + by, self.y1 + by)

    def mirrored(self) -> BoxSides:
        """Return them with x of the other sign."""
        return BoxSides(-self.x1, self.y0, -self.x0, self.y1)

    def away(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return (n,) how far points (n, 2) are from the box, mm; 0 within it."""
        x, y = points.T
        beyond: NDArray[np.float64] = np.hypot(
            np.maximum(np.maximum(self.x0 - x, x - self.x1), 0.0), np.maximum(np.maximum(self.y0 - y, y - self.y1), 0.0)
        )
        return beyond


@dataclass(frozen=True, eq=False)
class OpenedArea:
    """An area that goes on past the stock's edges.

    Attributes:
        contours: that bound it, even-odd. strips: outlines of what of it lies past the edges.
        findings: where areas on the way there are not what they should be.
    """

    contours: tuple[Contour, ...]
    strips: tuple[Contour, ...]
    findings: tuple[Finding, ...] = ()


def opened(regions: Sequence[Region], stock: BoxSides, past: float) -> OpenedArea:
    """Return an area that goes on past all of its walls that lie on the stock's edges.

    It is what of stock and strips is left without the metal that stands in the stock beside the area. So edges that
    area and strips have together are no walls, and every other wall stays as it is.

    Args:
        regions: within the stock. stock: its sides.
        past: how far it goes on, mm, > 0.
    """
    contours = tuple(contour for region in regions for contour in region.contours)
    boxes = _strips(pack(regions).rows, stock, past)
    if not boxes:
        return OpenedArea(contours, ())
    block = shapely.box(*stock)
    strips = shapely.difference(shapely.union_all(boxes), block)
    standing = without_crossings([*_outlines(block), *contours])
    made = without_crossings([*_outlines(shapely.union(strips, block)), *standing.contours])
    grown = differing(even_odd(contours), even_odd(made.contours).area - float(strips.area), contours)
    return OpenedArea(made.contours, _outlines(strips), (*standing.findings, *made.findings, *grown))


def _strips(rows: Rows, stock: BoxSides, past: float) -> list[shapely.Geometry]:
    """Return boxes past all rows that lie on sides of the stock."""
    boxes = []
    for number, side in enumerate(stock):
        axis = number % 2
        on = (rows[:, TURN] == 0) & (np.abs(rows[:, [axis, axis + 2]] - side) <= tolerances.WELD).all(axis=1)
        across = sorted((side, side + (past if number > 1 else -past)))
        for low, high in np.sort(rows[on][:, [1 - axis, 3 - axis]], axis=1).tolist():
            along = [low - past, high + past]
            (x0, x1), (y0, y1) = (across, along) if axis == 0 else (along, across)
            boxes.append(shapely.box(x0, y0, x1, y1))
    return boxes


def _outlines(shape: shapely.Geometry) -> tuple[Contour, ...]:
    """Return the outlines of polygons."""
    parts = [each for each in shapely.get_parts(shape) if each.geom_type == "Polygon"]
    rings = [ring for each in parts for ring in (each.exterior, *each.interiors)]
    return tuple(polygon_contour(shapely.get_coordinates(shapely.simplify(ring, 0.0))[:-1].tolist()) for ring in rings)
