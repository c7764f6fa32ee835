"""Paths to smooth, of known lines and arcs: as pixels, and as points between pixels."""

import math

import numpy as np

from app.geometry.outlines import polygon_contour
from app.geometry.primitives import contour_rows, points_at
from app.model.part import Contour
from app.raster.border import borders_of
from app.raster.frame import BitmapFrame
from tests.raster.oracle import even_odd


def traces(frame: BitmapFrame, contours: list[Contour]) -> list[np.ndarray]:
    """The chains of pixels whose centres lie inside, as points in mm; the longest first."""
    chains = sorted(
        (border.chain for border in borders_of(even_odd(frame, contours))), key=lambda chain: -len(chain.directions)
    )
    return [
        np.ascontiguousarray(frame.to_mm(chain.pixels()[:-1, ::-1] + 0.5)) for chain in chains if len(chain.directions)
    ]


def sampled(contour: Contour, step: float) -> np.ndarray:
    """Points exactly on a contour, about a step apart, its joints among them."""
    rows = contour_rows(contour)
    points = [
        points_at(np.repeat(row[None], n, axis=0), np.arange(n) / n)
        for row, n in ((row, max(2, round(float(length(row)) / step))) for row in rows)
    ]
    return np.ascontiguousarray(np.concatenate(points))


def length(row: np.ndarray) -> float:
    chord = math.hypot(row[2] - row[0], row[3] - row[1])
    return chord if row[7] == 0 else 2 * row[6] * math.asin(min(1.0, chord / 2 / row[6]))


def wavy(count: int = 6000) -> Contour:
    """A closed border of many waves, some 1400 mm long."""
    t = np.linspace(0, math.tau, count, endpoint=False)
    r = 40 + 5.5 * np.sin(60 * t) + 1.5 * np.sin(7 * t)
    return polygon_contour(list(zip((50 + r * np.cos(t)).tolist(), (50 + r * np.sin(t)).tolist(), strict=True)))
