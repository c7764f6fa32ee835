"""Depths that a DXF tells: by where along Z its curves lie, by how far these are drawn out, and by its texts."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from ...core import tolerances
from ...model.drawn_depths import DepthSource, DrawnDepth, depth_words
from ...model.part import Entity
from ..drawing_account import CurveHeights, UsableCurves
from .drawn_curves import DrawnCurves
from .letters import TextCurves


@dataclass(frozen=True, slots=True)
class DepthReading:
    """What depths are read from.

    Attributes:
        letterings: texts of the sheet. drawn: its curves, in the order in which they were numbered.
        found: what of them can be machined. unit: size of the drawing's unit, mm.
    """

    letterings: Sequence[TextCurves]
    drawn: DrawnCurves
    found: UsableCurves
    unit: float


def depths_of(reading: DepthReading) -> tuple[DrawnDepth, ...]:
    """Return every depth that a drawing tells.

    Depths by elevation count from the highest curve, or from Z 0 where that is higher. What is drawn out from Z 0 is as
    deep as it is thick, up or down; else it reaches from the top to its lower end.
    """
    return (*_of_curves(reading), *_of_texts(reading))


def _of_curves(reading: DepthReading) -> Iterator[DrawnDepth]:
    """Yield a depth for all curves that lie alike."""
    curves = reading.drawn.curves
    alike: defaultdict[CurveHeights, list[Entity]] = defaultdict(list)
    for entity, index in zip(reading.found.entities, reading.found.sources, strict=True):
        alike[_rounded(curves[index].heights, reading.unit)].append(entity)
    top = max([0.0, *(heights.high for heights in alike)])
    for heights, entities in alike.items():
        depth, source = _depth(heights, top), DepthSource.THICKNESS if heights.thickness else DepthSource.ELEVATION
        if depth is None or depth > tolerances.CURVE:
            numbers = tuple(each.id for each in entities)
            yield DrawnDepth(source, depth, _words(heights), entities[0].curve.start, numbers)


def _rounded(heights: CurveHeights, unit: float) -> CurveHeights:
    return CurveHeights(*(round(z * unit, 6) + 0.0 if math.isfinite(z) else 0.0 for z in heights))


def _depth(heights: CurveHeights, top: float) -> float | None:
    """Return how deep curves are drawn, mm; None where they lean."""
    if heights.high - heights.low > tolerances.CURVE:
        return None
    if heights.thickness and heights.low == 0:
        return abs(heights.thickness)
    return top - heights.low - min(heights.thickness, 0.0)


def _words(heights: CurveHeights) -> str:
    if heights.high - heights.low > tolerances.CURVE:
        return f"Z {heights.low:g} to {heights.high:g} mm"
    return f"Z {heights.low:g} mm" + (f", thickness {heights.thickness:g} mm" if heights.thickness else "")


def _of_texts(reading: DepthReading) -> Iterator[DrawnDepth]:
    """Yield the depths that texts tell; the curves of letters come behind all others, outlines before strokes."""
    unit, number = reading.unit, {source: k + 1 for k, source in enumerate(reading.found.sources)}
    shift = reading.found.moved or (0.0, 0.0)
    outline = len(reading.drawn.curves) - sum(each.size for each in reading.letterings)
    stroke = len(reading.drawn.curves) - reading.drawn.strokes
    for each in reading.letterings:
        rows = (
            *range(outline, outline + len(each.outlines)),
            *range(stroke, stroke + len(each.strokes)),
        )
        outline, stroke = outline + len(each.outlines), stroke + len(each.strokes)
        told = depth_words(each.words, unit)
        if told is not None:
            at = each.at[0] * unit + shift[0], each.at[1] * unit + shift[1]
            yield DrawnDepth(
                DepthSource.TEXT, told.depth, each.words.strip(), at, _numbers(rows, number), each.height * unit
            )


def _numbers(rows: Sequence[int], number: Mapping[int, int]) -> tuple[int, ...]:
    return tuple(number[row] for row in rows if row in number)
