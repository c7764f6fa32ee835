"""What belongs together in a text of the shape language: repeat, if, define … else … end, brackets; indents and
remarks. No Qt.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import NamedTuple

INDENT = "  "
_OPENS = frozenset({"repeat", "if", "define", "units"})
_WORD = re.compile(r"\"[^\"\n]*\"?|#.*|(?P<word>[^\W\d]\w*)|(?P<end>;)|\S")
_NAMED = re.compile(r"\blet\s+([^\W\d]\w*)|\bas\s+([^\W\d]\w*)|\bdefine\s+([^\W\d]\w*)\s*\(([^)\n]*)")
Place = tuple[int, int, int]
"""Row (0-based), first character, length of a word."""


def block_words(line: str) -> list[tuple[int, str]]:
    """Return (first character, word) of the words in a line that open, divide or close a block."""
    found, first = list[tuple[int, str]](), True
    for token in _WORD.finditer(line):
        word = (token["word"] or "").lower()
        if first and (word in _OPENS or word in ("else", "end")):
            found.append((token.start(), word))
        first = token["end"] is not None
    return found


def family(lines: Sequence[str], row: int, column: int) -> tuple[Place, ...]:
    """Return the places of the words of the block whose opening, dividing or closing word a place is at; () = it is at
    none.
    """
    stack, closed = list[list[Place]](), list[list[Place]]()
    for number, line in enumerate(lines):
        for start, word in block_words(line):
            place = (number, start, len(word))
            if word in _OPENS:
                stack.append([place])
            elif stack:
                stack[-1].append(place)
                if word == "end":
                    closed.append(stack.pop())
    here = [each for each in (*closed, *stack) if any(r == row and s <= column <= s + size for r, s, size in each)]
    return tuple(here[0]) if here else ()


class DepthChange(NamedTuple):
    """How many blocks a line leaves open (less than 0: closes), and whether it begins with else or end."""

    opened: int
    closing: bool


class KnownName(NamedTuple):
    """A name of the drawing, or of a command."""

    name: str
    is_command: bool = False


def depth_change(line: str) -> DepthChange:
    """Return what a line does to the depth of blocks."""
    words = block_words(line)
    change = sum((word in _OPENS) - (word == "end") for _, word in words)
    return DepthChange(change, bool(words) and words[0][1] in ("else", "end") and not line[: words[0][0]].strip())


def indent_after(line: str) -> str:
    """Return the indent of the line that follows a line."""
    own = line[: len(line) - len(line.lstrip())]
    change, closing = depth_change(line)
    steps = change + closing
    return own + INDENT * steps if steps > 0 else own


def switched_remarks(lines: Sequence[str]) -> list[str]:
    """Return lines as remarks, or, where all of them are, as what they were."""
    written = [line for line in lines if line.strip()]
    if written and all(line.lstrip().startswith("#") for line in written):
        return [re.sub(r"^(\s*)# ?", r"\1", line) for line in lines]
    least = min((len(line) - len(line.lstrip()) for line in written), default=0)
    return [f"{line[:least]}# {line[least:]}" if line.strip() else line for line in lines]


def names_in(text: str) -> Iterator[KnownName]:
    """Yield everything that a text names."""
    for found in _NAMED.finditer(text):
        let, label, command, parameters = found.groups()
        yield from (KnownName(name) for name in (let, label) if name)
        if command:
            yield KnownName(command, True)
            yield from (KnownName(name.strip()) for name in parameters.split(",") if name.strip())
