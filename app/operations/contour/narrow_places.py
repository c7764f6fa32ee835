"""Where a cutter does not fit along the walls that it should follow: gaps, slots and necks that are too narrow, and
clamps.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely

from ...geometry.distance import DistanceField
from ...geometry.primitives import boxes, contour_rows, sample
from ...model.finding import Finding, FindingKind
from ...model.part import Contour, Region
from ...model.tool import Tool
from ...toolpath.coverage.areas import region_shapes
from ...toolpath.leads.contour_path import ContourPath, Floats, left_of
from ...toolpath.machining_areas import MachiningArea
from ...toolpath.narrow_regions import ToolRoom
from .gaps import WallGap

_DEPTH = 0.01
"""mm; a place that is no deeper than this beyond the cutter's rim is no slot."""

_TELL = 50
"""Places that are told one by one; the rest is counted."""

_PARTS = np.linspace(0.25, 0.75, 5)
"""Of a wall that is not reached: where it is measured how wide the place is."""

_CORNER = 0.1
"""Of the cutter's distance; a disc smaller than this is in a corner."""

_TOUCH = 1e-3
"""mm; a wall this near to a disc's rim is touched by it."""

_CHORD = 1e-2
"""mm; only how much of the walls clamps lie over depends on it."""


@dataclass(frozen=True)
class NarrowPlace:
    """A place that is too narrow for a cutter.

    Attributes:
        x, y: its middle, mm.
        width: of what would fit, about, mm.
        gap: the wall that is not reached.
        clamped: True when a clamp makes it so narrow.
    """

    x: float
    y: float
    width: float
    gap: WallGap
    clamped: bool


def narrow_places(found: Sequence[WallGap], area: MachiningArea, distance: float) -> list[NarrowPlace]:
    """Return the places where a cutter whose centre keeps `distance` mm from the walls does not fit in; inner corners
    are none.

    Walls that face each other are one place.
    """
    bare = DistanceField.of(area.distances.rows[area.bare]) if area.bare.any() else None
    tight = [gap for gap in found if not gap.is_corner and not _is_shallow(gap, distance)]
    places = []
    for gap, (x, y, radius) in zip(tight, _free_discs(tight, area.distances, distance), strict=True):
        if radius > distance - _TOUCH:  # as wide as the cutter, which so has been there
            continue
        clamped = gap.bare or (bare is not None and float(bare.nearest(np.array([[x, y]]))[0][0]) <= radius + _TOUCH)
        places.append(NarrowPlace(x, y, 2 * radius, gap, clamped))
    return _once(places)


def _is_shallow(gap: WallGap, distance: float) -> bool:
    if gap.corner is None:
        return False
    points = np.concatenate([gap.rows[:, :2], ContourPath(gap.rows, False).points(np.linspace(0, gap.length, 17))])
    return float(np.hypot(*(points - np.array(gap.corner)).T).max()) - distance < _DEPTH


def _free_discs(found: Sequence[WallGap], field: DistanceField, most: float) -> list[tuple[float, float, float]]:
    """Return for each gap (x, y, radius) of a disc that touches its wall in its middle half: the largest, of necks the
    smallest.
    """
    if not found:
        return []
    paths = [ContourPath(gap.rows, False) for gap in found]
    parts = [_PARTS * path.length for path in paths]
    points = np.concatenate([path.points(where) for path, where in zip(paths, parts, strict=True)])
    aside = left_of(np.concatenate([path.headings(where) for path, where in zip(paths, parts, strict=True)]))
    low, high = np.zeros(len(points)), np.full(len(points), most)
    for _ in range(30):
        radius = (low + high) / 2
        fits = field.nearest(points + aside * radius[:, None])[0] >= radius - 1e-6
        low, high = np.where(fits, radius, low), np.where(fits, high, radius)
    size = low.reshape(len(found), -1) - 1e-6 * np.abs(_PARTS - 0.5)  # of as large ones the one in the middle
    # a neck is as wide as it is at its narrowest; corners are no part of it
    open_ended = np.array([[gap.corner is None] for gap in found])
    size = np.where(
        open_ended & (size > _CORNER * most), -size - 2e-6 * np.abs(_PARTS - 0.5), np.where(open_ended, -np.inf, size)
    )
    best = np.argmax(size, axis=1)
    chosen = np.arange(len(found)) * len(_PARTS) + best
    centres = points[chosen] + aside[chosen] * low[chosen, None]
    return [(float(x), float(y), float(radius)) for (x, y), radius in zip(centres, low[chosen], strict=True)]


