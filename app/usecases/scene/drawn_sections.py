"""Curves of a drawing as section curves of a scene: what is selected, joined where ends meet, exactly as it is
drawn.
"""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

from ...geometry.chaining.chain import chain
from ...model.part import Part
from ...model.scene_curves import CurveForm, SectionCurve
from ...surfaces.patches.section_curve import flat_curve


def drawn_sections(part: Part, ids: Collection[int]) -> tuple[SectionCurve, ...]:
    """Return section curves of control points, (x, y) mm each, in the order of drawing.

    Args:
        ids: of the curves; those that share an end become one, which is told by lines, arcs and circles exactly.
    """
    found = []
    for contour in chain([entity for entity in part.entities if entity.id in ids]).contours:
        curve = flat_curve(contour, part).curve
        weights = () if np.ptp(curve.weights) == 0 else tuple(curve.weights.tolist())
        points = tuple((x, y) for x, y in curve.points[:, :2].tolist())
        found.append(
            SectionCurve(points, CurveForm.CONTROL, curve.degree, weights=weights, knots=tuple(curve.knots.tolist()))
        )
    return tuple(found)
