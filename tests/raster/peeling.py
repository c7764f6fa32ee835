"""Whole peelings, as the stages do them peel by peel."""

from app.raster.peel import Floats, correct_by_circles, distance_px, frame_pixels, peels
from app.raster.walls import Mask


def peeled(area: Mask, count: int) -> Mask:
    """What is left after some peels (steps 301-305)."""
    return [area, *(left for left, _ in peels(area, count))][-1]


def shrink(area: Mask, radius: float) -> Mask:
    """What is left after as many peels as a radius has pixels, and the circles (steps 301-307)."""
    return correct_by_circles(peeled(area, int(radius)), area, radius)


def frame_distance(area: Mask) -> Floats:
    """Return the distance of every pixel of A' from the nearest pixel of its frame, px: the one field that all rings
    are levels of.

    The frame's pixels are the contour tool's path itself. -1 outside of the area.
    """
    distance = distance_px(area, frame_pixels(area))
    distance[~area] = -1
    return distance
