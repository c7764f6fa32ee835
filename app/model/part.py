"""What is drawn: curves on layers, the contours they chain into, the regions these bound."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from enum import Enum
from typing import Any

from .curves import Curve, Primitive
from .drawn_depths import DrawnDepth
from .notes import Note, Shape
from .read_options import AS_DRAWN, DrawingOptions


class Units(Enum):
    """Length units of a drawing or an NC program; the value is the unit's size in mm."""

    MM = 1.0
    INCH = 25.4
    CM = 10.0
    M = 1000.0
    FOOT = 304.8
    MICRON = 0.001


@dataclass(frozen=True, slots=True)
class Layer:
    """A named sheet of the drawing.

    Attributes:
        colour: "#rrggbb" or "" for the theme's ink.
    """

    name: str = "0"
    colour: str = ""
    visible: bool = True
    locked: bool = False


@dataclass(frozen=True, slots=True)
class Entity:
    """One drawn curve.

    Attributes:
        id: unique in its part, never used again, > 0.
        curve: the curve, mm.
        layer: name of its layer.
        lettering: True for a stroke of a letter: a tool may follow it, and it never bounds anything.
    """

    id: int
    curve: Curve
    layer: str = "0"
    lettering: bool = False


@dataclass(frozen=True)
class Part:
    """A drawing in mm.

    Attributes:
        entities: in the order of drawing.
        layers: every layer that exists, in order; entities name only these.
        units: the units in which the drawing was made or is shown.
        name: shown in titles and NC headers.
        used_id: the highest entity id that was ever given, where it is known; 0: the highest there is.
        notes: points, construction lines and dimensions, in the order of drawing; their ids are of the same count.
        reading: how it was read from a file of others, so that it can be read so again.
        depths: that the drawing tells of its own; nothing is cut by them until somebody asks for it.
    """

    entities: tuple[Entity, ...] = ()
    layers: tuple[Layer, ...] = (Layer(),)
    units: Units = Units.MM
    name: str = "untitled"
    used_id: int = field(default=0, compare=False)
    notes: tuple[Note, ...] = ()
    reading: DrawingOptions = field(default=AS_DRAWN, compare=False)
    depths: tuple[DrawnDepth, ...] = ()

    @property
    def machined_layers(self) -> tuple[Layer, ...]:
        """Layers that hold something, as far as paths depend on them: name, and whether they are visible."""
        used = {each.layer for each in self.entities} | {each.layer for each in self.notes}
        return tuple(Layer(layer.name, visible=layer.visible) for layer in self.layers if layer.name in used)

    def next_id(self) -> int:
        """Return an entity id that was never given."""
        return (self.used_id or _highest(self.entities, self.notes)) + 1

    def ids(self) -> set[int]:
        """Return the ids of all entities and notes."""
        return {e.id for e in self.entities} | {n.id for n in self.notes}

    def curve(self, entity_id: int) -> Curve | None:
        """Return an entity's curve, or None when the part does not have it."""
        return next((e.curve for e in self.entities if e.id == entity_id), None)

    def with_curves(self, curves: Iterable[Curve], layer: str, lettering: bool = False) -> Part:
        """Return the part with curves, or strokes of letters, added on fresh ids; a layer that is new is added."""
        first = self.next_id()
        new = tuple(Entity(first + n, curve, layer, lettering) for n, curve in enumerate(curves))
        layers = self.layers if any(known.name == layer for known in self.layers) else (*self.layers, Layer(layer))
        return replace(self, entities=self.entities + new, layers=layers, used_id=first + len(new) - 1)

    def with_note(self, shape: Shape, layer: str) -> Part:
        """Return the part with a note added on a fresh id; the layer is added where it is new."""
        note = Note(self.next_id(), shape, layer)
        layers = self.layers if any(known.name == layer for known in self.layers) else (*self.layers, Layer(layer))
        return replace(self, notes=(*self.notes, note), layers=layers, used_id=note.id)

    def with_entities(self, entities: tuple[Entity, ...]) -> Part:
        """Return the part with other entities; layers they name are added."""
        known = {layer.name for layer in self.layers}
        new = tuple(Layer(name) for name in dict.fromkeys(e.layer for e in entities) if name not in known)
        used = _highest(entities, self.notes)
        return replace(self, entities=entities, layers=self.layers + new, used_id=max(self.used_id, used))


def _highest(entities: tuple[Entity, ...], notes: tuple[Note, ...]) -> int:
    return max(max((e.id for e in entities), default=0), max((n.id for n in notes), default=0))


@dataclass(frozen=True)
class Contour:
    """Curves joined end to end.

    Attributes:
        primitives: lines, arcs, or one circle; each begins exactly where the one before ends.
        closed: the last one ends exactly where the first begins.
        layer: layer of the first curve.
        entity_ids: entities that it came from, in order.
        deviation: largest distance between the drawn curves and the primitives, mm (0: exact).
        kept: what was computed from the primitives, by name, so that each of many judges need not compute it again.
    """

    primitives: tuple[Primitive, ...]
    closed: bool = True
    layer: str = "0"
    entity_ids: tuple[int, ...] = ()
    deviation: float = 0.0
    kept: dict[str, Any] = field(default_factory=dict, init=False, repr=False, compare=False)


@dataclass(frozen=True)
class Region:
    """One area to machine: a boundary and the islands directly inside it.

    Attributes:
        number: 1, 2, … in order of the drawing.
        boundary: counter-clockwise, so the area lies to the left of travel.
        islands: clockwise, for the same reason.
    """

    number: int
    boundary: Contour
    islands: tuple[Contour, ...] = ()

    @property
    def contours(self) -> tuple[Contour, ...]:
        """Boundary first, then islands."""
        return (self.boundary, *self.islands)
