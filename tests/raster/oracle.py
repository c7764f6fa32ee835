"""Even-odd at every pixel centre in float64, by another way than the program's: chord polygons, and discs cut by
chords.
"""

import math

import numpy as np
from numpy.typing import NDArray

from app.model.curves import Arc, Circle, Line, Primitive
from app.model.part import Contour
from app.raster.frame import BitmapFrame, Codes, PixelCode

Mask = NDArray[np.bool_]


def even_odd(frame: BitmapFrame, contours: list[Contour]) -> Mask:
    """Return (rows, cols): the pixel centre is inside an odd number of times."""
    x = frame.x0 + (np.arange(frame.cols) + 0.5) * frame.pitch
    y = frame.y0 + (frame.rows - np.arange(frame.rows) - 0.5) * frame.pitch
    inside = np.zeros((frame.rows, frame.cols), bool)
    for contour in contours:
        for curve in [piece for primitive in contour.primitives for piece in pieces(primitive)]:
            if not isinstance(curve, Circle):
                flip_right_of_chord(inside, x, y, curve)
            if not isinstance(curve, Line):
                inside ^= between_arc_and_chord(x[None, :], y[:, None], curve)
    return inside


def pieces(curve: Primitive) -> tuple[Primitive, ...]:
    """Cut an arc at an odd place, so that its chords pass through no pixel centre by design."""
    if not isinstance(curve, Arc):
        return (curve,)
    angle = curve.start_angle + 0.3719 * curve.sweep
    cut = (curve.centre[0] + curve.radius * math.cos(angle), curve.centre[1] + curve.radius * math.sin(angle))
    return (Arc(curve.start, cut, curve.centre, curve.ccw), Arc(cut, curve.end, curve.centre, curve.ccw))


def flip_right_of_chord(inside: Mask, x: NDArray[np.float64], y: NDArray[np.float64], chord: Line | Arc) -> None:
    (ax, ay), (bx, by) = sorted((chord.start, chord.end), key=lambda p: p[1])
    rows = np.flatnonzero((ay <= y) & (y < by))
    crossing = ax + (y[rows] - ay) * (bx - ax) / (by - ay) if len(rows) else np.zeros(0)
    inside[rows] ^= crossing[:, None] < x[None, :]


def between_arc_and_chord(x: NDArray[np.float64], y: NDArray[np.float64], curve: Arc | Circle) -> Mask:
    disc = (x - curve.centre[0]) ** 2 + (y - curve.centre[1]) ** 2 < curve.radius**2
    if isinstance(curve, Circle):
        return disc
    (ax, ay), (bx, by) = curve.start, curve.end
    side = (bx - ax) * (y - ay) - (by - ay) * (x - ax)
    return disc & ((side < 0) if curve.ccw else (side > 0))


def distance(curve: Primitive, x: float, y: float) -> float:
    """Distance of a point from a curve, mm."""
    if isinstance(curve, Line):
        (ax, ay), (bx, by) = curve.start, curve.end
        t = ((x - ax) * (bx - ax) + (y - ay) * (by - ay)) / math.dist(curve.start, curve.end) ** 2
        t = min(max(t, 0.0), 1.0)
        return math.hypot(x - ax - t * (bx - ax), y - ay - t * (by - ay))
    to_circle = abs(math.dist((x, y), curve.centre) - curve.radius)
    if isinstance(curve, Circle):
        return to_circle
    ahead = (math.atan2(y - curve.centre[1], x - curve.centre[0]) - curve.start_angle) % math.tau
    within = ahead <= curve.sweep if curve.ccw else math.tau - ahead <= -curve.sweep
    return to_circle if within else min(math.dist((x, y), curve.start), math.dist((x, y), curve.end))


def wrong_pixels(codes: Codes, contours: list[Contour]) -> list[tuple[int, int]]:
    """Return the pixels that are no contour pixels, whose centre is on no edge, and that are filled wrongly."""
    contour = (codes.plane == PixelCode.TRACED) | (codes.plane == PixelCode.R)
    doubtful = np.argwhere(~contour & (codes.filled != even_odd(codes.frame, contours)))
    x, y = codes.frame.centres()
    curves = [curve for each in contours for curve in each.primitives]
    return [(r, c) for r, c in doubtful.tolist() if min(distance(curve, x[c], y[r]) for curve in curves) > 1e-9]


def strangers(codes: Codes, contours: list[Contour]) -> list[tuple[int, int]]:
    """Return the contour pixels through whose square no contour can pass."""
    x, y = codes.frame.centres()
    reach = codes.frame.pitch * math.sqrt(0.5) + 1e-9
    curves = [curve for each in contours for curve in each.primitives]
    drawn = np.argwhere((codes.plane == PixelCode.TRACED) | (codes.plane == PixelCode.R))
    return [(r, c) for r, c in drawn.tolist() if min(distance(curve, x[c], y[r]) for curve in curves) > reach]
