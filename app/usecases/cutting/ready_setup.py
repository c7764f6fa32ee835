"""What is cut out of what, with what, to become what: put together from what was asked and what the program tells of
itself.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import PurePath
from typing import NamedTuple

import numpy as np

from ...core.errors import HitofudeError, InputError
from ...core.input_file import FileBytes
from ...core.options import option
from ...core.progress import NO_PROGRESS, Progress
from ...formats.drawing import Drawing
from ...formats.job.toml import JobFile, StatedOrigin
from ...gcode.interpreter.codes import ROTARY
from ...gcode.interpreter.program import HeaderNote, OperationNote
from ...model.finding import Finding, FindingKind
from ...model.job import Copies, Job, OriginXY, OriginZ
from ...model.job import Stock as JobStock
from ...model.motion import Floats, MotionKind
from ...model.moves import DogBone, Tab
from ...model.operation import CutParameters, Operation, PocketOperation
from ...model.part import Part as DrawnPart
from ...model.part import Units
from ...model.read_options import AS_DRAWN, DrawingOptions
from ...model.reading import ReadingOptions
from ...model.scene import Scene
from ...model.stock_box import StockBox, stock_box, work_origin
from ...simulation.field.solid import SolidStock, read_solid
from ...simulation.field.workpiece import BoxStock, StockShape
from ...toolpath.coverage.floor_target import CHORD
from ...toolpath.drawn_contours import drawn_contours
from ...toolpath.machining_areas import MachiningAreas
from ...toolpath.witness import floor_findings
from ...verify.parts import TOLERANCE, FlatPart, Part, SolidPart
from ..examine import ExaminedProgram
from ..job.options import layers_to_read, with_layers_spelled
from ..job.plausible import read_plausible
from .cut import CutSetup
from .part_reading import other_length, other_names, other_units, part_reading
from .setup_stock import KnownStock, stock_from_comments
from .setup_tools import KnownTool, ToolHolding, ToolSource, other_tools, with_holders, with_tools


@dataclass(frozen=True, eq=False)
class SetupRequest:
    """What was said beside the programs; what was not is as the programs themselves tell, or is assumed.

    Attributes:
        tools: who tells of tools, best first.
        job: tools, operations, stock, origin.
        stock: the metal, program coordinates.
        against: name and bytes of the part: a drawing, a solid as .stl, or a scene of surfaces as .toml.
        beside: reads the files that a scene names.
        depth, leave: of all operations, mm: from the stock's top to the floor, > 0, and what is left on walls.
        layers: of the drawing; empty = as told, or all visible ones.
        units: of a drawing, or solid, that names none.
        origin: in the plane and along Z, each None where it is not said; None = as told, or the drawing's own zero.
        join_tolerance: mm.
        held: how tools are held, by T number; the others as told.
        tolerance: metal within this of the part is neither gouged nor left, mm; None = as the path was proven, else
            TOLERANCE.
        reading: what else is said about reading the drawing.
    """

    tools: tuple[ToolSource, ...] = ()
    job: JobFile | None = None
    stock: StockShape | None = None
    against: FileBytes | None = None
    beside: Callable[[str], bytes] | None = None
    depth: float | None = None
    leave: float | None = None
    layers: tuple[str, ...] = ()
    units: Units | None = None
    origin: StatedOrigin | None = None
    join_tolerance: float | None = None
    tolerance: float | None = None
    held: Mapping[int, ToolHolding] = field(default_factory=dict)
    reading: DrawingOptions = AS_DRAWN


@dataclass(frozen=True, eq=False)
class ReadySetup:
    """A setup that can be cut, and where it comes from.

    Attributes:
        programs: as they are cut; tools that they do not name have numbers.
        tools: by T number, those that cut.
        findings: what was assumed, and what there is to say about the drawing.
    """

    setup: CutSetup
    programs: tuple[ExaminedProgram, ...]
    tools: dict[int, KnownTool]
    stock: KnownStock
    findings: tuple[Finding, ...]


def setup_of(
    programs: tuple[ExaminedProgram, ...], request: SetupRequest = SetupRequest(), progress: Progress = NO_PROGRESS
) -> ReadySetup:
    """Return the setup that programs are cut in.

    Args:
        programs: at least one, in the order of cutting.
        request: what was said beside them.
        progress: told of the steps.

    Raises:
        InputError: a program has an error or cuts nothing; a tool, the depth of a drawing or the stock is told by
            nobody; or a file cannot be used.
        Cancelled: the job was asked to stop.
    """
    for examined in programs:
        _ensure_readable(examined)
    progress.step(0.0, "Looking for tools and stock")
    scene = _scene(request)
    noted = () if scene is None else (ToolSource("the scene", {tool.number: tool for tool in scene.tools}),)
    known = with_tools(programs, (*request.tools, *noted))
    programs, tools = known.programs, with_holders(known.tools, request.held)
    part: Part | None = None
    said: tuple[Finding, ...] = ()
    if scene is not None:
        part = _surfaces(scene, _header(programs), request)
    elif request.against is not None:
        part, said = _part(programs, tools, request)
    progress.step(0.8)
    stock = _stock(programs, tools, part, request)
    setup = CutSetup(
        tuple(each.program for each in programs),
        {number: each.tool for number, each in tools.items()},
        stock.stock,
        part,
        tuple(each.name for each in programs),
    )
    of_stock = _wound("the stock", stock.stock) if isinstance(stock.stock, SolidStock) else ()
    found = (
        *_unfollowed(programs),
        *_without_units(programs),
        *known.findings,
        *of_stock,
        *((stock.assumed,) if stock.assumed is not None else ()),
        *said,
    )
    return ReadySetup(setup, programs, tools, stock, found)


def _unfollowed(programs: tuple[ExaminedProgram, ...]) -> Iterator[Finding]:
    """Yield a finding for each axis that a program turns and nobody follows: what it really cuts is not known."""
    for each in programs:
        for problem in each.problems:
            if problem.word and problem.word.lower() in ROTARY:
                text = (
                    f"{problem.message(each.name)} What it turns is cut here as if it stood; leave it out, or try it "
                    "on the machine."
                )
                yield Finding(FindingKind.LEFT_OUT, text, line=problem.line)


def _without_units(programs: tuple[ExaminedProgram, ...]) -> Iterator[Finding]:
    """Say of each program that names no units in which it was read."""
    for each in programs:
        if each.unnamed:
            text = (
                f"{each.name} names no units (G20, G21) and is read in mm; say {option('units', 'in')} if it is in "
                "inches, or write G20 into it."
            )
            yield Finding(FindingKind.UNITS_ASSUMED, text, counts=False)


def _header(programs: tuple[ExaminedProgram, ...]) -> HeaderNote:
    """Return the first header of our own; an empty one where there is none."""
    return next((each.program.header for each in programs if each.program.header is not None), HeaderNote())


def _ensure_readable(examined: ExaminedProgram) -> None:
    error = examined.program.error
    if error is not None:
        raise InputError(
            f"{error.message(examined.name)} What stands behind it cannot be cut; correct it, or choose the control: "
            f"{option('dialect')}."
        )
    motions = examined.program.motions
    if np.all(motions.kind == MotionKind.RAPID):
        raise InputError(f"{examined.name}: nothing is cut; the program has no motion at feed rate.")


def _stock(
    programs: tuple[ExaminedProgram, ...], tools: dict[int, KnownTool], part: Part | None, request: SetupRequest
) -> KnownStock:
    """Return the metal: what was asked for, the job's, or what the programs tell."""
    if request.stock is not None:
        return KnownStock(request.stock, "as given")
    noted = any(each.program.stock is not None for each in programs)
    if isinstance(part, SolidPart) and part.block is not None and not noted:
        return KnownStock(BoxStock(part.block), "the scene")
    if request.job is not None and "stock" in request.job.tables and isinstance(part, FlatPart):
        box, (x, y, z) = stock_box(part.job, part.regions, part.lines), part.origin
        moved = replace(box, x0=box.x0 - x, y0=box.y0 - y, z0=box.z0 - z, x1=box.x1 - x, y1=box.y1 - y, z1=box.z1 - z)
        return KnownStock(BoxStock(moved), "the job file, round the drawing")
    return stock_from_comments(
        programs, max(each.tool.radius for each in tools.values()), None if part is None else _part_box(part)
    )


