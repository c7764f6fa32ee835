"""What the user asked of a make job, as far as he said anything: None means "as the job or the default says"."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from ...core.errors import InputError, ParameterError
from ...core.options import option
from ...formats.readers import known_format
from ...formats.tools.materials import stock_material
from ...model.curve_selectors import OnLayer, Selector, layer_names
from ...model.fields import parameters_of, with_values
from ...model.job import Job, OriginXY, OriginZ, Stock
from ...model.layer_names import spelled
from ...model.layer_rules import LayerRule
from ...model.machine import Machine
from ...model.operation import LEAST_LENGTH, Operation, Order, Side
from ...model.part import Part, Units
from ...model.read_options import AS_DRAWN, DrawingOptions
from ...model.tool import Tool
from ..pixels.options import BitmapOptions
from .feeds import FeedsOptions, JobWithFeeds, with_proposed_feeds
from .machining import MachiningOptions, contours_alone, no_effect, with_drills, with_machining

if TYPE_CHECKING:
    from ..proposal.propose import ProposalOptions  # few jobs are proposed


_STEPOVER = "stepover"
"""Key of the parameter that options for pockets change."""

LEAST_PER_CENT = 1.0
"""Of the diameter; a smaller stepover is a slip of the pen."""


@dataclass(frozen=True, slots=True)
class Stepover:
    """Distance between rings.

    Attributes:
        value: mm, in [0.001, diameter], or per cent of the tool's diameter, in [1, 100].
        percent: True when `value` is per cent.
    """

    value: float
    percent: bool = False

    def of(self, diameter: float) -> float:
        """Return the stepover in mm for a tool of this diameter in mm.

        Raises:
            ParameterError: the percentage is out of its range.
        """
        if self.percent and not LEAST_PER_CENT <= self.value <= 100:
            raise ParameterError(f"Stepover is {self.value:g} %; it must be {LEAST_PER_CENT:g} % to 100 %.")
        return self.value * diameter / 100 if self.percent else self.value


@dataclass(frozen=True)
class MakeOptions:
    """Options of `make`; every one that is given overrides the job's value. Lengths in mm.

    Attributes:
        job: tools, operations, stock, origin to start from (its part is not used); None = the default job.
        contour_diameter, pocket_diameter: tool diameters; with only one given that tool does both jobs.
        stepover: distance between pocket rings; None = as the job says, or the one with the shortest path.
        overlap: the same as diameter - stepover; give one of the two.
        safe_z: clearance height above the stock's top.
        feed, plunge (mm/min), speed (rpm): of every tool.
        machine: that the program has to fit and is timed on; None = timed on a usual one.
        units: of a drawing that names none. layers: to machine; empty = all visible ones.
        bitmap: compute on pixels, and how they are made; None = exactly, but for pictures.
        machining: sides, entries, leads, tabs, drills, copies, clamps.
        reading: what else is said about reading the drawing.
        propose: propose the operations; None = they are those of the job.
        rules: for layers, which make operations behind those of the job.
        material: of the stock; None = as the job says.
        propose_feeds: give the tools the speed and the feeds that are proposed for the material; `feed`, `plunge` and
            `speed` go before that.
        drawn_depths: cut shapes to the depths that the drawing tells of them.
    """

    job: Job | None = None
    contour_diameter: float | None = None
    pocket_diameter: float | None = None
    stepover: Stepover | None = None
    overlap: float | None = None
    safe_z: float | None = None
    feed: float | None = None
    plunge: float | None = None
    speed: float | None = None
    order: Order | None = None
    post: str | None = None
    out_units: Units | None = None
    units: Units | None = None
    origin_xy: OriginXY | None = None
    origin_z: OriginZ | None = None
    layers: tuple[str, ...] = ()
    join_tolerance: float | None = None
    exact_path: bool = False
    machine: Machine | None = None
    bitmap: BitmapOptions | None = None
    machining: MachiningOptions = field(default_factory=MachiningOptions)
    reading: DrawingOptions = AS_DRAWN
    propose: ProposalOptions | None = None
    rules: tuple[LayerRule, ...] = ()
    material: str | None = None
    propose_feeds: bool = False
    drawn_depths: bool = False


def job_with_options(part: Part, options: MakeOptions) -> Job:
    """Return the job for a part: the given job or the default one, with every given option put in.

    Raises:
        ParameterError: an option is out of its range or has no effect on the job, or two contradict one another.
        InputError: a layer is not in the drawing.
    """
    base = replace(options.job, part=part) if options.job is not None else Job(part=part)
    if options.job is None and options.machining.values.get("side") in (Side.OUTSIDE, Side.ON):
        base = contours_alone(base)
    _check_effects(base, options)
    tools, operations = _tools(base, options)
    operations = tuple(_operation(each, tools, options) for each in operations)
    safe_z = base.safe_z if options.safe_z is None else options.safe_z
    if not safe_z >= LEAST_LENGTH:
        raise ParameterError(
            f"Safe Z is {safe_z:g} mm; it must be {LEAST_LENGTH:g} mm or more above the top of the stock."
        )
    requested = replace(base, tools=tuple(tools.values()), operations=operations)
    requested = with_machining(
        with_drills(requested, options.machining.drills, options.machining.values.get("depth")), options.machining
    )
    return with_layers_spelled(
        replace(
            requested,
            tools=tuple(_speeds(tool, options) for tool in requested.tools),
            safe_z=safe_z,
            retract_z=min(base.retract_z, safe_z),
            stock=_stock(base, requested.operations, options),
            origin_xy=options.origin_xy or base.origin_xy,
            origin_z=options.origin_z or base.origin_z,
            order=options.order or base.order,
            post=options.post or base.post,
            out_units=options.out_units or base.out_units,
            layer_names=options.layers or base.layer_names,
            join_tolerance=base.join_tolerance if options.join_tolerance is None else options.join_tolerance,
            exact_path=options.exact_path or base.exact_path,
        )
    )


def with_feeds(job: Job, options: MakeOptions) -> JobWithFeeds:
    """Return a job with the material that was asked for, and where they were with the speeds and feeds for it.

    Raises:
        InputError: there is no such material. ParameterError: feeds are to be proposed, and nobody says for what.
    """
    material = options.material or job.stock.material
    if not options.propose_feeds:
        word = stock_material(options.material).word if options.material else material
        return JobWithFeeds(replace(job, stock=replace(job.stock, material=word)))
    if not material:
        raise ParameterError(
            f"Feeds are to be proposed, and nobody says what the stock is made of; add "
            f"{option('material', 'NAME')}, or material to the job's [stock]."
        )
    made = with_proposed_feeds(job, FeedsOptions(material, options.machine))
    return replace(made, job=replace(made.job, tools=tuple(_speeds(tool, options) for tool in made.job.tools)))


def layers_of_drawing(options: MakeOptions) -> tuple[str, ...]:
    """Return the layers that are to be read of a drawing; empty = all."""
    job = options.job or Job(Part())
    requested = replace(
        job,
        layer_names=options.layers or job.layer_names,
        keep_out_layers=options.machining.keep_out or job.keep_out_layers,
    )
    return layers_to_read(requested)


def _check_effects(base: Job, options: MakeOptions) -> None:
    """Refuse options for operations that the job does not have."""
    mills = [each for each in base.operations if each.cut.enabled and not each.HOLES]
    pocket = {"pocket_tool": options.pocket_diameter, "stepover": options.stepover, "overlap": options.overlap}
    one_tool = options.job is None and (options.pocket_diameter is None) != (options.contour_diameter is None)
    for name, value in pocket.items():
        if value is not None and not any(each.COARSE for each in mills) and not (name == "pocket_tool" and one_tool):
            raise no_effect(name.replace("_", "-"), "the job has no pocket operation")
    if options.contour_diameter is not None and all(each.COARSE for each in mills) and not one_tool:
        raise no_effect("contour-tool", "the job has no contour or rest operation")


def _tools(base: Job, options: MakeOptions) -> tuple[dict[int, Tool], tuple[Operation, ...]]:
    """Return tools by number, and the operations with the numbers of their tools."""
    tools = {tool.number: tool for tool in base.tools}
    diameters = {value for value in (options.pocket_diameter, options.contour_diameter) if value is not None}
    if not diameters:
        return tools, base.operations
    if options.job is None and len(diameters) == 1:
        one = replace(base.tools[0], diameter=diameters.pop())
        return {one.number: one}, tuple(
            replace(each, cut=replace(each.cut, tool=one.number)) for each in base.operations
        )
    operations = []
    for operation in base.operations:
        diameter, number = _diameter(operation, options), operation.cut.tool
        if diameter is not None:
            shared = any(each.cut.tool == number and _diameter(each, options) != diameter for each in base.operations)
            new = max(tools) + 1 if shared and tools[number].diameter != diameter else number
            tools[new] = replace(base.tool(number), number=new, diameter=diameter, name="")
            operation = replace(operation, cut=replace(operation.cut, tool=new))
        operations.append(operation)
    used = {operation.cut.tool for operation in operations}
    return {number: tool for number, tool in tools.items() if number in used}, tuple(operations)


def _diameter(operation: Operation, options: MakeOptions) -> float | None:
    """Return the diameter that was asked for of an operation's tool."""
    return None if operation.HOLES else options.pocket_diameter if operation.COARSE else options.contour_diameter


