"""A job to its program: one table from kind of operation to function, and the order of cutting."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from app.bitmap.fill import Observer
from app.errors import ParameterError
from app.geometry.chain import chain
from app.geometry.distance import DistanceField
from app.geometry.offset import Level, offset_levels
from app.geometry.overlay import without_crossings
from app.geometry.primitives import Primitives, pack
from app.geometry.region import nest
from app.model.finding import Finding, FindingKind
from app.model.job import Job
from app.model.moves import Program
from app.model.operation import ContourOperation, Operation, Order, PocketOperation
from app.model.part import Region
from app.model.tool import Tool
from app.progress import NO_PROGRESS, Progress
from app.toolpath.bitmap_check import BitmapCheck, check_on_bitmap
from app.toolpath.build import Label, MovesBuilder, Stroke
from app.toolpath.contour import contour_strokes, nearest_first
from app.toolpath.depth import cut_in_passes, pass_heights
from app.toolpath.link import link
from app.toolpath.narrow import necks, too_small
from app.toolpath.pocket import pocket_distances, stepover_of, without_empty


@dataclass
class Setting:
    """What all operations of one computation share.

    Attributes:
        primitives, distances: the drawing's regions as rows, and distances from them.
        observer: is shown the numbered steps of the fill.
        findings, polyline_rings, strokes, on_bitmap: collected while operations run.
    """

    job: Job
    regions: tuple[Region, ...]
    primitives: Primitives
    distances: DistanceField
    builder: MovesBuilder
    findings: list[Finding] = field(default_factory=list)
    polyline_rings: int = 0
    strokes: int = 0
    observer: Observer | None = None
    on_bitmap: BitmapCheck | None = None
    at: tuple[float, float] = (0.0, 0.0)

    def note(self, levels: Sequence[Level]) -> None:
        """Count rings that are polylines."""
        self.polyline_rings += sum(ring.polyline for level in levels for ring in level.rings)


def compute(job: Job, progress: Progress = NO_PROGRESS, observer: Observer | None = None) -> Program:
    """Return every move of a job.

    Args:
        observer: is shown the numbered steps of the bitmap fill (201-208); costs nothing when there is none.

    Raises:
        ParameterError: an operation's parameters do not fit its tool.
        Cancelled: by progress.
    """
    progress.step(0.0, "Chain contours")
    regions, findings = regions_of(job)
    builder = MovesBuilder()
    if not regions:
        return Program(builder.moves(), findings=tuple(findings))
    primitives = pack(regions)
    setting = Setting(job, regions, primitives, DistanceField.of(primitives.rows), builder, findings, observer=observer)
    operations = in_order(job)
    for k, index in enumerate(operations):
        operation = job.operations[index]
        _WAYS[type(operation)](setting, index, progress.part(0.05 + 0.95 * k / len(operations), 0.05 + 0.95 * (k + 1) / len(operations)))
    if job.order is Order.PATENT_1986:
        setting.findings.extend(slotting(job))
    ordered = sorted(setting.findings, key=lambda f: not f.counts)
    seen = setting.on_bitmap or BitmapCheck(0.0, 0.0, 0, (0.0, 0.0), 0.0)
    return Program(builder.moves(), regions, tuple(ordered), setting.strokes, setting.polyline_rings,
                   seen.bitmap_area, seen.exact_area, seen.pitch)


def regions_of(job: Job) -> tuple[tuple[Region, ...], list[Finding]]:
    """Return (regions, findings about the drawing) of the layers that a job machines; contours that meet count even-odd."""
    visible = {layer.name for layer in job.part.layers if layer.visible}
    wanted = set(job.layer_names) or visible
    chaining = chain([e for e in job.part.entities if e.layer in wanted], job.join_tolerance)
    contours = [contour for contour in chaining.contours if contour.closed]
    if any(f.kind is FindingKind.SELF_INTERSECTION for f in chaining.findings):
        contours = list(without_crossings(contours))
    return nest(contours), list(chaining.findings)


def in_order(job: Job) -> list[int]:
    """Return indices of the enabled operations in the order of cutting."""
    last = PocketOperation if job.order is Order.PATENT_1986 else ContourOperation
    enabled = [k for k, operation in enumerate(job.operations) if operation.cut.enabled]
    return sorted(enabled, key=lambda k: isinstance(job.operations[k], last))


def wall_distance(job: Job) -> float:
    """Return how far A' lies inside the walls, mm: the contour tool's radius and the stock it leaves (step 120).

    Without a contour operation the pocket goes up to the walls itself.
    """
    contours = [op.cut for op in job.operations if isinstance(op, ContourOperation) and op.cut.enabled]
    return max((job.tool(cut.tool).radius + cut.stock_to_leave for cut in contours), default=0.0)


def _contour(setting: Setting, index: int, progress: Progress) -> None:
    """Steps 120 and 130: offset every contour by the contour tool's radius, and fill the area it bounds."""
    operation = setting.job.operations[index]
    tool = setting.job.tool(operation.cut.tool)
    levels = offset_levels(setting.primitives, [tool.radius + operation.cut.stock_to_leave], progress, frame=True)
    setting.note(levels)
    progress.step(0.5, "Fill")
    setting.on_bitmap = check_on_bitmap(setting.distances, levels[0], setting.observer)
    setting.findings.extend(setting.on_bitmap.findings())
    setting.findings.extend(too_small(setting.regions, levels[0], tool, counts=True))
    setting.findings.extend(necks(levels[0], setting.distances, tool))
    emit(setting, index, contour_strokes(levels[0].rings, operation.cut.direction))


