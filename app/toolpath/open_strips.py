"""Areas beside open lines, on one side of them: what a cutter machines whose edge is no closed contour.

Such an area is what lies within reach of a line, without what lies on its other side: past the line's ends it turns
round them, where nothing is known of an edge, so that a cutter may go on as far as the end.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import shapely
import shapely.ops
from numpy.typing import NDArray

from ..core.errors import GeometryError
from ..core.tolerances import WELD
from ..core.wording import in_plane
from ..geometry.primitives import contour_rows, sample
from ..model.curves import Line, Primitive, reversed_curve
from ..model.operation import SideStrip
from ..model.part import Contour
from .leads.contour_path import headings_at

Floats = NDArray[np.float64]

_CHORD = 1e-3
"""mm; only what is far from the line depends on it."""

_QUARTER = 8
"""Chords of a quarter turn round the ends of lines."""


class StripsBesideLines(NamedTuple):
    """Closed contours of the areas, and of what of them no line bounds."""

    contours: list[Contour]
    bare: list[Contour]


def strips(lines: Sequence[Contour], strip: SideStrip) -> StripsBesideLines:
    """Return the areas beside open lines.

    Raises:
        GeometryError: a line comes back to itself, or another one comes near, within reach.
    """
    made = [_strip(line, strip) for line in lines]
    shapes = [shapely.Polygon(sample(contour_rows(each.contours[0]), _CHORD)) for each in made]
    _check_apart(shapes, lines, strip)
    return StripsBesideLines([each.contours[0] for each in made], [bare for each in made for bare in each.bare])


def _check_apart(shapes: Sequence[shapely.Polygon], lines: Sequence[Contour], strip: SideStrip) -> None:
    """Refuse areas that meet: each is judged by its own line."""
    if len(shapes) < 2:
        return
    one, other = shapely.STRtree(shapes).query(shapes, predicate="intersects")
    for k, j in zip(one.tolist(), other.tolist(), strict=True):
        if k < j:
            raise _too_near(lines[k], strip, "another open line of the same operation")


def _strip(line: Contour, strip: SideStrip) -> StripsBesideLines:
    """Return the area on the left of a line, as it is drawn, or on its right."""
    way: tuple[Primitive, ...] = line.primitives
    if not strip.left:
        way = tuple(reversed_curve(each) for each in reversed(way))  # type: ignore[misc]  # they stay primitives
    rows = contour_rows(replace(line, primitives=way))
    points = np.concatenate([sample(rows, _CHORD), rows[-1:, 2:4]])
    ahead = headings_at(rows[[0, -1]], np.array([0.0, 1.0]))
    right = np.column_stack([ahead[:, 1], -ahead[:, 0]])
    first, last = points[[0, -1]] + 2 * strip.reach * right
    across = shapely.LineString([first, *points, last])
    around = shapely.buffer(shapely.LineString(points), strip.reach, quad_segs=_QUARTER)
    sides = shapely.get_parts(shapely.ops.split(around, across)) if across.is_simple else ()
    rest = next(_beyond(sides, points), None)
    if len(sides) != 2 or rest is None:
        raise _too_near(line, strip, "itself")
    ends = _welded(np.array([points[-1], *rest, points[0]]))
    back = tuple(Line(tuple(a), tuple(b)) for a, b in pairwise(ends.tolist()))
    bounds = replace(line, primitives=(*way, *back), closed=True)
    return StripsBesideLines([bounds], [Contour(back, False)])


def _welded(points: Floats) -> Floats:
    """Return points (n, 2) without those that are one with the point before or with the last: where the ways across
    meet corners of the round ends, two may lie 1e-16 mm apart, and lines shorter than `WELD` are none.
    """
    kept = [points[0]]
    for point in points[1:-1]:
        if min(np.hypot(*(point - kept[-1])), np.hypot(*(point - points[-1]))) > WELD:
            kept.append(point)
    return np.array([*kept, points[-1]])


def _beyond(sides: Sequence[shapely.Polygon], points: Floats) -> Iterator[Floats]:
    """Yield the corners, after the last point of a way and before its first, of shapes that have it on their bounds and
    lie on its left.
    """
    for side in sides:
        corners = shapely.get_coordinates(shapely.geometry.polygon.orient(side).exterior)[:-1]
        found = np.flatnonzero((corners == points[0]).all(axis=1))
        if len(found) == 1 and not len(side.interiors):
            turned = np.roll(corners, -int(found[0]), axis=0)
            if len(turned) > len(points) and np.array_equal(turned[: len(points)], points):
                yield turned[len(points) :]


def _too_near(line: Contour, strip: SideStrip, what: str) -> GeometryError:
    x, y = line.primitives[0].start
    return GeometryError(
        f"The open line that begins at {in_plane(x, y)} comes within {strip.reach:.3f} mm of {what}, so its edge "
        "cannot be told from that; close the line, or give each an operation of its own."
    )
