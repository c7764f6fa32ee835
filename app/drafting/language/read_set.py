"""The command `set`: what it asks for, and what comes of it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any

from ...core.errors import InputError
from ...model.curves import Curve, Point
from ...model.notes import Shape
from ...model.part import Part
from ..commands.command import DraftingSession, SetLayer, SetLettering, check_ids
from ..commands.properties import WORDS, PropertyKind, Value, properties_of, with_property
from ..curves.shapes import shown
from ..expressions.arguments import Arguments


@dataclass(frozen=True, slots=True)
class SetProperty:
    """Give one property of curves and notes another value; what else they keep, `properties` says.

    Attributes:
        word: one of `properties.WORDS`. value: mm, or degrees.
    """

    ids: frozenset[int]
    word: str
    value: Value

    @property
    def name(self) -> str:
        """For the Edit menu."""
        return f"Set {self.word}"

    @property
    def reply(self) -> str:
        """A short sentence for the log."""
        if isinstance(self.value, tuple):
            return f"{self.word.capitalize()} {shown(self.value)}."
        return (
            f"{self.word.capitalize()} {self.value:.2f}\u00b0."
            if WORDS[self.word] is PropertyKind.ANGLE
            else (f"{self.word.capitalize()} {self.value:.3f} mm.")
        )

    def carried_out(self, session: DraftingSession) -> DraftingSession:
        """Return the session with these curves and notes changed.

        Raises:
            InputError: an id that the part does not have, or a shape that cannot have the value.
        """
        part = session.part
        entities = tuple(
            replace(e, curve=self._changed(e.id, e.curve)) if e.id in self.ids else e for e in part.entities
        )
        notes = tuple(replace(n, shape=self._changed(n.id, n.shape)) if n.id in self.ids else n for n in part.notes)
        return replace(session, part=replace(part, entities=entities, notes=notes))

    def _changed(self, number: int, shape: Curve | Shape) -> Any:
        try:
            return with_property(shape, self.word, self.value)
        except InputError as wrong:
            raise InputError(str(wrong) if len(self.ids) == 1 else f"{number}: {wrong}") from wrong


def set_property(words: Arguments, session: DraftingSession) -> SetProperty | SetLayer | SetLettering:
    """Give a property of curves another value."""
    found: list[int] = []
    while not (word := words.accept(*WORDS, "layer", "lettering")):
        if not words.more:
            raise words.wrong(f"Write what to set: {', '.join(sorted(WORDS))}, layer or lettering.")
        found.extend(words.some("an entity number"))
    ids = frozenset(found) or session.selection
    if not ids:
        raise InputError("Nothing is selected; select what to set, or write its numbers after set.")
    check_ids(session.part, ids)
    if word == "layer":
        return SetLayer(words.name("the name of a layer"), ids)
    if word == "lettering":
        if not (told := words.accept("yes", "no")):
            raise words.wrong("yes or no is expected: whether these are strokes of letters, which bound nothing.")
        return SetLettering(told == "yes", ids)
    return SetProperty(ids, word, _value(words, session.part, ids, word))


def _value(words: Arguments, part: Part, ids: frozenset[int], word: str) -> Value:
    if WORDS[word] is PropertyKind.ANGLE:
        return words.angle("the angle")
    if WORDS[word] is PropertyKind.LENGTH:
        return words.length("the length")
    words.last = _present(part, ids, word) or words.last
    return words.point()


def _present(part: Part, ids: frozenset[int], word: str) -> Point | None:
    """Return where a property of a single curve or note is now: what @dx,dy counts from."""
    shapes: Iterable[Curve | Shape] = (
        *(e.curve for e in part.entities if e.id in ids),
        *(n.shape for n in part.notes if n.id in ids),
    )
    known = [properties_of(shape)[word].read(shape) for shape in shapes if word in properties_of(shape)]
    return known[0] if len(known) == 1 and isinstance(known[0], tuple) else None
