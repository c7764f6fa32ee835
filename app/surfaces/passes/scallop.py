"""How far apart passes may be for ridges of a given height."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ...core.errors import ParameterError
from ...model.tool import Tool
from ..patches.facets import SurfaceFacets
from ..sections.compound import CuttingPlanes
from ..sections.planes import MOST_PLANES, extent_on

Floats = NDArray[np.float64]

_STEEPEST = math.tan(math.radians(75.0))
"""Steeper parts do not count: passes along them never come near enough together."""


def stepover_for_scallop(ball_radius: float, scallop_height: float) -> float:
    """Return the stepover that leaves ridges of a given height on a flat floor.

    Neighbouring passes of a ball-nose cutter leave a ridge whose crest is where their circles meet. Exact on a flat;
    along a slope across the passes that is their distance on the slope.

    Args:
        ball_radius: of the cutter's corner, mm, > 0.
        scallop_height: of the ridges above the floor, mm, in (0, ball_radius].

    Returns:
        Distance between passes, mm, in (0, 2 ball_radius].

    Raises:
        ParameterError: the scallop height is out of its range.

    References:
        Half-stepover right triangle: r^2 = (r - h)^2 + (s / 2)^2.
    """
    if not 0 < scallop_height <= ball_radius:
        raise ParameterError(
            f"The scallop height is {scallop_height:g} mm; it must be greater than 0 and not more than the radius of "
            f"the cutter's corner, {ball_radius:g} mm."
        )
    return 2 * math.sqrt(scallop_height * (2 * ball_radius - scallop_height))


def corner_radius(tool: Tool) -> float:
    """Return the radius of what a tool's ridges are rounded by, mm.

    Raises:
        ParameterError: it has none.
    """
    radius = tool.profile.fillet
    if not radius > 0:
        raise ParameterError(
            f"T{tool.number} is a {tool.kind.value} tool, whose ridges no scallop height describes; give a pitch, or "
            "choose a ball, bull-nose or tapered tool."
        )
    return radius


def scallop_planes(
    facets: SurfaceFacets, tool: Tool, scallop_height: float, origin: tuple[float, float], angle: float
) -> CuttingPlanes:
    """Return planes as far apart as a scallop height allows, nearer to each other where surfaces are steeper across
    them.

    On a slope the distance along it counts. Where surfaces curve the ridge is a little higher or lower than on their
    tangent planes: `hitofude cut` measures it.

    Args:
        scallop_height: mm. origin: x, y of a place on one of the planes, mm. angle: of the planes to the X axis,
            radians.

    Raises:
        ParameterError: the tool leaves no such ridges, the height is out of its range, or there would be too many
            planes.
    """
    flat = stepover_for_scallop(corner_radius(tool), scallop_height)
    bare = CuttingPlanes(origin, angle, ())
    _, (low, high) = extent_on(bare, facets.triangles[:, :, :2].reshape(-1, 2))
    first, last, steep = _slopes(facets, bare)
    order = np.argsort(first)
    first, last, steep = first[order], last[order], steep[order]
    begin = min(max(0.0, low), high)
    up = _steps(begin, high, flat, (first, last, steep))
    down = [-at for at in _steps(-begin, -low, flat, _mirrored(first, last, steep))]
    offsets = sorted({*up, *down})
    return CuttingPlanes(origin, angle, tuple(offsets))


def _slopes(facets: SurfaceFacets, planes: CuttingPlanes) -> tuple[Floats, Floats, Floats]:
    """Return from where to where across the planes each facet (n,) lies, and how steep it is across them."""
    c, s = planes.along
    t = facets.triangles
    across = (t[:, :, 1] - planes.origin[1]) * c - (t[:, :, 0] - planes.origin[0]) * s
    normal = np.cross(t[:, 1] - t[:, 0], t[:, 2] - t[:, 0])
    steep = np.abs(normal[:, 1] * c - normal[:, 0] * s) / np.maximum(np.abs(normal[:, 2]), 1e-300)
    return across.min(axis=1), across.max(axis=1), np.where(steep > _STEEPEST, 0.0, steep)


def _mirrored(first: Floats, last: Floats, steep: Floats) -> tuple[Floats, Floats, Floats]:
    order = np.argsort(-last)
    return -last[order], -first[order], steep[order]


def _steps(begin: float, end: float, flat: float, slopes: tuple[Floats, Floats, Floats]) -> list[float]:
    """Return places from `begin` to `end`, each so far on as the steepest facet up to there allows."""
    first, last, steep = slopes
    longest = float((last - first).max())
    found, at = [begin], begin
    while at < end - 1e-9:
        rows = slice(np.searchsorted(first, at - longest), np.searchsorted(first, at + flat, "right"))
        near = last[rows] >= at
        starts, slope = np.maximum(first[rows][near] - at, 0.0), steep[rows][near]
        if len(starts):
            order = np.argsort(starts)
            steepest = np.maximum.accumulate(slope[order])
            allowed = flat / np.sqrt(1 + steepest**2)
            beyond = np.flatnonzero(starts[order] >= allowed)  # what begins behind the step does not matter to it
            step = float(
                min(allowed[-1] if not len(beyond) else max(allowed[beyond[0]], starts[order][beyond[0]]), flat)
            )
        else:
            step = flat
        at = min(at + step, end)
        found.append(at)
        if len(found) > MOST_PLANES:
            raise ParameterError(f"That scallop height makes more than {MOST_PLANES:,} passes; allow a larger one.")
    return found
