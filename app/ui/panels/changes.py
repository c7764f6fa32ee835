"""What the side panel does to a job: each function takes a job and returns another one. No Qt."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from enum import Enum
from typing import NamedTuple

from ...core.errors import ParameterError
from ...model.fields import parameters_of
from ...model.job import Job
from ...model.operation import CutParameters, Operation, Order, Side
from ...model.tool import FeedRow, Tool

_CARVING_ANGLE = math.radians(60)
"""The usual V cutter for letters."""


class SubjectKind(Enum):
    """What can be selected in the side panel."""

    JOB = "job"
    TOOL = "tool"
    OPERATION = "operation"


@dataclass(frozen=True, slots=True)
class Subject:
    """What the properties are shown of: the job, the tool with a T number, or the operation at an index."""

    kind: SubjectKind
    key: int = 0

    def in_job(self, job: Job) -> Subject:
        """Return the same subject, or the nearest one that the job has."""
        if self.kind is SubjectKind.TOOL and self.key not in {t.number for t in job.tools}:
            return Subject(SubjectKind.TOOL, job.tools[-1].number) if job.tools else Subject(SubjectKind.JOB)
        if self.kind is SubjectKind.OPERATION and self.key >= len(job.operations):
            return (
                Subject(SubjectKind.OPERATION, len(job.operations) - 1) if job.operations else Subject(SubjectKind.JOB)
            )
        return self


def kind_name(kind: type[Operation]) -> str:
    """Return the trade's name of a kind of operation."""
    return kind.NAME or kind.WORD.capitalize()


def operation_name(operation: Operation) -> str:
    """Return the trade's name of an operation, with its side where it may have another and does not go inside."""
    name = kind_name(type(operation))
    if "side" not in parameters_of(type(operation)):
        return name
    return name + {Side.OUTSIDE: " outside", Side.ON: " on line"}.get(operation.wall_side or Side.INSIDE, "")


def refusal(job: Job, operation: Operation) -> str:
    """Return why an operation's tool cannot do it, or ""."""
    try:
        job.cutter(operation)
    except ParameterError as wrong:
        return str(wrong)
    return ""


def row_for(tool: Tool, material: str) -> FeedRow | None:
    """Return a tool's row of feeds for a material."""
    return next((row for row in tool.feeds if row.material.casefold() == material.casefold()), None)


def for_material(tool: Tool, material: str) -> Tool:
    """Return a tool with the feeds that it has for a material, as whole numbers; as it is where it has none."""
    row = row_for(tool, material)
    if row is None:
        return tool
    made = tool.in_material(row)
    return replace(
        made,
        spindle_speed=float(max(10, round(made.spindle_speed, -1))),
        feed_rate=float(max(1, round(made.feed_rate))),
        plunge_rate=float(max(1, round(made.plunge_rate))),
    )


def material_of(tool: Tool) -> str:
    """Return the material whose feeds a tool has now, "" where they are those of none."""
    return next((row.material for row in tool.feeds if for_material(tool, row.material) == tool), "")


def with_tool(job: Job, number: int, tool: Tool) -> Job:
    """Return the job with the tool `number` replaced; operations that use it follow a change of its number.

    Raises:
        ParameterError: another tool has that number already.
    """
    if tool.number != number and tool.number in {t.number for t in job.tools}:
        raise ParameterError(f"T{tool.number} is another tool of this job; choose a free number.")
    operations = tuple(
        replace(op, cut=replace(op.cut, tool=tool.number)) if op.cut.tool == number else op for op in job.operations
    )
    return replace(job, tools=tuple(tool if t.number == number else t for t in job.tools), operations=operations)


class JobWithTool(NamedTuple):
    """A job, and the T number of the tool that it got."""

    job: Job
    number: int


class JobWithOperation(NamedTuple):
    """A job, and the place of an operation in its list."""

    job: Job
    place: int


def with_new_tool(job: Job) -> JobWithTool:
    """Return the job with one more tool, a copy of the last with the next free number, and that number."""
    number = max((t.number for t in job.tools), default=0) + 1
    like = job.tools[-1] if job.tools else Tool(number, 3.0)
    return JobWithTool(replace(job, tools=(*job.tools, replace(like, number=number, name=""))), number)


def with_library_tool(job: Job, tool: Tool) -> JobWithTool:
    """Return the job with a tool of the library as one more, and its number: its own where that is free, else the
    next.
    """
    taken = {t.number for t in job.tools}
    number = tool.number if tool.number not in taken else max(taken) + 1
    return JobWithTool(replace(job, tools=(*job.tools, replace(tool, number=number))), number)


def without_tool(job: Job, number: int) -> Job:
    """Return the job without a tool.

    Raises:
        ParameterError: an operation uses it.
    """
    users = [operation_name(op) for op in job.operations if op.cut.tool == number]
    if users:
        raise ParameterError(f"T{number} is used by {users[0]}; give that operation another tool first.")
    return replace(job, tools=tuple(t for t in job.tools if t.number != number))


