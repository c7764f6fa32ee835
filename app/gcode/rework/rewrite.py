"""A program's text with some of its stretches written anew; all other lines stay, byte for byte."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from ..interpreter.text import ProgramBuffer
from .stretches import FeedStretch

_HEAD = re.compile(r"\s*(?:%.*|[O:]\s*\d+.*|\(.*|;.*)?$", re.IGNORECASE)
"""Lines that notes go behind: the tape's mark, the program's number, its first comments."""


@dataclass(frozen=True)
class RewrittenText:
    """The new text.

    Attributes:
        data: its bytes, with the line ends of the old one.
        lines: of each stretch that was written anew, its first and last line in the new text, 1-based.
    """

    data: bytes
    lines: Mapping[int, tuple[int, int]]


def rewrite(
    data: bytes, stretches: Sequence[FeedStretch], blocks: Mapping[int, Sequence[str]], notes: Sequence[str]
) -> RewrittenText:
    """Return a program in which the lines of some stretches are replaced.

    Args:
        data: the program's bytes.
        stretches: in the order of the text.
        blocks: the new lines of some of them, by index.
        notes: comment lines that are put behind the program's head.
    """
    text = ProgramBuffer(data)
    old = text.data.decode(text.encoding).split("\n")[:-1]
    new: list[str] = []
    at, lines = 0, {}
    behind = next((k for k, line in enumerate(old) if not _HEAD.match(line)), len(old))
    first = stretches[min(blocks)].first_line - 1 if blocks else len(old)
    behind = min(behind, first)
    new += old[:behind] + list(notes)
    at = behind
    for index in sorted(blocks):
        stretch = stretches[index]
        new += old[at : stretch.first_line - 1]
        lines[index] = (len(new) + 1, len(new) + len(blocks[index]))
        new += blocks[index]
        at = stretch.last_line
    new += old[at:]
    end = "\r\n" if b"\r\n" in data else "\n"
    return RewrittenText(end.join([*new, ""]).encode(text.encoding if text.encoding != "ascii" else "ascii"), lines)
