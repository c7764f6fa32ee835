"""How low a cutter comes over a mesh without touching more than its surface, at any places."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core.errors import ParameterError
from ...core.pool import pool
from ...core.progress import NO_PROGRESS, Progress
from ...model.tool import Tool
from ..patches.facets import NONE, SurfaceFacets

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_STRIP = 2_000
"""Places that one thread drops at before it asks whether to go on."""
FINE = 1e-7
"""Heights are as near to those over the true surfaces as this, mm."""


@dataclass(frozen=True, eq=False)
class DroppedCutter:
    """A cutter over m places.

    Attributes:
        height: (m,) of its tip, mm; -inf where nothing is in its reach.
        facet: (m,) number of the one that it touches, NONE where there is none.
    """

    height: Floats
    facet: Ints


def shape_of(tool: Tool, skin: float = 0.0) -> Floats:
    """Return a cutter's lower side (5,), see `drop_kernels`.

    Args:
        skin: mm, round it, measured from its own lowest place, which is as much below the tool's tip.

    Raises:
        ParameterError: it has a point of no angle.
    """
    radius, half, profile = tool.radius, tool.tip_angle / 2, tool.profile
    if tool.kind.conical and not half > 0:
        raise ParameterError(f"T{tool.number}: a point of 0 degrees; give its angle.")
    rim = profile.flat + profile.fillet * math.cos(half) if tool.kind.conical else radius  # where the cone begins
    shape = np.array((profile.flat, profile.fillet, profile.cone, radius, rim))
    if skin:
        from .contact_kernels import thicken

        thicken(shape.copy(), skin, shape)
    return shape


def drop(
    facets: SurfaceFacets, tool: Tool, places: Floats, fine: float = FINE, progress: Progress = NO_PROGRESS
) -> DroppedCutter:
    """Return how low a tool comes: see `drop_shape`."""
    return drop_shape(facets, shape_of(tool), places, fine, progress)


def drop_shape(
    facets: SurfaceFacets, shape: Floats, places: Floats, fine: float = FINE, progress: Progress = NO_PROGRESS
) -> DroppedCutter:
    """Return how low a cutter comes at places (m, 2), mm: over faces, edges and corners, each exactly.

    Args:
        shape: of the cutter, as of `shape_of`.
        fine: how near to the true surfaces heights are, mm; facets that stand for a patch are refined as far as that
            takes.

    Raises:
        Cancelled: the job was asked to stop.
    """
    from . import drop_kernels as kernels
    from .facet_tree_kernels import ANY

    tree, places = facets.tree, np.ascontiguousarray(places, np.float64)
    height, touched = np.empty(len(places)), np.empty(len(places), np.int64)
    parts = [
        pool().submit(
            kernels.drop, tree.held, shape, places, first, min(first + _STRIP, len(places)), ANY, fine, height, touched
        )
        for first in range(0, len(places), _STRIP)
    ]
    try:
        for n, part in enumerate(parts):
            part.result()
            progress.step((n + 1) / len(parts), "Dropping the cutter")
    except BaseException:
        for part in parts:
            part.cancel()
        raise
    return DroppedCutter(height, np.where(touched >= 0, tree.order[np.maximum(touched, 0)], NONE))