def _part_box(part: Part) -> Floats:
    """Return (2, 3) lower and upper corner of a part, program coordinates: of a drawing from its floor to its top."""
    if isinstance(part, SolidPart):
        corners = part.solid.triangles.reshape(-1, 3)
        return np.array([corners.min(axis=0), corners.max(axis=0)])
    box = stock_box(replace(part.job, stock=JobStock()), part.regions, part.lines)
    depth = max(each.cut.depth for each in part.job.operations)
    return np.array([[box.x0, box.y0, -depth], [box.x1, box.y1, 0.0]]) - part.origin


class _PartRead(NamedTuple):
    """A part, and what there is to say about it."""

    part: Part
    findings: tuple[Finding, ...]


def _part(programs: tuple[ExaminedProgram, ...], tools: dict[int, KnownTool], request: SetupRequest) -> _PartRead:
    assert request.against is not None
    name, data = request.against
    suffix = PurePath(name).suffix.lower()
    if suffix == ".stl":
        solid = read_solid(name, data)
        return _PartRead(_solid(solid, request), _wound(name, solid))
    return _flat(programs, tools, request)


def _scene(request: SetupRequest) -> Scene | None:
    """Return the scene to compare with, if it is one."""
    if request.against is None or PurePath(request.against[0]).suffix.lower() != ".toml":
        return None
    from ...formats.scene.toml import read_scene

    return read_scene(*request.against)


