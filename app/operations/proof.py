"""What the folder of an operation proves of it, on the written text as it was read back.

A proof shares nothing with the paths but the job: it sees the motions that the control will make, and what was asked.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, ClassVar, Protocol

from ..model.finding import Finding
from ..model.job import Job
from ..model.moves import Program
from ..model.operation import Operation
from ..model.operation_motions import OperationMotions


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


@dataclass(frozen=True, eq=False)
class ProofInput:
    """What an operation is proven on.

    Attributes:
        program: that was written; of it only what was drawn counts. job: what was asked.
        index: of the operation in the job. motions: that the control makes for it, part coordinates.
    """

    program: Program
    job: Job
    index: int
    motions: OperationMotions

    @property
    def operation(self) -> Operation:
        """What is proven."""
        return self.job.operations[self.index]
