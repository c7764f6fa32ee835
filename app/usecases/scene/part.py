"""The surfaces of a scene as the part that a cut is compared with: seen from above, metal below the topmost of them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...model.scene import Scene
from ...model.scene_curves import SceneFiles
from ...model.stock_box import StockBox
from ...simulation.field.solid import SolidStock
from ...surfaces.cutter_contact.scene_facets import scene_facets
from ...surfaces.patches.build import build
from ...verify.parts import TOLERANCE, SolidPart
from .compute import origin_of, stock_of

_SHARE = 0.25
"""Of the tolerance: how far the triangles may be off the surfaces."""
_BELOW = 1.0
"""mm from the lowest place of a surface down to what closes it."""

Origin = tuple[float, float, float]


def scene_part(
    scene: Scene, sources: SceneFiles, zero: Origin | None, leave: float | None, tolerance: float | None
) -> SolidPart:
    """Return what is to come out of the metal, in program coordinates.

    Args:
        sources: reads the files that the scene names.
        zero: the program's zero in the scene's coordinates, mm; None: the scene's own work origin.
        leave: stock to leave, mm; None: the least that its passes leave. tolerance: mm; None: TOLERANCE.

    Raises:
        HitofudeError: a surface cannot be made.
    """
    built, met = build(scene, sources), TOLERANCE if tolerance is None else tolerance
    coarse = scene_facets(built).facets
    facets = coarse if coarse.error.max() <= _SHARE * met else scene_facets(built, _SHARE * met).facets
    box = stock_of(scene, coarse)
    x, y, z = origin_of(scene, box) if zero is None else zero
    block = StockBox(box.x0 - x, box.y0 - y, box.z0 - z, box.x1 - x, box.y1 - y, box.z1 - z)
    left = (
        min((passes.stock_to_leave for passes in scene.passes if passes.enabled), default=0.0)
        if leave is None
        else leave
    )
    above = max((passes.chord_tolerance for passes in scene.passes if passes.enabled), default=0.0)
    return SolidPart(SolidStock(_closed(facets.triangles - np.array([x, y, z]))), left, met, block, above)


def _closed(triangles: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return triangles turned to look up, and for each one below everything that looks down: a line down meets as many
    of both.
    """
    a, b, c = np.moveaxis(triangles[..., :2], 1, 0)
    down = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) < (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
    upper = np.where(down[:, None, None], triangles[:, ::-1], triangles)
    lower = upper[:, ::-1].copy()
    lower[..., 2] = triangles[..., 2].min() - _BELOW
    return np.concatenate([upper, lower])
