"""Whole peelings, as the stages do them peel by peel."""

from app.bitmap.peel import correct_by_circles, peels
from app.bitmap.walls import Mask


def peeled(area: Mask, count: int) -> Mask:
    """What is left after some peels (steps 301-305)."""
    return [area, *(left for left, _ in peels(area, count))][-1]


def shrink(area: Mask, radius: float) -> Mask:
    """What is left after as many peels as a radius has pixels, and the circles (steps 301-307)."""
    return correct_by_circles(peeled(area, int(radius)), area, radius)
