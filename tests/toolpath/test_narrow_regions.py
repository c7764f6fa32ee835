"""The largest disc of each of many regions."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from app.model.curves import Arc, Line, Point, Primitive
from app.model.part import Contour, Region
from app.toolpath.narrow_regions import largest_discs

Loop = tuple[Primitive, ...]


def loop(*corners: Point) -> Loop:
    return tuple(Line(a, b) for a, b in pairwise((*corners, corners[0])))


def box(x: float, y: float, width: float, height: float) -> Loop:
    return loop((x, y), (x + width, y), (x + width, y + height), (x, y + height))


def half_disc(x: float, y: float) -> Loop:
    return (Line((x - 3, y), (x + 3, y)), Arc((x + 3, y), (x - 3, y), (x, y), True))


def region(number: int, boundary: Loop, *islands: Loop) -> Region:
    return Region(number, Contour(boundary), tuple(Contour(each) for each in islands))


def test_regions_that_are_alike_have_one_disc_each_in_its_place() -> None:
    """Two slots 4 mm wide, one with an island, one a little narrower, and half discs among them."""
    island = loop((2.0, 1.5), (2.0, 2.5), (6.0, 2.5), (6.0, 1.5))
    regions = [
        region(1, box(0, 0, 10, 4)),
        region(2, half_disc(5.3, 41.7)),
        region(3, box(100.1, 30.7, 10, 4)),
        region(4, box(0, 20, 10, 4), island),
        region(5, box(50, 20, 10, 3.99)),
        region(6, half_disc(-7.1, -0.3)),
    ]
    discs = largest_discs(regions)
    assert np.abs(discs[:, 2] - [4, 3, 4, discs[3, 2], 3.99, 3]).max() < 0.005
    corners = np.array([each.boundary.primitives[0].start for each in regions])
    about = discs[:, :2] - corners
    assert np.abs(about[[0, 1]] - about[[2, 5]]).max() < 1e-9  # a slot holds many as large: it is the same one
    for each, disc in zip(regions, discs, strict=True):
        assert np.abs(largest_discs([each])[0] - disc).max() < 1e-9
