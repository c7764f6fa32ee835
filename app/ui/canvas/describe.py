"""What there is to say about an entity under the mouse."""

from __future__ import annotations

import math

from app.edit.dimension_lines import figure
from app.edit.shapes import curve_length
from app.model.curves import Arc, Circle, Line
from app.model.notes import Dimension, Guide, Mark, Note
from app.model.part import Entity


def describe_entity(entity: Entity) -> str:
    """Return kind, number, measures and layer of an entity."""
    curve = entity.curve
    words = [f"{type(curve).__name__} {entity.id}"]
    if isinstance(curve, Arc | Circle):
        words.append(f"R {curve.radius:.3f} mm")
    if isinstance(curve, Arc):
        words.append(f"{abs(math.degrees(curve.sweep)):.2f}°")
    if isinstance(curve, Line | Arc | Circle):
        words.append(f"{curve_length(curve):.3f} mm")
    return " · ".join([*words, f"layer {entity.layer}"])


def describe_note(note: Note) -> str:
    """Return kind, number, measures and layer of a note."""
    shape = note.shape
    if isinstance(shape, Mark):
        words = [f"Point {note.id}", f"{shape.at[0]:.3f}, {shape.at[1]:.3f}"]
    elif isinstance(shape, Guide):
        words = [f"Construction line {note.id}", f"{math.degrees(shape.angle):.2f}°"]
    else:
        words = [f"Dimension {note.id}", _measure(shape)]
    return " · ".join([*words, f"layer {note.layer}"])


def _measure(dimension: Dimension) -> str:
    text = figure(dimension)
    return text if text.endswith("°") else f"{text} mm"
