"""What a line would do to the drawing, tried once and remembered until something has changed."""

from __future__ import annotations

from dataclasses import dataclass, field

from app.edit.difference import Difference, difference
from app.edit.document import Document
from app.edit.errors import reason_of
from app.edit.language import command_word
from app.errors import InputError


@dataclass(frozen=True, slots=True)
class Trial:
    """What a line would do, or why it would not."""

    difference: Difference = field(default_factory=Difference)
    reason: str = ""


HEAVY = frozenset({"offset", "heal", "join", "measure", "explode", "fillet", "chamfer"})
"""Commands that look at all their curves together and do not stop half-way: over many curves they would keep the window."""

FEW_CURVES = 300


def keeps_the_window(line: str, document: Document) -> bool:
    """Tell whether a line may take longer than anybody would wait for with the mouse."""
    curves = len(document.selection) or len(document.part.entities)
    return curves > FEW_CURVES and command_word(line) in HEAVY


class Trials:
    """Tries lines on a document."""

    def __init__(self, document: Document) -> None:
        """Begin with nothing tried."""
        self._document = document
        self._key: tuple[str, int, frozenset[int]] | None = None
        self._last = Trial()

    def of(self, line: str) -> Trial:
        """Return what a line would do; the same line again costs nothing while the document stays as it is."""
        key = (line, self._document.revision, self._document.selection)
        if key != self._key:
            self._key, self._last = key, self._tried(line)
        return self._last

    def _tried(self, line: str) -> Trial:
        if keeps_the_window(line, self._document):
            return Trial()
        try:
            return Trial(difference(self._document.part, self._document.tried(line).part))
        except InputError as error:
            return Trial(reason=reason_of(error))
