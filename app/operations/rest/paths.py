"""Rest machining: what the operations before have left, cleared by a tool that reaches it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ...core.errors import ParameterError
from ...core.progress import Progress
from ...geometry.offset.offset import OffsetLevel, offset_levels
from ...geometry.primitives import Rows, boxes
from ...model.job import Job
from ...model.moves import MoveKind, Purpose
from ...model.operation import CutParameters, RestOperation, Side
from ...model.tool import Tool
from ...toolpath.build import Stroke
from ...toolpath.coverage.areas import move_rows
from ...toolpath.linking.chains import Corridor, chains
from ...toolpath.linking.rest_runs import RestCells, RingChunks, RingRun, all_runs, runs
from ...toolpath.machining_areas import MachiningArea
from ...toolpath.operation_context import OperationContext, emit
from ...toolpath.rest_material import (
    CHUNK_BYTES,
    CentreReach,
    CutGround,
    Floats,
    core_cells,
    flat_radius,
    left_of,
    rim_cells,
    suspects,
)
from .sides import directed_runs

_TOGETHER = 2000
"""Regions that are cleared together: of more the rings and cells of all would not be held at once, nor near enough to
the processor.
"""

_DEPTH = 1e-6
"""mm by which a move may miss the floor and still count as on it."""

_FAR = 15.0
"""Tool diameters; ways to the next run as long as this are gone rather than that the tool lifts, however slow the
feed.
"""

_RAPID = 5000.0
"""mm/min; of a slow machine."""

_STOPS = 1.0
"""Seconds that the stops of a lift take."""

_FINEST = 8
"""Parts of a radius that rings to choose runs from are apart at least."""

_CHOSEN = 2
"""Times that runs are chosen; what these leave, for the size of cells, every ring near it clears."""


def rest(context: OperationContext, index: int, progress: Progress) -> None:
    """Clear what is left within reach of the operation's tool.

    What counts as cut are all moves so far that are as deep as the operation's floor, and the contours that operations
    later in the list will follow as deep. What the operations before left at the floor they left at every depth, so the
    same paths are cut at all depths. A run with metal on one side is cut in the direction asked for; only slots go
    either way.

    Raises:
        ParameterError: the stepover is larger than the tool, or the operation is deeper than the stock.
        Cancelled: by progress.
    """
    operation = context.job.operations[index]
    assert isinstance(operation, RestOperation)
    area, tool = context.areas.of(operation), context.job.tool(operation.cut.tool)
    if area is None:
        return
    progress.step(0.0, "Looking for what is left")
    within, closest = clears_within(operation, tool), tool.radius + operation.cut.stock_to_leave
    reach = CentreReach(area, tool.radius, closest, max(within, tool.radius / 4) / 16)
    cut = OtherPaths(paths_before(context, operation.cut.floor), contours_later(context, index, area))
    strokes: list[Stroke] = []
    parts = area.parts(_TOGETHER, closest, progress.part(0.0, 0.1))
    for k, part in enumerate(parts):
        share = progress.part(0.1 + 0.7 * k / len(parts), 0.1 + 0.7 * (k + 1) / len(parts))
        near = cut if part is area else cut.beside(part, closest + tool.radius)
        strokes += _cleared(context, index, RestClearing(replace(reach, area=part), near, within), share)
    if strokes:
        emit(context, index, area, strokes, progress.part(0.8, 1.0))


@dataclass(frozen=True, eq=False)
class OtherPaths:
    """What is cut without a rest operation: (rows (n, 8), radius of the cutter, mm) of each tool.

    Attributes:
        before: by operations before it. later: along walls, by those later in the list.
    """

    before: list[tuple[Rows, float]]
    later: list[tuple[Rows, float]] = field(default_factory=list)

    @property
    def all(self) -> list[tuple[Rows, float]]:
        """Both."""
        return [*self.before, *self.later]

    def beside(self, area: MachiningArea, reach: float) -> OtherPaths:
        """Return what may cut in an area, or beside it within so many mm."""
        low, high = area.distances.boxes[:, :2].min(axis=0) - reach, area.distances.boxes[:, 2:].max(axis=0) + reach

        def near(rows: Rows, radius: float) -> tuple[Rows, float]:
            around = boxes(rows)
            return rows[np.all((around[:, :2] <= high + radius) & (around[:, 2:] >= low - radius), axis=1)], radius

        return OtherPaths([near(*each) for each in self.before], [near(*each) for each in self.later])


def _cleared(context: OperationContext, index: int, clearing: RestClearing, progress: Progress) -> Sequence[Stroke]:
    """Return the strokes of an operation that clear what is left."""
    chunks, found = clearing.runs(progress.part(0.0, 0.6))
    context.note(clearing.levels)
    if not found:
        return ()
    reach, cut = clearing.reach, context.job.operations[index].cut
    tool, ground = context.job.tool(cut.tool), CutGround.of(clearing.paths.before)
    corridor = Corridor(reach.area.distances, reach.closest, ground, tool.radius)
    found = directed_runs(chunks, found, ground, tool.radius, cut.direction)
    return chains(chunks, found, corridor, longest_way(context.job, tool, cut), progress.part(0.6, 1.0))


def longest_way(job: Job, tool: Tool, cut: CutParameters) -> float:
    """Return the longest way at the floor, mm, that is gone rather than that the tool lifts."""
    lift = _STOPS / 60 + 2 * (job.travel_z + cut.floor) / _RAPID + (job.retract_z + cut.floor) / tool.plunge_rate
    return max(_FAR * tool.diameter, lift * tool.feed_rate)


def clears_within(operation: RestOperation, tool: Tool) -> float:
    """Return how far beside it a run is to clear, mm: half the stepover; without one the tool's radius.

    Raises:
        ParameterError: the stepover is larger than the tool.
    """
    if operation.stepover is None:
        return tool.radius
    if operation.stepover > tool.diameter:
        raise ParameterError(
            f"Stepover is {operation.stepover:g} mm, more than the diameter of T{tool.number} ({tool.diameter:g} mm); "
            "use at most the diameter."
        )
    return operation.stepover / 2


def paths_before(context: OperationContext, floor: float) -> list[tuple[Rows, float]]:
    """Return (rows, radius of the level ground it leaves, mm) of each tool's moves so far that lie as deep as a floor,
    mm, or deeper.
    """
    moves = context.builder.moves()
    deep = (np.maximum(moves.start[:, 2], moves.end[:, 2]) <= -floor + _DEPTH) & (moves.kind != MoveKind.RAPID)
    deep &= moves.purpose != Purpose.DRILL  # a drill's point leaves no level ground
    rows = move_rows(moves)
    tools = {int(number): context.job.tool(int(number)) for number in np.unique(moves.tool[deep])}
    return [
        (rows[deep & (moves.tool == number)], flat_radius(tool))
        for number, tool in tools.items()
        if flat_radius(tool) > 0
    ]


def contours_later(context: OperationContext, index: int, area: MachiningArea) -> list[tuple[Rows, float]]:
    """Return (rows, radius, mm) of the wall paths that operations later in the list will follow in the same area, as
    deep.
    """
    job = context.job
    own = job.operations[index].cut
    followers = [
        each.cut
        for each in job.operations[index + 1 :]
        if each.FOLLOWS_WALLS
        and each.wall_side is Side.INSIDE
        and each.cut.enabled
        and set(each.cut.curves) == set(own.curves)
        and each.cut.floor >= own.floor
    ]
    return [_wall_path(cut, job.tool(cut.tool), area) for cut in followers if flat_radius(job.tool(cut.tool)) > 0]


def _wall_path(cut: CutParameters, tool: Tool, area: MachiningArea) -> tuple[Rows, float]:
    level = area.frame(tool.radius + cut.stock_to_leave)
    rows = np.concatenate([np.zeros((0, 8)), *(ring.rows for ring in level.rings)])
    return rows[~area.follows_bare(rows)], flat_radius(tool)


@dataclass
class RestClearing:
    """Finds runs that clear what paths have left.

    Rings no farther apart than the radius leave nothing, so all of them near what is left clear it. They are offered
    closer together, and as few and short pieces of them are chosen as do.

    Attributes:
        reach: of the cutter.
        paths: what is cut without it.
        within: how far beside it a run is to clear, mm, at most the cutter's radius; nearer to walls it is the radius.
        levels: the rings.
    """

    reach: CentreReach
    paths: OtherPaths
    within: float
    levels: tuple[OffsetLevel, ...] = field(default=(), init=False)

    def runs(self, progress: Progress) -> tuple[RingChunks, list[RingRun]]:
        """Return the rings in short rows, and the runs along them."""
        reach, ground = self.reach, CutGround.of(self.paths.all)
        chunks = self._chunks((reach.area.frame(reach.closest, progress.part(0.0, 0.1)),))
        cutting = chunks.rows[~ground.in_air(chunks.rows, reach.radius)]
        squares = suspects(ground, reach, cutting, progress.part(0.1, 0.3))
        rim = rim_cells(ground, reach, squares, cutting)
        core = core_cells(ground, reach, squares)
        if not len(chunks.rows) or not len(core) + len(rim):
            return chunks, []
        step = max(self.within / 4, reach.radius / _FINEST)
        deepest = reach.area.distances.farthest(np.concatenate([core, rim]))
        count = 1 + int(max(0.0, deepest + step - reach.closest) / step)
        reach.ask_memory(CHUNK_BYTES * count * float(len(chunks.rows)))
        distances = [reach.closest + k * step for k in range(count)]
        chunks = self._chunks(offset_levels(reach.area.primitives, distances, progress.part(0.3, 0.6), frame=True))
        return chunks, self._choose(chunks, (core, rim), progress.part(0.6, 1.0))

    def _chunks(self, levels: tuple[OffsetLevel, ...]) -> RingChunks:
        self.levels = levels
        return RingChunks.of(self.levels, max(self.within, self.reach.radius / 2) / 4)

    def _choose(self, chunks: RingChunks, left: tuple[Floats, Floats], progress: Progress) -> list[RingRun]:
        """Return runs that clear cells of the core and of the rim."""
        reach, found = self.reach, list[RingRun]()
        cutting = ~CutGround.of(self.paths.all).in_air(chunks.rows, reach.radius)
        rim_rows = chunks.rows[cutting & (chunks.level[chunks.ring] == 0)]
        for done in range(_CHOSEN + 1):
            centres = _once(np.concatenate(left))
            if not len(centres) or not cutting.any():
                break
            progress.step(done / (_CHOSEN + 1), "Choosing runs")
            cells = RestCells.of(
                centres, chunks.rows[cutting], self.within - reach.corner if not done else reach.radius - reach.corner
            )
            found += runs(chunks, cutting, cells, reach) if done < _CHOSEN else all_runs(chunks, cutting, cells, reach)
            ground = CutGround.of(
                [*self.paths.all, *((chunks.path(run.chunk, run.count), reach.radius) for run in found)]
            )
            left = left_of(ground, reach, left, rim_rows)
        return found


def _once(places: Floats) -> Floats:
    """Return different places (n, 2) once, in the order of X, then of Y: complex numbers, which are sorted so, are
    sorted many times as quickly as rows.
    """
    return np.unique(places.view(np.complex128)).view(np.float64).reshape(-1, 2)
