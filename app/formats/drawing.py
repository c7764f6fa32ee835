"""What every reader of drawings returns, and every writer."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from ..model.finding import Finding
from ..model.part import Part
from .reading_question import NO_CHOICE, FileContents, ReadingQuestion


class LeftOutKind(NamedTuple):
    """What is left out of a drawing: its type, such as TEXT, and how many there are."""

    kind: str
    number: int


@dataclass(frozen=True)
class Drawing:
    """A drawing as it was read.

    Attributes:
        part: its curves in mm.
        findings: what is worth saying about the file.
        left_out: what is not machined.
        units_named: False when the file names no units and they had to be assumed or given.
        contents: what the file holds that can be chosen from.
        question: what is worth asking about how it was read; None = nothing.
    """

    part: Part
    findings: tuple[Finding, ...] = ()
    left_out: tuple[LeftOutKind, ...] = ()
    units_named: bool = True
    contents: FileContents = NO_CHOICE
    question: ReadingQuestion | None = None


@dataclass(frozen=True, slots=True)
class ConvertedCurves:
    """Curves that the format cannot hold and that became lines and arcs.

    Attributes:
        kind: "ellipse" or "spline".
        count: how many.
        deviation: the largest distance between any of them and what was written for it, mm.
    """

    kind: str
    count: int
    deviation: float


@dataclass(frozen=True)
class WrittenDrawing:
    """A drawing as it was written.

    Attributes:
        data: the whole file.
        converted: what could not be kept exactly, by kind.
        renamed: (layer, its name in the file) where the format forbids the name.
        too_small: how many curves are left out because they are too small for the format.
        notes_left_out: how many points, guides and dimensions are.
    """

    data: bytes
    converted: tuple[ConvertedCurves, ...] = ()
    renamed: tuple[tuple[str, str], ...] = ()
    too_small: int = 0
    notes_left_out: int = 0
