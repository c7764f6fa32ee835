"""What each family of a scene's passes is to do, for who looks at what its program leaves."""

from __future__ import annotations

import numpy as np
import shapely.affinity
from numpy.typing import NDArray

from ...core.progress import NO_PROGRESS, Progress
from ...simulation.cutter import cutter_of
from ...simulation.field.workpiece import Workpiece
from ...surfaces.cutter_contact.drop_cutter import drop_shape, shape_of
from ..scene.compute import ComputedFamily, ComputedScene
from .corner_reach import TipHeights
from .left import FamilyRequest, SceneLeft, left_of
from .reach import FamilyReach

Floats = NDArray[np.float64]

TIP_ERROR = 1e-3
"""How near to the surfaces a tool is dropped to look at corners, mm: a tenth of what counts as left at all."""


def left_in(computed: ComputedScene, workpiece: Workpiece, progress: Progress = NO_PROGRESS) -> SceneLeft:
    """Return what a computed scene's program leaves within reach.

    Args:
        workpiece: after the cut of the program, program coordinates.

    Raises:
        Cancelled: the job was asked to stop.
    """
    facets = computed.facets.facets
    triangles = facets.triangles - np.array(computed.origin)
    requested = [_asked(computed, family) for family in computed.families]
    return left_of(workpiece, triangles, float(facets.error.max()), requested, progress)


def _asked(computed: ComputedScene, family: ComputedFamily) -> FamilyRequest:
    passes, tool = family.passes, family.tool
    x, y, z = computed.origin
    floor = computed.stock.z0 if passes.floor is None else max(passes.floor, computed.stock.z0)
    area = None if family.area is None else shapely.affinity.translate(family.area, -x, -y)
    requested = FamilyReach(cutter_of(tool), passes.stock_to_leave, floor - z, area)
    spacing = _spacing(family)
    short = passes.overrun is not None and passes.overrun < tool.radius
    return FamilyRequest(
        requested,
        family.planes.angle,
        spacing,
        passes.scallop,
        passes.chord_tolerance,
        short,
        _tips(computed, family),
    )


def _tips(computed: ComputedScene, family: ComputedFamily) -> TipHeights:
    """Return how low a family's cutter comes over the surfaces and what is left on them, program coordinates, and not
    less.
    """
    leave, origin = family.passes.stock_to_leave, np.array(computed.origin)
    shape = shape_of(family.tool, leave)

    def heights(places: Floats, progress: Progress) -> Floats:
        dropped = drop_shape(computed.facets.facets, shape, places + origin[:2], TIP_ERROR, progress)
        return np.asarray(dropped.height + leave + TIP_ERROR - origin[2])

    return heights


def closest_passes(computed: ComputedScene) -> float:
    """Return the spacing of the family whose passes lie closest, mm, > 0."""
    return min(_spacing(family) for family in computed.families)


def _spacing(family: ComputedFamily) -> float:
    """Return how far apart neighbouring passes are at most, mm; of one pass alone, the tool's diameter."""
    if family.passes.pitch is not None:
        return family.passes.pitch
    return float(np.diff(family.planes.offsets).max(initial=0.0)) or family.tool.diameter
