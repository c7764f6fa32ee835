"""Drawing commands: what one line of the drawing language asks for, as frozen values."""

from __future__ import annotations

from dataclasses import dataclass, replace

from app.edit.move import moved_curve
from app.errors import InputError
from app.model.curves import Curve, Point
from app.model.part import Entity, Layer, Part


@dataclass(frozen=True, slots=True)
class Context:
    """What a line may refer to without saying it.

    Attributes:
        last: the point given last; a line that begins with `@` starts from it, mm.
        layer: where new curves go.
        selection: ids that `delete` and `move` mean when none are written.
    """

    last: Point = (0.0, 0.0)
    layer: str = "0"
    selection: frozenset[int] = frozenset()


@dataclass(frozen=True, slots=True)
class Draw:
    """Add curves to the drawing.

    Attributes:
        name: "Line", "Arc", …
        figures: the measures that the reply states.
        last: the point that the next relative coordinates start from, mm.
    """

    name: str
    curves: tuple[Curve, ...]
    layer: str
    figures: str
    last: Point

    @property
    def reply(self) -> str:
        """A short sentence for the log."""
        return f"{self.name}, {self.figures}."

    def apply(self, part: Part) -> Part:
        """Return the part with the curves added, on fresh ids."""
        first = part.next_id()
        new = tuple(Entity(first + n, curve, self.layer) for n, curve in enumerate(self.curves))
        return part.with_entities(part.entities + new)


@dataclass(frozen=True, slots=True)
class Delete:
    """Take curves out of the drawing."""

    ids: frozenset[int]
    name: str = "Delete"

    @property
    def reply(self) -> str:
        """A short sentence for the log."""
        return f"{len(self.ids)} deleted."

    def apply(self, part: Part) -> Part:
        """Return the part without these entities.

        Raises:
            InputError: an id that the part does not have.
        """
        check_ids(part, self.ids)
        return replace(part, entities=tuple(e for e in part.entities if e.id not in self.ids))


@dataclass(frozen=True, slots=True)
class Move:
    """Shift curves by a vector, mm."""

    ids: frozenset[int]
    by: Point
    name: str = "Move"

    @property
    def reply(self) -> str:
        """A short sentence for the log."""
        return f"{len(self.ids)} moved by {self.by[0]:.3f}, {self.by[1]:.3f}."

    def apply(self, part: Part) -> Part:
        """Return the part with these entities shifted.

        Raises:
            InputError: an id that the part does not have.
        """
        check_ids(part, self.ids)
        return replace(part, entities=tuple(
            replace(e, curve=moved_curve(e.curve, self.by)) if e.id in self.ids else e for e in part.entities))


@dataclass(frozen=True, slots=True)
class SetLayer:
    """Draw on a layer from now on, or put curves on it when ids are given; it is made when it is new."""

    layer: str
    ids: frozenset[int] = frozenset()
    name: str = "Layer"

    @property
    def reply(self) -> str:
        """A short sentence for the log."""
        return f"{len(self.ids)} put on layer {self.layer}." if self.ids else f"Layer {self.layer} is current."

    def apply(self, part: Part) -> Part:
        """Return the part that has the layer.

        Raises:
            InputError: an id that the part does not have.
        """
        check_ids(part, self.ids)
        if all(layer.name != self.layer for layer in part.layers):
            part = replace(part, layers=(*part.layers, Layer(self.layer)))
        if not self.ids:
            return part
        return replace(part, entities=tuple(replace(e, layer=self.layer) if e.id in self.ids else e for e in part.entities))


@dataclass(frozen=True, slots=True)
class Undo:
    """Take the last change back."""


@dataclass(frozen=True, slots=True)
class Redo:
    """Do again what was taken back."""


Edit = Draw | Delete | Move | SetLayer
"""Commands that make a new part; each has a name, a reply and `apply(part) -> part`."""


def check_ids(part: Part, ids: frozenset[int]) -> None:
    """Check that the part has every one of these entities.

    Raises:
        InputError: it names those that are missing.
    """
    missing = sorted(ids - {e.id for e in part.entities}) if ids else []
    if missing:
        listed = ", ".join(map(str, missing[:5])) + (" …" if len(missing) > 5 else "")
        raise InputError(f"The drawing has no entity {listed}; select what to change and repeat without numbers.")
