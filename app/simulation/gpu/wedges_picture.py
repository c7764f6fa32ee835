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
from ..cutter import cutter_of

MOVES = 12
"""Moves round the tool's place that a picture shows."""

FINENESS = 8.0
"""Facets in a picture are the radius over this, so that each can be seen; the cut's own are much finer."""


@dataclass(frozen=True, eq=False)
class WedgesPicture:
    """The facets of a sweep.

    Attributes:
        quads: (m, 4, 3) float32 corners, one after the other round each facet, mm.
        kind: (m,) uint8, 0 = of a cylinder, or of what another cutter than a ball sweeps along a move; 1 = of a wedge,
            or of a cutter at an end.
        facet: size asked for, mm.
    """

    quads: NDArray[np.float32]
    kind: NDArray[np.uint8]
    facet: float


def has_wedges(tool: Tool) -> bool:
    """Return whether the sweep of a tool can be shown in facets: of a ball in cylinders and wedges, of another cutter
    by what its silhouette sweeps; not of one whose shape is not known.
    """
    try:
        cutter_of(tool)
    except ParameterError:
        return False
    return True


def wedges_picture(tips: Floats, tool: Tool, facet: float = 0.0) -> WedgesPicture:
    """Return the facets of the sweep of a cutter.

    Args:
        tips: (n + 1, 3) places of the tip, mm; straight moves between them; one place is a cutter that stands.
        tool: the cutter.
        facet: size of a facet, mm; 0 = one that can be seen.

    Raises:
        ParameterError: the tool makes no shape.
    """
    from ..sweeps.chains import Chains
    from .wedges import FacetKind, Tessellation, facets_in

    cutter = cutter_of(tool)
    facet = facet or tool.radius / FINENESS
    places = np.asarray(tips, float) + (0.0, 0.0, cutter.lift)
    places = places if len(places) > 1 else np.repeat(places, 2, axis=0)
    chains = Chains.of(places[:-1], places[1:], np.arange(len(places) - 1) > 0)
    parts = [(part.quads.copy(), part.kind.copy()) for part, _ in facets_in(cutter, chains, Tessellation(facet))]
    kind = np.concatenate([kind for _, kind in parts]) != FacetKind.CYLINDER
    return WedgesPicture(np.concatenate([quads for quads, _ in parts]), kind.astype(np.uint8), facet)
