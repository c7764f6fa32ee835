"""The 1986 way from a part to moves: on pixels alone, ended by smoothing (steps 110-148 and 401-407).

It never gouges. Paths lie in pixels whose distance from the walls' pixels, less 1.21 px and what smoothing may move
them, is the tool's radius or more; smoothed, they are measured once more against the squares of these pixels. The price
is metal along the walls: how much is measured too.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from ...core.effort import Reckoning, announce
from ...core.errors import ParameterError
from ...core.progress import NO_PROGRESS, Progress
from ...core.wording import counted, in_plane
from ...fitting.corner_smoothing.smooth import CornerSmoothingOptions
from ...fitting.corner_smoothing.smoothed_path import SmoothedPath
from ...geometry.distance import DistanceField
from ...geometry.offset.offset import OffsetLevel, Ring
from ...geometry.primitives import Rows, lengths, pack, points_at, signed_area, within_half_turn
from ...model.finding import Finding, FindingKind
from ...model.job import Job
from ...model.moves import Program
from ...model.operation import Operation, Order
from ...model.tool import Tool
from ...operations.compute import in_order, slotting
from ...operations.contour.paths import contour_strokes
from ...operations.effort import workload_of
from ...operations.pocket.paths import stepover_of, wall_distance
from ...raster.border import Border, Index, borders_of
from ...raster.levels import SAFE_PX, RingSteps, offset_area, ring_index
from ...raster.trace import PixelChain
from ...raster.walls import Mask
from ...toolpath.drawn_contours import DrawnContours
from ...toolpath.linking.link import link_by_proof
from ...toolpath.machining_areas import MachiningArea, MachiningAreas
from ...toolpath.operation_context import OperationContext, emit, passes_of
from .part import BitmapPart
from .path import TOLERANCE_PX, WallLimits, chain_points, pixel_path

LONG_LINE = 10.0
"""Tool diameters from which a line counts as long (step 403)."""

SPARE_STEP_PX = 1.5
"""Pixels by which paths lie nearer to one another than would cover everything, were they exact."""

MOST_SKIN_PX = 4.0
"""Pixels that the rules of `offset_area` and smoothing may keep a path from its wall; what is farther is no skin but
metal left.
"""

LEAST_RADIUS_PX = 1.0
"""A tool must be wider than two pixels: below that a bitmap cannot tell where it is."""


@dataclass(frozen=True)
class WallExcess:
    """How much farther from the walls than asked the paths along them are.

    Attributes:
        most_mm, mean_mm: along the whole of these paths.
    """

    most_mm: float = 0.0
    mean_mm: float = 0.0


@dataclass(frozen=True)
class PixelPath:
    """A closed path made from pixels.

    Attributes:
        chain: its pixels.
        smoothed: the lines and arcs it has become, mm.
    """

    chain: PixelChain
    smoothed: SmoothedPath

    @property
    def rows(self) -> Rows:
        """(n, 8) mm."""
        return self.smoothed.rows


@dataclass(frozen=True)
class _Level:
    """Borders of pixels, before they are smoothed, and their distance from the walls, mm."""

    distance: float
    borders: Sequence[Border]


@dataclass(frozen=True)
class OperationPaths:
    """The paths of one operation on pixels.

    Attributes:
        index: of the operation in its job.
        wall: distance of the first paths from the walls, mm.
        area: (rows, cols) pixels of A' (step 120).
        levels: paths by level, outermost first.
        distances: of the levels from the walls, mm.
        pixels: (rows, cols) how many of the levels each pixel lies inside of.
        steps: where a pocket's levels lie, from the frame of A'.
    """

    index: int
    wall: float
    area: Mask
    levels: tuple[tuple[PixelPath, ...], ...]
    distances: tuple[float, ...]
    pixels: Index
    steps: RingSteps = field(default_factory=lambda: RingSteps(0.0, 1.0))


@dataclass(frozen=True)
class BitmapProgram:
    """What the bitmap way gives.

    Attributes:
        program: moves, regions and findings, as the exact way gives them.
        paths: of each operation, in the order of cutting.
        given_up: measured from the part's own walls.
        unsmoothed: paths that stay lines from pixel to pixel: of three pixels or fewer, or nothing smoother kept clear.
    """

    program: Program
    paths: tuple[OperationPaths, ...]
    given_up: WallExcess
    unsmoothed: int


def compute_on_bitmap(job: Job, part: BitmapPart, progress: Progress = NO_PROGRESS) -> BitmapProgram:
    """Return every move of a job, computed on pixels alone.

    Args:
        job: its tools and operations; its drawing is not looked at.
        part: the pixels.

    Raises:
        ParameterError: no operation is switched on, a tool is not wider than two pixels, or it cannot do what its
            operation asks.
        Cancelled: by progress.
    """
    job.check_operations()
    primitives = pack(part.regions)
    context = OperationContext(job, part.regions, MachiningAreas(job, DrawnContours()))
    walls = MachiningArea(part.regions, primitives, part.squares, np.zeros(len(primitives.rows), np.bool_))
    order, paths = [index for index in in_order(job) if job.operations[index].on_pixels], []
    announce(bitmap_effort(part, _lengths(job, part, order)), progress)
    for k, index in enumerate(order):
        share = progress.part(k / len(order), (k + 1) / len(order))
        paths.append(operation_paths(job, index, part, share.part(0.0, 0.7)))
        share.step(0.7, "Link paths")
        _emit(context, paths[-1], part, walls, share.part(0.7, 1.0))
    if job.order is Order.PATENT_1986:
        context.findings.extend(slotting(job))
    given_up = _given_up(paths, DistanceField.of(primitives.rows), part.frame.pitch)
    rough = sum(not path.smoothed.exact for each in paths for level in each.levels for path in level)
    context.findings.extend(_findings(part, paths, given_up, job))
    context.findings.extend(_left_out(job))
    findings = tuple(sorted(context.findings, key=lambda finding: not finding.counts))
    program = Program(
        context.builder.moves(),
        part.regions,
        findings,
        context.strokes,
        pitch_mm=part.frame.pitch,
        given_up_mm=given_up.most_mm,
        allowance_mm=min(given_up.most_mm, MOST_SKIN_PX * part.frame.pitch),
        stepovers={each.index: each.distances[1] - each.distances[0] for each in paths if len(each.distances) > 1},
    )
    return BitmapProgram(program, tuple(paths), given_up, rough)


def _lengths(job: Job, part: BitmapPart, order: Sequence[int]) -> list[float]:
    """Return how long the paths of operations are, about, mm: over the floor of pockets a step apart, else as long as
    the walls.
    """
    extent, found = workload_of(part.regions), []
    for index in order:
        operation, pitch = job.operations[index], part.frame.pitch
        over = 0.0
        if operation.CLEARS:
            step = operation.ring_stepover or job.tool(operation.cut.tool).radius - SPARE_STEP_PX * pitch
            over = extent.area / max(step, pitch)
        found.append(max(over, extent.length))
    return found


def _left_out(job: Job) -> list[Finding]:
    """Return which operations make no moves on pixels."""
    left = [operation for operation in job.operations if operation.cut.enabled and not operation.on_pixels]
    return [
        Finding(
            FindingKind.LEFT_OUT,
            f"The {operation.WORD} operation with T{operation.cut.tool} makes no moves: "
            "on pixels only pockets, and contours inside the walls, are cut.",
            counts=operation.COARSE or not operation.CLEARS,
        )
        for operation in left
    ]


def operation_paths(job: Job, index: int, part: BitmapPart, progress: Progress = NO_PROGRESS) -> OperationPaths:
    """Return the paths of one operation: step 120 for a contour, steps 141-148 for a pocket.

    Raises:
        ParameterError: the tool is not wider than two pixels, or the paths are nearer to one another than a pixel.
    """
    operation = job.operations[index]
    tool, pitch = job.tool(operation.cut.tool), part.frame.pitch
    if tool.radius < LEAST_RADIUS_PX * pitch:
        raise ParameterError(
            f"T{tool.number} of {tool.diameter:g} mm is not wider than two pixels of {pitch:.3g} mm; "
            "use a larger bitmap or a smaller pitch."
        )
    progress.step(0.0, "Shrink on pixels")
    if operation.FOLLOWS_WALLS:
        return _contour_paths(job, part, index, progress)
    return _pocket_paths(job, part, index, progress)


def _contour_paths(job: Job, part: BitmapPart, index: int, progress: Progress) -> OperationPaths:
    cut = job.operations[index].cut
    tool = job.tool(cut.tool)
    wall = tool.radius + cut.stock_to_leave
    area = offset_area(part.free, wall / part.frame.pitch, TOLERANCE_PX)
    paths = _smoothed(part, (_Level(wall, borders_of(area)),), tool, progress)
    return OperationPaths(index, wall, area, paths, (wall,), area.astype(np.uint16))


def _pocket_paths(job: Job, part: BitmapPart, index: int, progress: Progress) -> OperationPaths:
    operation = job.operations[index]
    tool, pitch, leave = job.tool(operation.cut.tool), part.frame.pitch, operation.cut.stock_to_leave
    step = _stepover(operation, tool, pitch)
    wall = max(wall_distance(job, operation), leave)
    area = offset_area(part.free, wall / pitch, TOLERANCE_PX)
    steps = RingSteps(tool.radius / pitch, step / pitch, min(SAFE_PX + TOLERANCE_PX, step / pitch - 1))
    index_plane = ring_index(area, steps)
    index_plane[~offset_area(part.free, (tool.radius + leave) / pitch, TOLERANCE_PX)] = 0
    count = int(index_plane.max())
    by_level: list[list[Border]] = [[] for _ in range(count)]
    for border in borders_of(index_plane):
        by_level[border.level - 1].append(border)
    distances = tuple(wall + tool.radius + k * step for k in range(count))
    paths = _smoothed(part, tuple(map(_Level, distances, by_level)), tool, progress)
    return OperationPaths(index, wall, area, paths, distances, index_plane, steps)


def _stepover(operation: Operation, tool: Tool, pitch: float) -> float:
    """Return the distance between paths, mm: as asked, or what pixels leave of the largest that covers everything by
    itself.

    Raises:
        ParameterError: it is less than a pixel, or more than the tool.
    """
    if operation.ring_stepover is None:
        return max(tool.radius - SPARE_STEP_PX * pitch, pitch)
    if operation.ring_stepover < pitch:
        raise ParameterError(
            f"The stepover of {operation.ring_stepover:g} mm is less than a pixel of {pitch:.3g} mm; "
            "use a larger bitmap or a smaller pitch."
        )
    return stepover_of(operation, tool)


def _smoothed(
    part: BitmapPart, levels: Sequence[_Level], tool: Tool, progress: Progress
) -> tuple[tuple[PixelPath, ...], ...]:
    options = CornerSmoothingOptions(TOLERANCE_PX * part.frame.pitch, LONG_LINE * tool.diameter)
    result = []
    for k, level in enumerate(levels):
        progress.step((k + 1) / (len(levels) + 1), "Smooth paths")
        keep = WallLimits(level.distance, levels[0].distance, part.squares, part.frame, part.free)
        chains = [border.chain for border in level.borders]
        result.append(
            tuple(PixelPath(chain, pixel_path(chain_points(part.frame, chain), keep, options)) for chain in chains)
        )
    return tuple(result)


def _ring(path: PixelPath, part: BitmapPart) -> Ring:
    rows = within_half_turn(path.rows)
    return Ring(rows, int(part.label[path.chain.start]), signed_area(rows), float(lengths(rows).sum()))


def _emit(
    context: OperationContext, paths: OperationPaths, part: BitmapPart, area: MachiningArea, progress: Progress
) -> None:
    """Append the moves of one operation."""
    operation = context.job.operations[paths.index]
    direction = operation.cut.direction
    rings = [tuple(_ring(path, part) for path in level) for level in paths.levels]
    levels = [OffsetLevel(distance, level) for distance, level in zip(paths.distances, rings, strict=True)]
    if operation.FOLLOWS_WALLS:
        emit(context, paths.index, area, contour_strokes(levels[0].rings, direction), progress)
        return
    strokes = link_by_proof(
        levels, part.squares, direction, max(part.frame.pitch, context.job.tool(operation.cut.tool).radius / 4)
    )
    context.strokes += len(strokes) * passes_of(context, paths.index)
    emit(context, paths.index, area, strokes, progress)


def _given_up(paths: Sequence[OperationPaths], walls: DistanceField, pitch: float) -> WallExcess:
    """Measure how far the paths next to the walls lie beyond their distance."""
    most, total, length = 0.0, 0.0, 0.0
    for each in paths:
        rows = [path.rows for path in each.levels[0]] if each.levels else []
        if rows:
            points = _along(np.concatenate(rows), pitch / 2)
            over = walls.nearest(points)[0] - each.distances[0]
            most, total, length = max(most, float(over.max())), total + float(over.sum()), length + len(over)
    return WallExcess(most, total / length if length else 0.0)


def _along(rows: Rows, step: float) -> Rows:
    """Return points (m, 2) along rows, about a step apart."""
    counts = np.maximum(np.ceil(lengths(rows) / step), 1).astype(np.int64)
    owner = np.repeat(np.arange(len(rows)), counts)
    place = np.arange(len(owner)) - np.repeat(np.cumsum(counts) - counts, counts)
    points: Rows = points_at(rows[owner], (place + 0.5) / counts[owner])
    return points


def _findings(part: BitmapPart, paths: Sequence[OperationPaths], given_up: WallExcess, job: Job) -> list[Finding]:
    """Return regions without a path, and what was given up."""
    pitch = part.frame.pitch
    text = (
        f"On pixels of {pitch:.3g} mm the paths along the walls are up to {given_up.most_mm:.3f} mm farther from them "
        f"than asked, {given_up.mean_mm:.3f} mm in the mean, so that none is nearer; a larger bitmap gives up less."
    )
    return [
        Finding(FindingKind.TOLERANCE, text, counts=False, amount=given_up.most_mm),
        *_without_path(part, paths, job),
    ]


def _without_path(part: BitmapPart, paths: Sequence[OperationPaths], job: Job) -> Iterator[Finding]:
    """Yield the regions in which a tool has no path, once a tool; whether it fits between the lines as drawn is another
    question.
    """
    missed: dict[tuple[int, int], bool] = {}
    for each in paths:
        reached = {int(part.label[path.chain.start]) for level in each.levels for path in level}
        alone = job.operations[each.index].FOLLOWS_WALLS or each.wall == 0
        for region in part.regions:
            if region.number not in reached:
                key = (region.number, job.operations[each.index].cut.tool)
                missed[key] = missed.get(key, False) or alone
    boundaries = {region.number: region.boundary for region in part.regions}
    for (number, tool_number), counts in missed.items():
        (x, y), tool = boundaries[number].primitives[0].start, job.tool(tool_number)
        text = (
            f"Region {number}, which begins at {in_plane(x, y)}, has no room for T{tool.number} {tool.label} on "
            f"pixels of {part.frame.pitch:.3g} mm; use a larger bitmap or a smaller tool."
        )
        yield Finding(FindingKind.REGION_TOO_SMALL, text, x, y, counts, boundaries[number].entity_ids)


_PIXEL_S = 5e-8
"""A pixel of a bitmap that an operation shrinks and traces; measured, as the two below, on bitmaps of 512 to 4,096
pixels a side with paths of 19,000 to 280,000.
"""
_CHAIN_S = 2e-5
"""A pixel along a path that is smoothed, and proven to keep clear: straight walls take a third of it, waves twice."""
_ON_PIXELS_S = 0.07
"""A contour whose paths on pixels are linked, written, read back, and measured as to what they leave."""


def bitmap_effort(part: BitmapPart, chains_mm: Sequence[float]) -> Reckoning:
    """Return what a job on pixels takes.

    Args:
        part: the pixels. chains_mm: how long the paths of each operation are, about, in one pass.
    """
    pitch, contours = part.frame.pitch, sum(len(region.contours) for region in part.regions)
    along = sum(chains_mm) / pitch
    seconds = part.free.size * len(chains_mm) * _PIXEL_S + along * _CHAIN_S + contours * _ON_PIXELS_S
    many, outlines = contours * _ON_PIXELS_S > seconds / 2, counted(contours, "contour", thousands=",")
    return Reckoning(
        seconds,
        f"{along:,.0f} pixels of paths in {outlines} on {part.frame.cols:,} x {part.frame.rows:,} pixels",
        "leave out layers" if many else "use a smaller bitmap, a larger pitch, or a larger tool",
    )
