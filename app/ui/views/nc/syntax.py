"""Which part of a line is what: comments, G and M words, numbers of lines, parameters. No Qt; for colours only."""

from __future__ import annotations

import re
from enum import Enum
from typing import NamedTuple


class SyntaxPart(Enum):
    """What a stretch of text is."""

    PLAIN = "plain"
    COMMENT = "comment"
    LINE_NUMBER = "line number"
    COMMAND = "command"
    SETTING = "setting"
    FLOW = "flow"


class Span(NamedTuple):
    """A part of a line, from its first character to behind its last."""

    first: int
    stop: int
    part: SyntaxPart


_FLOW_WORDS = (
    "sub|endsub|call|return|if|elseif|else|endif|while|endwhile|do|end\\d*|repeat|endrepeat|break|continue|goto|then"
)
_NUMBER = r"[-+]?\s*(?:\d[\d ]*\.?\d*|\.\d+)"
_PARTS = re.compile(
    r"(?P<comment>\([^)]*\)?|;.*|^\s*%.*)"
    rf"|(?P<flow>o\s*(?:<[^>]*>|\d+)|#\s*(?:<[^>]*>|\d+)?|\b(?:{_FLOW_WORDS})\b|\b(?:a?sin|a?cos|a?tan|abs|sqrt|exp|ln|fix|fup|round|exists"
    r"|mod|and|x?or|eq|ne|[gl][te])(?=[\s\[])|[\[\]=])"
    rf"|(?P<number>n\s*\d+\.?\d*)|(?P<command>[gm]\s*{_NUMBER})|(?P<setting>[fst]\s*{_NUMBER})",
    re.IGNORECASE,
)
_KINDS = {
    "comment": SyntaxPart.COMMENT,
    "flow": SyntaxPart.FLOW,
    "number": SyntaxPart.LINE_NUMBER,
    "command": SyntaxPart.COMMAND,
    "setting": SyntaxPart.SETTING,
}


def spans(line: str) -> list[Span]:
    """Return the parts of a line in order and without gaps."""
    found: list[Span] = []
    at = 0
    for match in _PARTS.finditer(line):
        first, last = match.start(), match.start() + len(match.group().rstrip())
        if first > at:
            found.append(Span(at, first, SyntaxPart.PLAIN))
        found.append(Span(first, last, _KINDS[match.lastgroup or ""]))
        at = last
    if at < len(line):
        found.append(Span(at, len(line), SyntaxPart.PLAIN))
    return found