def _operation(operation: Operation, tools: dict[int, Tool], options: MakeOptions) -> Operation:
    """Return the operation with the stepover that was asked for."""
    if not operation.COARSE or _STEPOVER not in parameters_of(type(operation)):
        return operation
    if operation.cut.tool not in tools:
        raise ParameterError(f"The job has no tool T{operation.cut.tool}; add it to the tools or choose another.")
    diameter = tools[operation.cut.tool].diameter
    stepover = operation.ring_stepover
    if options.stepover is not None:
        stepover = options.stepover.of(diameter)
    if options.overlap is not None:
        stepover = _stepover_of_overlap(options, diameter)
    if stepover is not None and not LEAST_LENGTH <= stepover <= diameter:
        raise ParameterError(
            f"Stepover is {stepover:g} mm with a pocket tool of {diameter:g} mm; "
            f"it must be {LEAST_LENGTH:g} mm or more and not more than the tool's diameter."
        )
    return with_values(operation, {_STEPOVER: stepover})


def _stepover_of_overlap(options: MakeOptions, diameter: float) -> float:
    """Return diameter - overlap, checked (SPEC: step s = 2R - overlap, 0 < overlap < 2R)."""
    overlap = options.overlap or 0.0
    if options.stepover is not None:
        raise ParameterError(
            "Stepover and overlap are both given; give one of them (overlap = tool diameter - stepover)."
        )
    if not 0 < overlap < diameter:
        raise ParameterError(
            f"Overlap is {overlap:g} mm with a pocket tool of {diameter:g} mm; "
            "it must be greater than 0 and less than the tool's diameter."
        )
    return diameter - overlap


