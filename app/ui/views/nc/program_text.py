"""A program's text as lines that are cut out only when they are looked at, and what is found in it. No Qt."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ....gcode.interpreter.text import ProgramBuffer

Ints = NDArray[np.int64]

MOST_MARKED = 5_000
"""So many lines with a hit are marked beside the scroll bar; more would be one solid bar."""


@dataclass(frozen=True, eq=False)
class ProgramText:
    """Lines of a program, split as the NC reader splits them.

    Attributes:
        text: all of it, lines ended by a line feed.
        folded: the same in lower case, character for character.
        starts, ends: (n,) where each line begins and ends in the text, its line feed left out.
    """

    text: str
    folded: str
    starts: Ints
    ends: Ints

    def __len__(self) -> int:
        return len(self.starts)

    def line(self, row: int) -> str:
        """Return a line (0-based) without its end."""
        return self.text[self.starts[row] : self.ends[row]]

    def piece(self, row: int, first: int, count: int) -> str:
        """Return at most `count` characters of a line from its character `first` (0-based) on."""
        begin = int(self.starts[row]) + first
        return self.text[begin : min(begin + count, int(self.ends[row]))]

    def length(self, row: int) -> int:
        """Return how many characters a line has."""
        return int(self.ends[row] - self.starts[row])

    @property
    def longest(self) -> int:
        """Characters of the longest line."""
        return int(np.max(self.ends - self.starts, initial=0))

    def rows(self, first: int, last: int) -> str:
        """Return the lines from `first` to `last` (0-based, both included), joined by line feeds."""
        return self.text[self.starts[first] : self.ends[last]]

    def row_at(self, position: int) -> int:
        """Return the row of a position in the text."""
        return int(np.searchsorted(self.starts, position, side="right")) - 1

    def find(self, words: str, position: int, back: bool = False) -> int | None:
        """Return where words stand next, upper or lower case alike, going on from the other end; None = nowhere.

        Args:
            words: what to look for, not empty.
            position: where to begin; what begins there counts, but not when going back.
            back: look towards the beginning.
        """
        sought = words.lower()
        if back:
            found = self.folded.rfind(sought, 0, max(position - 1, 0) + len(sought)) if position > 0 else -1
            found = found if found >= 0 else self.folded.rfind(sought)
        else:
            found = self.folded.find(sought, position)
            found = found if found >= 0 else self.folded.find(sought)
        return found if found >= 0 else None

    def count(self, words: str, before: int | None = None) -> int:
        """Return how often words stand in the text, or in what lies before a position."""
        return self.folded.count(words.lower(), 0, before) if words else 0

    def rows_with(self, words: str) -> Ints:
        """Return the rows that hold words, in order; the first 5,000 hits."""
        found: list[int] = []
        sought, at = words.lower(), -1
        while sought and len(found) < MOST_MARKED and (at := self.folded.find(sought, at + 1)) >= 0:
            found.append(at)
        return np.unique(np.searchsorted(self.starts, np.array(found, np.int64), side="right") - 1)


def program_text(data: bytes) -> ProgramText:
    """Return the lines of a file's bytes."""
    read = ProgramBuffer(data)
    text = read.data.decode(read.encoding)
    codes = (
        np.frombuffer(read.data, np.uint8)
        if read.encoding == "ascii"
        else np.frombuffer(text.encode("utf-32-le"), np.uint32)
    )
    ends = np.flatnonzero(codes == ord("\n")).astype(np.int64)
    starts = np.concatenate([np.zeros(min(1, len(ends)), np.int64), ends[:-1] + 1])
    lower = text.lower()
    return ProgramText(text, lower if len(lower) == len(text) else text, starts, ends)