def with_operation(job: Job, index: int, operation: Operation) -> Job:
    """Return the job with one operation replaced."""
    operations = list(job.operations)
    operations[index] = operation
    return replace(job, operations=tuple(operations))


def with_cut(job: Job, index: int, cut: CutParameters) -> Job:
    """Return the job with the parameters of one operation replaced."""
    return with_operation(job, index, replace(job.operations[index], cut=cut))


def with_order(job: Job, order: Order) -> Job:
    """Return the job with an order, and its operations listed as they are cut."""
    contours_first = order is Order.PATENT_1986
    return replace(
        job,
        order=order,
        operations=tuple(sorted(job.operations, key=lambda each: contours_first and not each.FOLLOWS_WALLS)),
    )


def with_moved_operation(job: Job, index: int, place: int) -> JobWithOperation:
    """Return the job with one operation at another place in the list, and its new index; from then on it is cut as
    listed.
    """
    place = min(max(place, 0), len(job.operations) - 1)
    operations = list(job.operations)
    operations.insert(place, operations.pop(index))
    return JobWithOperation(replace(job, operations=tuple(operations), order=Order.POCKET_FIRST), place)


def with_new_operation(
    job: Job, kind: type[Operation], library: Callable[[], Iterable[Tool]] = tuple
) -> JobWithOperation:
    """Return the job with one more operation, as deep as the last one of its kind or the last of all, and its index.

    A V cutter carves as deep as it does by default: what is carved is rarely as deep as what is cleared or cut out.

    Args:
        job: to add to. kind: of the operation.
        library: tools to add one from where none of the job's can do it.

    Raises:
        ParameterError: the job has no tool.
    """
    if not job.tools:
        raise ParameterError("The job has no tool yet; add one first.")
    own = [operation for operation in job.operations if isinstance(operation, kind)]
    alike = own or list(job.operations)
    like = alike[-1].cut if alike else CutParameters(tool=job.tools[0].number)
    if kind.CARVES and not own:
        like = CutParameters(like.tool, min(CutParameters(like.tool).depth, job.stock.thickness))
    job, number = with_fitting_tool(job, kind(like), library)
    place = _place_of_new(job, kind)
    operations = list(job.operations)
    operations.insert(place, kind(replace(like, tool=number, enabled=True, curves=())))
    return JobWithOperation(replace(job, operations=tuple(operations)), place)


def _place_of_new(job: Job, kind: type[Operation]) -> int:
    """Return where in the list an operation goes: pockets and rest machining before the contours, so that a small
    cutter follows walls where a large one has been; nothing but contours behind what cuts parts out.
    """
    contours = [k for k, operation in enumerate(job.operations) if operation.FOLLOWS_WALLS]
    if kind.FOLLOWS_WALLS:
        return len(contours) if job.order is Order.PATENT_1986 else len(job.operations)
    if job.order is not Order.POCKET_FIRST:
        return len(job.operations)
    outlines = [k for k in contours if job.operations[k].wall_side is Side.OUTSIDE]
    first = contours if kind.CLEARS else outlines
    return first[0] if first else len(job.operations)


def with_fitting_tool(job: Job, operation: Operation, library: Callable[[], Iterable[Tool]]) -> JobWithTool:
    """Return the job with a tool that can do an operation, and its number: the operation's own, another one of the job,
    or one of a library, which is added; the operation's own where there is none.
    """
    fitting = [tool for tool in job.tools if not _refused_with(job, operation, tool)]
    own = operation.cut.tool
    if any(tool.number == own for tool in fitting):
        return JobWithTool(job, own)
    if fitting:
        return JobWithTool(job, fitting[0].number)
    found = [tool for tool in library() if not _refused_with(job, operation, tool)]
    if not found:
        return JobWithTool(job, own)
    tool = min(found, key=lambda tool: abs(tool.tip_angle - _CARVING_ANGLE)) if operation.CARVES else found[0]
    return with_library_tool(job, for_material(tool, material_of(job.tools[0])))


def _refused_with(job: Job, operation: Operation, tool: Tool) -> str:
    """Return why a tool, of the job or not, cannot do an operation, or ""."""
    only = replace(job, tools=(tool,), operations=())
    return refusal(only, replace(operation, cut=replace(operation.cut, tool=tool.number)))


def with_copied_operation(job: Job, index: int) -> JobWithOperation:
    """Return the job with an operation twice, one after the other, and the index of the second."""
    operations = list(job.operations)
    operations.insert(index + 1, operations[index])
    return JobWithOperation(replace(job, operations=tuple(operations)), index + 1)


def without_operation(job: Job, index: int) -> Job:
    """Return the job without one operation."""
    return replace(job, operations=job.operations[:index] + job.operations[index + 1 :])
