"""What every reader of drawings returns, and every writer."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum
from typing import NamedTuple

from ..model.finding import Finding
from ..model.part import Part
from .reading_question import NO_CHOICE, FileContents, ReadingQuestion

MOST_LETTERS = 10_000
"""Of one text; more is no text."""


class LeftOutReason(Enum):
    """Why something is left out of a drawing, in the words that stand in brackets behind its type."""

    DAMAGED = "damaged"
    INVISIBLE = "invisible"
    UNPAINTED = "without stroke and fill"
    CLIPPED = "clipped away"
    GROUND = "white ground of the page"
    AS_ASKED = "as asked"
    TOO_LONG = f"of more than {MOST_LETTERS} letters"
    FILLS_LENGTH = "vertical, to fill a length"


class LeftOutSort(NamedTuple):
    """What is left out of a drawing alike.

    Attributes:
        kind: its type, such as TEXT. reason: why one of this type is left out that others are read; None = nobody reads
            this type, or its outlines are elsewhere.
    """

    kind: str
    reason: LeftOutReason | None = None

    @property
    def said(self) -> str:
        """What it is called in sentences."""
        return self.kind if self.reason is None else f"{self.kind} ({self.reason.value})"


LeftOutCounts = Mapping[LeftOutSort, int]
"""How many of each sort are left out."""


class LeftOutKind(NamedTuple):
    """What is left out of a drawing: its type, such as TEXT, and how many there are."""

    kind: str
    number: int


def left_out_kinds(counts: LeftOutCounts) -> tuple[LeftOutKind, ...]:
    """Return what is left out as sentences have it, in the order of the alphabet."""
    return tuple(sorted(LeftOutKind(sort.said, count) for sort, count in counts.items()))


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
