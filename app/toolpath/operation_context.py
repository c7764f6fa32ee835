"""What all operations of one computation share, and how their strokes become moves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from ..core.errors import ParameterError
from ..core.progress import Progress
from ..geometry.distance import DistanceField
from ..geometry.offset.offset import OffsetLevel
from ..geometry.primitives import contour_rows
from ..model.curves import Point
from ..model.entry import EntryKind
from ..model.finding import Finding
from ..model.job import Job
from ..model.moves import DogBone, Tab
from ..model.operation import CutParameters, Side
from ..model.part import Region
from ..raster.fill import Observer
from .bitmap_check import BitmapCheck
from .build import MovesBuilder, Stroke, StrokeLabel
from .depth import DepthLevels, DepthPasses, drilled, pass_heights, usable
from .entry.entry import EntryContext
from .machining_areas import BoxSides, MachiningArea, MachiningAreas
from .ordering.tour import in_order
from .rest_material import ClearedGround


@dataclass(frozen=True, slots=True)
class ProgramDigits:
    """Places that the program can say to which paths are written.

    Attributes:
        step: of X and Y, mm; 0 = nobody knows, or it does not matter. zero: of the program, part coordinates, mm.
    """

    step: float = 0.0
    zero: Point = (0.0, 0.0)


ANY_DIGITS = ProgramDigits()


@dataclass
class OperationContext:
    """What all operations of one computation share.

    Attributes:
        regions: what the job machines, copies and all.
        areas: areas and walls of each operation.
        builder: the moves so far, in the order of cutting.
        findings, polyline_rings, strokes, stepovers, on_bitmap, tabs, dog_bones: collected while operations run.
        cleared: ground that was cut.
        observer: is shown the numbered steps of the fill.
        at: where the tool is, mm.
        digits: of the program that is written.
    """

    job: Job
    regions: tuple[Region, ...]
    areas: MachiningAreas
    builder: MovesBuilder = field(default_factory=MovesBuilder)
    cleared: ClearedGround = field(default_factory=ClearedGround)
    findings: list[Finding] = field(default_factory=list)
    polyline_rings: int = 0
    strokes: int = 0
    stepovers: dict[int, float] = field(default_factory=dict)
    observer: Observer | None = None
    on_bitmap: BitmapCheck | None = None
    tabs: list[Tab] = field(default_factory=list)
    dog_bones: list[DogBone] = field(default_factory=list)
    at: tuple[float, float] = (0.0, 0.0)
    digits: ProgramDigits = ANY_DIGITS

    def apart(self) -> OperationContext:
        """Return a context of the same job that collects for itself, for an operation that is prepared beside
        others.
        """
        return OperationContext(self.job, self.regions, self.areas, observer=self.observer, digits=self.digits)

    def take(self, prepared: OperationContext) -> None:
        """Put what was collected apart behind what there is."""
        self.findings += prepared.findings
        self.tabs += prepared.tabs
        self.dog_bones += prepared.dog_bones
        self.polyline_rings += prepared.polyline_rings
        self.on_bitmap = prepared.on_bitmap or self.on_bitmap

    def note(self, levels: Sequence[OffsetLevel]) -> None:
        """Count rings that are polylines."""
        self.polyline_rings += sum(ring.polyline for level in levels for ring in level.rings)


@dataclass(frozen=True, eq=False)
class PreparedStrokes:
    """What an operation cuts: the area that it keeps within, and the strokes, not yet in order; the stock's sides where
    the area is open past them.
    """

    area: MachiningArea
    strokes: Sequence[Stroke]
    open_stock: BoxSides | None = None


def emit(
    context: OperationContext, index: int, area: MachiningArea, strokes: Sequence[Stroke], progress: Progress
) -> None:
    """Append the strokes of one of the job's operations, in an order of short rapids, at all its depths.

    Args:
        area: the operation's area, which entries and ways between strokes keep within.

    Raises:
        ParameterError: it is deeper than the stock.
        Cancelled: by progress.
    """
    job = context.job
    cut = job.operations[index].cut
    check_depth(job, cut)
    groups = in_order(strokes, context.at, progress.part(0.0, 0.3))
    if not groups:
        return
    tool = job.tool(cut.tool)
    operation = job.operations[index]
    beside = operation.wall_side is not Side.ON or not area.lines
    keep, worn = tool.radius + cut.stock_to_leave + operation.wear, operation.wear > 0
    ground = EntryContext(
        tool, cut.entry, area.distances, keep, beside, cut.direction, context.cleared, context.tabs, worn
    )
    label = StrokeLabel(index, tool.number, tool.feed_rate, tool.plunge_rate)
    passes = DepthPasses(context.builder, label, ground, levels_of(context, cut))
    if cut.entry.kind is EntryKind.PREDRILLED:
        passes.holes = usable(
            drilled(context.builder.moves(), {each.number: each for each in job.tools}), ground, -cut.floor
        )
    passes.cut(groups, progress.part(0.3, 1.0))
    context.at = groups[-1][-1].end
    context.findings.extend(passes.entries.findings(tool, cut.entry.kind))


def check_depth(job: Job, cut: CutParameters) -> None:
    """Refuse a depth that the stock has not.

    Raises:
        ParameterError: it is deeper than the stock.
    """
    if cut.depth > job.stock.thickness + 1e-9:
        raise ParameterError(
            f"Depth is {cut.depth:g} mm, but the stock is {job.stock.thickness:g} mm thick; reduce the depth."
        )


def levels_of(context: OperationContext, cut: CutParameters) -> DepthLevels:
    """Return the heights of an operation."""
    job, clamps = context.job, context.areas.drawn.clamps
    heights = pass_heights(cut.floor, cut.stepdown, cut.finish_depth)
    if not clamps or job.keep_out_height <= job.retract_z:
        return DepthLevels(heights, job.travel_z, job.retract_z)
    tool = job.tool(cut.tool)
    outlines = DistanceField.of(
        np.concatenate([contour_rows(contour) for region in clamps for contour in region.contours])
    )
    wide = max(tool.radius, tool.shank_diameter / 2, *(radius for _, radius in tool.holder), 0.0)
    return DepthLevels(heights, job.travel_z, job.retract_z, outlines, wide)


def passes_of(context: OperationContext, index: int) -> int:
    """Return how many depth passes an operation has."""
    cut = context.job.operations[index].cut
    return len(pass_heights(cut.floor, cut.stepdown, cut.finish_depth))
