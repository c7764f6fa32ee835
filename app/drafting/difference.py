"""What one drawing has that another has not: for showing what a command would do before it does."""

from __future__ import annotations

from dataclasses import dataclass

from ..model.notes import Note
from ..model.part import Entity, Part


@dataclass(frozen=True, slots=True)
class DrawingDifference:
    """How a drawing differs from what it was.

    Attributes:
        added: entities that are new, or changed, as they are now. gone: those that are no longer there, or changed, as
            they were.
        notes: that are new, or changed.
    """

    added: tuple[Entity, ...] = ()
    gone: tuple[Entity, ...] = ()
    notes: tuple[Note, ...] = ()


def difference(before: Part, after: Part) -> DrawingDifference:
    """Return what a part has become; entities that are the same object in both cost next to nothing."""
    if before is after:
        return DrawingDifference()
    was, now = before.entities, after.entities
    moved = [(b, a) for b, a in zip(was, now, strict=False) if b is not a]
    gone, added = [b for b, _ in moved] + list(was[len(now) :]), [a for _, a in moved] + list(now[len(was) :])
    old, new = {e.id: e for e in gone}, {e.id: e for e in added}
    notes = {note.id: note for note in before.notes}
    return DrawingDifference(
        tuple(e for e in added if (one := old.get(e.id)) is not e and one != e),
        tuple(e for e in gone if (one := new.get(e.id)) is not e and one != e),
        tuple(note for note in after.notes if notes.get(note.id) != note),
    )
