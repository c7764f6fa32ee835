"""What the operator answers, checked, and the job that it makes: two tools, each by its offset."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

from ....core.errors import InputError
from ....drafting.expressions.errors import CommandError
from ....drafting.expressions.numbers import length
from ....model.contour_operation import ContourOperation
from ....model.job import Job
from ....model.operation import CutParameters, Operation, PocketOperation
from ....model.tool import Tool
from ....model.tool_kind import ToolKind


@dataclass(frozen=True, slots=True)
class EnteredOffsets:
    """The three amounts that the text has entered.

    Attributes:
        contour, pocket: offset of each tool = its radius, mm, > 0.
        overlap: of the pocket tool's paths, mm, in (0, 2 pocket).
    """

    contour: float
    pocket: float
    overlap: float

    @property
    def step(self) -> float:
        """Distance between the pocket tool's paths, mm."""
        return 2 * self.pocket - self.overlap


def offered(job: Job) -> EnteredOffsets:
    """Return what a job's own tools amount to."""
    pocket, contour = _operations(job)
    radius = _tool(job, pocket, Tool(1, 6.0)).radius
    step = radius if pocket.stepover is None else min(pocket.stepover, 2 * radius - 1e-3)
    return EnteredOffsets(_tool(job, contour, Tool(2, 3.0)).radius, radius, 2 * radius - step)


def amount(text: str, low: float, high: float) -> float:
    """Return the length that an answer states, mm.

    Args:
        text: a number, with or without a unit.
        low, high: the least and the most, mm, > 0.

    Raises:
        InputError: it is no length, or out of its range; in the terminal's words.
    """
    try:
        value = length(text.lower())
    except CommandError as error:
        raise InputError(f"? {error.reason}") from error
    if not low <= value <= high:
        raise InputError(
            f"? {value:g} mm is out of range. Enter {_inwards(low, math.ceil)} to {_inwards(high, math.floor)} mm."
        )
    return value


def _inwards(value: float, towards: Callable[[float], int]) -> str:
    """Return a limit with three figures, rounded so that it is still allowed."""
    unit = 10.0 ** (math.floor(math.log10(value)) - 2)
    return f"{towards(value / unit) * unit:.6g}"


def job_of(job: Job, given: EnteredOffsets) -> Job:
    """Return the job with a pocket and a contour operation whose tools have these offsets, and with no other.

    Speeds, feeds, depths and everything else stay; a tool whose offset is what it was stays as it is, another becomes
    flat.
    """
    pocket, contour = _operations(job)
    large = _sized(_tool(job, pocket, Tool(1, 6.0)), given.pocket)
    small = _sized(_tool(job, contour, Tool(2, 3.0)), given.contour)
    if small.number == large.number:
        small = replace(small, number=max(tool.number for tool in (*job.tools, large)) + 1)
    own = {large.number: large, small.number: small}
    tools = (*own.values(), *(tool for tool in job.tools if tool.number not in own))
    stepover = None if abs(given.step - given.pocket) < 1e-9 else given.step
    operations: tuple[Operation, ...] = (
        PocketOperation(_cut(pocket.cut, large), stepover),
        ContourOperation(_cut(contour.cut, small)),
    )
    return replace(job, tools=tools, operations=operations)


def _operations(job: Job) -> tuple[PocketOperation, ContourOperation]:
    """Return the job's first pocket and contour operation, or usual ones."""
    pocket = next(
        (each for each in job.operations if isinstance(each, PocketOperation)), PocketOperation(CutParameters(tool=1))
    )
    contour = next(
        (each for each in job.operations if isinstance(each, ContourOperation)), ContourOperation(CutParameters(tool=2))
    )
    return pocket, contour


def _tool(job: Job, operation: Operation, usual: Tool) -> Tool:
    return next((tool for tool in job.tools if tool.number == operation.cut.tool), usual)


def _cut(cut: CutParameters, tool: Tool) -> CutParameters:
    """Return the cut with another tool; the offset is all that it keeps from the walls."""
    return replace(cut, tool=tool.number, enabled=True, stock_to_leave=0.0)


def _sized(tool: Tool, radius: float) -> Tool:
    return (
        tool if abs(tool.radius - radius) < 1e-9 else replace(tool.as_kind(ToolKind.FLAT), diameter=2 * radius, name="")
    )
