"""What a line would do to the drawing, tried once and remembered until something has changed."""

from __future__ import annotations

import re
from dataclasses import dataclass, field

from ....core.errors import InputError
from ....drafting.difference import DrawingDifference, difference
from ....drafting.document import Document
from ....drafting.expressions.errors import reason_of
from ....drafting.language.language import command_word


@dataclass(frozen=True, slots=True)
class CommandTrial:
    """What a line would do, or why it would not."""

    difference: DrawingDifference = field(default_factory=DrawingDifference)
    reason: str = ""


_NUMBERS_BEFORE = {"offset": 1, "heal": 1, "join": 0, "measure": 0, "explode": 0, "fillet": 1, "chamfer": 1}
"""Commands that look at all their curves together and do not stop half-way, and how many numbers stand before those
curves.
"""

_OPTIONS = re.compile(r"\b(?:and|within)\s+\S+|\bround\b")
_FEW_CURVES = 300


def keeps_the_window(line: str, document: Document) -> bool:
    """Tell whether a line may take longer than anybody would wait for with the mouse."""
    word = command_word(line)
    return word in _NUMBERS_BEFORE and _concerned(word, line, document) > _FEW_CURVES


def _concerned(word: str, line: str, document: Document) -> int:
    """Return how many curves such a command looks at; where ranges or names tell, as many as there are."""
    said = _OPTIONS.sub(" ", line).split()[1 + _NUMBERS_BEFORE[word] :]
    curves = [each for each in said if "," not in each and "<" not in each]
    if curves:
        return len(curves) if all(each.isdigit() for each in curves) else len(document.part.entities)
    if word == "heal":
        return len(document.part.entities)
    return 0 if word == "measure" and said else len(document.selection)


class CommandTrials:
    """Tries lines on a document."""

    def __init__(self, document: Document) -> None:
        """Begin with nothing tried."""
        self._document = document
        self._key: tuple[str, int, frozenset[int]] | None = None
        self._last = CommandTrial()

    def of(self, line: str) -> CommandTrial:
        """Return what a line would do; the same line again costs nothing while the document stays as it is."""
        key = (line, self._document.revision, self._document.selection)
        if key != self._key:
            self._key, self._last = key, self._tried(line)
        return self._last

    def _tried(self, line: str) -> CommandTrial:
        if keeps_the_window(line, self._document):
            return CommandTrial()
        try:
            return CommandTrial(difference(self._document.part, self._document.tried(line).part))
        except InputError as error:
            return CommandTrial(reason=reason_of(error))
