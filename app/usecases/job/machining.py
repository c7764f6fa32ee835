"""How a job is to be machined beyond tools and stepover: what was asked for, put into its operations."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from typing import Any

from ...core.errors import ParameterError
from ...core.options import option
from ...core.toml_tables import known_words
from ...core.wording import either
from ...model.fields import ParameterPlace, parameters_of, with_values
from ...model.hole_operations import DrillOperation
from ...model.job import Copies, Job
from ...model.operation import CutParameters, Operation, Order
from ...model.operation_kinds import OPERATION_KINDS, parameters
from ...model.tool import Tool
from ...model.tool_kind import ToolKind


@dataclass(frozen=True)
class MachiningOptions:
    """What was asked for; nothing means "as the job or the default says". Lengths in mm.

    Attributes:
        values: of operations' parameters, by key; each goes into all operations that it has an effect on.
        drills: diameters of drills, each of which drills the circles as wide as it before anything is milled.
        copies: the part in a grid.
        keep_out, keep_out_height: layers of clamps, and how far these stand above the stock.
        clamping, zero: what the sheet says of how the stock is held, and of how the zero is set.
    """

    values: Mapping[str, Any] = field(default_factory=dict)
    drills: tuple[float, ...] = ()
    copies: Copies | None = None
    keep_out: tuple[str, ...] = ()
    keep_out_height: float | None = None
    clamping: str | None = None
    zero: str | None = None

    @staticmethod
    def of(**requested: Any) -> MachiningOptions:
        """Return what is asked for by names of attributes and keys of parameters."""
        own = {each.name for each in fields(MachiningOptions)}
        return MachiningOptions(
            {name: value for name, value in requested.items() if name not in own},
            **{name: value for name, value in requested.items() if name in own},
        )

    @property
    def requested(self) -> tuple[str, ...]:
        """Options, without their dashes, of what was asked for."""
        others = {
            "drill": self.drills,
            "copies": self.copies,
            "keep-out": self.keep_out,
            "keep-out-height": self.keep_out_height,
            "clamping": self.clamping,
            "zero": self.zero,
        }
        return (*map(option_of, self.values), *(option for option, value in others.items() if value not in (None, ())))


def option_of(key: str) -> str:
    """Return the option that asks for a parameter, without its dashes."""
    return parameters()[key].place.parameter.option or key.replace("_", "-")


def contours_alone(job: Job) -> Job:
    """Return a job with the operations that follow walls alone, and their tools."""
    operations = tuple(each for each in job.operations if each.FOLLOWS_WALLS)
    used = {each.cut.tool for each in operations}
    return replace(job, operations=operations, tools=tuple(tool for tool in job.tools if tool.number in used))


def with_drills(job: Job, diameters: tuple[float, ...], depth: float | None) -> Job:
    """Return a job with an operation before all others for each drill, whose tools get numbers of their own.

    Args:
        depth: of the holes, mm; None = as deep as the job's deepest operation.

    Raises:
        ParameterError: a diameter is given twice.
    """
    twice = next((diameter for k, diameter in enumerate(diameters) if diameter in diameters[:k]), None)
    if twice is not None:
        raise ParameterError(
            f"{option('drill', f'{twice:g}')} mm is given twice and would drill the same circles again; give each "
            "diameter once."
        )
    deepest = max((each.cut.depth for each in job.operations if each.cut.enabled), default=CutParameters(1).depth)
    first = max((tool.number for tool in job.tools), default=0) + 1
    tools = tuple(Tool(first + k, diameter, ToolKind.DRILL) for k, diameter in enumerate(diameters))
    drills = tuple(
        DrillOperation(CutParameters(tool.number, depth=deepest if depth is None else depth)) for tool in tools
    )
    return replace(job, tools=(*job.tools, *tools), operations=(*drills, *job.operations))


def with_machining(job: Job, machining: MachiningOptions) -> Job:
    """Return a job with what was asked for put into its operations; drills are there already.

    Raises:
        ParameterError: something is out of its range, does not go with something else, or has no effect on this job.
    """
    if strange := [key for key in machining.values if key not in parameters()]:
        raise ParameterError(
            f"No operation has a parameter '{strange[0]}'; use {known_words(strange[0], [*parameters()])}."
        )
    concerned = {key: parameters()[key] for key in machining.values}
    operations = job.operations
    for later in (False, True):  # what depends on something else comes behind it
        names = [key for key, (placed, _) in concerned.items() if (placed.parameter.needs is not None) is later]
        operations = tuple(_with_values(each, {key: machining.values[key] for key in names}) for each in operations)
        for key in names:
            placed, kinds = concerned[key]
            if not any(_concerned(each, placed, kinds) for each in operations):
                raise no_effect(option_of(key), f"the job has {_lacking(placed, kinds)}")
    keep_out = machining.keep_out or job.keep_out_layers
    if machining.keep_out_height is not None and not keep_out:
        raise no_effect("keep-out-height", f"no layer of clamps is named; {option('keep-out', 'NAME')} does")
    height = job.keep_out_height if machining.keep_out_height is None else machining.keep_out_height
    return replace(
        job,
        operations=operations,
        copies=machining.copies or job.copies,
        keep_out_layers=keep_out,
        keep_out_height=height,
        clamping_note=job.clamping_note if machining.clamping is None else machining.clamping,
        zero_note=job.zero_note if machining.zero is None else machining.zero,
    )


def _with_values(operation: Operation, values: Mapping[str, Any]) -> Operation:
    """Return an operation with those of the values that have an effect on it."""
    own = parameters_of(type(operation))
    mine = {
        key: value
        for key, value in values.items()
        if key in own and operation.cut.enabled and own[key].has_effect(operation)
    }
    return with_values(operation, mine) if mine else operation


def _concerned(operation: Operation, placed: ParameterPlace, kinds: tuple[type[Operation], ...]) -> bool:
    return operation.cut.enabled and isinstance(operation, kinds) and placed.has_effect(operation)


def _lacking(placed: ParameterPlace, kinds: tuple[type[Operation], ...]) -> str:
    """Return what a job lacks that a parameter has no effect on."""
    needs = placed.parameter.needs
    mills = {kind for kind in OPERATION_KINDS.values() if kind.LEVELS and not kind.HOLES}
    what = "operation that mills" if mills <= set(kinds) else f"{either(kind.WORD for kind in kinds)} operation"
    drills = DrillOperation in kinds and all(kind.HOLES for kind in kinds)
    added = f"; {option('drill', 'D')} adds one" if drills else ""
    asked = f"; {needs.option()}" if needs and needs.option else ""
    with_ = f" with {needs.with_}{asked}" if needs else ""
    return f"no {what}{with_}{added}"


def check_order(job: Job, order: Order | None) -> None:
    """Refuse the order of 1986 for a job in which it changes nothing.

    Args:
        order: that was asked for; None = nothing was.

    Raises:
        ParameterError: the job has no contours, or nothing else that they could come before.
    """
    contours = [each.FOLLOWS_WALLS for each in job.operations if each.cut.enabled]
    if order is Order.PATENT_1986 and contours and (all(contours) or not any(contours)):
        lacking = (
            "no operation but contours, which it puts first"
            if all(contours)
            else "no contour operation, which it puts first"
        )
        raise no_effect("order", f"the job has {lacking}")


def no_effect(name: str, why: str) -> ParameterError:
    """Return the error that something has no effect on a job.

    Args:
        name: of the option, without its dashes.
        why: what the job lacks, without a full stop.
    """
    return ParameterError(f"{option(name)} has no effect: {why}. Leave the option away, or use a job that it concerns.")