def _surfaces(scene: Scene, header: HeaderNote, request: SetupRequest) -> SolidPart:
    """Return the surfaces of a scene in program coordinates."""
    from ...formats.scene.toml import sources_of
    from ..scene.part import scene_part

    xy, z = request.origin or StatedOrigin()
    scene = replace(scene, origin_xy=xy or scene.origin_xy, origin_z=z or scene.origin_z)
    zero = header.origin if request.origin is None else None
    return scene_part(scene, sources_of(request.beside or _nothing_beside), zero, request.leave, request.tolerance)


def _nothing_beside(name: str) -> bytes:
    raise InputError(
        f"{name}: the scene names this file, and it is not known where it lies; put its points into the scene."
    )


def _wound(name: str, solid: SolidStock) -> tuple[Finding, ...]:
    """Return the remark that triangles of a solid had to be turned over, if any had."""
    said = solid.wound_words(name)
    return (Finding(FindingKind.ASSUMED, said, counts=False, amount=float(solid.turned)),) if said else ()


def _solid(solid: SolidStock, request: SetupRequest) -> SolidPart:
    """Return a solid in program coordinates."""
    triangles = solid.triangles * (request.units or Units.MM).value
    low, high = triangles.min(axis=(0, 1)), triangles.max(axis=(0, 1))
    xy, z = request.origin or StatedOrigin()
    zero = np.zeros(3)
    if xy is OriginXY.LOWER_LEFT:
        zero[:2] = low[:2]
    elif xy is OriginXY.CENTRE:
        zero[:2] = (low[:2] + high[:2]) / 2
    if z is not None:
        zero[2] = high[2] if z is OriginZ.TOP else low[2]
    tolerance = TOLERANCE if request.tolerance is None else request.tolerance
    return SolidPart(replace(solid, triangles=triangles - zero), request.leave or 0.0, tolerance)


