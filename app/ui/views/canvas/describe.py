"""What there is to say about an entity under the mouse."""

from __future__ import annotations

import math

from ....drafting.curves.shapes import curve_length
from ....geometry.dimension_lines import figure
from ....model.curves import Arc, Circle, Line, Point
from ....model.notes import Dimension, Guide, Mark, Note
from ....model.part import Entity
from ...framework.display_unit import display_unit_name, display_unit_size


def describe_entity(entity: Entity) -> str:
    """Return kind, number, measures and layer of an entity."""
    curve = entity.curve
    words = [f"{type(curve).__name__} {entity.id}"]
    if isinstance(curve, Arc | Circle):
        words.append(f"R {_length(curve.radius)}")
    if isinstance(curve, Arc):
        words.append(f"{abs(math.degrees(curve.sweep)):.2f}°")
    if isinstance(curve, Line | Arc | Circle):
        words.append(_length(curve_length(curve)))
    return " · ".join([*words, f"layer {entity.layer}"])


def describe_note(note: Note) -> str:
    """Return kind, number, measures and layer of a note."""
    shape = note.shape
    if isinstance(shape, Mark):
        words = [f"Point {note.id}", _place(shape.at)]
    elif isinstance(shape, Guide):
        words = [f"Construction line {note.id}", f"{math.degrees(shape.angle):.2f}°"]
    else:
        words = [f"Dimension {note.id}", _measure(shape)]
    return " · ".join([*words, f"layer {note.layer}"])


def _place(at: Point) -> str:
    size = display_unit_size()
    return f"{at[0]:.3f}, {at[1]:.3f}" if size == 1.0 else f"{at[0] / size:.4f}, {at[1] / size:.4f} in"


def _length(length: float) -> str:
    return f"{length:.3f} mm" if display_unit_size() == 1.0 else f"{length / display_unit_size():.4f} in"


def _measure(dimension: Dimension) -> str:
    text = figure(dimension, display_unit_size())
    return text if text.endswith("°") else f"{text} {display_unit_name('mm')}"
