"""What there is to say of the ways that an operation takes into the metal."""

from __future__ import annotations

from dataclasses import dataclass, field

from ...model.curves import Point
from ...model.entry import EntryKind
from ...model.finding import Finding, FindingKind
from ...model.tool import Tool


@dataclass
class EntryFallbacks:
    """Entries that are not as asked, by kind: how many, and where the first one is."""

    others: dict[EntryKind, tuple[int, Point]] = field(default_factory=dict)

    def note(self, requested: EntryKind, taken: EntryKind, place: Point) -> None:
        """Count an entry."""
        if taken is not requested:
            count, first = self.others.get(taken, (0, place))
            self.others[taken] = count + 1, first

    def findings(self, tool: Tool, requested: EntryKind) -> tuple[Finding, ...]:
        """Return one remark, if any entry is not as asked."""
        if not self.others:
            return ()
        kinds = [kind for kind in _WORDS if kind in self.others]
        said = [_said(kind, *self.others[kind], _reason(requested, kind)) for kind in kinds]
        x, y = self.others[kinds[0]][1]
        text = f"T{tool.number} {tool.label}: {'; '.join(said)}."
        return (
            Finding(FindingKind.ENTRY, text, x, y, counts=False, amount=float(sum(n for n, _ in self.others.values()))),
        )


_WORDS = {EntryKind.PLUNGE: "straight down", EntryKind.RAMP: "a ramp along the path", EntryKind.HELIX: "a helix"}
"""Worst first."""


def _said(kind: EntryKind, count: int, place: Point, reason: str) -> str:
    entries = "1 entry is" if count == 1 else f"{count} entries are"
    first = "" if count == 1 else "the first "
    return f"{entries} {_WORDS[kind]} as {reason}, {first}at ({place[0]:.3f}, {place[1]:.3f})"


def _reason(requested: EntryKind, taken: EntryKind) -> str:
    if requested is EntryKind.PREDRILLED:
        return "no drilled hole is near"
    if taken is EntryKind.PLUNGE:
        return "no ramp fits" if requested is EntryKind.RAMP else "neither helix nor ramp fits"
    return "no helix fits"
