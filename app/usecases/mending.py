"""What mends a finding: changes of the job, each with the words for a button and what it changes from and to."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

from ..core.errors import ParameterError
from ..model.entry import EntryKind
from ..model.finding import Finding, FindingKind
from ..model.job import Job
from ..model.operation import LEAST_LENGTH, Operation, RestOperation
from ..model.tool import Tool
from ..model.tool_kind import ToolKind
from ..toolpath.advice.advise import standard_tools

SPARE = 0.5
"""mm that a mended length has beyond what was measured: the measure is one of cells."""

RAISE = 5.0
"""mm by which the clearance height goes up where nobody knows how deep a rapid went."""


@dataclass(frozen=True, slots=True)
class Fault:
    """A finding as far as a change of the job depends on it.

    Attributes:
        kind: what is wrong. operation: index of the one that did it; None = nobody knows.
        depth: how deep, or how far too long, mm; None = nobody knows.
        disc: diameter of what fits where metal is left, mm; None = nobody knows.
    """

    kind: FindingKind
    operation: int | None = None
    depth: float | None = None
    disc: float | None = None

    @staticmethod
    def of(finding: Finding, operation: int | None) -> Fault:
        """Return that of a finding; what its amount counts is no depth where it names no line."""
        return Fault(finding.kind, operation, finding.amount if finding.line else None)


@dataclass(frozen=True, eq=False)
class Mend:
    """A change of a job.

    Attributes:
        words: on the button, and in the list of what can be undone. change: from what to what, in words.
        job: the job as it is then.
    """

    words: str
    change: str
    job: Job


def mends(job: Job, fault: Fault, library: Sequence[Tool] = ()) -> tuple[Mend, ...]:
    """Return what mends a fault of a job's program, the least change first; none where the job cannot help it.

    Args:
        job: whose program it is. fault: what is wrong.
        library: tools that may be taken in the place of the job's.
    """
    return tuple(_BY_KIND[fault.kind](job, fault, library)) if fault.kind in _BY_KIND else ()


Maker = Callable[[Job, Fault, Sequence[Tool]], Iterator[Mend]]


def _holder(job: Job, fault: Fault, library: Sequence[Tool]) -> Iterator[Mend]:
    """Let the tool stick out of its holder as far as its contact was deep, or cut less deep."""
    operation = _operation(job, fault)
    if operation is None or fault.depth is None:
        return
    tool = job.tool(operation.cut.tool)
    out = float(math.ceil(tool.stick_out + fault.depth + SPARE))
    if not tool.overall_length or out <= tool.overall_length:
        yield _with_tool(job, tool, replace(tool, stick_out=out), "stick-out", (tool.stick_out, out))
    yield from _less_deep(job, fault, operation)


def _shank(job: Job, fault: Fault, library: Sequence[Tool]) -> Iterator[Mend]:
    """Take a tool of the same end with flutes as long as the cut is deep; or say that it has them; or cut less deep."""
    operation = _operation(job, fault)
    if operation is None or fault.depth is None:
        return
    tool = job.tool(operation.cut.tool)
    flutes = float(math.ceil(tool.flute_length + fault.depth + SPARE))
    fitting = [each for each in library if _same_end(each, tool) and each.flute_length >= flutes]
    if fitting:
        other = min(fitting, key=lambda each: each.flute_length)
        placed = replace(other, number=tool.number)
        tools = tuple(placed if each.number == tool.number else each for each in job.tools)
        lengths = f"flutes {tool.flute_length:g} \u2192 {other.flute_length:g} mm"
        yield Mend(f"T{tool.number} of the library", lengths, replace(job, tools=tools))
    if not tool.overall_length or flutes <= tool.overall_length:
        yield _with_tool(job, tool, replace(tool, flute_length=flutes), "flutes", (tool.flute_length, flutes))
    yield from _less_deep(job, fault, operation)


def _left(job: Job, fault: Fault, library: Sequence[Tool]) -> Iterator[Mend]:
    """Clear what is left with the smallest mill of the job; out of its reach, with the largest that fits."""
    resting = [each for each in job.operations if isinstance(each, RestOperation)]
    mills = [tool for tool in job.tools if tool.kind in (ToolKind.FLAT, ToolKind.BULL)]
    if not mills:
        return
    smallest = min(mills, key=lambda tool: tool.diameter)
    off = next((each for each in resting if not each.cut.enabled), None)
    if fault.kind is FindingKind.LEFT_REACHABLE and off is not None:
        on = replace(off, cut=replace(off.cut, enabled=True))
        operations = tuple(on if each is off else each for each in job.operations)
        yield Mend(f"Rest operation T{off.cut.tool} on", "off \u2192 on", replace(job, operations=operations))
        return
    if fault.kind is FindingKind.LEFT_REACHABLE:
        yield _rest(job, fault, smallest)
        return
    fits = [each for each in standard_tools() if fault.disc is not None and each.diameter <= fault.disc]
    advised = max(fits, key=lambda tool: tool.diameter, default=None)
    if advised is not None and advised.diameter < smallest.diameter:
        number = max(tool.number for tool in job.tools) + 1
        added = replace(smallest, number=number, diameter=advised.diameter, name="", corner_radius=0.0, feeds=())
        added = replace(added, kind=ToolKind.FLAT, shank_diameter=0.0, flute_length=0.0)
        yield _rest(replace(job, tools=(*job.tools, added)), fault, added)


def _rest(job: Job, fault: Fault, tool: Tool) -> Mend:
    """Return the job with a rest operation behind the one that left something, or behind the last that clears."""
    clearing = [k for k, each in enumerate(job.operations) if each.CLEARS]
    after = fault.operation if fault.operation is not None else clearing[-1] if clearing else 0
    like = job.operations[after].cut
    cut = replace(like, tool=tool.number, enabled=True, stepdown=min(like.stepdown, tool.diameter))
    operations = list(job.operations)
    operations.insert(after + 1, RestOperation(cut))
    return Mend(f"Rest operation with T{tool.number} {tool.label}", "added", replace(job, operations=tuple(operations)))


def _rapid(job: Job, fault: Fault, library: Sequence[Tool]) -> Iterator[Mend]:
    """Travel higher."""
    higher = float(math.ceil(job.safe_z + (fault.depth if fault.depth is not None else RAISE) + SPARE))
    change = f"{job.safe_z:g} \u2192 {higher:g} mm"
    yield Mend(f"Clearance height {higher:g} mm", change, replace(job, safe_z=higher))


def _plunge(job: Job, fault: Fault, library: Sequence[Tool]) -> Iterator[Mend]:
    """Go down along a slope."""
    operation = _operation(job, fault)
    if operation is None or operation.cut.entry.kind is EntryKind.RAMP or operation.DRILLS:
        return
    cut = replace(operation.cut, entry=replace(operation.cut.entry, kind=EntryKind.RAMP))
    change = f"{operation.cut.entry.kind.value} \u2192 ramp along the path"
    yield Mend("Ramp into the metal", change, _with_operation(job, fault, replace(operation, cut=cut)))


def _below_table(job: Job, fault: Fault, library: Sequence[Tool]) -> Iterator[Mend]:
    """Lay the stock on waste as thick as the cut goes below it, or cut less deep."""
    if fault.depth is None:
        return
    under = math.ceil(2 * (fault.depth + 0.1)) / 2
    stock = replace(job.stock, under=under)
    change = f"{job.stock.under:g} \u2192 {under:g} mm under the stock"
    yield Mend(f"Waste board {under:g} mm", change, replace(job, stock=stock))
    operation = _operation(job, fault)
    if operation is not None:
        yield from _less_deep(job, replace(fault, depth=fault.depth - job.stock.under), operation, spare=0.0)


def _less_deep(job: Job, fault: Fault, operation: Operation, spare: float = SPARE) -> Iterator[Mend]:
    """Have no operation with the tool go deeper than what the one that did it may."""
    assert fault.depth is not None
    before = operation.cut.depth
    depth = math.floor(1000 * (before - fault.depth - spare) + 1e-6) / 1000
    if depth < LEAST_LENGTH:
        return
    try:
        operations = tuple(_not_deeper(each, operation.cut.tool, depth) for each in job.operations)
    except ParameterError:  # a finish pass, or what is left on the floor, is thicker than that
        return
    yield Mend(f"Depth {depth:g} mm", f"{before:g} \u2192 {depth:g} mm", replace(job, operations=operations))


def _not_deeper(operation: Operation, tool: int, depth: float) -> Operation:
    cut = operation.cut
    if cut.tool != tool or cut.depth <= depth:
        return operation
    return replace(operation, cut=replace(cut, depth=depth, stepdown=min(cut.stepdown, depth)))


def _with_tool(job: Job, tool: Tool, changed: Tool, what: str, lengths: tuple[float, float]) -> Mend:
    tools = tuple(changed if each.number == tool.number else each for each in job.tools)
    change = f"{lengths[0]:g} \u2192 {lengths[1]:g} mm"
    return Mend(f"T{tool.number} {what} {lengths[1]:g} mm", change, replace(job, tools=tools))


def _same_end(one: Tool, other: Tool) -> bool:
    return one.kind is other.kind and one.shape == other.shape


def _operation(job: Job, fault: Fault) -> Operation | None:
    known = fault.operation is not None and fault.operation < len(job.operations)
    return job.operations[fault.operation] if known and fault.operation is not None else None


def _with_operation(job: Job, fault: Fault, operation: Operation) -> Job:
    operations = list(job.operations)
    assert fault.operation is not None
    operations[fault.operation] = operation
    return replace(job, operations=tuple(operations))


_BY_KIND: dict[FindingKind, Maker] = {
    FindingKind.HOLDER_CONTACT: _holder,
    FindingKind.SHANK_CONTACT: _shank,
    FindingKind.LEFT_REACHABLE: _left,
    FindingKind.LEFT_UNREACHABLE: _left,
    FindingKind.RAPID_IN_MATERIAL: _rapid,
    FindingKind.PLUNGE: _plunge,
    FindingKind.BELOW_TABLE: _below_table,
}
