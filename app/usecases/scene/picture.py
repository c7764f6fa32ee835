"""A computed scene as what a window paints: triangles of its surfaces, and moves as lines by what they are for."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ...model.moves import Purpose
from ...model.tool import Tool
from ...surfaces.cutter_contact.drop_cutter import shape_of
from ...surfaces.cutter_contact.scene_facets import scene_facets
from ...surfaces.sections.compound import BoundaryKind
from .compute import ComputedScene
from .lines import BoundaryPoint, LineRole, SceneLines
from .plot import boundary_name

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
_SHARE, _FINEST, _FEW = 4e-5, 1e-3, 200_000
"""Of the surfaces' extent, how far triangles that are looked at are off; the least, mm; and so many are still drawn
quickly.
"""
_COARSER = 4.0
"""Times the tolerance of the paths: fine enough to be looked at."""


_ROLES = {Purpose.CONTOUR: LineRole.PATH, Purpose.LINK: LineRole.LINK, Purpose.PLUNGE: LineRole.PLUNGE}


def move_lines(computed: ComputedScene) -> Iterator[SceneLines]:
    """Yield all moves but the first, since nobody knows where the tool stands before it: by role, surface and tool."""
    moves, surface = computed.moves.moves, computed.moves.surface
    start, end = moves.start, moves.end
    role = np.array(
        [list(LineRole).index(_ROLES.get(Purpose(value), LineRole.RAPID)) for value in range(len(Purpose))]
    )[moves.purpose]
    keys = np.stack([role, surface, moves.tool.astype(np.int64)], axis=1)
    known = np.isfinite(start).all(axis=1) & np.isfinite(end).all(axis=1)
    for key in sorted(set(map(tuple, keys[known].tolist()))):
        rows = np.flatnonzero(known & (keys == key).all(axis=1))
        first = np.append(True, np.diff(rows) != 1)
        at = np.arange(len(rows)) + np.cumsum(first)
        points, joined = np.empty((len(rows) + int(first.sum()), 3)), np.zeros(len(rows) + int(first.sum()), np.bool_)
        points[at], points[at[first] - 1] = end[rows], start[rows[first]]
        joined[at - 1] = True
        yield SceneLines(list(LineRole)[key[0]], points, joined, key[1], key[2])


def boundary_points(computed: ComputedScene) -> tuple[BoundaryPoint, ...]:
    """Return the boundary points of the compound surface, family by family, as its sections mark them."""
    rows, first = [], 0
    for family in computed.families:
        found = family.surface.boundaries
        for k in np.flatnonzero((found.before >= 0) & (found.after >= 0)).tolist():
            name = boundary_name(int(found.before[k]), int(found.after[k]))
            rows.append(
                BoundaryPoint(
                    name, first + int(found.plane[k]), found.place[k], BoundaryKind(int(found.kind[k])).name.lower()
                )
            )
        first += len(family.planes.offsets)
    return tuple(rows)


def outline(tool: Tool) -> Floats:
    """Return a tool's lower side (k, 2), mm from its tip: out from the axis and up; and on along its side as far as it
    is wide.
    """
    disc, corner, cone, radius, bend = shape_of(tool).tolist()
    turn = np.linspace(0.0, 1.0, 25)
    reach = math.asin(min((bend - disc) / corner, 1.0)) if corner > 0 else 0.0
    rows = [(0.0, 0.0), (disc, 0.0)]
    rows += (
        [(disc + corner * math.sin(reach * share), corner * (1 - math.cos(reach * share))) for share in turn[1:]]
        if corner > 0
        else []
    )
    if cone > 0 and radius > bend:
        rows.append((radius, rows[-1][1] + cone * (radius - bend)))
    rows.append((radius, rows[-1][1] + 2 * tool.radius))
    return np.array(rows)


def looked_at(computed: ComputedScene) -> tuple[Floats, Ints]:
    """Return triangles (n, 3, 3), mm, of the surfaces that are shown, and whose each is, (n,)."""
    built = [replace(each, surface=replace(each.surface, enabled=each.surface.visible)) for each in computed.built]
    if not any(each.surface.visible for each in built):
        return np.zeros((0, 3, 3)), np.zeros(0, np.int64)
    corners = computed.facets.facets.triangles.reshape(-1, 3)
    near = max(_SHARE * float(np.ptp(corners, axis=0).max()), _FINEST)
    facets = scene_facets(built, near * _COARSER).facets
    finer = 4.0 * len(facets)
    if finer <= _FEW:
        facets = scene_facets(built, near).facets
    return np.ascontiguousarray(facets.triangles), np.ascontiguousarray(facets.owner)
