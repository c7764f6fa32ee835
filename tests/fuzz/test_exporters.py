"""Drawings in the habits of CAD programs and editors: their areas are those of what was drawn, and nothing is lost."""

from __future__ import annotations

import math
import random

import pytest

from app.formats.readers import read_drawing
from app.geometry.chaining.chain import chain
from app.model.curves import Arc, Circle, Primitive
from app.model.read_options import DrawingOptions
from tests.fuzz.exporters import drawn, dxf, svg

NO_NOTES = DrawingOptions(without_layers=("NOTES",), lenient=True)
WRITERS = {"dxf": dxf, "svg": svg}
SLACK = 0.26
"""mm2 a shape: 100 mm of outline by the last digit of what is written, inches among it."""


def area_beside(primitive: Primitive) -> float:
    """Return the area between a line or an arc and the way to it from (0, 0) and back, mm2."""
    if isinstance(primitive, Circle):
        return math.pi * primitive.radius**2
    (x0, y0), (x1, y1) = primitive.start, primitive.end
    area = (x0 * y1 - x1 * y0) / 2
    if isinstance(primitive, Arc):
        cx, cy = primitive.centre
        sweep = (math.atan2(y1 - cy, x1 - cx) - math.atan2(y0 - cy, x0 - cx)) % math.tau
        sweep = sweep if primitive.ccw else sweep - math.tau
        area += math.dist(primitive.start, primitive.centre) ** 2 / 2 * (sweep - math.sin(sweep))
    return area


def fault(kind: str, seed: int) -> str:
    """Return what is wrong with how a drawing is read."""
    rng = random.Random(seed)
    shapes = drawn(rng)
    drawing = read_drawing(f"d.{kind}", WRITERS[kind](rng, shapes), None, (), NO_NOTES)
    result = chain(drawing.part.entities)
    told = [each.text for each in [*result.findings, *drawing.findings] if each.counts]
    if told:
        return told[0]
    areas = sorted(abs(sum(map(area_beside, contour.primitives))) for contour in result.contours)
    expected = sorted(shape.area for shape in shapes)
    if len(areas) != len(expected):
        return f"{len(areas)} contours of {len(expected)}"
    off = max(abs(a - b) for a, b in zip(areas, expected, strict=True))
    return "" if off < SLACK else f"areas {areas} of {expected}"


@pytest.mark.parametrize("kind", WRITERS)
def test_some_drawings(kind: str) -> None:
    assert {seed: found for seed in range(25) if (found := fault(kind, seed))} == {}


@pytest.mark.exhaustive
@pytest.mark.parametrize("kind", WRITERS)
def test_hundreds_of_drawings(kind: str) -> None:
    assert {seed: found for seed in range(25, 175) if (found := fault(kind, seed))} == {}


def test_the_judge_sees_a_shape_that_is_lost(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(WRITERS, "dxf", lambda rng, shapes: dxf(rng, shapes[1:] or shapes * 2))
    assert any(fault("dxf", seed) for seed in range(3))
