"""Where a tool does not fit: regions too small for it, and necks that part a region for it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely

from app.geometry.distance import DistanceField
from app.geometry.offset import Level, Ring
from app.geometry.primitives import contour_rows, sample
from app.model.finding import Finding, FindingKind
from app.model.part import Region
from app.model.tool import Tool

_CHORD = 1e-3


@dataclass(frozen=True)
class Need:
    """The room that a tool needs.

    Attributes:
        tool: the tool.
        width: of a gap that it can pass, mm: for a pocket tool, its diameter and what the contour tool takes along both walls.
    """

    tool: Tool
    width: float

    @property
    def text(self) -> str:
        """Who needs how much."""
        why = "" if self.width < self.tool.diameter + 1e-6 else ": its diameter, and the strip that it leaves along each wall"
        return f"T{self.tool.number} {self.tool.label} needs {self.width:.3f} mm{why}"


def too_small(regions: Sequence[Region], level: Level, tool: Tool, counts: bool) -> list[Finding]:
    """Return a finding for each region in which a tool has no room at all.

    Args:
        level: the rings of the tool's centre.
        counts: True when nothing else of the job machines such a region.
    """
    reached = {ring.region for ring in level.rings}
    need = Need(tool, 2 * level.distance)
    findings = []
    for region in regions:
        if region.number in reached:
            continue
        x, y, diameter = largest_disc(region)
        text = (f"Region {region.number} at ({x:.3f}, {y:.3f}) is too small: its largest disc is about {diameter:.2f} mm, "
                f"and {need.text}. Use a smaller tool for it.")
        findings.append(Finding(FindingKind.REGION_TOO_SMALL, text, x, y, counts, amount=diameter,
                                entity_ids=region.boundary.entity_ids))
    return findings


def largest_disc(region: Region) -> tuple[float, float, float]:
    """Return (x, y, diameter), mm, of the largest disc in a region, within 0.005 mm."""
    outline, *holes = (sample(contour_rows(contour), _CHORD) for contour in region.contours)
    polygon = shapely.Polygon()
    if len(outline) > 2:
        polygon = shapely.make_valid(shapely.Polygon(outline, [hole for hole in holes if len(hole) > 2]))
    if polygon.area <= 0:
        return float(outline[0, 0]), float(outline[0, 1]), 0.0
    radius = shapely.maximum_inscribed_circle(polygon, tolerance=_CHORD)
    (x, y), _ = shapely.get_coordinates(radius)
    return float(x), float(y), 2 * float(radius.length)


def necks(level: Level, field: DistanceField, tool: Tool) -> list[Finding]:
    """Return a finding for each place where a region falls into parts because the tool does not fit through.

    The place is the narrowest one on the straight way between two parts, moved across the way to where there is most room.
    """
    need = Need(tool, 2 * level.distance)
    findings = []
    for number in dict.fromkeys(ring.region for ring in level.rings):
        parts = [_polygon(ring) for ring in level.rings if ring.region == number and ring.area > 0]
        for a, b in _nearest_pairs(parts):
            (x, y), room = _narrowest(a, b, field)
            text = f"Region {number} has a neck at ({x:.3f}, {y:.3f}), about {2 * room:.2f} mm wide; {need.text}."
            findings.append(Finding(FindingKind.NECK_TOO_NARROW, text, float(x), float(y), counts=False, amount=2 * room))
    return findings


def _narrowest(a: np.ndarray, b: np.ndarray, field: DistanceField) -> tuple[np.ndarray, float]:
    """Return (place, distance from the drawing) of the neck between two points."""
    way = np.linspace(a, b, 65)
    place = way[int(np.argmin(field.nearest(way)[0]))]
    along = (b - a) / max(float(np.hypot(*(b - a))), 1e-9)
    across = np.array([-along[1], along[0]])
    reach = float(field.nearest(place[None])[0][0])
    for _ in range(6):  # ever finer steps across the way, towards more room
        places = place + across * np.linspace(-reach, reach, 33)[:, None]
        room = field.nearest(places)[0]
        place, reach = places[int(np.argmax(room))], reach / 8
    return place, float(room.max())


def _polygon(ring: Ring) -> shapely.Polygon:
    return shapely.Polygon(sample(ring.rows, _CHORD)) if len(ring.rows) > 2 else shapely.Point(ring.rows[0, :2]).buffer(1e-6)


def _nearest_pairs(parts: Sequence[shapely.Polygon]) -> list[tuple[np.ndarray, np.ndarray]]:
    """Return the ends of the shortest ways that join all parts, one less than there are parts."""
    joined, rest = list(parts[:1]), list(parts[1:])
    pairs = []
    while rest:
        tree = shapely.STRtree(joined)
        (own, other), distance = tree.query_nearest(rest, return_distance=True, all_matches=False)
        k = int(np.argmin(distance))
        part = rest.pop(int(own[k]))
        pairs.append(tuple(shapely.get_coordinates(shapely.shortest_line(part, joined[int(other[k])]))))
        joined.append(part)
    return pairs
