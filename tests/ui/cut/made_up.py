"""A cut that a few lines of numpy can make: sweeps of ball and flat tools over a box, with everything the view can
show.
"""

from __future__ import annotations

import numpy as np

from app.ui.views.cut.cut_picture import CutMoves, CutPaths, CutPicture
from app.ui.views.nc.motion_shapes import MotionLineStyle

SIDE = 100.0
FLOOR, TOP = -20.0, 0.0


def swept(heights, move, places, tip, number):
    """Lower heights to those of a straight sweep; the last cutter of a cell is noted.

    Args:
        heights, move: (n, n), changed in place. places: (start, end), each (3,).
        tip: height of the tool's surface over its tip at a distance from its axis. number: of the move.
    """
    n = len(heights)
    w = SIDE / n
    (x0, y0, z0), (x1, y1, z1) = places
    reach = tip.radius + w
    columns = slice(max(0, int((min(x0, x1) - reach) / w)), min(n, int((max(x0, x1) + reach) / w) + 1))
    rows = slice(max(0, int((min(y0, y1) - reach) / w)), min(n, int((max(y0, y1) + reach) / w) + 1))
    x, y = (np.arange(columns.start, columns.stop) + 0.5) * w, ((np.arange(rows.start, rows.stop) + 0.5) * w)[:, None]
    length2 = (x1 - x0) ** 2 + (y1 - y0) ** 2
    t = np.clip(((x - x0) * (x1 - x0) + (y - y0) * (y1 - y0)) / length2, 0, 1) if length2 else 0.0 * x + 0.0 * y
    radius = np.hypot(x - x0 - t * (x1 - x0), y - y0 - t * (y1 - y0))
    cut = (z0 + t * (z1 - z0) + tip(radius)).astype(np.float32)
    part = heights[rows, columns]
    deeper = cut < part - 1e-7
    part[deeper] = cut[deeper]
    move[rows, columns][deeper] = number


class Ball:
    def __init__(self, radius):
        self.radius = radius

    def __call__(self, rho):
        inside = np.maximum(self.radius**2 - rho**2, 0.0)
        return np.where(rho <= self.radius, self.radius - np.sqrt(inside), np.inf)


class Flat(Ball):
    def __call__(self, rho):
        return np.where(rho <= self.radius, 0.0, np.inf)


def program():
    """Rows of (start, end, look, tool): a dished square by a ball, a ring by a flat tool, a slot that ends too deep."""
    rows, at = [], (0.0, 0.0, 5.0)

    def go(place, look, tool):
        nonlocal at
        rows.append((at, place, look, tool))
        at = place

    def dish(x, y):
        return -9.0 + 6.0 * ((x - 34) ** 2 + (y - 50) ** 2) / 30**2

    xs = np.linspace(12, 56, 45)
    for k, y in enumerate(np.arange(20, 80.1, 1.6)):
        line = xs if k % 2 == 0 else xs[::-1]
        places = [(float(x), float(y), float(min(dish(x, y), -0.8))) for x in line]
        if k == 0:
            go((*places[0][:2], 5.0), MotionLineStyle.RAPID, 1)
            go(places[0], MotionLineStyle.PLUNGE, 1)
        for place in places:
            go(place, MotionLineStyle.CUT, 1)
    go((*at[:2], 5.0), MotionLineStyle.RAPID, 1)
    for radius, depth in ((14.0, -4.0), (10.0, -4.0), (6.0, -4.0), (14.0, -7.0)):
        ring = [(78 + radius * np.cos(a), 32 + radius * np.sin(a), depth) for a in np.linspace(0, 2 * np.pi, 73)]
        look = MotionLineStyle.CONTOUR if radius == 14 else MotionLineStyle.CUT
        go((*ring[0][:2], 5.0), MotionLineStyle.RAPID, 2)
        go(ring[0], MotionLineStyle.PLUNGE, 2)
        for place in ring[1:]:
            go(place, look, 2)
        go((*at[:2], 5.0), MotionLineStyle.RAPID, 2)
    go((66.0, 66.0, 5.0), MotionLineStyle.RAPID, 3)
    go((66.0, 66.0, -3.0), MotionLineStyle.PLUNGE, 3)
    for place in ((92.0, 66.0, -3.0), (92.0, 88.0, -3.0), (66.0, 88.0, -5.0), (66.0, 66.0, -3.0)):
        go(place, MotionLineStyle.CONTOUR, 3)
    go((66.0, 66.0, 5.0), MotionLineStyle.RAPID, 3)
    return rows


def made_up(n=1024):
    """Return the picture of it on n x n cells."""
    tips = {1: Ball(3.0), 2: Flat(2.0), 3: Ball(2.0)}
    heights, move = np.full((n, n), TOP, np.float32), np.full((n, n), -1, np.int32)
    rows = program()
    for number, (start, end, look, tool) in enumerate(rows):
        if look != MotionLineStyle.RAPID:
            swept(heights, move, (start, end), tips[tool], number)
    starts, ends = (np.array([row[k] for row in rows], float) for k in (0, 1))
    looks, tools = np.array([row[2] for row in rows], np.uint8), np.array([row[3] for row in rows], np.int32)
    ripple = np.float32(0.02) * np.sin(np.arange(n, dtype=np.float32) / n * 40)
    deviation = np.where(move < 0, np.float32(0.0), ripple + np.zeros((n, 1), np.float32))
    deviation[(move >= 0) & (heights < -6.5)] = -0.3
    deviation[(heights > -1.5) & (move >= 0)] = 1.2
    return CutPicture(
        heights,
        0.0,
        0.0,
        SIDE / n,
        FLOOR,
        TOP,
        move,
        CutMoves(np.arange(12, 12 + len(rows), dtype=np.int32), tools, tools - 1),
        deviation.astype(np.float32),
        0.01,
        (heights > -0.9) & (move >= 0),
        CutPaths(starts, ends, looks),
    )
