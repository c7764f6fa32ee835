"""What stands after a program: heights in float64 at points, each motion of flat and pointed tools in closed form."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tests.fuzz.plain_nc import Cut

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Shape:
    """A cutter: its radius, mm, and how far its point falls from the rim to the axis, mm for each mm; 0 = flat.

    Attributes:
        ball: its end is half a ball.
    """

    radius: float
    fall: float = 0.0
    ball: bool = False


class DenseHeights:
    """A block whose top is `top`, seen at the points of a grid.

    Attributes:
        x, y: (columns,), (rows,) of the points, mm. z: (rows, columns), mm.
    """

    def __init__(self, box: tuple[float, float, float, float], pitch: float, top: float = 0.0) -> None:
        self.x = np.arange(box[0], box[2], pitch) + pitch * 0.37  # off the round numbers that walls lie on
        self.y = np.arange(box[1], box[3], pitch) + pitch * 0.41
        self.z = np.full((len(self.y), len(self.x)), top)

    def points(self) -> tuple[Floats, Floats]:
        """Return X and Y of every point, (rows, columns)."""
        x, y = np.meshgrid(self.x, self.y)
        return x, y

    def cut(self, cuts: Iterable[Cut], shapes: dict[int, Shape]) -> None:
        """Take away what tools take, rapids too; those that are above all of it cost nothing."""
        top = float(self.z.max())
        for each in cuts:
            if min(each.start[2], each.end[2]) < top:
                self._one(each, shapes[each.tool])

    def _one(self, cut: Cut, shape: Shape) -> None:
        (x0, y0, z0), (x1, y1, z1) = cut.start, cut.end
        a, b = np.searchsorted(self.x, [min(x0, x1) - shape.radius, max(x0, x1) + shape.radius])
        c, d = np.searchsorted(self.y, [min(y0, y1) - shape.radius, max(y0, y1) + shape.radius])
        if a >= b or c >= d:
            return
        px, py = self.x[None, a:b] - x0, self.y[c:d, None] - y0
        length = math.hypot(x1 - x0, y1 - y0)
        if length < 1e-9:
            away = np.hypot(px, py)
            with np.errstate(invalid="ignore"):
                over = shape.radius - np.sqrt(shape.radius**2 - away**2) if shape.ball else shape.fall * away
            made = min(z0, z1) + over
            made = np.where(away <= shape.radius, made, np.inf)
        else:
            ux, uy, slope = (x1 - x0) / length, (y1 - y0) / length, (z1 - z0) / length
            along, beside = px * ux + py * uy, np.abs(py * ux - px * uy)
            closed = _round if shape.ball else _pointed if shape.fall else _flat
            made = closed(along, beside, (length, z0, slope), shape)
        np.minimum(self.z[c:d, a:b], made, out=self.z[c:d, a:b])


def _within(along: Floats, beside: Floats, length: float, radius: float) -> tuple[Floats, Floats]:
    """Return between which places on the line the cutter is over each point; the first beyond the last = nowhere."""
    with np.errstate(invalid="ignore"):
        half = np.sqrt(radius**2 - beside**2)
    return np.maximum(along - half, 0.0), np.minimum(along + half, length)


def _flat(along: Floats, beside: Floats, line: tuple[float, float, float], shape: Shape) -> Floats:
    length, z0, slope = line
    first, last = _within(along, beside, length, shape.radius)
    return np.where(first <= last, z0 + slope * (last if slope < 0 else first), np.inf)


def _pointed(along: Floats, beside: Floats, line: tuple[float, float, float], shape: Shape) -> Floats:
    """A cone over a point is lowest where its slope is that of the line; beyond its rim there is none of it."""
    length, z0, slope = line
    first, last = _within(along, beside, length, shape.radius)
    steep = abs(slope) >= shape.fall
    shift = math.copysign(1e9, slope) if steep else slope * beside / math.sqrt(shape.fall**2 - slope**2)
    at = np.clip(along - shift, first, last)
    return np.where(first <= last, z0 + slope * at + shape.fall * np.hypot(along - at, beside), np.inf)


def _round(along: Floats, beside: Floats, line: tuple[float, float, float], shape: Shape) -> Floats:
    """A ball over a point is lowest where its tangent plane has the slope of the line."""
    length, z0, slope = line
    first, last = _within(along, beside, length, shape.radius)
    with np.errstate(invalid="ignore"):
        half = np.sqrt(shape.radius**2 - beside**2)
        at = np.clip(along - slope * half / math.sqrt(1 + slope**2), first, last)
        low = np.sqrt(np.maximum(shape.radius**2 - beside**2 - (along - at) ** 2, 0.0))
        return np.where(first <= last, z0 + slope * at + shape.radius - low, np.inf)
