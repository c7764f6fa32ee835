"""What every reader of drawings returns."""

from __future__ import annotations

from dataclasses import dataclass

from ..model.finding import Finding
from ..model.part import Part
from .reading_question import NO_CHOICE, Contents, Question


@dataclass(frozen=True)
class Drawing:
    """A drawing as it was read.

    Attributes:
        part: its curves in mm.
        findings: what is worth saying about the file.
        left_out: (type, how many) of what is not machined, such as ("TEXT", 5).
        units_named: False when the file names no units and they had to be assumed or given.
        contents: what the file holds that can be chosen from.
        question: what is worth asking about how it was read; None = nothing.
    """

    part: Part
    findings: tuple[Finding, ...] = ()
    left_out: tuple[tuple[str, int], ...] = ()
    units_named: bool = True
    contents: Contents = NO_CHOICE
    question: Question | None = None
