"""The questions that the terminal asks, in the order of the text."""

from __future__ import annotations

from enum import Enum, auto

from .answers import Offsets


class Ask(Enum):
    """Which question the operator is at, or what goes on."""

    SHAPE = auto()
    DRAW = auto()
    CONTOUR = auto()
    POCKET = auto()
    OVERLAP = auto()
    WORK = auto()
    PLAY = auto()
    LIST = auto()
    DONE = auto()


BACK = {
    Ask.DRAW: Ask.SHAPE,
    Ask.CONTOUR: Ask.SHAPE,
    Ask.POCKET: Ask.CONTOUR,
    Ask.OVERLAP: Ask.POCKET,
    Ask.DONE: Ask.OVERLAP,
}
"""The question before each."""

BUSY = (Ask.WORK, Ask.PLAY, Ask.LIST)
"""Where nothing is asked."""


def prompt(ask: Ask, given: Offsets, drawn: bool) -> str:
    """Return the words of a question, with what Return alone answers in brackets.

    Args:
        given: the amounts on offer.
        drawn: the job has a drawing.
    """
    return {
        Ask.SHAPE: f"SHAPE [{1 if drawn else 2}]?",
        Ask.DRAW: "DRAW?",
        Ask.CONTOUR: f"CONTOUR TOOL OFFSET, MM [{given.contour:.6g}]?",
        Ask.POCKET: f"POCKET TOOL OFFSET, MM [{given.pocket:.6g}]?",
        Ask.OVERLAP: f"POCKET TOOL OVERLAP, MM [{given.overlap:.6g}]?",
    }.get(ask, "RETURN FOR THE MODERN VIEWS, BACK, NEW?")
