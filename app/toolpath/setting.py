"""What all operations of one computation share, and how their strokes become moves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from ..core.errors import ParameterError
from ..core.progress import Progress
from ..geometry.distance import DistanceField
from ..geometry.offset.offset import Level
from ..geometry.primitives import contour_rows
from ..model.entry import EntryKind
from ..model.finding import Finding
from ..model.job import Job
from ..model.moves import DogBone, Tab
from ..model.operation import Cut, Side
from ..model.part import Region
from ..raster.fill import Observer
from .bitmap_check import BitmapCheck
from .build import Label, MovesBuilder, Stroke
from .cleared import Cleared
from .depth.depth import DepthPasses, Levels, pass_heights
from .entry.entry import Ground
from .entry.hole import drilled, usable
from .ordering.depth_order import in_order
from .sheets import Sheet, Sheets


@dataclass
class Setting:
    """What all operations of one computation share.

    Attributes:
        regions: what the job machines, copies and all.
        sheets: areas and walls of each operation.
        builder: the moves so far, in the order of cutting.
        findings, polyline_rings, strokes, stepovers, on_bitmap, tabs, dog_bones: collected while operations run.
        cleared: ground that was cut.
        observer: is shown the numbered steps of the fill.
        at: where the tool is, mm.
    """

    job: Job
    regions: tuple[Region, ...]
    sheets: Sheets
    builder: MovesBuilder = field(default_factory=MovesBuilder)
    cleared: Cleared = field(default_factory=Cleared)
    findings: list[Finding] = field(default_factory=list)
    polyline_rings: int = 0
    strokes: int = 0
    stepovers: dict[int, float] = field(default_factory=dict)
    observer: Observer | None = None
    on_bitmap: BitmapCheck | None = None
    tabs: list[Tab] = field(default_factory=list)
    dog_bones: list[DogBone] = field(default_factory=list)
    at: tuple[float, float] = (0.0, 0.0)

    def note(self, levels: Sequence[Level]) -> None:
        """Count rings that are polylines."""
        self.polyline_rings += sum(ring.polyline for level in levels for ring in level.rings)


def emit(setting: Setting, index: int, sheet: Sheet, strokes: Sequence[Stroke], progress: Progress) -> None:
    """Append the strokes of one of the job's operations, in an order of short rapids, at all its depths.

    Args:
        sheet: the operation's area, which entries and ways between strokes keep within.

    Raises:
        ParameterError: it is deeper than the stock.
        Cancelled: by progress.
    """
    job = setting.job
    cut = job.operations[index].cut
    check_depth(job, cut)
    groups = in_order(strokes, setting.at, progress.part(0.0, 0.3))
    if not groups:
        return
    tool = job.tool(cut.tool)
    operation = job.operations[index]
    beside = operation.wall_side is not Side.ON
    keep = tool.radius + cut.stock_to_leave
    ground = Ground(tool, cut.entry, sheet.distances, keep, beside, cut.direction, setting.cleared, setting.tabs)
    label = Label(index, tool.number, tool.feed_rate, tool.plunge_rate)
    passes = DepthPasses(setting.builder, label, ground, levels_of(setting, cut))
    if cut.entry.kind is EntryKind.PREDRILLED:
        passes.holes = usable(
            drilled(setting.builder.moves(), {each.number: each for each in job.tools}), ground, -cut.floor
        )
    passes.cut(groups, progress.part(0.3, 1.0))
    setting.at = groups[-1][-1].end
    setting.findings.extend(passes.entries.findings(tool, cut.entry.kind))


def check_depth(job: Job, cut: Cut) -> None:
    """Refuse a depth that the stock has not.

    Raises:
        ParameterError: it is deeper than the stock.
    """
    if cut.depth > job.stock.thickness + 1e-9:
        raise ParameterError(
            f"Depth is {cut.depth:g} mm, but the stock is {job.stock.thickness:g} mm thick; reduce the depth."
        )


def levels_of(setting: Setting, cut: Cut) -> Levels:
    """Return the heights of an operation."""
    job, clamps = setting.job, setting.sheets.drawn.clamps
    heights = pass_heights(cut.floor, cut.stepdown, cut.finish_depth)
    if not clamps or job.keep_out_height <= job.retract_z:
        return Levels(heights, job.travel_z, job.retract_z)
    tool = job.tool(cut.tool)
    outlines = DistanceField.of(
        np.concatenate([contour_rows(contour) for region in clamps for contour in region.contours])
    )
    wide = max(tool.radius, tool.shank_diameter / 2, *(radius for _, radius in tool.holder), 0.0)
    return Levels(heights, job.travel_z, job.retract_z, outlines, wide)


def passes_of(setting: Setting, index: int) -> int:
    """Return how many depth passes an operation has."""
    cut = setting.job.operations[index].cut
    return len(pass_heights(cut.floor, cut.stepdown, cut.finish_depth))
