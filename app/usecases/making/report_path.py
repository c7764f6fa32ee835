"""What a report says of the path: lengths by what they are for, strokes, operations one by one."""

from __future__ import annotations

from enum import Enum
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...model.fields import ParameterPlace, Unit, parameters_of
from ...model.job import Job
from ...model.motion import MotionKind
from ...model.moves import MoveKind, Moves, Program, Purpose
from ...model.operation import Operation
from ...verify.verdict import in_stock
from .written import WrittenProgram

LENGTHS_METHOD = (
    "cut: in metal or where it was; link: between rings; lead: to walls and away from them; entry: ways down below the "
    "stock's top; air: at feed above the stock's top; rapid"
)

_WAYS = {"link": Purpose.LINK, "lead": Purpose.LEAD, "entry": Purpose.PLUNGE}

Json = dict[str, Any]
Mask = NDArray[np.bool_]


def path_lengths(moves: Moves, written: WrittenProgram, top: float, operation: int | None = None) -> dict[str, float]:
    """Return lengths of what was written, mm: cut, link, lead, entry, air, rapid; they add up to the whole.

    Args:
        top: height of the stock's top, mm, program coordinates.
        operation: its index; None = all.
    """
    move, rapid = written.move, written.kind == MoveKind.RAPID
    mine = np.ones(len(rapid), bool) if operation is None else moves.operation[move] == operation
    above = _share_above(written, top)
    purpose = moves.purpose[move]
    below = np.where(rapid, 0.0, 1.0 - above) * written.length
    found = {name: float(np.sum(below[mine & (purpose == way)])) for name, way in _WAYS.items()}
    cut = float(np.sum(below[mine & ~np.isin(purpose, list(_WAYS.values()))]))
    air = float(np.sum((above * written.length)[mine & ~rapid]))
    return {"cut": cut, **found, "air": air, "rapid": float(np.sum(written.length[mine & rapid]))}


def _share_above(written: WrittenProgram, top: float) -> NDArray[np.float64]:
    """Return (m,) which share of each motion lies above the stock's top; along each, Z changes evenly."""
    if not written.programs:
        return np.zeros(0)
    start, end = (
        np.concatenate([getattr(each.motions, name)[:, 2] for each in written.programs]) - top
        for name in ("start", "end")
    )
    high, low = np.maximum(start, end), np.minimum(start, end)
    span = np.where(high > low, high - low, 1.0)
    share: NDArray[np.float64] = (
        np.where(high > low, np.clip(high, 0.0, None) - np.clip(low, 0.0, None), low > 0) / span
    )
    return share


def retracts(moves: Moves) -> int:
    """Return how often the tool leaves the stock."""
    below = in_stock(moves)
    return int(np.sum(below & (moves.end[:, 2] >= 0)))


def strokes_of(moves: Moves, operation: int) -> int:
    """Return how many unbroken runs of feed moves hold moves of an operation that cut."""
    ways = (Purpose.RAPID, *_WAYS.values())
    return _runs(moves, (moves.operation == operation) & ~np.isin(moves.purpose, ways))


def _runs(moves: Moves, chosen: Mask) -> int:
    feed = moves.kind != MoveKind.RAPID
    return len(np.unique(np.cumsum(~feed)[feed & chosen]))


def operation_values(job: Job, index: int, program: Program, written: WrittenProgram, top: float) -> Json:
    """Return an operation as a report lists it.

    Args:
        top: height of the stock's top, mm, program coordinates.
    """
    operation, moves = job.operations[index], program.moves
    mine = moves.operation[written.move] == index
    return {
        "kind": operation.WORD,
        **_parameters(operation),
        **_stepover(job, index, program),
        "strokes": strokes_of(moves, index),
        "length_mm": path_lengths(moves, written, top, index),
        "time_s": float(np.sum(written.moving[mine])),
        "rapid_time_s": float(np.sum(written.moving[mine & (written.kind == MotionKind.RAPID)])),
    }


def _stepover(job: Job, index: int, program: Program) -> Json:
    """Return the stepover that was asked for, or what the program has chosen, of rest runs the most; None where a
    pocket makes no rings.
    """
    operation = job.operations[index]
    if "stepover" not in parameters_of(type(operation)):
        return {}
    requested = _parameters(operation)["stepover_mm"]
    usual = None if operation.COARSE else requested or job.tool(operation.cut.tool).diameter
    return {"stepover_mm": program.stepovers.get(index, requested or usual)}


def _parameters(operation: Operation) -> Json:
    """Return what was asked of an operation, with the unit behind the name; None where nothing was."""
    return {
        f"{key.removesuffix(_suffix(placed))}{_suffix(placed)}": _plain(placed, placed.of(operation))
        for key, placed in parameters_of(type(operation)).items()
    }


def _suffix(placed: ParameterPlace) -> str:
    return _SUFFIXES.get(placed.parameter.unit, "")


def _plain(placed: ParameterPlace, value: Any) -> Any:
    if isinstance(value, Enum):
        return value.value
    if placed.parameter.unit is Unit.CURVES:
        return [each.text for each in value]
    if isinstance(value, tuple):
        return [list(each) if isinstance(each, tuple) else each for each in value]
    return placed.parameter.shown(value) if placed.parameter.unit is Unit.ANGLE and value is not None else value


_SUFFIXES = {Unit.LENGTH: "_mm", Unit.ANGLE: "_deg", Unit.TIME: "_s"}
