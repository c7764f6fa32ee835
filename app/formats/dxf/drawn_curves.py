"""All curves that a DXF's space draws: its own, boundaries of hatches that are not drawn anyway, and letters, strokes
last.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import compress

from ...model.curves import Curve
from ..drawing_account import LayeredCurve
from .blocks import DxfContent
from .hatch import Hatch, bounding_alone


@dataclass(frozen=True, slots=True)
class DrawnCurves:
    """Curves in the order in which they are numbered, so that a drawing without texts and hatches is numbered as it
    ever was.

    Attributes:
        curves: drawing units.
        strokes: so many of the last ones are strokes of letters.
        boundaries: of hatches on layers that are machined; `repeated` of them lie on drawn curves and are none of
            these.
    """

    curves: tuple[LayeredCurve, ...]
    strokes: int
    boundaries: int
    repeated: int


def all_drawn(content: DxfContent, machined: Callable[[str], bool], size: float) -> DrawnCurves:
    """Return all curves of a sheet.

    Args:
        content: of the space. machined: tells whether a layer is. size: of the drawing's unit, mm.
    """
    shown = [each for each in content.hatches if machined(each.layer)]
    rings = [(ring, each.layer) for each in shown for ring in each.boundaries]
    new = _new([ring for ring, _ in rings], content, machined, size) if rings else []
    kept = [LayeredCurve(curve, layer) for ring, layer in compress(rings, new) for curve in ring]
    kept += [
        LayeredCurve(curve, each.layer) for each in content.hatches if not machined(each.layer) for curve in _all(each)
    ]
    outlines = [LayeredCurve(curve, each.layer) for each in content.letterings for curve in each.outlines]
    strokes = [LayeredCurve(curve, each.layer) for each in content.letterings for curve in each.strokes]
    return DrawnCurves((*content.curves, *kept, *outlines, *strokes), len(strokes), len(rings), len(rings) - sum(new))


def _all(hatch: Hatch) -> list[Curve]:
    return [curve for ring in hatch.boundaries for curve in ring]


def _new(
    rings: list[tuple[Curve, ...]], content: DxfContent, machined: Callable[[str], bool], size: float
) -> list[bool]:
    return bounding_alone(rings, [each.curve for each in content.curves if machined(each.layer)], size)
