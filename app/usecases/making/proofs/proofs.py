"""All that is proven of the operations of a written program: one list of proofs an operation, whatever they are of."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from ....core.progress import Progress
from ....model.finding import Finding
from ....model.job import Job
from ....model.moves import Program
from ....operations.registry import OperationProof, ProofInput, method_of
from ..written import WrittenMotions, WrittenProgram
from .plain_cuts import WrittenPlainCuts


@dataclass(frozen=True, eq=False)
class ProgramProofs:
    """What is proven.

    Attributes:
        kinds: each the proofs of one kind, by index of the operation.
    """

    kinds: tuple[Mapping[int, OperationProof], ...] = ()

    def values(self, index: int) -> dict[str, Any]:
        """Return what a report lists of an operation."""
        return {proofs[index].KEY: proofs[index].values() for proofs in self.kinds if index in proofs}

    def findings(self) -> Iterator[Finding]:
        """Yield what counts."""
        for proofs in self.kinds:
            for proof in proofs.values():
                yield from proof.findings()


def prove(program: Program, job: Job, written: WrittenProgram, progress: Progress) -> ProgramProofs:
    """Return what is proven of a program's operations; what proves a kind is loaded with the first of it.

    Raises:
        Cancelled: by progress.
    """
    if not written.files:
        return ProgramProofs()
    motions = WrittenMotions.of(written, program, job)
    enabled = [each for each in job.operations if each.cut.enabled]
    kinds: list[Mapping[int, OperationProof]] = []
    if any(each.proven_angle is not None for each in job.operations):
        from .engagement import engagement_proofs

        kinds.append(engagement_proofs(job, motions, progress.part(0.0, 0.4)))
    if any(each.CARVES for each in enabled):
        from .carving import carving_proofs

        kinds.append(carving_proofs(program, job, motions, progress.part(0.4, 0.8)))
    kinds.append(dict(_of_their_own(program, job, motions)))
    if any(each.wear for each in enabled):
        from .wear import wear_proofs

        kinds.append(wear_proofs(program, job, written, motions, progress.part(0.8, 1.0)))
    return ProgramProofs(tuple(kinds))


def _of_their_own(program: Program, job: Job, motions: WrittenMotions) -> Iterable[tuple[int, OperationProof]]:
    """Yield what the folders of operations prove of theirs."""
    plain = WrittenPlainCuts(job, motions)
    for index, operation in enumerate(job.operations):
        prove_one = method_of(operation).proof
        if operation.cut.enabled and prove_one is not None:
            own = motions.done_for(index).moved(motions.origin)
            if (proof := prove_one(ProofInput(program, job, index, own, plain))) is not None:
                yield index, proof
