"""How long the passes over a scene will take, reckoned from counts before they are begun."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from ...core.effort import Reckoning

if TYPE_CHECKING:  # a cut needs nothing of them
    from ...surfaces.passes.facet_crossings import FacetCrossings

_CROSSING_S = 1.1e-4
"""A facet that a plane of passes crosses: contact, path, compound surface, text and proof; measured on scenes of 1,500
to 120,000 moves.
"""


def scene_effort(families: Iterable[FacetCrossings]) -> Reckoning:
    """Return what a scene's passes take."""
    crossings, planes = 0.0, 0
    for family in families:
        crossings, planes = crossings + family.crossings, planes + family.planes
    return Reckoning(
        crossings * _CROSSING_S,
        f"{planes:,} passes over {crossings:,.0f} facets",
        "use a larger pitch or scallop height, coarser surfaces, or check the model's units",
    )
