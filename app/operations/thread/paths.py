"""Thread milling: on a helix of the pitch, in and out on half circles.

Climb milling goes round counter-clockwise in a hole, clockwise on a boss. A right-handed thread rises
counter-clockwise, a left-handed one falls. The half circle through the hole's middle stays on the thread's own surface:
seen from the axis it turns half as fast as it goes round, so that it rises, or falls, by a quarter of the pitch.
A wide mill cuts more of the flanks than a thread has: `correction` keeps it off the wall.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...core.errors import ParameterError
from ...core.progress import Progress
from ...core.wording import counted
from ...model.finding import Finding, FindingKind
from ...model.hole_operations import ThreadOperation
from ...model.moves import Purpose
from ...model.operation import Direction
from ...model.thread_sizes import ThreadSize
from ...model.tool import Tool
from ...toolpath.build import Stroke, StrokeLabel
from ...toolpath.drill_holes import CircleHole
from ...toolpath.operation_context import OperationContext
from ..helix import HelixRows, half_circle, helix
from ..holes import (
    HolesBefore,
    HoleVerb,
    holes_in_order,
    no_thread_findings,
    out_of_hole,
    over_hole,
    thread_findings,
)

VERB = HoleVerb("thread", "threads", "threaded", "thread mill", "too narrow for the mill")


@dataclass(frozen=True)
class ThreadWay:
    """The way of a thread mill round one axis.

    Attributes:
        radius: of its centre's helix, mm. lead: height that a half circle in or out takes, mm.
        starts: height of the lower end of each pass, mm. turns: of each.
        pitch: mm. ccw: seen from above. up: whether it goes up on its way round.
        beside: how far from the axis each half circle begins, mm: 0 in a hole.
        feed: of the mill's centre, mm/min.
    """

    radius: float
    lead: float
    starts: tuple[float, ...]
    turns: int
    pitch: float
    ccw: bool
    up: bool
    beside: float
    feed: float


def teeth_of(tool: Tool, pitch: float) -> int:
    """Return how many turns of a thread a mill cuts at once: as many as its flutes are pitches long; 1 = a single
    point.
    """
    return max(1, math.floor(tool.flute_length / pitch + 1e-9))


def way_of(operation: ThreadOperation, tool: Tool) -> ThreadWay:
    """Return the way of a thread mill round an axis.

    Raises:
        ParameterError: the thread is shorter than a half of its pitch.
    """
    thread, cut = operation.thread, operation.cut
    pitch, teeth = thread.pitch, teeth_of(tool, thread.pitch)
    ccw = (cut.direction is Direction.CLIMB) != operation.external
    up = ccw != operation.left_hand
    if operation.external:
        radius = thread.bolt_core / 2 + tool.radius + correction(thread, tool.radius, external=True)
        lead, beside = pitch * operation.lead(tool) / (2 * radius), radius + 2 * operation.lead(tool)
        feed = tool.feed_rate
    else:
        radius = thread.major / 2 - tool.radius - correction(thread, tool.radius, external=False)
        lead, beside = pitch / 4, 0.0
        feed = tool.feed_rate * radius / (radius + tool.radius)  # of its edge at the wall: the tool's own
    if cut.depth <= lead + pitch / 4:
        raise ParameterError(
            f"Depth is {cut.depth:g} mm, which is not even half a turn of {thread.value}; make the thread longer."
        )
    first = lead - cut.depth
    if teeth == 1:
        return ThreadWay(radius, lead, (first,), math.ceil(-first / pitch - 1e-9), pitch, ccw, up, beside, feed)
    passes = math.ceil(-first / (teeth * pitch) - 1e-9)
    starts = tuple(first + k * teeth * pitch for k in range(passes))
    return ThreadWay(radius, lead, starts if up else starts[::-1], 1, pitch, ccw, up, beside, feed)


def thread(context: OperationContext, index: int, progress: Progress) -> None:
    """Mill the thread in, or on, every circle that is one for it.

    Raises:
        ParameterError: it is deeper than the stock, or shorter than a turn.
        Cancelled: by progress.
    """
    job = context.job
    operation = job.operations[index]
    assert isinstance(operation, ThreadOperation)
    tool = job.tool(operation.cut.tool)
    way, unready, holes = way_of(operation, tool), [], []
    made = HolesBefore(job, context.areas.drawn, index)
    for hole, label in holes_in_order(context, index, VERB, progress):
        holes.append(hole)
        if not operation.external and (made.at(hole, operation.cut.depth) or 0.0) < operation.core - 1e-3:
            unready.append(hole)
        _cut_thread(context, hole, way, label)
    if unready:
        context.findings.append(_unready(unready, operation))
    if not operation.external:
        context.findings.extend(no_thread_findings(holes, made, operation, operation.cut.depth))
    context.findings.extend(thread_findings(holes, tool, operation))
    context.findings.append(_turns_finding(operation, tool, way))


def _cut_thread(context: OperationContext, hole: CircleHole, way: ThreadWay, label: StrokeLabel) -> None:
    """Append the passes round one axis."""
    builder, centre = context.builder, (hole.x, hole.y)
    place, wall = (hole.x + way.beside, hole.y), (hole.x + way.radius, hole.y)
    rise = way.turns * way.pitch
    over_hole(context, place, label)
    for low in way.starts:
        ends = (low, low + rise) if way.up else (low + rise, low)
        lead = way.lead if way.up else -way.lead
        builder.straight((*place, ends[0] - lead), Purpose.PLUNGE, label)
        turning = way.ccw != bool(way.beside)
        ways = (
            (half_circle(place, wall, (ends[0] - lead, ends[0]), turning), Purpose.LEAD),
            (helix(centre, way.radius, ends, way.turns, way.ccw), Purpose.CONTOUR),
            (half_circle(wall, place, (ends[1], ends[1] + lead), turning), Purpose.LEAD),
        )
        for each, purpose in ways:
            _append(context, each, purpose, way.feed, label)
    context.strokes += len(way.starts)
    out_of_hole(context, label)


def _append(context: OperationContext, way: HelixRows, purpose: Purpose, feed: float, label: StrokeLabel) -> None:
    stroke = Stroke(way.rows, np.full(len(way.rows), purpose, np.uint8), 0)
    context.builder.along(stroke, way.heights, label, np.full(len(way.rows), feed))


def _unready(holes: list[CircleHole], operation: ThreadOperation) -> Finding:
    first, thread = holes[0], operation.thread
    text = (
        f"No operation before it makes {'the hole' if len(holes) == 1 else f'{len(holes)} of the holes'} at "
        f"({first.x:.3f}, {first.y:.3f}) as wide as the core of {thread.value}, {operation.core:.3f} mm, and "
        f"{operation.cut.depth:g} mm deep; drill or bore it first."
    )
    return Finding(FindingKind.ENGAGEMENT, text, first.x, first.y, amount=float(len(holes)))


def _turns_finding(operation: ThreadOperation, tool: Tool, way: ThreadWay) -> Finding:
    """Return how the thread is cut, and what the cut shows of it."""
    passes = len(way.starts)
    how = (
        f"{counted(way.turns, 'turn')} with one tooth"
        if teeth_of(tool, way.pitch) == 1
        else f"{passes} x 1 turn with all teeth"
    )
    short = correction(operation.thread, tool.radius, operation.external)
    moved = f", {short:.4f} mm farther from the wall for the form of the flanks"
    hand = ", left-handed," if operation.left_hand else ""
    where = "on the boss" if operation.external else "in the hole"
    text = (
        f"T{tool.number} mills {operation.thread.value}{hand} {where}: {how}, {'up' if way.up else 'down'}{moved}. The "
        "cut shows no turns of a thread, only the core within the mill's teeth."
    )
    return Finding(FindingKind.ASSUMED, text, counts=False)


_SAMPLES = 4096
"""Angles that are looked at: what lies between two of them is less than a nanometre higher."""


_ROUNDS = 6
"""The error changes little with the way: each round is a tenth as far off as the one before, or less."""


def flank_error(thread: ThreadSize, radius: float, way: float, place: float) -> float:
    """Return by how much, mm along the axis, a tooth's flank cuts more than it is meant to, for the mill's width.

    A tooth of half width w(d) = (r - d) tan(a) at distance d from the mill's axis, r its radius, a half the angle
    between the flanks, goes round on a helix of radius R and pitch P. In a plane through the hole's axis, at distance q
    from that, it is q - R deep at angle 0 of the mill, and at angle t it is P t / 2 pi higher and its distance there is
    d(t) = sqrt(R^2 + q^2 - 2 R q cos t). So its flank cuts, beside what it is meant to, up to

        f(q) = max over t of  P t / 2 pi - (d(t) - d(0)) tan(a)  >= 0

    which is 0 for a mill without width and grows with r. On a boss the same holds, with R outside.

    Args:
        thread: its pitch and form. radius: of the mill, mm. way: radius of its centre's helix, mm.
        place: distance from the hole's axis, mm.
    """
    slope = math.tan(math.radians(thread.form.value / 2))

    within = (way**2 + place**2 - radius**2) / (2 * way * place)  # beyond this angle the tooth is out of the wall
    angles = np.linspace(0.0, math.acos(max(-1.0, min(1.0, within))), _SAMPLES)
    far = np.sqrt(way**2 + place**2 - 2 * way * place * np.cos(angles))
    gain = thread.pitch * angles / math.tau - (far - abs(place - way)) * slope
    return float(gain.max())


def correction(thread: ThreadSize, radius: float, external: bool) -> float:
    """Return by how much farther from the wall a mill keeps than it is wide, mm, so that the thread has its pitch
    diameter: by `flank_error` / tan(a) there, so that the flanks are where they should be.

    Args:
        thread: that is cut. radius: of the mill, mm. external: on a boss, and not in a hole.
    """
    slope, place = math.tan(math.radians(thread.form.value / 2)), thread.pitch_diameter / 2
    farther = 0.0
    for _ in range(_ROUNDS):
        way = thread.bolt_core / 2 + radius + farther if external else thread.major / 2 - radius - farther
        farther = flank_error(thread, radius, way, place) / slope
    return farther