def _speeds(tool: Tool, options: MakeOptions) -> Tool:
    """Return the tool with the given feed, plunge and speed."""
    return replace(
        tool,
        feed_rate=tool.feed_rate if options.feed is None else options.feed,
        plunge_rate=tool.plunge_rate if options.plunge is None else options.plunge,
        spindle_speed=tool.spindle_speed if options.speed is None else options.speed,
    )


def _stock(base: Job, operations: tuple[Operation, ...], options: MakeOptions) -> Stock:
    """Return the stock; a deeper cut makes that of the default job thicker, never one that a job has said."""
    if options.job is not None:
        return base.stock
    deepest = max((each.cut.depth for each in operations), default=0.0)
    return replace(base.stock, thickness=max(base.stock.thickness, deepest))


# Layers that a job asks for: which are to be read, and by which names the drawing has them.


def layers_to_read(job: Job) -> tuple[str, ...]:
    """Return the layers of a drawing that a job needs; empty = all."""
    own = [name for operation in job.operations if operation.cut.enabled for name in layer_names(operation.cut.curves)]
    return tuple(dict.fromkeys((*job.layer_names, *own, *job.keep_out_layers))) if job.layer_names else ()


def with_layers_spelled(job: Job) -> Job:
    """Return the job with its layers' names as its part spells them: drawings tell no case, and some controls write
    capitals alone.

    Raises:
        InputError: the part has no such layer.
    """
    enabled = [each for each in job.operations if each.cut.enabled]
    own = (each.name for operation in enabled for each in operation.cut.curves if isinstance(each, OnLayer))
    spelling = _spelling((*own, *job.layer_names, *job.keep_out_layers), job.part)
    operations = tuple(
        replace(each, cut=replace(each.cut, curves=_curves_spelled(each.cut.curves, spelling)))
        if each.cut.enabled
        else each
        for each in job.operations
    )
    return replace(
        job,
        operations=operations,
        layer_names=tuple(dict.fromkeys(spelling[name] for name in job.layer_names)),
        keep_out_layers=tuple(dict.fromkeys(spelling[name] for name in job.keep_out_layers)),
    )


def _curves_spelled(curves: Iterable[Selector], spelling: Mapping[str, str]) -> tuple[Selector, ...]:
    """Return selectors whose layers are called as the part calls them."""
    return tuple(dict.fromkeys(OnLayer(spelling[each.name]) if isinstance(each, OnLayer) else each for each in curves))


def _spelling(names: Iterable[str], part: Part) -> dict[str, str]:
    """Return for each name the layer that it means, as the part calls it.

    Raises:
        InputError: the part has no such layer.
    """
    known = [layer.name for layer in part.layers]
    found: dict[str, str] = {}
    for name, layer in spelled(names, known).items():
        if layer is None:
            raise InputError(f"{part.name}: there is no layer '{name}'; the drawing has {', '.join(known) or 'none'}.")
        found[name] = layer
    return found


# The job that lies in the file of a drawing.


def with_own_job(name: str, data: bytes, options: MakeOptions) -> MakeOptions:
    """Return the options with the job of a file that holds one, a project, unless they bring another.

    Args:
        name: of the file; its suffix tells the kind.
        data: its bytes.

    Raises:
        InputError: the file cannot be read.
    """
    format_ = known_format(name)
    if options.job is not None or format_ is None or format_.job is None:
        return options
    return replace(options, job=format_.job(name, data))
