"""How a job is to be machined beyond tools, depths and stepover: what was asked for, put into its operations."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

from ..core.errors import ParameterError
from ..model.entry import EntryKind, LeadKind
from ..model.job import Copies, Job
from ..model.operation import ContourOperation, Cut, DrillOperation, Operation, Order, PocketOperation, Side
from ..model.tool import Tool, ToolKind


@dataclass(frozen=True)
class Machining:
    """What was asked for; None, False and nothing mean "as the job or the default says". Lengths in mm.

    Attributes:
        side, lead, lead_radius, lead_overlap, tabs, tab_width, tab_height, dog_bones, finish_width, spring_passes: of contours.
        outside_in: of pockets.
        entry, ramp_angle (radians), finish_depth, floor_to_leave, most_engaged: of all that mills.
        drills: diameters of drills, each of which drills the circles as wide as it before anything is milled.
        peck, through: of drilling.
        copies: the part in a grid.
        keep_out, keep_out_height: layers of clamps, and how far these stand above the stock.
    """

    side: Side | None = None
    lead: LeadKind | None = None
    lead_radius: float | None = None
    lead_overlap: float | None = None
    tabs: int | None = None
    tab_width: float | None = None
    tab_height: float | None = None
    dog_bones: bool = False
    finish_width: float | None = None
    spring_passes: int | None = None
    outside_in: bool = False
    entry: EntryKind | None = None
    ramp_angle: float | None = None
    finish_depth: float | None = None
    floor_to_leave: float | None = None
    most_engaged: float | None = None
    drills: tuple[float, ...] = ()
    peck: float | None = None
    through: float | None = None
    copies: Copies | None = None
    keep_out: tuple[str, ...] = ()
    keep_out_height: float | None = None

    @property
    def asked(self) -> tuple[str, ...]:
        """Names of what was asked for."""
        return tuple(name for name in self.__dataclass_fields__ if getattr(self, name) not in (None, False, ()))


def _contours(operation: Operation) -> bool:
    return isinstance(operation, ContourOperation)


def _mills(operation: Operation) -> bool:
    return not isinstance(operation, DrillOperation)


def _drills(operation: Operation) -> bool:
    return isinstance(operation, DrillOperation)


def _pockets(operation: Operation) -> bool:
    return isinstance(operation, PocketOperation)


def _slopes(operation: Operation) -> bool:
    return _mills(operation) and operation.cut.entry.sloped


def _leads(operation: Operation) -> bool:
    return isinstance(operation, ContourOperation) and operation.lead.wanted


def _has_tabs(operation: Operation) -> bool:
    return isinstance(operation, ContourOperation) and operation.tabs.wanted


_OPTIONS: tuple[tuple[str, Callable[[Operation], bool], str, str], ...] = (
    ("side", _contours, "side", "no contour operation"),
    ("lead", _contours, "lead.kind", "no contour operation"),
    ("lead_radius", _leads, "lead.radius", "no contour operation with a lead"),
    ("lead_overlap", _leads, "lead.overlap", "no contour operation with a lead"),
    ("tabs", _contours, "tabs.count", "no contour operation"),
    ("tab_width", _has_tabs, "tabs.width", "no contour operation with tabs; --tabs N makes some"),
    ("tab_height", _has_tabs, "tabs.height", "no contour operation with tabs; --tabs N makes some"),
    ("dog_bones", _contours, "dog_bones", "no contour operation"),
    ("finish_width", _contours, "finish_width", "no contour operation"),
    ("spring_passes", _contours, "spring_passes", "no contour operation"),
    ("outside_in", _pockets, "outside_in", "no pocket operation"),
    ("entry", _mills, "cut.entry.kind", "no operation that mills"),
    ("ramp_angle", _slopes, "cut.entry.angle", "no operation that goes down by a helix or a ramp"),
    ("floor_to_leave", _mills, "cut.floor_to_leave", "no operation that mills"),
    ("finish_depth", _mills, "cut.finish_depth", "no operation that mills"),
    ("most_engaged", _mills, "most_engaged", "no operation that mills"),
    ("peck", _drills, "peck", "no drill operation; --drill D adds one"),
    ("through", _drills, "through", "no drill operation; --drill D adds one"),
)
"""By name of what was asked for: the operations that it has an effect on, the field, and what a job lacks that has none of them."""


def contours_alone(job: Job) -> Job:
    """Return a job with its contour operations alone, and their tools."""
    operations = tuple(each for each in job.operations if isinstance(each, ContourOperation))
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
        raise ParameterError(f"--drill {twice:g} mm is given twice and would drill the same circles again; give each diameter once.")
    deepest = max((each.cut.depth for each in job.operations if each.cut.enabled), default=Cut(1).depth)
    first = max((tool.number for tool in job.tools), default=0) + 1
    tools = tuple(Tool(first + k, diameter, ToolKind.DRILL) for k, diameter in enumerate(diameters))
    drills = tuple(DrillOperation(Cut(tool.number, depth=deepest if depth is None else depth)) for tool in tools)
    return replace(job, tools=(*job.tools, *tools), operations=(*drills, *job.operations))


def with_machining(job: Job, machining: Machining) -> Job:
    """Return a job with what was asked for put into its operations; drills are there already.

    Raises:
        ParameterError: something is out of its range, does not go with something else, or has no effect on this job.
    """
    operations = job.operations
    for name, concerns, field, lacking in _OPTIONS:
        value = getattr(machining, name)
        if value is None or value is False:
            continue
        concerned = [each.cut.enabled and concerns(each) for each in operations]
        if not any(concerned):
            raise no_effect(name, f"the job has {lacking}")
        operations = tuple(_put(each, field.split("."), value) if mine else each for each, mine in zip(operations, concerned, strict=True))
    keep_out = machining.keep_out or job.keep_out_layers
    if machining.keep_out_height is not None and not keep_out:
        raise no_effect("keep_out_height", "no layer of clamps is named; --keep-out NAME does")
    height = job.keep_out_height if machining.keep_out_height is None else machining.keep_out_height
    return replace(job, operations=operations, copies=machining.copies or job.copies, keep_out_layers=keep_out, keep_out_height=height)


def check_order(job: Job, order: Order | None) -> None:
    """Refuse the order of 1986 for a job in which it changes nothing.

    Args:
        order: that was asked for; None = nothing was.

    Raises:
        ParameterError: the job has no contours, or nothing else that they could come before.
    """
    contours = [isinstance(each, ContourOperation) for each in job.operations if each.cut.enabled]
    if order is Order.PATENT_1986 and contours and (all(contours) or not any(contours)):
        lacking = "no operation but contours, which it puts first" if all(contours) else "no contour operation, which it puts first"
        raise no_effect("order", f"the job has {lacking}")


def no_effect(name: str, why: str) -> ParameterError:
    """Return the error that something has no effect on a job.

    Args:
        name: of the option, with underscores.
        why: what the job lacks, without a full stop.
    """
    return ParameterError(f"--{name.replace('_', '-')} has no effect: {why}. Leave the option away, or use a job that it concerns.")


def _put(whole: Any, path: list[str], value: Any) -> Any:
    """Return an operation, or a part of one, with a value in one of its fields."""
    if len(path) > 1:
        value = _put(getattr(whole, path[0]), path[1:], value)
    return replace(whole, **{path[0]: value})