def _flat(programs: tuple[ExaminedProgram, ...], tools: dict[int, KnownTool], request: SetupRequest) -> _PartRead:
    """Return the drawing and what of it is milled, and what there is to say about it."""
    from ...operations.compute import drawing_findings, followed_lines
    from ...operations.unmachined import unmachined_findings

    header = _header(programs)
    requested = _job(DrawnPart(), programs, tools, request)
    drawing, reading_findings = _drawing(requested, header, tools, request)
    job = with_layers_spelled(replace(requested, part=drawing.part)).prepared()
    parts = drawn_contours(job)
    made, lines = parts.regions, followed_lines(job, parts)
    regions = made.regions
    if not regions and not lines:
        raise _nothing_to_compare_with(request, parts.findings)
    proven = header.path_tolerance if request.tolerance is None else None
    tolerance = TOLERANCE if request.tolerance is None else request.tolerance
    tabs, dog_bones = _on_purpose(programs)
    machining_areas = MachiningAreas(job, parts)
    areas = machining_areas.areas()
    part = FlatPart(
        job,
        regions,
        _origin(job, stock_box(job, regions, lines), request, header),
        tolerance if proven is None else proven,
        tolerance,
        header.allowance or 0.0,
        areas,
        lines,
        clamps=parts.clamps,
        tabs=tabs,
        dog_bones=dog_bones,
    )
    found = (
        *reading_findings,
        *_differing(request, header, drawing.part.units),
        *drawing.findings,
        *drawing_findings(job, parts, lines),
        *made.findings,
        *machining_areas.findings,
        *floor_findings(areas, CHORD),
        *unmachined_findings(machining_areas, regions),
    )
    return _PartRead(part, found)


def _nothing_to_compare_with(request: SetupRequest, findings: Sequence[Finding]) -> InputError:
    """Return the error of a drawing without contours, with what its first findings say."""
    assert request.against is not None
    said = " ".join(finding.text for finding in findings[:3])
    return InputError(
        f"{request.against[0]}: there is no closed contour to compare with; choose other layers, or join loose ends: "
        f"{option('join-tolerance')}. {said}".rstrip()
    )


def _drawing(
    requested: Job, header: HeaderNote, tools: dict[int, KnownTool], request: SetupRequest
) -> tuple[Drawing, tuple[Finding, ...]]:
    """Return the drawing that programs are compared with, and what there is to say of how it was read.

    It is read as was asked for, else as the programs' header tells that it was read when they were made.
    """
    assert request.against is not None
    name, data = request.against
    reading = part_reading(request.reading, header.reading, name, request.units)
    noted_units = None if reading.how.pixels_per_inch else header.drawing_units
    units = request.units or (request.job.units if request.job else None) or noted_units
    diameters = [each.tool.diameter for each in tools.values()]
    options = ReadingOptions(units, layers_to_read(requested), reading.how)
    return read_plausible(name, data, options, lambda _: diameters), reading.findings


def _differing(request: SetupRequest, header: HeaderNote, units: Units) -> Iterator[Finding]:
    """Yield where what was asked about the drawing is not what the program tells of how it was made."""
    yield from other_units(request.units, header.drawing_units, units)
    yield from other_names("layer", request.layers, header.layers)
    yield from other_length("join-tolerance", request.join_tolerance, header.join_tolerance)


class _OnPurpose(NamedTuple):
    """What stays and what is cut into the walls on purpose."""

    tabs: tuple[Tab, ...]
    dog_bones: tuple[DogBone, ...]


def _on_purpose(programs: tuple[ExaminedProgram, ...]) -> _OnPurpose:
    """Return tabs and dog-bones that headers of our own tell of, each once."""
    headers = [each.program.header for each in programs if each.program.header is not None]
    return _OnPurpose(
        tuple(dict.fromkeys(tab for header in headers for tab in header.tabs)),
        tuple(dict.fromkeys(dog_bone for header in headers for dog_bone in header.dog_bones)),
    )


def _origin(
    job: Job,
    box: StockBox,
    request: SetupRequest,
    header: HeaderNote,
) -> tuple[float, float, float]:
    """Return the program's zero in the drawing's coordinates."""
    requested = request.origin is not None or (request.job is not None and "origin" in request.job.tables)
    if not requested:
        return header.origin or (0.0, 0.0, 0.0)
    return work_origin(job, box)