def _once(places: Sequence[NarrowPlace]) -> list[NarrowPlace]:
    """Return the places without those that are another one seen from the wall that faces it."""
    if len(places) < 2:
        return list(places)
    owner = np.repeat(np.arange(len(places)), [len(place.gap.rows) for place in places])
    rows = np.concatenate([place.gap.rows for place in places])
    around = shapely.STRtree(shapely.box(*boxes(rows).T))
    kept: dict[int, NarrowPlace] = {}
    for k, place in enumerate(places):
        reach = place.width / 2 + _TOUCH
        near = around.query(shapely.box(place.x - reach, place.y - reach, place.x + reach, place.y + reach))
        near = near[np.isin(owner[near], list(kept))]
        if not len(near) or DistanceField.of(rows[near]).nearest(np.array([[place.x, place.y]]))[0][0] > reach:
            kept[k] = place
    return list(kept.values())


def narrow_place_findings(places: Sequence[NarrowPlace], tool: Tool, distance: float, counts: bool) -> list[Finding]:
    """Return a finding for each place that is too narrow for a cutter.

    Args:
        distance: of the cutter's centre from the walls, mm.
        counts: True when nothing else tells of the metal that is left.
    """
    need = ToolRoom(tool, 2 * distance).text
    own = [place for place in places if not place.clamped]
    findings = []
    for place in own[:_TELL]:
        text = (
            f"Region {place.gap.region} has a {'neck' if place.gap.corner is None else 'slot'} at ({place.x:.3f}, "
            f"{place.y:.3f}), about {place.width:.3f} mm wide; {need}. {place.gap.length:.2f} mm of wall are not "
            "reached."
        )
        findings.append(Finding(FindingKind.NECK_TOO_NARROW, text, place.x, place.y, counts, amount=place.width))
    if len(own) > _TELL:
        more = (
            "1 more place along the walls is"
            if len(own) == _TELL + 1
            else f"{len(own) - _TELL} more places along the walls are"
        )
        findings.append(
            Finding(
                FindingKind.NECK_TOO_NARROW,
                f"{more} too narrow; {need}.",
                own[_TELL].x,
                own[_TELL].y,
                counts,
                amount=float(len(own) - _TELL),
            )
        )
    return findings


def clamp_findings(
    places: Sequence[NarrowPlace], walls: Sequence[Contour], clamps: Sequence[Region], tool: Tool
) -> list[Finding]:
    """Return a finding for each clamp that keeps a cutter off walls: those that it lies over, and those beside it that
    are not reached.

    Args:
        walls: contours as they are drawn.
    """
    if not clamps:
        return []
    shapes = [shapely.union_all(region_shapes([clamp], _CHORD)) for clamp in clamps]
    lost = [_under(shape, walls) for shape in shapes]
    for place in places:
        if place.clamped:
            k = int(np.argmin([shapely.distance(shape, shapely.Point(place.x, place.y)) for shape in shapes]))
            length, at = lost[k]
            lost[k] = length + place.gap.length, at or (place.x, place.y)
    return [
        Finding(
            FindingKind.LEFT_OUT,
            f"A keep-out area at ({at[0]:.3f}, {at[1]:.3f}) keeps T{tool.number} {tool.label} off about "
            f"{length:.2f} mm of the walls; move the clamp and cut the rest.",
            *at,
            amount=length,
        )
        for length, at in lost
        if at is not None and length > _DEPTH
    ]


def _under(shape: shapely.Geometry, walls: Sequence[Contour]) -> tuple[float, tuple[float, float] | None]:
    """Return (mm of walls under a clamp, a place of them)."""
    shapely.prepare(shape)
    lines = [shapely.LineString(points) for points in map(_closed_points, walls) if len(points) > 1]
    parts = [part for part in shapely.intersection(np.array(lines, dtype=object), shape) if shapely.length(part) > 0]
    if not parts:
        return 0.0, None
    place = shapely.line_interpolate_point(
        shapely.get_parts(shapely.line_merge(max(parts, key=shapely.length)))[0], 0.5, normalized=True
    )
    return float(sum(shapely.length(part) for part in parts)), (float(place.x), float(place.y))


def _closed_points(contour: Contour) -> Floats:
    rows = contour_rows(contour)
    return np.concatenate([sample(rows, _CHORD), rows[-1:, 2:4]])
