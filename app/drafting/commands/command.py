"""Drawing commands: what one line of the drawing language asks for, as frozen values."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from itertools import count
from typing import NamedTuple

from ...core.errors import InputError
from ...core.wording import counted
from ...geometry.transform import Similarity, transformed, transformed_note
from ...model.curves import Curve, Point
from ...model.part import Entity, Layer, Part
from ..expressions.syntax import CommandDefinition
from ..expressions.values import Scope, Value


@dataclass(frozen=True, slots=True)
class DraftingSession:
    """What a line of the language may refer to without saying it, and what it leaves for the next one.

    Attributes:
        last: the point given last; coordinates that begin with `@` start from it, mm.
        layer: where new curves go.
        selection: ids that `delete` and `move` mean when none are written.
        names: what `let` and `as` have named. commands: what `define` has made.
        renamed: layers that have another name since (old, new), for whoever else calls them by it.
        plain: what a length counts in that is written without a unit, mm.
    """

    part: Part = field(default_factory=Part)
    last: Point = (0.0, 0.0)
    layer: str = "0"
    selection: frozenset[int] = frozenset()
    names: Mapping[str, Value] = field(default_factory=dict)
    commands: Mapping[str, CommandDefinition] = field(default_factory=dict)
    renamed: tuple[tuple[str, str], ...] = ()
    plain: float = 1.0

    @property
    def scope(self) -> Scope:
        """What its expressions may refer to."""
        return Scope(self.names, self.last, self.part, plain=self.plain)

    def with_part(self, part: Part) -> DraftingSession:
        """Return the session with another drawing; what has gone is no longer selected."""
        kept = self.selection & part.ids() if self.selection else self.selection
        return replace(self, part=part, selection=kept)


@dataclass(frozen=True, slots=True)
class Draw:
    """Add curves to the drawing.

    Attributes:
        name: "Line", "Arc", …
        figures: the measures that the reply states.
        last: the point that the next relative coordinates start from, mm.
        lettering: the curves are strokes of letters, which bound nothing.
    """

    name: str
    curves: tuple[Curve, ...]
    figures: str
    last: Point
    lettering: bool = False

    @property
    def reply(self) -> str:
        """A short sentence for the log."""
        return f"{self.name}, {self.figures}."

    def carried_out(self, session: DraftingSession) -> DraftingSession:
        """Return the session with the curves added, on fresh ids."""
        part = session.part.with_curves(self.curves, session.layer, self.lettering)
        return replace(session, part=part, last=self.last)


@dataclass(frozen=True, slots=True)
class Delete:
    """Take curves and notes out of the drawing."""

    ids: frozenset[int]
    name: str = "Delete"

    @property
    def reply(self) -> str:
        """A short sentence for the log."""
        return f"{len(self.ids)} deleted."

    def carried_out(self, session: DraftingSession) -> DraftingSession:
        """Return the session without these entities.

        Raises:
            InputError: an id that the part does not have.
        """
        part = session.part
        check_ids(part, self.ids)
        kept = tuple(e for e in part.entities if e.id not in self.ids)
        notes = tuple(n for n in part.notes if n.id not in self.ids)
        return session.with_part(replace(part, entities=kept, notes=notes, used_id=part.next_id() - 1))


@dataclass(frozen=True, slots=True)
class Transform:
    """Map curves and notes by similarities of the plane: onto one place, or onto several as copies.

    Attributes:
        maps: one for each place; where `keep` is False there is one, and the curves themselves go there.
        keep: the curves stay and copies go to the places.
    """

    ids: frozenset[int]
    maps: tuple[Similarity, ...]
    name: str
    keep: bool = False

    @property
    def reply(self) -> str:
        """A short sentence for the log."""
        curves = counted(len(self.ids), "curve")
        return f"{curves}, {counted(len(self.maps), 'copy', 'copies')}." if self.keep else f"{curves}."

    def carried_out(self, session: DraftingSession) -> DraftingSession:
        """Return the session with the curves at their places.

        Raises:
            InputError: an id that the part does not have.
        """
        part = session.part
        check_ids(part, self.ids)
        if not self.keep:
            return replace(
                session,
                part=replace(
                    part,
                    entities=tuple(
                        replace(e, curve=transformed(e.curve, self.maps[0])) if e.id in self.ids else e
                        for e in part.entities
                    ),
                    notes=tuple(
                        replace(n, shape=transformed_note(n.shape, self.maps[0])) if n.id in self.ids else n
                        for n in part.notes
                    ),
                ),
            )
        chosen, noted = [e for e in part.entities if e.id in self.ids], [n for n in part.notes if n.id in self.ids]
        ids = count(part.next_id())
        copies = tuple(replace(e, id=next(ids), curve=transformed(e.curve, to)) for to in self.maps for e in chosen)
        notes = tuple(replace(n, id=next(ids), shape=transformed_note(n.shape, to)) for to in self.maps for n in noted)
        return replace(
            session,
            part=replace(part, entities=part.entities + copies, notes=part.notes + notes, used_id=next(ids) - 1),
        )


class AddedCurve(NamedTuple):
    """A new curve, on the layer of an entity, by its id."""

    beside: int
    curve: Curve


@dataclass(frozen=True, slots=True)
class ReplaceCurves:
    """Put other curves in the place of some.

    Attributes:
        pieces: by id what each becomes: the first piece keeps the id, the others follow it, none takes it away.
        added: new curves.
    """

    pieces: Mapping[int, tuple[Curve, ...]]
    name: str
    reply: str
    added: tuple[AddedCurve, ...] = ()

    def carried_out(self, session: DraftingSession) -> DraftingSession:
        """Return the session with the pieces, on fresh ids but for the first of each."""
        part, entities, fresh = session.part, list[Entity](), session.part.next_id()
        layers = {e.id: e.layer for e in part.entities}
        for entity in part.entities:
            if entity.id not in self.pieces:
                entities.append(entity)
                continue
            for number, curve in enumerate(self.pieces[entity.id]):
                entities.append(replace(entity, id=entity.id if number == 0 else fresh, curve=curve))
                fresh += number > 0
        entities += [Entity(fresh + number, curve, layers[near]) for number, (near, curve) in enumerate(self.added)]
        return session.with_part(replace(part.with_entities(tuple(entities)), used_id=fresh + len(self.added) - 1))


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

    def carried_out(self, session: DraftingSession) -> DraftingSession:
        """Return the session that has the layer.

        Raises:
            InputError: an id that the part does not have.
        """
        part = session.part
        check_ids(part, self.ids)
        if all(layer.name != self.layer for layer in part.layers):
            part = replace(part, layers=(*part.layers, Layer(self.layer)))
        if not self.ids:
            return replace(session, part=part, layer=self.layer)
        return replace(
            session,
            part=replace(
                part,
                entities=tuple(replace(e, layer=self.layer) if e.id in self.ids else e for e in part.entities),
                notes=tuple(replace(n, layer=self.layer) if n.id in self.ids else n for n in part.notes),
            ),
        )


@dataclass(frozen=True, slots=True)
class SetLettering:
    """Say of curves that they are strokes of letters, which a tool may follow and which bound nothing; or not."""

    lettering: bool
    ids: frozenset[int]
    name: str = "Set lettering"

    @property
    def reply(self) -> str:
        """A short sentence for the log."""
        what = "strokes of letters" if self.lettering else "curves that may bound areas"
        return f"{len(self.ids)} are {what}."

    def carried_out(self, session: DraftingSession) -> DraftingSession:
        """Return the session that knows it.

        Raises:
            InputError: an id that the part does not have.
        """
        check_ids(session.part, self.ids)
        entities = tuple(replace(e, lettering=self.lettering) if e.id in self.ids else e for e in session.part.entities)
        return replace(session, part=replace(session.part, entities=entities))


@dataclass(frozen=True, slots=True)
class SetLayerStyle:
    """Show or hide a layer, lock or unlock it, or give it a colour.

    Attributes:
        change: the attributes of `Layer` that become other, with their values.
    """

    layer: str
    change: Mapping[str, str | bool]
    reply: str
    name: str = "Layer"

    def carried_out(self, session: DraftingSession) -> DraftingSession:
        """Return the session with the layer changed.

        Raises:
            InputError: there is no such layer.
        """
        layers = session.part.layers
        if all(layer.name != self.layer for layer in layers):
            raise InputError(
                f"There is no layer {self.layer}; the drawing has {', '.join(layer.name for layer in layers)}."
            )
        changed = tuple(replace(layer, **self.change) if layer.name == self.layer else layer for layer in layers)  # type: ignore[arg-type]
        return replace(session, part=replace(session.part, layers=changed))


@dataclass(frozen=True, slots=True)
class Clear:
    """Begin anew with nothing drawn, nothing named and numbers from 1."""

    name: str = "Clear"
    reply: str = "The drawing is empty."

    def carried_out(self, session: DraftingSession) -> DraftingSession:
        """Return the session of an empty drawing of the same name and units."""
        return DraftingSession(Part(units=session.part.units, name=session.part.name), plain=session.plain)


@dataclass(frozen=True, slots=True)
class Undo:
    """Take the last change back."""


@dataclass(frozen=True, slots=True)
class Redo:
    """Do again what was taken back."""


Edit = Clear | Draw | Delete | Transform | ReplaceCurves | SetLayer | SetLettering | SetLayerStyle
"""Commands that change the drawing; each has a name, a reply and `carried_out(session) -> session`."""


def check_ids(part: Part, ids: frozenset[int]) -> None:
    """Check that the part has every one of these entities.

    Raises:
        InputError: it names those that are missing.
    """
    missing = sorted(ids - part.ids()) if ids else []
    if missing:
        listed = ", ".join(map(str, missing[:5])) + (" …" if len(missing) > 5 else "")
        raise InputError(f"The drawing has no entity {listed}; select what to change and repeat without numbers.")
