"""What a line that is being typed could go on with: commands and their words, names, layers, properties."""

from __future__ import annotations

import re
from collections.abc import Iterable

from ....drafting.commands.properties import WORDS
from ....drafting.document import Document
from ....drafting.expressions.values import Curves
from ....drafting.expressions.words import name_text
from ...views.language.completion import CompletionItem, names_of, offers, word_before

_LAYER = re.compile(
    r"(?:^|;)\s*(?:layer|la|hide|show|lock|unlock|colou?r|(?:select|se)\s+(?:(?:add|remove)\s+)?layer|(?:rename|remove)\s+layer|set\s.*\blayer)"
    r"\s+(?P<begun>\"[^\"]*|[^\s\"]*)$",
    re.IGNORECASE,
)
_SET = re.compile(r"(?:^|;)\s*set\s(?:[\d\s-]|\b\w+\s)*(?P<begun>[a-z]*)$", re.IGNORECASE)
_PLAIN = re.compile(r"\w+")


def completions(line: str, document: Document) -> tuple[str, list[CompletionItem]]:
    """Return what stands at the end of a line, cut at the cursor, and what it could become, best first."""
    if (found := _LAYER.search(line)) is not None:
        layers = _layers(found["begun"], (layer.name for layer in document.part.layers))
        return found["begun"], [CompletionItem(name, "layer") for name in layers]
    session = document.session
    begun = word_before(line)
    if (found := _SET.search(line)) is not None and not any(
        re.search(rf"\b{word}\s", line) for word in (*WORDS, "layer")
    ):
        words = [
            CompletionItem(word, WORDS[word].value if word in WORDS else "layer", " ")
            for word in (*sorted(WORDS), "layer")
        ]
        words += [
            CompletionItem(name, "your curve", " ")
            for name, value in session.names.items()
            if isinstance(value, Curves)
        ]
        return begun, [offer for offer in words if offer.word.startswith(begun.lower())]
    return begun, offers(line, names_of(session))


def _layers(begun: str, layers: Iterable[str]) -> list[str]:
    """Return the layers whose names begin so, as the language writes them."""
    bare, quoted = begun.lstrip('"').casefold(), begun.startswith('"')
    return [
        name_text(name) if quoted or not _PLAIN.fullmatch(name) else name
        for name in layers
        if name.casefold().startswith(bare)
    ]


def common_beginning(words: list[str]) -> str:
    """Return what all words begin with."""
    low, high = min(words), max(words)
    return low[: next((at for at, (a, b) in enumerate(zip(low, high, strict=False)) if a != b), len(low))]
