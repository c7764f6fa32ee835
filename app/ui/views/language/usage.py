"""How each word of the shape language is used: read from its manual, so that there is one text. No Qt."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum
from functools import cache

from ....core.resources import resource
from ....drafting.expressions.functions import FUNCTIONS
from ....drafting.language.interpret import RESERVED
from ....drafting.language.language import ALIASES, COMMANDS

_SPAN = re.compile(r"`([^`]+)`")
_BAR = re.compile(r"\|(?=(?:[^`]*`[^`]*`)*[^`]*$)")
_OPTION = re.compile(r"(?<![\w(])[a-z]{2,}(?![\w(])")
_BLOCKS: Mapping[str, tuple[str, str]] = {
    "let": ("let NAME = value", "names a number or a point"),
    "repeat": ("repeat n [as NAME] … end", "carries out the lines n times; the name counts from 0"),
    "if": ("if a < b … else … end", "carries out one list of lines or the other"),
    "units": ("units in … end", "lines in which a length without a unit is in inches, or in another unit"),
    "define": ("define NAME(a, b) … end", "makes a command of your own; it is called with NAME a b"),
    "else": ("if a < b … else … end", "begins what is carried out when the comparison does not hold"),
    "end": ("repeat, if, units or define … end", "ends a block"),
    "as": ("circle P r as NAME, repeat n as NAME", "names what is drawn, or the count"),
}


class WordKind(Enum):
    """What a word is."""

    COMMAND = "command"
    BLOCK = "word of a block"
    FUNCTION = "function"


@dataclass(frozen=True, slots=True)
class Usage:
    """One word.

    Attributes:
        forms: (how it is written, what that does), one for each way; what it does may be "".
        short: other words for it.
    """

    word: str
    kind: WordKind
    forms: tuple[tuple[str, str], ...]
    short: tuple[str, ...] = ()

    @property
    def form(self) -> str:
        """How it is written most often."""
        return self.forms[0][0]

    @property
    def options(self) -> tuple[str, ...]:
        """The words among its arguments, such as close."""
        found = {option for form, _ in self.forms for option in _OPTION.findall(form)}
        return tuple(sorted(found & RESERVED - {self.word}))


@cache
def usages() -> Mapping[str, Usage]:
    """Return the usage of every command, word of a block and function, by its word; a function's has a bracket
    behind.
    """
    page = resource("docs", "language.md").read_text(encoding="utf-8")
    forms: dict[str, list[tuple[str, str]]] = {word: [] for word in COMMANDS}
    told: dict[str, str] = {}
    for row in (line for line in page.splitlines() if line.startswith("|")):
        cells = [cell.strip() for cell in _BAR.split(row.strip()[1:-1])]
        _take_row(_SPAN.findall(cells[0]), re.sub(r"[`*]", "", cells[-1]), forms, told)
    found = {
        word: Usage(word, WordKind.COMMAND, tuple(ways) or ((word, ""),), _short(word)) for word, ways in forms.items()
    }
    found |= {word: Usage(word, WordKind.BLOCK, (form,)) for word, form in _BLOCKS.items()}
    return found | {
        f"{name}(": Usage(name, WordKind.FUNCTION, ((function.shown, told.get(name, "")),))
        for name, function in FUNCTIONS.items()
    }


def usage_of(word: str, function: bool = False) -> Usage | None:
    """Return the usage of a word or a short form, upper or lower case alike; None = it is no word of the language.

    Args:
        word: as it stands in a text.
        function: a bracket follows, so that of a command and a function of one name the function is meant.
    """
    plain = word.lower()
    if function and plain in FUNCTIONS:
        return usages()[f"{plain}("]
    return usages().get(ALIASES.get(plain, plain)) or usages().get(f"{plain}(")


def _take_row(spans: list[str], does: str, forms: dict[str, list[tuple[str, str]]], told: dict[str, str]) -> None:
    """Note what one row of the manual's tables tells: of commands the forms, of functions what they are."""
    current = ""
    for span in spans:
        first = re.match(r"[a-z0-9]+", span)
        word = first[0] if first else ""
        if span[len(word) : len(word) + 1] == "(" and word in FUNCTIONS:
            told.setdefault(word, does)
        elif word in forms and current != "select":
            current = word
            forms[word].append((span, does))
        elif current:
            forms[current].append((f"{current} {span}", ""))


def _short(word: str) -> tuple[str, ...]:
    return tuple(alias for alias, full in ALIASES.items() if full == word)
