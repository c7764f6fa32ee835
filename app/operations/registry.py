"""How each kind of operation is carried out: registered by its folder, asked for by whoever computes a job, judges what
it lacks, or proves its motions as they were read back from the text.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from importlib import import_module
from importlib.util import find_spec
from typing import Any, ClassVar, Protocol

import numpy as np
from numpy.typing import NDArray

from ..core.progress import Progress
from ..model.finding import Finding
from ..model.job import Job
from ..model.motion import Floats
from ..model.moves import Program
from ..model.operation import Operation
from ..model.tool import Tool
from ..toolpath.machining_areas import MachiningArea, MachiningAreas
from ..toolpath.operation_context import OperationContext, PreparedStrokes
from .effort import Workload, along_walls


@dataclass(frozen=True, eq=False)
class OperationMotions:
    """Motions of one operation, n of them.

    Attributes:
        start, end, centre: (n, 3) mm; centres of arcs. Program coordinates, where they were not moved.
        kind: (n,) MotionKind.
        feed: (n,) mm/min.
        line: (n,) of the NC text of its file.
    """

    start: Floats
    end: Floats
    centre: Floats
    kind: NDArray[np.uint8]
    feed: Floats
    line: NDArray[np.int32]

    def __len__(self) -> int:
        return len(self.kind)

    def moved(self, by: tuple[float, float, float]) -> OperationMotions:
        """Return them so many mm along X, Y, Z."""
        return replace(self, start=self.start + by, end=self.end + by, centre=self.centre + by)


@dataclass(frozen=True)
class OperationMethod:
    """How a kind of operation is carried out.

    Attributes:
        paths: makes the moves of the operation with an index in the job of a context.
        missed: what an operation asks for and no path of it will make, from the drawing alone; without an area for one
            on holes, which has none.
        effort: how long paths and their proof take, s, about, by what the contours come to.
        prepared: the strokes of an operation that asks nothing of what those before it have cut, so that they can be
            made beside these; None = where it has nothing to machine. No function: it asks.
        proof: what is proven of an operation that is switched on, on its text as read back; None = where it has
            nothing to machine. No function: nothing.
    """

    paths: Callable[[OperationContext, int, Progress], None]
    missed: Callable[[MachiningAreas, Operation, MachiningArea | None], Iterable[Finding]] = (
        lambda areas, operation, area: ()
    )
    effort: Callable[[Workload, Operation, Tool], float] = along_walls
    prepared: Callable[[OperationContext, int, Progress], PreparedStrokes | None] | None = None
    proof: Callable[[ProofInput], OperationProof | None] | None = None


_METHODS: dict[type[Operation], OperationMethod] = {}


def register(kind: type[Operation], method: OperationMethod) -> None:
    """Make known how a kind of operation is carried out.

    Raises:
        ValueError: that is known already.
    """
    if _METHODS.setdefault(kind, method) is not method:
        raise ValueError(f"operations of the kind {kind.WORD} are carried out in two ways")


def method_of(operation: Operation) -> OperationMethod:
    """Return how an operation is carried out. What comes with the program is imported when the first of its kind is
    asked for: the folder that its word names.

    Raises:
        KeyError: nobody has registered that.
    """
    kind = type(operation)
    if kind not in _METHODS and find_spec(f".{kind.WORD}", __package__):
        import_module(f".{kind.WORD}", __package__)
    return _METHODS[kind]


# What the folder of an operation proves of it, on the written text as it was read back.
#
# A proof shares nothing with the paths but the job: it sees the motions that the control will make, and what was
# asked.


class OperationProof(Protocol):
    """What is proven of one operation.

    Attributes:
        KEY: under which a report lists it.
    """

    KEY: ClassVar[str]

    def values(self) -> dict[str, Any]:
        """Return it as a report lists it."""

    def findings(self) -> Iterable[Finding]:
        """Return what counts."""


class PlainCuts(Protocol):
    """What all operations of a program cut whose tools cut no thread, asked at single points."""

    def lowest(self, points: Floats) -> Floats:
        """Return the lowest heights (m,) that are cut at points (m, 2), mm, part coordinates; infinite where nothing
        is.
        """

    def spacing(self, depth: float) -> float:
        """Return how far apart points may be, mm, for none of the cutters to pass unseen between two of them whose tip
        is so many mm below what is asked for.
        """


@dataclass(frozen=True, eq=False)
class ProofInput:
    """What an operation is proven on.

    Attributes:
        program: that was written; of it what was drawn counts. job: what was asked.
        index: of the operation in the job. motions: that the control makes for it, part coordinates.
        plain: what is cut beside threads.
    """

    program: Program
    job: Job
    index: int
    motions: OperationMotions
    plain: PlainCuts

    @property
    def operation(self) -> Operation:
        """What is proven."""
        return self.job.operations[self.index]
