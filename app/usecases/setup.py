"""What is cut out of what, with what, to become what: put together from what was asked and what the program tells of
itself.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import PurePath

import numpy as np

from ..core.errors import HitofudeError, InputError
from ..core.progress import NO_PROGRESS, Progress
from ..formats.job.toml import JobFile
from ..gcode.interpreter.codes import ROTARY
from ..gcode.interpreter.program import HeaderNote, OperationNote
from ..model.finding import Finding, FindingKind
from ..model.job import Copies, Job, OriginXY, OriginZ
from ..model.job import Stock as JobStock
from ..model.motion import Floats, MotionKind
from ..model.moves import DogBone, Tab
from ..model.operation import Cut, Operation, PocketOperation
from ..model.part import Contour, Region, Units
from ..model.part import Part as DrawnPart
from ..model.read_options import AS_DRAWN, DrawingOptions
from ..model.reading import Reading
from ..model.scene import Scene
from ..model.stock_box import stock_box, work_origin
from ..simulation.field.solid import SolidStock, read_solid
from ..simulation.field.workpiece import BoxStock, Stock
from ..verify.parts import TOLERANCE, FlatPart, Part, SolidPart
from .cut import CutSetup
from .examine import Examined
from .layers import layers_to_read, with_layers_spelled
from .plausible import read_plausible
from .setup_stock import KnownStock, told_stock
from .setup_tools import Held, KnownTool, ToolsTold, other_tools, with_holders, with_tools
from .told_reading import other_length, other_names, other_units, told_reading


@dataclass(frozen=True, eq=False)
class Wishes:
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

    tools: tuple[ToolsTold, ...] = ()
    job: JobFile | None = None
    stock: Stock | None = None
    against: tuple[str, bytes] | None = None
    beside: Callable[[str], bytes] | None = None
    depth: float | None = None
    leave: float | None = None
    layers: tuple[str, ...] = ()
    units: Units | None = None
    origin: tuple[OriginXY | None, OriginZ | None] | None = None
    join_tolerance: float | None = None
    tolerance: float | None = None
    held: Mapping[int, Held] = field(default_factory=dict)
    reading: DrawingOptions = AS_DRAWN


@dataclass(frozen=True, eq=False)
class Ready:
    """A setup that can be cut, and where it comes from.

    Attributes:
        programs: as they are cut; tools that they do not name have numbers.
        tools: by T number, those that cut.
        findings: what was assumed, and what there is to say about the drawing.
    """

    setup: CutSetup
    programs: tuple[Examined, ...]
    tools: dict[int, KnownTool]
    stock: KnownStock
    findings: tuple[Finding, ...]


def setup_of(programs: tuple[Examined, ...], wishes: Wishes = Wishes(), progress: Progress = NO_PROGRESS) -> Ready:
    """Return the setup that programs are cut in.

    Args:
        programs: at least one, in the order of cutting.
        wishes: what was said beside them.
        progress: told of the steps.

    Raises:
        InputError: a program has an error or cuts nothing; a tool, the depth of a drawing or the stock is told by
            nobody; or a file cannot be used.
        Cancelled: the job was asked to stop.
    """
    for examined in programs:
        _ensure_readable(examined)
    progress.step(0.0, "Looking for tools and stock")
    scene = _scene(wishes)
    told = () if scene is None else (ToolsTold("the scene", {tool.number: tool for tool in scene.tools}),)
    programs, tools, assumed = with_tools(programs, (*wishes.tools, *told))
    tools = with_holders(tools, wishes.held)
    part: Part | None = None
    said: tuple[Finding, ...] = ()
    if scene is not None:
        part = _surfaces(scene, _header(programs), wishes)
    elif wishes.against is not None:
        part, said = _part(programs, tools, wishes)
    progress.step(0.8)
    stock = _stock(programs, tools, part, wishes)
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
        *assumed,
        *of_stock,
        *((stock.assumed,) if stock.assumed is not None else ()),
        *said,
    )
    return Ready(setup, programs, tools, stock, found)


def _unfollowed(programs: tuple[Examined, ...]) -> Iterator[Finding]:
    """Yield a finding for each axis that a program turns and nobody follows: what it really cuts is not known."""
    for each in programs:
        for problem in each.problems:
            if problem.word and problem.word.lower() in ROTARY:
                text = (
                    f"{problem.told(each.name)} What it turns is cut here as if it stood; leave it out, or try it on "
                    "the machine."
                )
                yield Finding(FindingKind.LEFT_OUT, text, line=problem.line)


def _header(programs: tuple[Examined, ...]) -> HeaderNote:
    """Return the first header of our own; an empty one where there is none."""
    return next((each.program.header for each in programs if each.program.header is not None), HeaderNote())


def _ensure_readable(examined: Examined) -> None:
    error = examined.program.error
    if error is not None:
        raise InputError(
            f"{error.told(examined.name)} What stands behind it cannot be cut; correct it, or choose the control: "
            "--dialect."
        )
    motions = examined.program.motions
    if np.all(motions.kind == MotionKind.RAPID):
        raise InputError(f"{examined.name}: nothing is cut; the program has no motion at feed rate.")


def _stock(
    programs: tuple[Examined, ...], tools: dict[int, KnownTool], part: Part | None, wishes: Wishes
) -> KnownStock:
    """Return the metal: what was asked for, the job's, or what the programs tell."""
    if wishes.stock is not None:
        return KnownStock(wishes.stock, "as given")
    noted = any(each.program.stock is not None for each in programs)
    if isinstance(part, SolidPart) and part.block is not None and not noted:
        return KnownStock(BoxStock(part.block), "the scene")
    if wishes.job is not None and "stock" in wishes.job.tables and isinstance(part, FlatPart):
        box, (x, y, z) = stock_box(part.job, part.regions, part.lines), part.origin
        moved = replace(box, x0=box.x0 - x, y0=box.y0 - y, z0=box.z0 - z, x1=box.x1 - x, y1=box.y1 - y, z1=box.z1 - z)
        return KnownStock(BoxStock(moved), "the job file, round the drawing")
    return told_stock(
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


def _part(
    programs: tuple[Examined, ...], tools: dict[int, KnownTool], wishes: Wishes
) -> tuple[Part, tuple[Finding, ...]]:
    assert wishes.against is not None
    name, data = wishes.against
    suffix = PurePath(name).suffix.lower()
    if suffix == ".stl":
        solid = read_solid(name, data)
        return _solid(solid, wishes), _wound(name, solid)
    return _flat(programs, tools, wishes)


def _scene(wishes: Wishes) -> Scene | None:
    """Return the scene to compare with, if it is one."""
    if wishes.against is None or PurePath(wishes.against[0]).suffix.lower() != ".toml":
        return None
    from ..formats.scene.toml import read_scene

    return read_scene(*wishes.against)


def _surfaces(scene: Scene, header: HeaderNote, wishes: Wishes) -> SolidPart:
    """Return the surfaces of a scene in program coordinates."""
    from ..formats.scene.toml import sources_of
    from .scene_part import scene_part

    xy, z = wishes.origin or (None, None)
    scene = replace(scene, origin_xy=xy or scene.origin_xy, origin_z=z or scene.origin_z)
    zero = header.origin if wishes.origin is None else None
    return scene_part(scene, sources_of(wishes.beside or _nothing_beside), zero, wishes.leave, wishes.tolerance)


def _nothing_beside(name: str) -> bytes:
    raise InputError(
        f"{name}: the scene names this file, and it is not known where it lies; put its points into the scene."
    )


def _wound(name: str, solid: SolidStock) -> tuple[Finding, ...]:
    """Return the remark that triangles of a solid had to be turned over, if any had."""
    said = solid.wound_words(name)
    return (Finding(FindingKind.ASSUMED, said, counts=False, amount=float(solid.turned)),) if said else ()


def _solid(solid: SolidStock, wishes: Wishes) -> SolidPart:
    """Return a solid in program coordinates."""
    triangles = solid.triangles * (wishes.units or Units.MM).value
    low, high = triangles.min(axis=(0, 1)), triangles.max(axis=(0, 1))
    xy, z = wishes.origin or (None, None)
    zero = np.zeros(3)
    if xy is OriginXY.LOWER_LEFT:
        zero[:2] = low[:2]
    elif xy is OriginXY.CENTRE:
        zero[:2] = (low[:2] + high[:2]) / 2
    if z is not None:
        zero[2] = high[2] if z is OriginZ.TOP else low[2]
    tolerance = TOLERANCE if wishes.tolerance is None else wishes.tolerance
    return SolidPart(replace(solid, triangles=triangles - zero), wishes.leave or 0.0, tolerance)


def _flat(
    programs: tuple[Examined, ...], tools: dict[int, KnownTool], wishes: Wishes
) -> tuple[FlatPart, tuple[Finding, ...]]:
    """Return the drawing and what of it is milled, and what there is to say about it."""
    from ..operations.compute import about_drawing, followed_lines, machined
    from ..operations.missed import missed
    from ..toolpath.coverage.wanted import CHORD
    from ..toolpath.drawn import drawn
    from ..toolpath.sheets import Sheets
    from ..toolpath.witness import about_floors

    assert wishes.against is not None
    header, (name, data) = _header(programs), wishes.against
    asked = _job(DrawnPart(), programs, tools, wishes)
    diameters = [each.tool.diameter for each in tools.values()]
    reading = told_reading(wishes.reading, header.reading, name, wishes.units)
    units = (
        wishes.units
        or (wishes.job.units if wishes.job else None)
        or (None if reading.how.pixels_per_inch else header.drawing_units)
    )
    drawing = read_plausible(name, data, Reading(units, layers_to_read(asked), reading.how), lambda _: diameters)
    job = with_layers_spelled(replace(asked, part=drawing.part))
    parts = drawn(job)
    made, lines = machined(parts), followed_lines(job, parts)
    regions = made.regions
    if not regions and not lines:
        said = " ".join(finding.text for finding in parts.findings[:3])
        raise InputError(
            f"{name}: there is no closed contour to compare with; choose other layers, or join loose ends: "
            f"--join-tolerance. {said}".rstrip()
        )
    proven = header.path_tolerance if wishes.tolerance is None else None
    tolerance = TOLERANCE if wishes.tolerance is None else wishes.tolerance
    tabs, dog_bones = _on_purpose(programs)
    sheets = Sheets(job, parts)
    areas = sheets.areas()
    part = FlatPart(
        job,
        regions,
        _origin(job, (regions, lines), wishes, header),
        tolerance if proven is None else proven,
        tolerance,
        header.allowance or 0.0,
        areas,
        lines,
        clamps=parts.clamps,
        tabs=tabs,
        dog_bones=dog_bones,
    )
    told = (*reading.findings, *_differing(wishes, header, drawing.part.units))
    return part, (
        *told,
        *drawing.findings,
        *about_drawing(job, parts, lines),
        *made.findings,
        *sheets.findings,
        *about_floors(areas, CHORD),
        *missed(sheets, regions),
    )


def _differing(wishes: Wishes, header: HeaderNote, units: Units) -> Iterator[Finding]:
    """Yield where what was asked about the drawing is not what the program tells of how it was made."""
    yield from other_units(wishes.units, header.drawing_units, units)
    yield from other_names("--layer", wishes.layers, header.layers)
    yield from other_length("--join-tolerance", wishes.join_tolerance, header.join_tolerance)


def _on_purpose(programs: tuple[Examined, ...]) -> tuple[tuple[Tab, ...], tuple[DogBone, ...]]:
    """Return tabs and dog-bones that headers of our own tell of, each once."""
    headers = [each.program.header for each in programs if each.program.header is not None]
    return (
        tuple(dict.fromkeys(tab for header in headers for tab in header.tabs)),
        tuple(dict.fromkeys(bone for header in headers for bone in header.dog_bones)),
    )


def _origin(
    job: Job,
    milled: tuple[tuple[Region, ...], tuple[Contour, ...]],
    wishes: Wishes,
    header: HeaderNote,
) -> tuple[float, float, float]:
    """Return the program's zero in the drawing's coordinates."""
    asked = wishes.origin is not None or (wishes.job is not None and "origin" in wishes.job.tables)
    if not asked:
        return header.origin or (0.0, 0.0, 0.0)
    return work_origin(job, stock_box(job, *milled))


def _job(part: DrawnPart, programs: tuple[Examined, ...], tools: dict[int, KnownTool], wishes: Wishes) -> Job:
    """Return the job that the programs do: the one that is given, with what was asked for put in."""
    base = wishes.job.job if wishes.job is not None else Job(part)
    operations = _operations(programs, tools, wishes)
    missing = dict.fromkeys(each.cut.tool for each in operations if each.cut.tool not in tools)
    mine = {
        tool.number: tool
        for tool in (*(each.tool for each in tools.values()), *other_tools(missing, wishes.tools, programs))
    }
    operations = tuple(each for each in operations if each.cut.tool in mine)
    header = _header(programs)
    xy, z = wishes.origin or (base.origin_xy, base.origin_z)
    join = next(
        (
            t
            for t in (wishes.join_tolerance, base.join_tolerance if wishes.job else header.join_tolerance)
            if t is not None
        ),
        None,
    )
    layers = wishes.layers or (base.layer_names if wishes.job else ()) or header.layers
    copies, (clamps, height) = base.copies, (base.keep_out_layers, base.keep_out_height)
    return replace(
        base,
        part=part,
        tools=tuple(mine.values()),
        operations=operations,
        stock=_job_stock(base, operations, programs, wishes),
        origin_xy=xy or OriginXY.DRAWING,
        origin_z=z or OriginZ.TOP,
        join_tolerance=base.join_tolerance if join is None else join,
        layer_names=layers,
        copies=copies if wishes.job and "copies" in wishes.job.tables else header.copies or Copies(),
        keep_out_layers=clamps or header.keep_out[0],
        keep_out_height=height or header.keep_out[1],
    )


def _job_stock(
    base: Job, operations: tuple[Operation, ...], programs: tuple[Examined, ...], wishes: Wishes
) -> JobStock:
    """Return the stock's margin, and how thick it is: as given, told by a comment, or as the job has it."""
    note = next((each.program.stock for each in programs if each.program.stock is not None), None)
    if isinstance(wishes.stock, BoxStock):
        thickness = wishes.stock.solid.size[2]
    elif note is not None and note.size[2] > 0:
        thickness = note.size[2]
    else:
        thickness = max([base.stock.thickness, *(each.cut.depth for each in operations)])
    told = (each.program.header.under for each in programs if each.program.header is not None)
    return replace(base.stock, thickness=thickness, under=max([base.stock.under, *told]))


def _operations(programs: tuple[Examined, ...], tools: dict[int, KnownTool], wishes: Wishes) -> tuple[Operation, ...]:
    """Return what is milled how deep: as the job or the header of our own says, else a pocket a tool, as deep as was
    asked.
    """
    told = (
        wishes.job.job.operations
        if wishes.job is not None and "operation" in wishes.job.tables
        else tuple(_noted(programs))
    )
    if not told and wishes.depth is None:
        assert wishes.against is not None
        raise InputError(
            f"{wishes.against[0]}: nobody tells how deep the part is milled; give --depth, mm from the stock's top "
            "down to the floor, or a job file with operations."
        )
    asked = told or tuple(PocketOperation(Cut(number)) for number in tools)
    return tuple(_with(operation, wishes) for operation in asked)


def _noted(programs: tuple[Examined, ...]) -> list[Operation]:
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


def _with(operation: Operation, wishes: Wishes) -> Operation:
    """Return an operation with the depth and the stock to leave that were asked for; a step is never in the way of a
    depth.
    """
    depth = operation.cut.depth if wishes.depth is None else wishes.depth
    leave = operation.cut.stock_to_leave if wishes.leave is None else wishes.leave
    return replace(operation, cut=replace(operation.cut, depth=depth, stepdown=depth, stock_to_leave=leave))
