"""Facing: parallel rows or a square spiral over the stock's top, beginning and turning beside it.

A flat end of radius e clears a strip 2 e wide. Rows lie at most a stepover apart, the first and the last one a little
less than e from the edges, and go on past them by the whole tool. Round the corners of a spiral the strips of two turns
still meet where they are at most sqrt(2) e apart, and the outermost turn reaches the corners of the stock where it lies
at most e / sqrt(2) from the edges. What no pass at Z 0 clears of the top is measured on the written text, as read back.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
import shapely
from numpy.typing import NDArray

from ...core.errors import ParameterError
from ...core.progress import Progress
from ...model.face_operation import FaceOperation, FacePattern
from ...model.finding import Finding, FindingKind
from ...model.job import Job
from ...model.motion import MotionKind
from ...model.moves import Purpose
from ...model.stock_box import StockBox, stock_box
from ...model.tool import Tool
from ...toolpath.build import Stroke, StrokeLabel
from ...toolpath.depth import pass_heights
from ...toolpath.operation_context import OperationContext
from ..registry import ProofInput

Points = NDArray[np.float64]

_SHARE = 0.7
"""Of the flat end's diameter: the stepover where nobody says one; the most of a spiral's is sqrt(2) / 2."""

_EDGE = 0.65
"""Of the flat end's radius: how far the outermost turn of a spiral is from the edges."""

_CLEAR = 1.0
"""mm beside the stock at which the tool goes down."""

_SAME = 1e-9
"""mm; steps that differ by no more are equal."""


def end_radius(tool: Tool) -> float:
    """Return the radius of a tool's level end, mm."""
    return tool.profile.flat


def stepover_of(operation: FaceOperation, tool: Tool) -> float:
    """Return the distance between rows, mm.

    Raises:
        ParameterError: the tool has no level end, or strips so far apart would not meet.
    """
    if not tool.kind.level:
        raise ParameterError(
            f"T{tool.number} {tool.label} leaves no level floor; take a flat or a bull-nose mill to face with."
        )
    wide = 2 * end_radius(tool)
    step = _SHARE * wide if operation.stepover is None else operation.stepover
    most = wide * (math.sqrt(0.5) if operation.pattern is FacePattern.SPIRAL else 1.0)
    if step > most + _SAME:
        raise ParameterError(
            f"Stepover is {step:g} mm; rows of T{tool.number}, whose end is level over {wide:g} mm, meet in this "
            f"pattern up to {most:.3f} mm: use less."
        )
    return step


def face(context: OperationContext, index: int, progress: Progress) -> None:
    """Take off the whole stock what stands above Z 0, in passes.

    Raises:
        ParameterError: nothing stands above Z 0, clamps are in the way, or the tool cannot face.
        Cancelled: by progress.
    """
    job = context.job
    operation = job.operations[index]
    assert isinstance(operation, FaceOperation)
    tool, step = job.tool(operation.cut.tool), stepover_of(operation, job.tool(operation.cut.tool))
    _check_room(job, bool(context.areas.drawn.clamps))
    box = stock_box(job, context.regions, context.areas.drawn.open)
    label = StrokeLabel(index, tool.number, tool.feed_rate, tool.plunge_rate)
    runs = tuple(_runs(box, tool, step, operation.pattern))
    for height in pass_heights(job.stock.above, operation.cut.stepdown, 0.0):
        progress.step(0.5, "Facing")
        for run in runs:
            _append(context, run, job.stock.above + height, label)
    context.stepovers[index] = step
    context.strokes += len(runs)
    text = f"T{tool.number} faces {job.stock.above:g} mm off the stock, down to Z 0, rows {step:g} mm apart."
    context.findings.append(Finding(FindingKind.ASSUMED, text, counts=False, amount=job.stock.above))


def _check_room(job: Job, clamped: bool) -> None:
    if not job.stock.above:
        raise ParameterError(
            "Nothing of the stock stands above Z 0, so there is nothing to face; say how much does: above in [stock]."
        )
    if clamped:
        raise ParameterError(
            "Keep-out areas lie on the stock, and facing goes over all of it; face in a set-up without clamps on top."
        )


def _runs(box: StockBox, tool: Tool, step: float, pattern: FacePattern) -> Iterator[Points]:
    """Yield the runs (n, 2) of a pass, without a lift each; along the longer side of the stock."""
    turned = box.y1 - box.y0 > box.x1 - box.x0
    x0, y0, x1, y1 = (box.y0, box.x0, box.y1, box.x1) if turned else (box.x0, box.y0, box.x1, box.y1)
    if pattern is FacePattern.SPIRAL:
        runs = [_spiral((x0, y0, x1, y1), tool, step)]
    else:
        rows = _rows((x0, y0, x1, y1), tool, step)
        runs = [np.concatenate(_zigzag(rows))] if pattern is FacePattern.ZIGZAG else rows
    yield from (run[:, ::-1] if turned else run for run in runs)


