"""What expressions of the shape language stand for, and what they may refer to."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from ...model.curves import Curve, Point
from ...model.notes import Guide
from ...model.part import Part
from . import syntax as s
from .errors import CommandError


@dataclass(frozen=True, slots=True)
class Curves:
    """Entities of the drawing, by number."""

    ids: tuple[int, ...]


class Length(float):
    """A number that is known to be a length, mm; one that is not counts, wherever a length is wanted, in the unit of
    the text.
    """


Value = float | Point | Curves
"""What a name can stand for; lengths in mm, angles in degrees."""


@dataclass(frozen=True, slots=True)
class Scope:
    """What an expression may refer to.

    Attributes:
        names: what the names stand for.
        last: the point that relative coordinates start from, mm.
        part: the drawing that curves are looked up in.
        units: that may stand behind a number, with their sizes.
        plain: what a length counts in that is written without a unit, mm.
    """

    names: Mapping[str, Value] | None = None
    last: Point = (0.0, 0.0)
    part: Part = field(default_factory=Part)
    units: Mapping[str, float] | None = None
    plain: float = 1.0

    def length(self, value: float) -> Length:
        """Return a value as a length, mm."""
        return value if isinstance(value, Length) else Length(value * self.plain)

    def curve(self, value: Curves, place: s.TextSpan) -> Curve:
        """Return the one curve that a value stands for.

        Raises:
            CommandError: it stands for several, for a note, or for one that has been deleted.
        """
        found = self.edge(value, place)
        if any(note.id == value.ids[0] for note in self.part.notes):
            raise wrong(f"{value.ids[0]} is a construction line, which has no ends; a curve is wanted.", place)
        return found

    def edge(self, value: Curves, place: s.TextSpan) -> Curve:
        """Return the one curve that a value stands for, or a construction line as a long line.

        Raises:
            CommandError: it stands for several, for a point or a dimension, or for one that has been deleted.
        """
        if len(value.ids) != 1:
            raise wrong(f"This stands for {len(value.ids)} curves; one is wanted.", place)
        (number,) = value.ids
        found = self.part.curve(number)
        if found is not None:
            return found
        shape = next((note.shape for note in self.part.notes if note.id == number), None)
        if isinstance(shape, Guide):
            return shape.line
        if shape is not None:
            raise wrong(f"{number} is a point or a dimension; a curve is wanted.", place)
        if number >= self.part.next_id():
            raise wrong(f"There is no curve {number}; the drawing's properties show the numbers that there are.", place)
        raise wrong(f"Curve {number} is no longer in the drawing; draw it again or leave this out.", place)


def wrong(reason: str, place: s.TextSpan) -> CommandError:
    """Return the error that something at a place is wrong."""
    return CommandError(reason, place.column, place.line)


def kind_of(value: Value) -> str:
    """Return what a value is, in words."""
    return "a number" if isinstance(value, float) else "a point" if isinstance(value, tuple) else "a curve"
