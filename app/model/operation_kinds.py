"""The kinds of operation, each by its word, and the parameters of all of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from .adaptive_operation import AdaptiveOperation
from .chamfer_operation import ChamferOperation
from .contour_operation import ContourOperation
from .face_operation import FaceOperation
from .fields import ParameterPlace, declared_of, parameters_of
from .hole_operations import (
    BoreOperation,
    CountersinkOperation,
    DrillOperation,
    ReamOperation,
    TapOperation,
    ThreadOperation,
)
from .operation import Operation, PocketOperation, RestOperation, Side
from .slot_operation import SlotOperation
from .vcarve_operation import VcarveOperation

OPERATION_KINDS: dict[str, type[Operation]] = {}
"""By the words of job files, reports and NC headers; `register` adds to it."""


@dataclass(frozen=True)
class OperationAlias:
    """What jobs may also call a kind of operation.

    Attributes:
        kind: its word. key, value: of the parameter that makes it what the other word says.
    """

    kind: str
    key: str
    value: object


ALIASES = {"engrave": OperationAlias(ContourOperation.WORD, "side", Side.ON)}
"""By the other word."""


def register(kind: type[Operation]) -> None:
    """Make a kind of operation known to job files, options, forms, headers and reports.

    Raises:
        ValueError: another kind has its word.
    """
    if OPERATION_KINDS.setdefault(kind.WORD, kind) is not kind:
        raise ValueError(f"two kinds of operation are called {kind.WORD}")


for _kind in (
    PocketOperation,
    AdaptiveOperation,
    RestOperation,
    ContourOperation,
    SlotOperation,
    VcarveOperation,
    ChamferOperation,
    DrillOperation,
    ReamOperation,
    TapOperation,
    CountersinkOperation,
    BoreOperation,
    ThreadOperation,
    FaceOperation,
):
    register(_kind)


def declared() -> dict[str, ParameterPlace]:
    """Return every parameter of every kind by key."""
    return {key: placed for kind in OPERATION_KINDS.values() for key, placed in declared_of(kind).items()}


class UsedParameter(NamedTuple):
    """A parameter, and the kinds of operation that it has an effect on."""

    place: ParameterPlace
    kinds: tuple[type[Operation], ...]


def parameters() -> dict[str, UsedParameter]:
    """Return every parameter of every kind by key, and the kinds that it has an effect on."""
    found: dict[str, UsedParameter] = {}
    for kind in OPERATION_KINDS.values():
        for key, placed in parameters_of(kind).items():
            first, kinds = found.get(key, (placed, ()))
            found[key] = UsedParameter(first, (*kinds, kind))
    return found
