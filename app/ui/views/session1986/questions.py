"""The questions that the terminal asks, in the order of the text."""

from __future__ import annotations

from enum import Enum, auto

from .answers import EnteredOffsets


class SessionQuestion(Enum):
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
    SessionQuestion.DRAW: SessionQuestion.SHAPE,
    SessionQuestion.CONTOUR: SessionQuestion.SHAPE,
    SessionQuestion.POCKET: SessionQuestion.CONTOUR,
    SessionQuestion.OVERLAP: SessionQuestion.POCKET,
    SessionQuestion.DONE: SessionQuestion.OVERLAP,
}
"""The question before each."""

BUSY = (SessionQuestion.WORK, SessionQuestion.PLAY, SessionQuestion.LIST)
"""Where nothing is asked."""


def prompt(ask: SessionQuestion, given: EnteredOffsets, drawn: bool) -> str:
    """Return the words of a question, with what Return alone answers in brackets.

    Args:
        given: the amounts on offer.
        drawn: the job has a drawing.
    """
    return {
        SessionQuestion.SHAPE: f"SHAPE [{1 if drawn else 2}]?",
        SessionQuestion.DRAW: "DRAW?",
        SessionQuestion.CONTOUR: f"CONTOUR TOOL OFFSET, MM [{given.contour:.6g}]?",
        SessionQuestion.POCKET: f"POCKET TOOL OFFSET, MM [{given.pocket:.6g}]?",
        SessionQuestion.OVERLAP: f"POCKET TOOL OVERLAP, MM [{given.overlap:.6g}]?",
    }.get(ask, "RETURN FOR THE MODERN VIEWS, BACK, NEW?")