def _rows(sides: tuple[float, float, float, float], tool: Tool, step: float) -> list[Points]:
    x0, y0, x1, y1 = sides
    first, last = y0 + _EDGE * end_radius(tool), y1 - _EDGE * end_radius(tool)
    count = max(1, math.ceil((last - first) / step - _SAME) + 1) if last > first else 1
    heights = np.linspace(first, last, count) if count > 1 else np.array([(y0 + y1) / 2])
    past = tool.radius + _CLEAR
    return [np.array([[x0 - past, y], [x1 + past, y]]) for y in heights.tolist()]


def _zigzag(rows: list[Points]) -> list[Points]:
    """Return rows of which every other one goes back."""
    return [row[::-1] if k % 2 else row for k, row in enumerate(rows)]


def _spiral(sides: tuple[float, float, float, float], tool: Tool, step: float) -> Points:
    """Return a square spiral, from beside the stock to its middle."""
    x0, y0, x1, y1 = sides
    edge = _EDGE * end_radius(tool)
    begin = x0 - tool.radius - _CLEAR
    x0, y0, x1, y1 = x0 + edge, y0 + edge, x1 - edge, y1 - edge
    points = [(begin, min(y0, (y0 + y1) / 2))]
    while x1 > x0 and y1 > y0:
        points += [(x1, y0), (x1, y1), (x0, y1), (x0, y0 + step)]
        x0, y0, x1, y1 = x0 + step, y0 + step, x1 - step, y1 - step
    middle = (y0 + y1) / 2  # less than two steps are left there
    points += [(min(x0, x1), middle), (max(x0, x1), middle)]
    return np.array(points)


def _append(context: OperationContext, run: Points, height: float, label: StrokeLabel) -> None:
    """Append a run: down beside the stock, along, up."""
    job, builder, (x, y) = context.job, context.builder, run[0].tolist()
    builder.straight((x, y, job.travel_z), Purpose.RAPID, label)
    if job.retract_z < job.travel_z:
        builder.straight((x, y, job.retract_z), Purpose.RAPID, label)
    builder.straight((x, y, height), Purpose.PLUNGE, label)
    rows = np.zeros((len(run) - 1, 8))
    rows[:, :2], rows[:, 2:4] = run[:-1], run[1:]
    builder.cut(Stroke(rows, np.full(len(rows), Purpose.POCKET, np.uint8), 0), height, label)
    x, y = run[-1].tolist()
    builder.straight((x, y, job.travel_z), Purpose.RAPID, label)
    context.at = x, y


_LEVEL = 1e-3
"""mm above Z 0 at which a pass still clears it."""

_CHORD = 1e-3
"""mm; strips end in chords that lie this much within them, at most."""

_LEAST = 1e-4
"""mm2; less is left by digits alone."""


@dataclass(frozen=True)
class FaceProof:
    """What is proven of a face operation.

    Attributes:
        left_mm2: of the stock's top that no pass clears. x, y: in the middle of the largest such place.
    """

    KEY: ClassVar[str] = "faced"

    left_mm2: float
    x: float
    y: float

    def values(self) -> dict[str, Any]:
        """Return it as a report lists it."""
        return {"left_mm2": self.left_mm2, "x": self.x, "y": self.y}

    def findings(self) -> Iterator[Finding]:
        """Yield what counts."""
        if self.left_mm2 > _LEAST:
            text = f"{self.left_mm2:.4f} mm2 of the stock's top are not faced; use a smaller stepover."
            yield Finding(FindingKind.LEFT_REACHABLE, text, self.x, self.y, amount=self.left_mm2)


def face_proof(evidence: ProofInput) -> FaceProof:
    """Return what is proven of a face operation."""
    job, motions = evidence.job, evidence.motions
    box = stock_box(job, evidence.program.regions, evidence.program.lines)
    top = shapely.box(box.x0, box.y0, box.x1, box.y1)
    low = (motions.kind == MotionKind.LINE) & (np.maximum(motions.start[:, 2], motions.end[:, 2]) <= _LEVEL)
    ways = shapely.linestrings(np.stack([motions.start[low, :2], motions.end[low, :2]], axis=1))
    radius = job.tool(evidence.operation.cut.tool).profile.flat
    cleared = shapely.union_all(shapely.buffer(ways, radius - _CHORD, quad_segs=64))
    left = shapely.difference(top, cleared)
    place = shapely.point_on_surface(max(shapely.get_parts(left), key=shapely.area) if left.area else top)
    return FaceProof(float(left.area), float(place.x), float(place.y))
