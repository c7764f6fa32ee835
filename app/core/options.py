"""Options of the command line in sentences, spelled in the words of the door that was asked: a sentence names an option
and its value, and each door says what stands in their place there.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar

OptionSpelling = Callable[[str, str], str]
"""How a door spells an option, by its name without dashes and its value as it is typed, "" where none is meant."""


def on_command_line(name: str, value: str = "") -> str:
    """Return an option as it is typed."""
    return f"--{name} {value}" if value else f"--{name}"


_SPELLING: ContextVar[OptionSpelling] = ContextVar("spelling", default=on_command_line)


def option(name: str, value: object = "") -> str:
    """Return an option for a sentence, in the words of the door whose call this is.

    A constant keeps the words of whoever loaded it: such sentences are made where they are said.

    Args:
        name: without its dashes, such as "units".
        value: as it is typed, such as "in", or what stands for it, such as "NAME"; "" = the option alone.
    """
    return _SPELLING.get()(name, str(value))


def without_options(sentence: str) -> str:
    """Return a sentence without what it says of the command line's options: a window has no place to type them."""
    return re.sub(r"[;,] [^;]*--[a-z].*$", ".", sentence)


@contextmanager
def spelled(spelling: OptionSpelling) -> Iterator[None]:
    """Have options spelled by a door in what this context says, and in the pieces of work that it shares out."""
    token = _SPELLING.set(spelling)
    try:
        yield
    finally:
        _SPELLING.reset(token)
