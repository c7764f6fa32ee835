"""What there is to say about an entity under the mouse."""

from __future__ import annotations

import math

from app.edit.shapes import curve_length
from app.model.curves import Arc, Circle, Line
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
