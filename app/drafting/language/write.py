"""A drawing as a text of the shape language, which draws it again to the last digit."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from ...core.tolerances import WELD
from ...model.curves import Arc, Circle, Curve, Ellipse, Line, Spline
from ...model.notes import Guide, Mark, Note, Shape
from ...model.part import Entity, Layer, Part
from ..expressions.words import ids_text, name_text, number_text, point_text


@dataclass(frozen=True, slots=True)
class DrawText:
    """A text of the shape language.

    Attributes:
        left_out: curves too small for it: shorter than the program welds, or of a smaller radius.
    """

    text: str
    left_out: int = 0


def draw_text(part: Part) -> DrawText:
    """Return the text that draws a part: its layers with their looks, then its curves in order, with the notes among
    them.
    """
    lines = [f"# {part.name}"]
    for layer in part.layers:
        lines += [f"layer {name_text(layer.name)}", *_looks(layer)]
    lines += _first_in_its_place(part.layers)
    current = part.layers[-1].name if part.layers else ""
    left_out, strokes, number = 0, list[int](), 0
    for item in _in_order(part):
        if isinstance(item, Entity) and _is_nothing(item.curve):
            left_out += 1
            continue
        number += 1
        if isinstance(item, Entity) and item.lettering:
            strokes.append(number)
        if item.layer != current:
            current = item.layer
            lines.append(f"layer {name_text(current)}")
        lines.append(curve_text(item.curve) if isinstance(item, Entity) else note_text(item.shape))
    lines += [f"set {ids_text(strokes)} lettering yes"] if strokes else []
    return DrawText("\n".join(lines) + "\n", left_out)


def _first_in_its_place(layers: tuple[Layer, ...]) -> list[str]:
    """Return the line that puts the layer that every drawing begins with behind those that come before it."""
    at = next((at for at, layer in enumerate(layers) if layer.name == Layer().name), 0)
    return [f"order layer {name_text(layers[at].name)} after {name_text(layers[at - 1].name)}"] if at else []


def _in_order(part: Part) -> Iterator[Entity | Note]:
    notes = sorted(part.notes, key=lambda note: note.id, reverse=True)
    for entity in part.entities:
        while notes and notes[-1].id < entity.id:
            yield notes.pop()
        yield entity
    yield from reversed(notes)


def note_text(shape: Shape) -> str:
    """Return the line that draws a note."""
    if isinstance(shape, Mark):
        return f"point {point_text(shape.at)}"
    if isinstance(shape, Guide):
        return f"guide {point_text(shape.through)} {number_text(math.degrees(shape.angle))}"
    return f"dimension {shape.measure.value} {' '.join(map(point_text, shape.points))} place {point_text(shape.place)}"


def curve_text(curve: Curve) -> str:
    """Return the line that draws a curve."""
    if isinstance(curve, Line):
        return f"line {point_text(curve.start)} {point_text(curve.end)}"
    if isinstance(curve, Arc):
        return f"arc {point_text(curve.start)} {point_text(curve.end)} centre {point_text(curve.centre)}" + " cw" * (
            not curve.ccw
        )
    if isinstance(curve, Circle):
        return f"circle {point_text(curve.centre)} {number_text(curve.radius)}" + " cw" * (not curve.ccw)
    if isinstance(curve, Ellipse):
        return _ellipse_text(curve)
    return _spline_text(curve)


def _ellipse_text(curve: Ellipse) -> str:
    end = (curve.centre[0] + curve.major[0], curve.centre[1] + curve.major[1])
    words = ["ellipse", point_text(curve.centre), point_text(end), number_text(math.hypot(*curve.major) * curve.ratio)]
    if (curve.start_parameter, curve.end_parameter) != (0.0, math.tau):
        words += [
            "from",
            number_text(math.degrees(curve.start_parameter)),
            "to",
            number_text(math.degrees(curve.end_parameter)),
        ]
    return " ".join(words + ["cw"] * (not curve.ccw))


def _spline_text(curve: Spline) -> str:
    words = [
        "spline degree",
        str(curve.degree),
        *map(point_text, curve.control_points),
        "knots",
        *map(number_text, curve.knots),
    ]
    return " ".join(words + (["weights", *map(number_text, curve.weights)] if curve.weights else []))


def _looks(layer: Layer) -> list[str]:
    name = name_text(layer.name)
    return (
        [f"colour {name} {name_text(layer.colour)}"] * bool(layer.colour)
        + [f"hide {name}"] * (not layer.visible)
        + [f"lock {name}"] * layer.locked
    )


def _is_nothing(curve: Curve) -> bool:
    if isinstance(curve, Line | Arc):
        return math.dist(curve.start, curve.end) < WELD
    if isinstance(curve, Circle):
        return curve.radius < WELD
    return isinstance(curve, Ellipse) and math.hypot(*curve.major) * curve.ratio < WELD
