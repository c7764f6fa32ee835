"""All curves that a DXF's space draws: its own, boundaries of hatches that are not drawn anyway, and letters, strokes
last.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import compress

from ...model.curves import Curve
from .blocks import DxfSheet
from .hatch import Hatch, apart


@dataclass(frozen=True, slots=True)
class AllDrawn:
    """Curves in the order in which they are numbered, so that a drawing without texts and hatches is numbered as it
    ever was.

    Attributes:
        curves: (curve, layer), drawing units.
        strokes: so many of the last ones are strokes of letters.
        boundaries: of hatches on layers that are machined; `repeated` of them lie on drawn curves and are none of
            these.
    """

    curves: tuple[tuple[Curve, str], ...]
    strokes: int
    boundaries: int
    repeated: int


def all_drawn(sheet: DxfSheet, machined: Callable[[str], bool], size: float) -> AllDrawn:
    """Return all curves of a sheet.

    Args:
        sheet: of the space. machined: tells whether a layer is. size: of the drawing's unit, mm.
    """
    shown = [each for each in sheet.hatches if machined(each.layer)]
    rings = [(ring, each.layer) for each in shown for ring in each.boundaries]
    new = _new([ring for ring, _ in rings], sheet, machined, size) if rings else []
    kept = [(curve, layer) for ring, layer in compress(rings, new) for curve in ring]
    kept += [(curve, each.layer) for each in sheet.hatches if not machined(each.layer) for curve in _all(each)]
    outlines = [(curve, each.layer) for each in sheet.letterings for curve in each.outlines]
    strokes = [(curve, each.layer) for each in sheet.letterings for curve in each.strokes]
    return AllDrawn((*sheet.curves, *kept, *outlines, *strokes), len(strokes), len(rings), len(rings) - sum(new))


def _all(hatch: Hatch) -> list[Curve]:
    return [curve for ring in hatch.boundaries for curve in ring]


def _new(rings: list[tuple[Curve, ...]], sheet: DxfSheet, machined: Callable[[str], bool], size: float) -> list[bool]:
    return apart(rings, [curve for curve, layer in sheet.curves if machined(layer)], size)