def _pocket(setting: Setting, index: int, progress: Progress) -> None:
    """Steps 141-148: rings inside A', linked to one stroke a connected area."""
    operation = setting.job.operations[index]
    assert isinstance(operation, PocketOperation)
    tool = setting.job.tool(operation.cut.tool)
    wall = wall_distance(setting.job)
    outermost = max(wall, operation.cut.stock_to_leave) + tool.radius
    distances = pocket_distances(outermost, stepover_of(operation, tool), setting.distances)
    levels = without_empty(offset_levels(setting.primitives, distances, progress.part(0, 0.7), frame=True)) if distances else ()
    setting.note(levels)
    first = levels[0] if levels else Level(outermost, ())
    setting.findings.extend(too_small(setting.regions, first, tool, counts=wall == 0))
    setting.findings.extend(necks(first, setting.distances, tool))
    progress.step(0.7, "Link rings")
    strokes = link(levels, setting.distances, operation.cut.direction)
    setting.strokes += len(strokes) * len(pass_heights(operation.cut.depth, operation.cut.stepdown))
    emit(setting, index, strokes)


def emit(setting: Setting, index: int, strokes: Sequence[Stroke]) -> None:
    """Append the strokes of one of the job's operations, in an order of short rapids, at all its depths.

    Raises:
        ParameterError: it is deeper than the stock.
    """
    job = setting.job
    cut = job.operations[index].cut
    tool: Tool = job.tool(cut.tool)
    label = Label(index, tool.number, tool.feed_rate, tool.plunge_rate)
    ordered = nearest_first(strokes, setting.at)
    if ordered:
        setting.at = (float(ordered[-1].rows[-1, 2]), float(ordered[-1].rows[-1, 3]))
    if cut.depth > job.stock.thickness + 1e-9:
        raise ParameterError(f"Depth is {cut.depth:g} mm, but the stock is {job.stock.thickness:g} mm thick; reduce the depth.")
    cut_in_passes(ordered, cut, (job.safe_z, job.retract_z), label, setting.builder)


def slotting(job: Job) -> list[Finding]:
    """Return the warning that the 1986 order deserves."""
    tools = [job.tool(op.cut.tool) for op in job.operations if isinstance(op, ContourOperation) and op.cut.enabled]
    return [Finding(FindingKind.ENGAGEMENT, f"Order 1986: T{tool.number} {tool.label} cuts first and slots full stock, engaged over 100 % "
                    "of its diameter. Reduce the stepdown, or let the pocket tool cut first.", counts=False, amount=tool.diameter)
            for tool in tools]


_WAYS: dict[type[Operation], Callable[[Setting, int, Progress], None]] = {ContourOperation: _contour, PocketOperation: _pocket}
