"""The sweep of a few moves as the method of the wedges makes it, for a picture of the method (figs 3, 7, 8 of its
text).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core.errors import ParameterError
from ...model.motion import Floats
from ...model.tool import Tool
from ...model.tool_kind import ToolKind

MOVES = 12
"""Moves round the tool's place that a picture shows."""

FINENESS = 8.0
"""Facets in a picture are the radius over this, so that each can be seen; the cut's own are much finer."""


@dataclass(frozen=True, eq=False)
class WedgesPicture:
    """The facets of a sweep.

    Attributes:
        quads: (m, 4, 3) float32 corners, one after the other round each facet, mm.
        kind: (m,) uint8, 0 = of a cylinder, 1 = of a wedge, or of a half sphere at an end.
        facet: size asked for, mm.
    """

    quads: NDArray[np.float32]
    kind: NDArray[np.uint8]
    facet: float


def has_wedges(tool: Tool) -> bool:
    """Return whether the sweep of a tool consists of cylinders and wedges: that of a ball does."""
    return tool.kind is ToolKind.BALL


def wedges_picture(tips: Floats, tool: Tool, facet: float = 0.0) -> WedgesPicture:
    """Return the facets of the sweep of a ball.

    Args:
        tips: (n + 1, 3) places of the tip, mm; straight moves between them; one place is a ball that stands.
        tool: a ball cutter.
        facet: size of a facet, mm; 0 = one that can be seen.

    Raises:
        ParameterError: the tool is no ball.
    """
    from .wedges import FacetKind, Tessellation, sweep_facets

    if not has_wedges(tool):
        raise ParameterError(
            f"T{tool.number} is a {tool.kind.value} tool; cylinders and wedges are the sweep of a ball. "
            "Choose a move of a ball cutter."
        )
    facet = facet or tool.radius / FINENESS
    places = np.asarray(tips, float) + (0.0, 0.0, tool.radius)
    found = sweep_facets(places if len(places) > 1 else np.repeat(places, 2, axis=0), tool.radius, Tessellation(facet))
    return WedgesPicture(found.quads, (found.kind != FacetKind.CYLINDER).astype(np.uint8), facet)
