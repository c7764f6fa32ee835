"""The lines that drew what is drawn, so that they can draw it again."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from ..core.errors import InputError
from ..model.part import Part
from .expressions.words import ids_text
from .language.language import command_word
from .language.write import draw_text

_HEEDLESS = frozenset(
    {
        "line",
        "polyline",
        "arc",
        "circle",
        "rect",
        "polygon",
        "slot",
        "ellipse",
        "spline",
        "point",
        "guide",
        "dimension",
        "text",
    }
)
"""Commands that look at no selection and leave it as it is."""


@dataclass(frozen=True, slots=True, eq=False)
class RecordedLine:
    """A line that changed the drawing, and what came before it.

    Attributes:
        line: as it was run; "" where the record begins.
        chosen: the selection that it found. left: the selection that it left.
        before: None where the record begins.
        base: the drawing that the record begins with.
    """

    base: Part
    line: str = ""
    chosen: frozenset[int] = frozenset()
    left: frozenset[int] = frozenset()
    before: RecordedLine | None = None

    def then(self, line: str, chosen: frozenset[int], left: frozenset[int]) -> RecordedLine:
        """Return the record with one line more."""
        return RecordedLine(self.base, line, chosen, left, self)

    def text(self) -> str:
        """Return the text that draws the drawing again, with the same numbers.

        Raises:
            InputError: it begins with a drawing from a file whose numbers have gaps, and no line draws those anew.
        """
        steps = list(self._steps())
        lines = [] if steps and _clears(steps[0].line) else _base_lines(self.base)
        chosen: frozenset[int] = frozenset()
        for step in steps:
            clears, heedless = _clears(step.line), _is_heedless(step.line)
            if step.chosen != chosen and not (clears or heedless):
                lines.append(f"select {ids_text(step.chosen) or 'none'}")
            line = _without_clear(step.line)
            lines += [line] if line else []
            chosen = chosen if heedless else step.left
        return "\n".join(lines) + "\n" if lines else ""

    def _steps(self) -> Iterator[RecordedLine]:
        """Return the lines in order, from the last one on that begins anew."""
        found, at = list[RecordedLine](), self
        while at.before is not None:
            found.append(at)
            if _clears(at.line):
                break
            at = at.before
        return reversed(found)


def _is_heedless(line: str) -> bool:
    """Return whether a line surely looks at no selection and leaves it as it is; of a block nothing is sure."""
    return ";" not in line and "\n" not in line and command_word(line) in _HEEDLESS


def _clears(line: str) -> bool:
    return command_word(line.replace(";", "\n")) == "clear"


def _without_clear(line: str) -> str:
    return line[len("clear") :].lstrip(" \t;\r\n") if _clears(line) else line


def _base_lines(part: Part) -> list[str]:
    things = sorted([e.id for e in part.entities] + [n.id for n in part.notes])
    if not things:
        return []
    if things != list(range(1, len(things) + 1)) or [e.id for e in part.entities] != sorted(
        e.id for e in part.entities
    ):
        raise InputError(
            "The drawing was opened from a file whose numbers have gaps, so its log alone does not draw it; "
            "take the text from the drawing instead."
        )
    return draw_text(part).text.splitlines()
