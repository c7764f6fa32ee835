"""Whether a drawing is fig. 2 of the 1986 patent: its job is the published rule, however it came to be drawn."""

from __future__ import annotations

from collections import Counter

from ...core.resources import resource
from ...formats.readers import read_drawing
from ...geometry.sample import bounds
from ...model.curves import Circle, Curve
from ...model.part import Part

_DECIMALS = 3
"""Of mm, within which the drawing is the same."""


def is_figure_2(part: Part) -> bool:
    """Return whether a part is drawn of the curves of fig. 2, in any order, each in either direction."""
    sample = resource("samples", "fig2.dxf")
    published = read_drawing(sample.name, sample.read_bytes(), None, ()).part
    return _shapes(part) == _shapes(published)


def _shapes(part: Part) -> Counter[object]:
    return Counter(_shape(entity.curve) for entity in part.entities)


def _shape(curve: Curve) -> object:
    """Return what a curve is, whichever way it runs: its kind, its box, its ends."""
    box = tuple(round(value, _DECIMALS) + 0.0 for value in bounds(curve))
    ends = () if isinstance(curve, Circle) else (curve.start, curve.end)
    rounded = frozenset((round(x, _DECIMALS) + 0.0, round(y, _DECIMALS) + 0.0) for x, y in ends)
    return type(curve), box, rounded