def _job(
    part: DrawnPart, programs: tuple[ExaminedProgram, ...], tools: dict[int, KnownTool], request: SetupRequest
) -> Job:
    """Return the job that the programs do: the one that is given, with what was asked for put in."""
    base = request.job.job if request.job is not None else Job(part)
    operations = _operations(programs, tools, request)
    missing = dict.fromkeys(each.cut.tool for each in operations if each.cut.tool not in tools)
    mine = {
        tool.number: tool
        for tool in (*(each.tool for each in tools.values()), *other_tools(missing, request.tools, programs))
    }
    operations = tuple(each for each in operations if each.cut.tool in mine)
    header = _header(programs)
    xy, z = request.origin or StatedOrigin(base.origin_xy, base.origin_z)
    join = next(
        (
            t
            for t in (request.join_tolerance, base.join_tolerance if request.job else header.join_tolerance)
            if t is not None
        ),
        None,
    )
    layers = request.layers or (base.layer_names if request.job else ()) or header.layers
    copies, (clamps, height) = base.copies, (base.keep_out_layers, base.keep_out_height)
    return replace(
        base,
        part=part,
        tools=tuple(mine.values()),
        operations=operations,
        stock=_job_stock(base, operations, programs, request),
        origin_xy=xy or OriginXY.DRAWING,
        origin_z=z or OriginZ.TOP,
        join_tolerance=base.join_tolerance if join is None else join,
        layer_names=layers,
        copies=copies if request.job and "copies" in request.job.tables else header.copies or Copies(),
        keep_out_layers=clamps or header.keep_out.layers,
        keep_out_height=height or header.keep_out.height,
    )


def _job_stock(
    base: Job, operations: tuple[Operation, ...], programs: tuple[ExaminedProgram, ...], request: SetupRequest
) -> JobStock:
    """Return the stock's margin, and how thick it is: as given, told by a comment, or as the job has it."""
    note = next((each.program.stock for each in programs if each.program.stock is not None), None)
    headers = [each.program.header for each in programs if each.program.header is not None]
    above = max([base.stock.above, *(each.above for each in headers)])
    if isinstance(request.stock, BoxStock):
        thickness = request.stock.solid.size[2] - above
    elif note is not None and note.size[2] > above:
        thickness = note.size[2] - above
    else:
        thickness = max([base.stock.thickness, *(each.cut.depth for each in operations)])
    under = max([base.stock.under, *(each.under for each in headers)])
    return replace(base.stock, thickness=thickness, above=above, under=under)


def _operations(
    programs: tuple[ExaminedProgram, ...], tools: dict[int, KnownTool], request: SetupRequest
) -> tuple[Operation, ...]:
    """Return what is milled how deep: as the job or the header of our own says, else a pocket a tool, as deep as was
    asked.
    """
    noted = (
        request.job.job.operations
        if request.job is not None and "operation" in request.job.tables
        else tuple(_noted(programs))
    )
    if not noted and request.depth is None:
        assert request.against is not None
        raise InputError(
            f"{request.against[0]}: nobody tells how deep the part is milled; give {option('depth')}, mm from the "
            "stock's top down to the floor, or a job file with operations."
        )
    requested = noted or tuple(PocketOperation(CutParameters(number)) for number in tools)
    return tuple(_with(operation, request) for operation in requested)


def _noted(programs: tuple[ExaminedProgram, ...]) -> list[Operation]:
    """Return the operations that headers of our own tell of, each once."""
    notes = dict.fromkeys(
        note for each in programs if each.program.header is not None for note in each.program.header.operations
    )
    return [_as_noted(note) for note in notes]


def _as_noted(note: OperationNote) -> Operation:
    """Return the operation that a header tells of, with what its part depends on.

    Raises:
        InputError: its numbers make none.
    """
    try:
        return note.operation()
    except HitofudeError as error:
        raise InputError(f"The program's comments tell of an operation that is none: {error}") from error


def _with(operation: Operation, request: SetupRequest) -> Operation:
    """Return an operation with the depth and the stock to leave that were asked for; a step is never in the way of a
    depth.
    """
    depth = operation.cut.depth if request.depth is None else request.depth
    leave = operation.cut.stock_to_leave if request.leave is None else request.leave
    return replace(operation, cut=replace(operation.cut, depth=depth, stepdown=depth, stock_to_leave=leave))
